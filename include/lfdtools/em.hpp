// One iteration of expectation maximisation for a Gaussian mixture, linear in the samples.
#pragma once

#include "lfdtools/gmm.hpp"

namespace lfd {

/// 1 for a column of the samples (N x D) that takes two values or more, 0 for a constant one.
[[nodiscard]] Vector varying_columns(const Matrix& samples);

/// The covariance of a type of its own (not tied) that maximises Q (see em_step) for a component.
/// full: S + R. diagonal: its diagonal. spherical: sigma^2 I, where Q, -D ln sigma^2 - tr(S + R) / sigma^2 up to
/// constants, is greatest at sigma^2 = tr(S + R) / D; a constant column takes no part and keeps its own S + R, so that
/// it neither narrows the others nor is widened by them.
/// @param Sigma   S + R, D x D   @param varies  varying_columns
[[nodiscard]] Matrix constrained(const Matrix& Sigma, CovarianceType type, const Vector& varies);

struct EmStep {
  Gmm gmm;               ///< after the M step
  double objective = 0;  ///< of the mixture that went in [nats]: see GmmFit::history
  Vector counts;         ///< K, sum over the samples of the responsibilities of the E step
};

/// E step, then M step with R added to each covariance. A component without responsibility keeps mean and covariance.
/// The E step weighs component k by pi_k N(x; mu_k, Sigma_k) exp(-1/2 tr(Sigma_k^-1 R)); then adding R is the exact M
/// step (Q = sum_ik r_ik (ln pi_k + ln N(x_i; mu_k, Sigma_k) - 1/2 tr(Sigma_k^-1 R)) is greatest at Sigma_k = S_k + R),
/// and the objective, sum_i ln of the sum of these weights, never falls.
/// @param gmm             covariances positive definite
/// @param samples         N x D, stored column by column
/// @param regularization  diagonal of R, D, not negative
/// @param jobs            threads; 0: one a processor
/// @param vector_width    one of vector_widths() (lanes.hpp); 0: the widest. The result depends on neither, to the last
/// bit
/// @throws DataError [linalg.not_positive_definite], [gmm.too_many_columns] above 64 columns; UsageError
/// [em.vector_width]
[[nodiscard]] EmStep em_step(const Gmm& gmm, const Matrix& samples, const Vector& regularization,
                             CovarianceType type = CovarianceType::full, unsigned jobs = 1, int vector_width = 0);

}  // namespace lfd
