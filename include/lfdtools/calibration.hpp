// Bands that hold on people: what a process says of its own uncertainty, scaled by what it missed on targets that were
// left out.
#pragma once

#include <limits>
#include <optional>

#include "lfdtools/metrics.hpp"
#include "lfdtools/skill_train.hpp"

namespace lfd {

/// Variance of the positions of a motion by model and phase.
struct PositionVariance {
  Samples unit;   ///< T x D, of a relative variance of 1 [m^2]: diag(s^2 R A^-T Omega A^-1 R^T)
  Vector latent;  ///< D, relative latent variance k^ of (21) of the process that gives the axis
  Vector noise;   ///< D, relative noise variance of one demonstration

  /// unit times (latent + extra + noise / repetitions), T x D [m^2].
  /// @param extra  D, relative   @param repetitions  infinite: no noise
  [[nodiscard]] Samples of_mean(const Vector& extra, double repetitions) const;
};

/// @param phases  T, times over the duration
[[nodiscard]] PositionVariance position_variance(const SkillPredictor& predictor, const Reach& reach,
                                                 const Vector& phases);

/// Shares at which bands are calibrated and judged: 0.1, 0.2, ... 0.9, 0.95, 0.99.
[[nodiscard]] const std::vector<double>& nominal_levels();

/// Which samples a band promises to hold.
enum class BandKind {
  pointwise,  ///< a share of all samples, each axis by itself
  path        ///< the whole path of a share of targets
};

/// What the intention at a new target may do: half-width of the band about the predicted motion, T x D [m],
/// sqrt(factor^2 (unit (latent + target_variance) + reproduction^2) + q^2 unit noise / repetitions), where q is the
/// normal quantile of the level, for whole paths times the ratio of both factors. Without a calibration the factor is
/// the quantile of the process's Student-t and the band is only as honest as the process.
/// @param level        share promised, in (0, 1)
/// @param repetitions  of the mean path that is to be held: its noise is added; infinite: of the intention itself
[[nodiscard]] Samples band(const SkillPredictor& predictor, const Reach& reach, const Vector& phases, BandKind kind,
                           double level = 0.95, double repetitions = std::numeric_limits<double>::infinity());

/// Factors on the latent covariance of a motion, D, with which its 95 % intervals are the calibrated band's, but for
/// what primitives miss of the recordings: (factor / normal quantile)^2 (latent + target_variance) / latent. Empty
/// without a calibration.
[[nodiscard]] Vector covariance_factors(const SkillPredictor& predictor, const Reach& reach);

/// Leaves every target out in turn, learns from the others, and compares what is predicted with the mean of the
/// target's rows. The error is that of hyperparameters searched anew, which know nothing of the target (but the kind of
/// kernel, which is chosen once for all rows). The sd beside
/// it is that of the skill's own hyperparameters: searched anew, they fall now into one optimum and now into another,
/// and a factor measured on the narrow sd of the one would be applied to the wide sd of the other.
///
/// target_variance is what sets a target apart from what its neighbours say (rows of one target share it, so that
/// repeating a target does not average it away), by moments on each axis: the mean over targets of
/// (sum of squared errors) / (sum of unit variances) - noise / rows, but at least the mean of the latent variances. So
/// at least half of the variance does not depend on the target: how latent variance rises from a target's neighbourhood
/// is the least certain part of a process, and a factor measured where targets are left out would be too small between
/// them.
///
/// A factor is the least with which band() holds what was missed on the mean of the rows, and what their primitives
/// miss of the recordings: `pointwise` on a share of all samples and axes, but at least half a normal quantile (few
/// targets do not show that the process is over twice too careful); `path`, at least `pointwise`, on whole targets,
/// with the rank ceil((m + 1) level) of split conformal prediction, so that a new whole path is inside with probability
/// m / (m + 1) when that rank is over m. None is smaller than that of a lower level. All times t / z, the quantiles of
/// Student-t and of the normal distribution, because the sd was itself measured on m targets: with m - 1 degrees of
/// freedom `path`, and with D (m - 1) `pointwise`, which is a measured choice (the sd counts the latent variance twice;
/// m - 1 would hold 99 % of synthetic intentions).
///
/// Where several teachers reach one target, all of their rows are left out together.
/// @return empty with fewer than three targets that differ
/// @throws those of train_skill
/// @param rows, options  those that the skill was trained with
[[nodiscard]] std::optional<Calibration> calibrate(const Skill& skill, const std::vector<SkillRow>& rows,
                                                   const SkillOptions& options);

}  // namespace lfd
