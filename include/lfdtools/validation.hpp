// The judge: every target is left out once and generated from the others, whole pipe inside each fold.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/alignment.hpp"
#include "lfdtools/dmp.hpp"
#include "lfdtools/skill.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// The demonstrations of one target, as recorded.
struct TargetDemonstrations {
  Labels labels;
  std::vector<Trajectory> demonstrations;
};

/// Which rows a skill learns from.
enum class Road {
  demonstrations,  ///< every aligned demonstration
  references       ///< one GMM-GMR reference a target: the paper's
};

/// Names that ValidationOptions::methods may hold, and what they mean, for --help and the manual.
struct MethodDescription {
  std::string name;
  std::string meaning;
};
[[nodiscard]] const std::vector<MethodDescription>& validation_methods();

struct ValidationOptions {
  std::vector<std::string> methods;  ///< empty: all of validation_methods()
  Road road = Road::demonstrations;  ///< of the method `skill`; both papers' take references
  AlignmentOptions alignment;
  Eigen::Index k_from = 1;  ///< components of the references, chosen by BIC
  Eigen::Index k_to = 12;
  Eigen::Index bases = 15;
  std::uint64_t seed = 1;
  unsigned jobs = 1;
};

/// How a method did on a target that it had not seen.
struct ValidationScore {
  Labels labels;  ///< of the left-out target
  std::string method;
  double rmse = 0;       ///< to the target's mean path at equal phases [m]
  double end_error = 0;  ///< distance from the goal at tau [m]
  double dtw = 0;        ///< mean distance along the cheapest DTW path to the mean path [m]
  double outside = 0;    ///< greatest depth beyond the region that neighbouring demonstrations swept [m]
  std::optional<double>
      coverage95;  ///< share of samples of the mean path inside the 95 % band on every axis; empty: no band
  std::optional<double> path95;  ///< 1 if the whole mean path is inside, else 0
};

struct Validation {
  std::vector<ValidationScore> scores;  ///< by target, then by method
  /// Training rows, over all folds, that the gate on small |g - y0| would have refused for `paper` and `paper-full`.
  int lifted_gates = 0;
};

/// Scores are taken on 200 phases. The mean path of a target is linear in each demonstration's own time, so that it
/// owes nothing to the alignment under test. The left-out target's mean start and goal are the query. `outside` looks
/// at deviations from the straight minimum-jerk line between start and goal: at each phase the box that the deviations
/// of the demonstrations of the four nearest training targets span.
/// @throws DataError [validation.too_few_targets] under three targets; UsageError [validation.method]; those of the
/// stages
[[nodiscard]] Validation leave_one_target_out(const std::vector<TargetDemonstrations>& targets,
                                              const ValidationOptions& options);

/// Straight minimum-jerk line y0 + mj(s) (g - y0), mj(s) = 10 s^3 - 15 s^4 + 6 s^5, n x D.
/// @param phases  n in [0, 1]
[[nodiscard]] Samples straight_line(const Vector& start, const Vector& goal, const Vector& phases);

/// One reference of a target: its aligned demonstrations through GMM (K by BIC) and GMR, on 200 times.
struct ReferencePath {
  Trajectory path;  ///< 200 x D, times from 0
  Vector start;     ///< mean of the measured starts, D [m]
  Vector goal;      ///< mean of the measured goals, D [m]
};
[[nodiscard]] ReferencePath reference_path(const std::vector<Trajectory>& aligned, const ValidationOptions& options);

}  // namespace lfd
