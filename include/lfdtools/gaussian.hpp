// Densities in logarithms.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

inline constexpr double log_2pi = 1.8378770664093454835606594728112353;

/// ln sum_i exp(v_i), without overflow; -inf for an empty vector or one of -inf alone.
[[nodiscard]] double log_sum_exp(const Eigen::Ref<const Vector>& v);

/// ln N(x; mu, L L^T), paper eq. (2).
/// @param x, mu  d   @param L  lower Cholesky factor of the covariance, d x d
[[nodiscard]] double log_normal_density(const Eigen::Ref<const Vector>& x, const Eigen::Ref<const Vector>& mu,
                                        const Matrix& L);

/// Derivative of ln Gamma, to a relative 1e-14 but near its zero at 1.46.  @param x  positive
[[nodiscard]] double digamma(double x);

/// Quantile of Student's t distribution.
/// @param p  in (0, 1)   @param nu  degrees of freedom, positive; infinite: the normal distribution
[[nodiscard]] double student_t_quantile(double p, double nu);

}  // namespace lfd
