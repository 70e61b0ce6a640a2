// Alignment in time of the demonstrations of one target (paper Table 1, step 1).
//
// Gathering samples along a DTW path leaves staircases. Here the path only says which elapsed times belong together:
// it becomes a smooth, strictly rising warp of time, and a spline through the recorded samples is read at warped times.
#pragma once

#include <optional>
#include <vector>

#include "lfdtools/linalg.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// What the demonstrations of a group are warped to.
enum class Reference {
  medoid,      ///< the demonstration with the least summed DTW cost to the others
  longest,     ///< the one that takes longest (the first of equals)
  barycentre,  ///< DTW barycentre averaging (Petitjean et al. 2011), from the medoid
  chosen       ///< the one that AlignmentOptions::chosen names
};

/// Whose timing the aligned group has.
enum class Clock {
  mean,      ///< the mean over the group: at each phase, the mean of the demonstrations' own elapsed times
  reference  ///< the reference's, scaled to the mean duration
};

/// Speed, as a fraction of a demonstration's peak speed, under which its ends count as idle when `--trim` has no value.
inline constexpr double default_trim = 0.05;

/// Price of bending a warp: 3e-4 to 1e-3 draw hand motions together almost as far as no price, without rougher motion.
inline constexpr double warp_stiffness = 3e-4;
/// No demonstration is sped up or slowed down by more than this, relative to its reference.
inline constexpr double steepest_warp = 3;

/// How a group is aligned.
struct AlignmentOptions {
  Reference reference = Reference::medoid;
  Eigen::Index chosen = 0;  ///< index in the group, from 0; for Reference::chosen only
  Clock clock = Clock::mean;
  std::optional<double> window;         ///< Sakoe-Chiba half-width, as in DtwOptions; of the costs and of the warps
  std::optional<Eigen::Index> samples;  ///< of each aligned demonstration, >= 2; default: those of the reference
  std::optional<double> trim;           ///< cut idle ends: fraction of the peak speed in (0, 1), see trim()
  bool leave_out_outliers = false;      ///< all but the chosen reference
  double outlier_deviations = 5;  ///< an outlier's mean cost exceeds the median by this many robust standard deviations
  unsigned jobs = 1;              ///< threads; 0: one a processor; the result is the same
};

/// A strictly rising map from phase, 0 to 1, to seconds elapsed since a demonstration's first sample: monotone cubic
/// (PCHIP) through its knots.
struct Warp {
  Vector phases;   ///< n, strictly rising, first 0, last 1
  Vector elapsed;  ///< n, strictly rising, first 0, last the duration [s]

  /// Elapsed times at the phases s, n; the ends exact. @param s  in [0, 1]
  [[nodiscard]] Vector operator()(const Vector& s) const;
};

/// What is left of a demonstration whose idle ends were cut.
struct Trimmed {
  Trajectory trajectory;  ///< keeps the recorded times
  double start = 0;       ///< cut at the start [s]
  double end = 0;         ///< cut at the end [s]
};

/// A group on one time base. Vectors run over the demonstrations given, in their order, unless `kept` is named.
struct GroupAlignment {
  std::vector<Trajectory> aligned;  ///< of `kept`: T x D on one grid, linspace(0, mean duration, T)
  std::vector<Warp> warps;          ///< of `kept`: from the group's phase (grid / mean duration) to own elapsed time
  std::vector<Eigen::Index> kept;   ///< indices of the demonstrations aligned, rising
  Eigen::Index reference = 0;       ///< index of the reference; for Reference::barycentre of the medoid it began with
  Matrix costs;                     ///< M x M DTW costs of the recorded (trimmed) positions, symmetric, zero diagonal
  std::vector<Trimmed> trimmed;     ///< M; without `trim` the demonstrations as they came and zero seconds
  std::vector<bool> outliers;       ///< M
};

/// Cuts idle time at both ends: the motion begins at the last sample before the speed first exceeds the threshold and
/// ends at the first sample after it last does. Speed is distance over time across a window of 0.2 s or a twentieth of
/// the duration, the shorter, so that tremor does not count as motion.
/// @param threshold  fraction of the demonstration's peak speed, in (0, 1)
/// @throws DataError as check(Trajectory), [alignment.no_motion] if nothing moves; UsageError [alignment.trim]
[[nodiscard]] Trimmed trim(const Trajectory& demonstration, double threshold = default_trim);

/// DTW costs of all pairs of recorded positions: sums of Euclidean distances on the cheapest path, classic steps.
/// @return  M x M, symmetric, zero diagonal   @throws as dtw_cost
[[nodiscard]] Matrix pairwise_costs(const std::vector<Trajectory>& demonstrations, std::optional<double> window = {},
                                    unsigned jobs = 1);

/// Demonstrations far from the group: mean cost to the others above the median by `deviations` times 1.4826 MAD (and by
/// a tenth of the median, so that a group of near-copies has none). None in groups under four.
/// @param costs  M x M as from pairwise_costs   @return  M flags
[[nodiscard]] std::vector<bool> find_outliers(const Matrix& costs, double deviations = 5);

/// The warp that leads a demonstration x along a reference r, both over phase s (elapsed time over duration). With phi
/// its elapsed time over its duration at 201 phases, it begins at the tie means of the DTW path and is a minimum near
/// them of
///   mean_s |x(phi(s)) - r(s)|^2 / V + warp_stiffness * integral phi''^2,   phi(0) = 0, phi(1) = 1,
/// V the variance of r over s, slopes of phi within [1 / steepest_warp, steepest_warp].
/// @param window  Sakoe-Chiba half-width as a fraction of the phase, (0, 1]
/// @throws DataError as check(Trajectory)
[[nodiscard]] Warp warp_onto(const Trajectory& reference, const Trajectory& demonstration,
                             std::optional<double> window = {});

/// Aligns the demonstrations of one target. First and last samples are kept exactly. A group of one is only resampled.
/// Samples closer together than a tenth of the median interval become one, their mean: no spline passes through two
/// values at nearly the same time.
/// @param demonstrations  M >= 1, all of D signals, times strictly rising, from any origin
/// @throws DataError as check(Trajectory), [alignment.empty] [alignment.dimensions]; UsageError [alignment.samples]
///         [alignment.chosen] [alignment.trim] [dtw.window]
[[nodiscard]] GroupAlignment align(const std::vector<Trajectory>& demonstrations, const AlignmentOptions& options = {});

}  // namespace lfd
