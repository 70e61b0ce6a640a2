// The probability of touching that is told beforehand, and how often what it speaks of does touch.
#pragma once

#include <vector>

#include "banded_skill.hpp"
#include "lfdtools/methods.hpp"
#include "studied_scene.hpp"

namespace lfd::scenes {

/// Writes rows of the skill's own paths, of paths drawn from its covariance, and of the same about the skill's way to
/// where a goal that is off was seen.
/// @param skill  the default one   @param paths  its path to each new hole, n x 3 [m]
void judge_chances(const StudiedScene& scene, const BandedSkill& banded, const Predictor& skill,
                   const std::vector<Samples>& paths, const Random& random);

}  // namespace lfd::scenes
