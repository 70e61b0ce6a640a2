// skill-validate --suggest: from its option to what is written.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/fold.hpp"
#include "lfdtools/suggestion.hpp"

namespace lfd::cli {

/// The box of `--suggest`. @param region  low and high of each signal in turn
/// @throws UsageError [usage.arity], [usage.range]
[[nodiscard]] GoalBox goal_box(const std::vector<double>& region);

/// Learns the default skill of all targets and writes what to demonstrate next.
/// @throws UsageError [usage.arity] unless the box has an interval for every column; those of learn and suggest
void suggest_target(const std::vector<TargetDemonstrations>& targets, const std::vector<std::string>& columns,
                    const GoalBox& box, const PreparationOptions& preparation, Run& run);

}  // namespace lfd::cli
