// The skill as a method to be judged, in all its readings.
#pragma once

#include "lfdtools/prediction.hpp"
#include "lfdtools/skill_train.hpp"

namespace lfd {

/// The default skill with the given structure and process, its rows those of the road, its bands calibrated on the
/// targets of the fold. Needs primitives.
[[nodiscard]] Trainer skill_method(SkillStructure structure, ProcessType process = ProcessType::gaussian);

/// The published formulation: rows TrainingTarget::paper, SkillOptions::paper. Needs them.
/// @param structure  axis (Sec. III-C) or full (Table 1)
[[nodiscard]] Trainer paper_method(SkillStructure structure);

}  // namespace lfd
