// What training rows say against themselves: rows that repeat each other, outliers, targets that coincide.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lfdtools/skill.hpp"

namespace lfd {

/// Rows that are, number for number, an earlier row of their target. Such a copy says that a demonstration
/// has no noise at all.
[[nodiscard]] std::vector<std::size_t> repeated_rows(const std::vector<SkillRow>& rows);

/// A row that is far from the others.
struct Outlier {
  std::size_t row = 0;
  double ratio = 0;   ///< how far, over the median of the rows judged
  bool ends = false;  ///< far by its start and goal, not by its motion
};

/// Rows over `limit` times as far from the others as the median row. None under four rows, of which the median says too
/// little.
///
/// First by start and goal: the distance from their medians over the repetitions of the target by its teacher, of three
/// at least, if it is over 100 mm too. A row far off in its inputs is a target of its own to the processes, which miss
/// its neighbours for it, so that where there is one, motions are not judged.
///
/// Else by what a row misses: its left-out residual (left_out_residuals, norm over all signals) over the standard
/// deviation that the processes expect of it, for a target at the edge may be missed by more than one between others.
/// @param rows  that the skill was trained with
[[nodiscard]] std::vector<Outlier> outlying_rows(const Skill& skill, const std::vector<SkillRow>& rows,
                                                 double limit = 5);

/// Pairs of target_groups whose mean dP and mean start differ by under 1 mm. Left out in turn, the one is predicted
/// from the other.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> coinciding_targets(const std::vector<SkillRow>& rows);

}  // namespace lfd
