// The skill as a method to be judged, in all its readings, and its band.
#pragma once

#include "lfdtools/prediction.hpp"
#include "lfdtools/skill.hpp"

namespace lfd {

/// The default skill with the given structure, its rows those of the road. Needs primitives.
[[nodiscard]] Trainer skill_method(SkillStructure structure);

/// The published formulation: rows TrainingTarget::paper, SkillOptions::paper. Needs them.
/// @param structure  axis (Sec. III-C) or full (Table 1)
[[nodiscard]] Trainer paper_method(SkillStructure structure);

/// Band of a skill about its prediction: Student-t quantile times the sd of a new row, whose noise (that of one
/// demonstration) is divided by `averaged`.
/// @param primitive  as predicted   @param averaged  demonstrations in the mean path that the band is about
[[nodiscard]] Band band_of(const Skill& skill, const Dmp& primitive, double averaged);

}  // namespace lfd
