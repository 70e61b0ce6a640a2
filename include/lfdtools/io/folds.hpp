// Lists of folds: which targets are left out together.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/io/csv.hpp"

namespace lfd {

/// Reads `target,[teacher,]fold`, a row a target; folds are numbers or words. Without a column `teacher` a row stands
/// for the target of every teacher.
/// @param targets  labels of the demonstrations' targets
/// @return fold of each target, numbered from 0 in the order of first appearance
/// @throws as CsvTable; DataError [folds.repeated_target], [folds.unknown_target], [folds.missing_target]
[[nodiscard]] std::vector<int> read_folds(const std::string& name, const std::vector<Labels>& targets,
                                          Messages& messages);

}  // namespace lfd
