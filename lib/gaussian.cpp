#include "lfdtools/gaussian.hpp"

#include <cmath>
#include <limits>

namespace lfd {

double log_sum_exp(const Eigen::Ref<const Vector>& v) {
  if (v.size() == 0) return -std::numeric_limits<double>::infinity();
  const double largest = v.maxCoeff();
  if (!std::isfinite(largest)) return largest;
  return largest + std::log((v.array() - largest).exp().sum());
}

double log_normal_density(const Eigen::Ref<const Vector>& x, const Eigen::Ref<const Vector>& mu, const Matrix& L) {
  const Vector e = L.triangularView<Eigen::Lower>().solve(x - mu);
  return -0.5 * (static_cast<double>(x.size()) * log_2pi + log_determinant_from_cholesky(L) + e.squaredNorm());
}

}  // namespace lfd
