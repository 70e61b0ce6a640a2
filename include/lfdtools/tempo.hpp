// Tempo: how early or late a hand is on its way, which repetitions of one motion show to be mostly chance.
#pragma once

#include "lfdtools/skill.hpp"

namespace lfd {

/// Rows whose targets have been drawn towards one tempo. To first order a hand that is early by c, at phase
/// s + c sin(pi s) instead of s, changes its path y by c sin(pi s) dy/ds. For each row c is the projection onto that
/// direction of what is left of it when its target is left out; rows of one target scatter about the target's mean c_i
/// with variance v, so c_i itself has the variance v / n_i by chance alone. What the c_i vary beyond that, V, is the
/// targets' own (moments, at least 0), and each row of target i loses
///     v / n_i / (V + v / n_i) (c_i - mean)
/// of its earliness: the best linear guess of the target's own tempo. Ends stay where they are.
/// @param skill  learnt from these rows, with an output transform, scaling none
/// @return rows unchanged where there are fewer than three targets (of each teacher) or no target has two rows
[[nodiscard]] std::vector<SkillRow> with_shared_tempo(const Skill& skill, std::vector<SkillRow> rows);

}  // namespace lfd
