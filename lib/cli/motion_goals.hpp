// The numbers of a request as goals and demands; shared by the files that answer it.
#pragma once

#include "lfdtools/cli/motion_request.hpp"

namespace lfd::cli {

/// @throws UsageError [usage.arity] unless there is one number a signal
[[nodiscard]] Vector position(const std::vector<double>& numbers, std::size_t D, const char* option);

/// The goals of --goal or --goals, through --camera; --start and --duration take the place of their own.
/// @throws UsageError [generate.no_target], [generate.camera], [usage.arity]; those of read_goals
[[nodiscard]] std::vector<Goal> goals_of(const MotionRequest& request, const std::vector<std::string>& columns,
                                         Run& run);

/// --goal-at through --camera: goals with their times, weights empty.
/// @throws UsageError [usage.arity], [usage.value] unless the times are positive and rise
[[nodiscard]] std::vector<GoalChange> changes_of(const MotionRequest& request, std::size_t D);

/// --via, --start-velocity and --end-velocity. @throws UsageError [usage.arity], [usage.value] for a negative sd or
/// time
[[nodiscard]] MotionConstraints constraints_of(const MotionRequest& request, std::size_t D);

}  // namespace lfd::cli
