// Weights of a movement primitive from one trajectory.
#pragma once

#include <optional>
#include <vector>

#include "lfdtools/dmp.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// How to fit. The defaults are those of the library; the paper's are lwr and goal.
struct DmpFitOptions {
  DmpFitMethod fit = DmpFitMethod::trajectory;
  DmpScaling scaling = DmpScaling::none;
  Eigen::Index bases = 15;                            ///< N >= 2
  double alpha_z = 25;                                ///< damping [1]
  std::optional<double> beta_z;                       ///< alpha_z / 4 if empty [1]
  double alpha_x = CanonicalSystem::default_alpha_x;  ///< decay of the phase [1]
  std::optional<DmpSettings> settings;                ///< in place of the five above
  std::optional<Vector> start;                        ///< D [m]; the first sample if empty
  std::optional<Vector> goal;                         ///< D [m]; the last sample if empty
  Samples sd;                                         ///< T x D [m], or empty: standard deviation of each sample
  double hold_weight = 10;                            ///< weight of standing still after tau, see below; 0: none
  bool allow_small_scale = false;                     ///< zero weights instead of an error where g = y0
};

/// Fits a primitive of duration tau = last time - first time; times are counted from the first sample.
///
/// `lwr`: w_i = sum_k psi_i xi_k f_k / sum_k psi_i xi_k^2 with xi = x s and f = forcing_target, one weight at a time.
/// `ls`: all weights together, min sum_k (f_k - f(x_k))^2. `trajectory`: min sum_k (y_k - y_free - s R w)^2 over
/// positions, without derivatives; sample k weighs 1 / sd_k^2 where sd is given (floored at 1 % of the axis's largest).
///
/// Only `trajectory` sees to the end of the motion. A recording that is cut while the hand still moves leaves the last
/// weights free, and the forcing term, which fades slowly after tau, would carry the hand away from the goal (48 mm)
/// and back. So y(tau) = goal is met to rounding, and the goal is held over two durations after tau, at the samples'
/// own rate and at hold_weight times the weight of a sample: with 15 bases a recording that ends at rest then stays
/// within 0.1 mm of its goal, one that ends at 10 cm/s within 0.5 mm (settle_time says when it rests). Both are linear
/// in the weights, so that weights predicted as combinations of fitted ones inherit them.
///
/// With sd (used by `trajectory` alone) the covariance of the weights is kept: (A^T S^-1 A)^-1 where A are the rows of
/// samples, end and hold, S the variances of the samples; end and hold count as samples of typical sd, 1 / sqrt(mean
/// 1/sd^2), divided by their weight. Errors of samples are taken as independent. An axis whose sd are all zero is
/// fitted unweighted with covariance zero.
/// @throws DataError as check(Trajectory); [dmp.more_bases_than_samples] for N > T, [dmp.too_few_samples] for T < 3;
///         [dmp.basis], [dmp.spring], [dmp.alpha_x]; [dmp.shape], [dmp.not_finite] of start, goal or sd;
///         [dmp.zero_scale]. UsageError [dmp.hold_weight] unless finite and not negative
[[nodiscard]] Dmp fit_dmp(const Trajectory& trajectory, const DmpFitOptions& options = {});

/// Forcing term that reproduces a trajectory, paper eq. (14), with the derivatives of `difference`.
/// @param trajectory  T x D, T >= 3   @param goal  D [m]
/// @return f_target, T x D [m]
[[nodiscard]] Samples forcing_target(const Trajectory& trajectory, const Spring& spring, const Vector& goal);

/// First and second derivative of samples: of the least-squares cubic through the seven nearest samples (all where
/// there are fewer; a parabola through three). On uneven times and at both ends as well, the error of the second
/// derivative is of second order in the spacing, that of the first of third.
struct Derivatives {
  Samples first;   ///< T x D [1/s]
  Samples second;  ///< T x D [1/s^2]
};
/// @throws DataError as check(Trajectory); [dmp.too_few_samples] for T < 3
[[nodiscard]] Derivatives difference(const Trajectory& trajectory);

/// Per axis, whether |g - y0| is under 1 % of the excursion of the axis (largest minus smallest sample): there the
/// scaling `goal` divides by almost nothing. A constant axis is not small.
/// @param start, goal  D [m]
[[nodiscard]] std::vector<bool> small_goal_change(const Trajectory& trajectory, const Vector& start,
                                                  const Vector& goal);

}  // namespace lfd
