// The judge: methods learn from some targets and generate others that they have not seen, whole pipe inside each fold.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/fold.hpp"
#include "lfdtools/prediction.hpp"

namespace lfd {

struct ValidationOptions {
  std::vector<std::string> methods;  ///< names of methods.hpp; empty: all
  /// Fold of each target, any numbers; targets of one fold are left out together. Empty: each is a fold of its own.
  /// Of leave_one_target_out alone.
  std::vector<int> folds;
  PreparationOptions preparation;
  unsigned jobs = 1;
};

/// How a band at some level does on one target.
struct BandScore {
  double pointwise =
      0;             ///< share of (phase, signal) pairs of the mean path inside the pointwise band, without the ends
  double path = 0;   ///< 1 if all of them are inside the band for whole paths, else 0
  double width = 0;  ///< mean over these pairs of the half-width of the pointwise band [m]
};

/// How a method did on a target that it had not seen.
struct ValidationScore {
  Labels labels;  ///< of the judged target
  std::string method;
  double rmse = 0;                  ///< to the target's mean path at equal phases [m]
  double end_error = 0;             ///< distance from the goal at tau [m]
  double dtw = 0;                   ///< mean distance along the cheapest DTW path to the mean path [m]
  double outside = 0;               ///< greatest depth beyond the region that neighbouring demonstrations swept [m]
  std::optional<BandScore> band95;  ///< empty: the method has no band
  std::vector<BandScore> bands;     ///< at nominal_levels() (calibration.hpp), or empty
};

/// Processor time that a method took to learn and to predict, over all folds [s]; without the preparation of rows.
struct MethodTime {
  std::string method;
  double seconds = 0;
};

struct Validation {
  std::vector<ValidationScore> scores;             ///< by target, then by method
  std::vector<std::optional<double>> noise_floor;  ///< JudgedTarget::noise_floor of each target [m]
  std::vector<MethodTime> times;                   ///< by method
  /// Training rows, over all folds, that the gate on small |g - y0| would have refused for `paper` and `paper-full`.
  int lifted_gates = 0;
};

/// Leaves every target out once, by all of its teachers, alone or with the others of its fold (folds are taken as they
/// are, also where they part the teachers of a target). A method learns once a fold and is told of the left-out targets
/// their mean start and mean goal, the query, and nothing else.
/// @throws DataError [validation.too_few_targets] under three targets, or where a fold leaves under two to learn from;
///         UsageError [validation.method]; those of the stages, with method and fold named
[[nodiscard]] Validation leave_one_target_out(const std::vector<TargetDemonstrations>& targets,
                                              const ValidationOptions& options);

/// Learns from all of `targets`, once, and is judged on all of `test`, told of them what leave_one_target_out tells.
/// Both are trimmed alike. A target may be in both: then its score is one of reproduction.
/// @throws DataError [validation.too_few_targets] under two targets to learn from, [validation.no_test_target];
///         the others as leave_one_target_out
[[nodiscard]] Validation judge_on_test_targets(const std::vector<TargetDemonstrations>& targets,
                                               const std::vector<TargetDemonstrations>& test,
                                               const ValidationOptions& options);

/// Greatest depth of a path beyond what demonstrations swept: at each phase, by how far its deviation from the straight
/// minimum-jerk line lies outside the box that the deviations of the four nearest targets (by goal - start) span [m].
/// @param path  phase_count x D
[[nodiscard]] double outside_depth(const Samples& path, const Query& query,
                                   std::vector<const JudgedTarget*> demonstrated);

/// @param predicted  with a band   @param mean_path  phase_count x D [m]
[[nodiscard]] BandScore band_score(const Predicted& predicted, double level, const Samples& mean_path);

}  // namespace lfd
