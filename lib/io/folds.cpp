#include "lfdtools/io/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace lfd {

std::vector<int> read_folds(const std::string& name, const std::vector<Labels>& targets, Messages& messages) {
  std::vector<Input> inputs;
  inputs.emplace_back(name);
  const CsvTable table(std::move(inputs), messages, {.grouped = false});
  const auto target_cells = table.read_text(0, "target");
  const auto fold_cells = table.read_text(0, "fold");
  const auto teacher_cells = table.has("teacher") ? table.read_text(0, "teacher") : std::vector<std::string>();
  const std::size_t first_line = table.groups().front().first_line;

  std::map<std::string, int> numbers;
  std::vector<int> folds(targets.size(), -1);
  for (std::size_t row = 0; row < target_cells.size(); ++row) {
    const Place place{table.inputs().front().name(), first_line + row, 0, ""};
    Labels labels;
    labels.target = target_cells[row];
    if (!teacher_cells.empty()) labels.teacher = teacher_cells[row];
    const int fold = numbers.emplace(fold_cells[row], static_cast<int>(numbers.size())).first->second;
    bool known = false;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (targets[i].target != labels.target || (labels.teacher && targets[i].teacher != labels.teacher)) continue;
      if (folds[i] >= 0) {
        throw DataError("folds.repeated_target", fmt::format("{} stands twice", describe(labels)), place);
      }
      folds[i] = fold;
      known = true;
    }
    if (!known) {
      throw DataError("folds.unknown_target", fmt::format("there are no demonstrations of {}", describe(labels)),
                      place);
    }
  }
  const auto missing = std::find(folds.begin(), folds.end(), -1);
  if (missing != folds.end()) {
    const auto& labels = targets[static_cast<std::size_t>(missing - folds.begin())];
    throw DataError("folds.missing_target", fmt::format("no row gives the fold of {}", describe(labels)),
                    {table.inputs().front().name(), 0, 0, ""});
  }
  return folds;
}

}  // namespace lfd
