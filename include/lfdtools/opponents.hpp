// Methods without learning from dP: what a skill has to beat before anything else.
#pragma once

#include "lfdtools/prediction.hpp"

namespace lfd {

/// Straight minimum-jerk line between the ends (Flash and Hogan 1985): nothing is learnt.
[[nodiscard]] Predictor train_line(const Fold& fold, const PreparationOptions& options);

/// Mean weights (fit trajectory, scaling none) of the target with the nearest dP. Needs primitives.
[[nodiscard]] Predictor train_nearest(const Fold& fold, const PreparationOptions& options);

/// Mean over the targets of each target's mean weights. Needs primitives.
[[nodiscard]] Predictor train_mean(const Fold& fold, const PreparationOptions& options);

/// The mean deviation from the straight minimum-jerk line, at equal phases, of the target with the nearest dP, added to
/// the query's line.
[[nodiscard]] Predictor train_nearest_deviation(const Fold& fold, const PreparationOptions& options);

/// The same with the mean over the targets of each target's mean deviation.
[[nodiscard]] Predictor train_mean_deviation(const Fold& fold, const PreparationOptions& options);

/// One primitive, of the mean path of the target with the nearest dP, with start and goal moved: what a movement
/// primitive does by itself (Ijspeert et al. 2013), and where the paper begins. Scaling goal, paper eq. (12): with
/// scaling none this would be `train_nearest`. Fit trajectory; an axis on which that goal is the start keeps zero
/// weights.
[[nodiscard]] Predictor train_moved_goal(const Fold& fold, const PreparationOptions& options);

/// Index in the fold of the target whose dP is nearest to that of the query (of equals the first).
[[nodiscard]] std::size_t nearest_target(const Fold& fold, const Query& query);

/// Mean over the examples of their deviations, phase_count x D [m].
[[nodiscard]] Samples mean_deviation(const TrainingTarget& target);

}  // namespace lfd
