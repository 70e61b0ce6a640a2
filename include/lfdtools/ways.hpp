// Two ways round: demonstrations that pass something on one side or the other, whose mean would go through it.
#pragma once

#include <optional>

#include "lfdtools/skill.hpp"

namespace lfd {

struct Ways {
  std::vector<int> of_row;  ///< 0 or 1; way 0 is that of the first row
  double distance = 0;      ///< between the ways of a target, root mean square over the duration and the targets [m]
  double separation = 0;    ///< distance over the rows' standard deviation about the mean of their target and way
};

/// Looks for two ways in what is left of each row when its target is left out (left_out_residuals), along the direction
/// in which rows of one target differ most: there, the rows of each target (and teacher) that has six or more are
/// parted in two so that they scatter least about the means of both parts. A target was reached both ways where these
/// are at least 5 % of the mean |dP| and seven standard deviations apart (Ashman's D, of the scatter pooled over all
/// targets; six values of a normal distribution part by 5 as often as not, and by 7 once in twenty). Two ways are told
/// where some target was reached both ways, for a jump from target to target may as well be what is meant, and each is
/// that of a tenth of all rows, for fewer are outliers. The other targets belong to the way whose rows tell them
/// better.
///
/// Where no target has six rows, all rows are split at once, by 2-means, and have to be five standard deviations apart.
/// Not looked for under twenty rows, where the best split of mere scatter is as clear, and in weights of scaling goal,
/// which are no distances.
/// @param skill  learnt from these rows, with an output transform
[[nodiscard]] std::optional<Ways> two_ways(const Skill& skill, const std::vector<SkillRow>& rows);

/// Way of most rows of the target nearest to a goal, by change.
[[nodiscard]] int nearest_way(const std::vector<SkillRow>& rows, const Ways& ways, const Vector& change);

/// The rows of one way.
[[nodiscard]] std::vector<SkillRow> rows_of_way(const std::vector<SkillRow>& rows, const Ways& ways, int way);

}  // namespace lfd
