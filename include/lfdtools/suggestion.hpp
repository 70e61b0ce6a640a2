// Which target to demonstrate next, and which demonstration says least: what a skill's uncertainty over a box of goals
// would be with a row more and with a row less.
#pragma once

#include <cstddef>
#include <vector>

#include "lfdtools/calibration.hpp"

namespace lfd {

/// Goals that matter. An axis may be flat.
struct GoalBox {
  Vector low;   ///< D [m]
  Vector high;  ///< D [m], none below low
};

/// The goals of a box that are looked at, G x D [m]: an equally spaced grid with both ends of each axis, the same odd
/// number of points along all that are not flat, 101 at most and 1000 in all.
/// @throws UsageError [suggestion.box] if low and high differ in size, are not finite, or low is above high;
///         [suggestion.dimensions] for over six axes that are not flat
[[nodiscard]] Matrix goal_grid(const GoalBox& box);

/// The standard deviation of the intention at a goal, as the calibrated band has it (calibration.hpp): the largest over
/// 200 phases and all axes of sqrt(unit (k^ + target_variance) + reproduction^2) [m], where k^ is the latent relative
/// variance (21) of a motion from the usual start. Of a skill that is not calibrated sqrt(unit k^).
///
/// k^ does not depend on the outputs, so for given hyperparameters, Omega and calibration it is known beforehand what a
/// row would do to it; Omega's expectation under the prediction is what it is now. With C the latent covariance between
/// goals, P = K'^-1 and k = K(X, g):
///   r demonstrations more of a target at c   k^(g) - C(g, c)^2 / (k^(c) + noise_variance / r)
///   row i less                               k^(g) + (P k)_i^2 / P_ii
struct Suggestion {
  /// Without one row. largest_sd alone says nothing of rows far from the goal where the sd is largest.
  struct Row {
    double largest_sd = 0;  ///< over the box [m]
    double growth = 0;      ///< of the sd, the greatest over the goals [m]
  };

  Vector goal;            ///< of the grid, that whose demonstrations leave the smallest largest sd, D [m]
  double sd_before = 0;   ///< largest over the box [m]
  double sd_after = 0;    ///< the same with the new target [m]
  double fall = 0;        ///< of the sd with the new target, the greatest over the goals [m]
  std::vector<Row> rows;  ///< n
  std::size_t least = 0;  ///< the row of the smallest growth, of equals the first
};

/// @param repetitions  demonstrations r of the new target, at least 1
/// @throws UsageError those of goal_grid, and [suggestion.box] if the box has not D axes
[[nodiscard]] Suggestion suggest(const SkillPredictor& predictor, const GoalBox& box, double repetitions);

}  // namespace lfd
