#include "lfdtools/gmm.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"

namespace lfd {
namespace {

using Eigen::Index;

Place at(std::string pointer) {
  Place place;
  place.pointer = std::move(pointer);
  return place;
}

/// Calls use(first, weights) for blocks of samples with ln(pi_k N(x_i; mu_k, Sigma_k)), block x K.
template <typename Use>
void for_log_weights(const Gmm& gmm, const Samples& samples, const Use& use) {
  check(gmm);
  const Index K = gmm.components();
  const Index D = gmm.dimensions();
  if (samples.cols() != D) {
    throw DataError("gmm.shape", "samples have " + std::to_string(samples.cols()) + " columns, the mixture has " +
                                     std::to_string(D));
  }
  if (!samples.allFinite()) throw DataError("gmm.not_finite", "a sample is not a finite number");
  std::vector<Matrix> factors;
  Vector constants(K);
  for (Index k = 0; k < K; ++k) {
    factors.push_back(cholesky(gmm.covariances[static_cast<std::size_t>(k)]));
    constants[k] = std::log(gmm.priors[k]) -
                   0.5 * (static_cast<double>(D) * log_2pi + log_determinant_from_cholesky(factors.back()));
  }
  constexpr Index block = 512;
  for (Index first = 0; first < samples.rows(); first += block) {
    const Index count = std::min(block, samples.rows() - first);
    const Matrix x = samples.middleRows(first, count).transpose();
    Matrix weights(count, K);
    for (Index k = 0; k < K; ++k) {
      Matrix z = x.colwise() - gmm.means.row(k).transpose();
      factors[static_cast<std::size_t>(k)].triangularView<Eigen::Lower>().solveInPlace(z);
      weights.col(k) = constants[k] - 0.5 * z.colwise().squaredNorm().transpose().array();
    }
    use(first, weights);
  }
}

/// log_sum_exp of each row.
Vector row_log_sum_exp(const Matrix& weights) {
  const Vector largest = weights.rowwise().maxCoeff();
  if (!largest.allFinite()) {  // a sample so far away that its density underflows even as a logarithm
    Vector result(weights.rows());
    for (Index i = 0; i < weights.rows(); ++i) result[i] = log_sum_exp(weights.row(i).transpose());
    return result;
  }
  const Vector total = (weights.colwise() - largest).array().exp().rowwise().sum();
  return largest.array() + total.array().log();
}

}  // namespace

void check(const Gmm& gmm) {
  const Index K = gmm.components();
  const Index D = gmm.dimensions();
  if (K == 0 || D == 0) throw DataError("gmm.shape", "a mixture without components or dimensions");
  if (gmm.means.rows() != K || static_cast<Index>(gmm.covariances.size()) != K) {
    throw DataError("gmm.shape", "priors, means and covariances differ in length");
  }
  if (!gmm.priors.allFinite()) {
    throw DataError("gmm.not_finite", "a prior is not a finite number", at("/priors"));
  }
  if (gmm.priors.minCoeff() < 0.0 || std::abs(gmm.priors.sum() - 1.0) > 1e-6) {
    throw DataError("gmm.priors", "priors must not be negative and must sum to 1", at("/priors"));
  }
  if (!gmm.means.allFinite()) throw DataError("gmm.not_finite", "a mean is not a finite number", at("/means"));
  for (Index k = 0; k < K; ++k) {
    const Matrix& Sigma = gmm.covariances[static_cast<std::size_t>(k)];
    const Place place = at("/covariances/" + std::to_string(k));
    if (Sigma.rows() != D || Sigma.cols() != D) throw DataError("gmm.shape", "covariance is not D x D", place);
    if (!Sigma.allFinite())
      throw DataError("gmm.not_finite", "covariance has an entry that is no finite number", place);
    // |Sigma_ab - Sigma_ba| against the largest entry that the variances allow at this place
    const Vector sd = Sigma.diagonal().cwiseMax(0.0).cwiseSqrt();
    const Matrix allowed = 1e-9 * (sd * sd.transpose());
    if (((Sigma - Sigma.transpose()).cwiseAbs().array() > allowed.array()).any()) {
      throw DataError("gmm.not_symmetric", "covariance is not symmetric", place);
    }
    Matrix L;
    if (!try_cholesky(Sigma, L)) {
      throw DataError("gmm.not_positive_definite", "covariance is not positive definite", place);
    }
  }
}

Vector log_densities(const Gmm& gmm, const Samples& samples) {
  Vector result(samples.rows());
  for_log_weights(gmm, samples, [&](Index first, const Matrix& weights) {
    result.segment(first, weights.rows()) = row_log_sum_exp(weights);
  });
  return result;
}

double log_likelihood(const Gmm& gmm, const Samples& samples) {
  return log_densities(gmm, samples).sum();
}

Samples responsibilities(const Gmm& gmm, const Samples& samples) {
  Samples result(samples.rows(), gmm.components());
  for_log_weights(gmm, samples, [&](Index first, const Matrix& weights) {
    const Vector total = row_log_sum_exp(weights);
    if (!total.allFinite()) throw DataError("gmm.out_of_range", "a sample is too far from the mixture");
    result.middleRows(first, weights.rows()) = (weights.colwise() - total).array().exp();
  });
  return result;
}

double responsibility_entropy(const Gmm& gmm, const Samples& samples) {
  double result = 0.0;
  for_log_weights(gmm, samples, [&](Index, const Matrix& weights) {
    const Vector total = row_log_sum_exp(weights);
    if (!total.allFinite()) throw DataError("gmm.out_of_range", "a sample is too far from the mixture");
    // ln r, kept finite where r underflows to 0 or the prior is 0: there r ln r is 0
    const Matrix log_r = (weights.colwise() - total).cwiseMax(-1e3);
    result -= log_r.array().exp().cwiseProduct(log_r.array()).sum();
  });
  return std::max(result, 0.0);  // rounding can put ln r a little over 0
}

}  // namespace lfd
