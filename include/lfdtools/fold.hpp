// What a judge of methods knows: the targets that they learn from, and those that they are asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lfdtools/alignment.hpp"
#include "lfdtools/dmp.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// The demonstrations of one target, as recorded.
struct TargetDemonstrations {
  Labels labels;
  std::vector<Trajectory> demonstrations;
  bool noise_free = false;  ///< the one path is the intention itself: a band about it needs no noise of demonstrations
  std::vector<Labels> demonstration_labels = {};  ///< of each, where they are known
};

/// What one training row is.
enum class Road {
  recordings,      ///< a demonstration in its own time
  demonstrations,  ///< a demonstration, aligned with the others of its target
  references       ///< the GMM-GMR reference of a target: the paper's
};

/// From demonstrations to training rows.
struct PreparationOptions {
  Road road = Road::recordings;
  AlignmentOptions alignment;
  Eigen::Index k_from = 1;  ///< components of the references, chosen by BIC
  Eigen::Index k_to = 12;
  Eigen::Index bases = 15;
  std::optional<std::size_t> repetitions;  ///< learn from this many demonstrations of a target, drawn; empty: all
  std::uint64_t seed = 1;                  ///< of the draw, of EM and of the methods
};

/// One motion to learn from.
struct Example {
  Vector start, goal;  ///< D [m]
  Samples path;        ///< phase_count x D [m]
  Dmp primitive;       ///< fit trajectory, scaling none; without weights unless a method needs them

  [[nodiscard]] Vector change() const { return goal - start; }
  /// Path minus the straight minimum-jerk line between its ends, phase_count x D [m].
  [[nodiscard]] Samples deviation() const;
};

/// A target that methods learn from.
struct TrainingTarget {
  Labels labels;
  Vector start, goal;             ///< means over the examples, D [m]
  std::vector<Example> examples;  ///< one or more
  std::optional<Dmp> paper;       ///< fit lwr, scaling goal, of the reference; empty unless a method needs it
  bool small_change = false;      ///< the gate of the paper's scaling would refuse it

  [[nodiscard]] Vector change() const { return goal - start; }
};

/// All that a method is told of a target that it has not seen.
struct Query {
  Vector start, goal;      ///< means of the measured ends, D [m]
  double repetitions = 1;  ///< demonstrations behind the mean path that the band is about; infinite: the intention
  std::optional<std::string> teacher = {};  ///< whose motion is wanted

  [[nodiscard]] Vector change() const { return goal - start; }
};

/// A target that methods are judged on.
struct JudgedTarget {
  Labels labels;
  Query query;
  /// Mean path, linear in each demonstration's own time, so that it owes nothing to any alignment; phase_count x D [m].
  Samples mean_path;
  std::vector<Samples> deviations;  ///< of each demonstration, phase_count x D [m]
  /// How far the mean path itself is from that of endless repetitions: root mean square over the phases of the standard
  /// deviation of the demonstrations, over the root of their number [m]. Empty for a single demonstration.
  std::optional<double> noise_floor;
};

/// Targets that a method may learn from.
using Fold = std::vector<const TrainingTarget*>;

/// What of a training target the chosen methods ask for.
struct Needs {
  bool primitives = false;  ///< Example::primitive
  bool paper = false;       ///< TrainingTarget::paper
};

/// Recordings with idle ends cut and outliers left out, as the options say.
/// @throws those of trim and pairwise_costs
[[nodiscard]] std::vector<Trajectory> recorded(const TargetDemonstrations& target, const AlignmentOptions& options);

/// @param recordings  as from `recorded`, M >= 1
[[nodiscard]] JudgedTarget judged_target(const Labels& labels, const std::vector<Trajectory>& recordings);

/// Alignment, mixture and regression are computed only where the road or `needs` ask for them.
/// @param recordings  as from `recorded`, M >= 1
/// @param stream      number of the target: each has a random stream of its own for the draw of repetitions
/// @throws those of align, select_components, fit_dmp
[[nodiscard]] TrainingTarget training_target(const Labels& labels, const std::vector<Trajectory>& recordings,
                                             const PreparationOptions& options, const Needs& needs,
                                             std::uint64_t stream);

/// Straight minimum-jerk line y0 + mj(s) (g - y0), mj(s) = 10 s^3 - 15 s^4 + 6 s^5, n x D.
/// @param phases  n in [0, 1]
[[nodiscard]] Samples straight_line(const Vector& start, const Vector& goal, const Vector& phases);

/// One reference of a target: its aligned demonstrations through GMM (K by BIC) and GMR, on 200 times.
struct ReferencePath {
  Trajectory path;  ///< 200 x D, times from 0
  Vector start;     ///< mean of the measured starts, D [m]
  Vector goal;      ///< mean of the measured goals, D [m]
};
[[nodiscard]] ReferencePath reference_path(const std::vector<Trajectory>& aligned, const PreparationOptions& options);

}  // namespace lfd
