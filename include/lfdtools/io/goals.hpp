// Lists of goals: where a skill shall go.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/io/csv.hpp"
#include "lfdtools/skill.hpp"

namespace lfd {

/// Reads `[target,][teacher,]<signal...>[,start_<s>...][,sd_<s>...][,duration]`, a row a goal.
/// @param signals  columns of the positions, all needed
/// @throws as CsvTable; DataError [goals.partial_start] if some but not all start columns are there,
///         [goals.partial_sd] likewise, [goals.sd] if one is negative, [goals.repeated_target], [goals.duration] unless
///         positive
[[nodiscard]] std::vector<Goal> read_goals(const std::string& name, const std::vector<std::string>& signals,
                                           Messages& messages);
/// The same from an input that is open.
[[nodiscard]] std::vector<Goal> read_goals(Input input, const std::vector<std::string>& signals, Messages& messages);

}  // namespace lfd
