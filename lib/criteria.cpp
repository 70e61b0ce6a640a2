#include "lfdtools/criteria.hpp"

#include <cmath>

namespace lfd {

using Eigen::Index;

Index free_parameters(Index components, Index dimensions, CovarianceType type) {
  const Index K = components;
  const Index D = dimensions;
  const Index location = (K - 1) + K * D;
  switch (type) {
    case CovarianceType::tied:
      return location + D * (D + 1) / 2;
    case CovarianceType::diagonal:
      return location + K * D;
    case CovarianceType::spherical:
      return location + K;
    case CovarianceType::full:
      break;
  }
  return location + K * D * (D + 1) / 2;
}

double bic(double log_likelihood, Index q, double n) {
  return -2.0 * log_likelihood + static_cast<double>(q) * std::log(n);
}

double aic(double log_likelihood, Index q) {
  return -2.0 * log_likelihood + 2.0 * static_cast<double>(q);
}

double icl(double log_likelihood, Index q, double n, double entropy) {
  return bic(log_likelihood, q, n) + 2.0 * entropy;
}

double Criteria::of(Criterion criterion) const {
  switch (criterion) {
    case Criterion::aic:
      return aic;
    case Criterion::icl:
      return icl;
    case Criterion::bic:
      break;
  }
  return bic;
}

Criteria criteria(double log_likelihood, double entropy, Index q, Index samples, const CriterionOptions& options) {
  const auto N = static_cast<double>(samples);
  const double n = options.bic_n > 0.0 ? options.bic_n : N;
  if (options.likelihood == Likelihood::effective) {
    log_likelihood *= n / N;
    entropy *= n / N;
  }
  return {bic(log_likelihood, q, n), aic(log_likelihood, q), icl(log_likelihood, q, n, entropy)};
}

}  // namespace lfd
