// What skill-validate --suggest writes: the target to demonstrate next, and what each demonstration adds.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/skill.hpp"
#include "lfdtools/suggestion.hpp"

namespace lfd::cli {

/// CSV `kind,[target,][teacher,][demo,]<signal...>,sd_before,sd_after,change`: a row `suggestion`, then a row
/// `demonstration` a training row.
/// @param rows  that the skill was trained on
void write_suggestion(const Suggestion& suggestion, const std::vector<std::string>& columns,
                      const std::vector<SkillRow>& rows, Output& out);

/// The same in two sentences, millimetres, as notes; figures for --summary.
void report(const Suggestion& suggestion, const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
            Run& run);

}  // namespace lfd::cli
