// Two ways round: demonstrations that pass something on one side or the other, whose mean would go through it.
#pragma once

#include <optional>

#include "lfdtools/skill.hpp"

namespace lfd {

struct Ways {
  std::vector<int> of_row;  ///< 0 or 1; way 0 is that of the first row
  double distance = 0;      ///< between the mean motions of both, root mean square over the duration [m]
  double separation = 0;    ///< distance over the rows' standard deviation about their own way, along the line between
};

/// Looks for two ways in what is left of each row when its target is left out (left_out_residuals), so that what
/// follows the target smoothly is gone: the best 2-means split, projected onto the line between its centers. Two ways
/// are told where these are at least 5 % of the mean |dP| and five standard deviations apart (Ashman's D; splitting a
/// normal distribution in the middle gives 2.6, a uniform one 3.5), each is that of a tenth of the rows at least,
/// and some target was reached both ways: a jump from target to target may as well be what is meant.
/// Not looked for under twenty rows, where the best split of mere scatter is as clear, and in weights of scaling goal,
/// which are no distances.
/// @param skill  learnt from these rows, with an output transform
[[nodiscard]] std::optional<Ways> two_ways(const Skill& skill, const std::vector<SkillRow>& rows);

/// Way of most rows of the target nearest to a goal, by change.
[[nodiscard]] int nearest_way(const std::vector<SkillRow>& rows, const Ways& ways, const Vector& change);

/// The rows of one way.
[[nodiscard]] std::vector<SkillRow> rows_of_way(const std::vector<SkillRow>& rows, const Ways& ways, int way);

}  // namespace lfd
