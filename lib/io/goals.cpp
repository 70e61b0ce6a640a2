#include "lfdtools/io/goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lfdtools/io/labelled_table.hpp"

namespace lfd {

std::vector<Goal> read_goals(const std::string& name, const std::vector<std::string>& signals, Messages& messages) {
  return read_goals(Input(name), signals, messages);
}

std::vector<Goal> read_goals(Input input, const std::vector<std::string>& signals, Messages& messages) {
  const std::string name = input.name();
  std::vector<Input> inputs;
  inputs.push_back(std::move(input));
  const CsvTable table(std::move(inputs), messages, {.grouped = false});
  const auto all_or_none = [&](const std::vector<std::string>& names, const char* id, const char* what) {
    const auto count = std::count_if(names.begin(), names.end(), [&](const auto& s) { return table.has(s); });
    if (count != 0 && count != static_cast<std::ptrdiff_t>(names.size())) {
      throw DataError(id, fmt::format("some signals have {} column and others have none", what), {name, 1, 0, ""});
    }
    return count > 0;
  };
  const auto starts = prefixed("start_", signals);
  const auto sds = prefixed("sd_", signals);
  const bool with_start = all_or_none(starts, "goals.partial_start", "a start_");
  const bool with_sd = all_or_none(sds, "goals.partial_sd", "an sd_");
  const bool with_duration = table.has("duration");
  auto columns = signals;
  if (with_start) columns = joined(columns, starts);
  if (with_sd) columns = joined(columns, sds);
  if (with_duration) columns.emplace_back("duration");
  std::string unused;
  for (const auto& column : table.columns()) {
    if (column != "target" && column != "teacher" &&
        std::find(columns.begin(), columns.end(), column) == columns.end()) {
      unused += (unused.empty() ? "" : ", ") + column;
    }
  }
  if (!unused.empty()) messages.note("csv.ignored_columns", "columns without a use here: " + unused, {name, 1, 0, ""});
  const NumericBlock block = table.read_group(0, columns);
  const auto targets = table.has("target") ? table.read_text(0, "target") : std::vector<std::string>();
  const auto teachers = table.has("teacher") ? table.read_text(0, "teacher") : std::vector<std::string>();

  std::vector<Goal> goals(static_cast<std::size_t>(block.values.rows()));
  std::set<std::pair<std::string, std::string>> seen;
  const auto D = static_cast<Eigen::Index>(signals.size());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Goal& goal = goals[i];
    if (!targets.empty()) goal.labels.target = targets[i];
    if (!teachers.empty()) goal.labels.teacher = teachers[i];
    if (!targets.empty() && !seen.emplace(targets[i], teachers.empty() ? "" : teachers[i]).second) {
      throw DataError("goals.repeated_target", fmt::format("target {} stands twice", targets[i]), block.place(row));
    }
    goal.position = block.values.row(row).head(D).transpose();
    if (with_start) goal.start = block.values.row(row).segment(D, D).transpose();
    if (with_sd) {
      const Vector sd = block.values.row(row).segment(with_start ? 2 * D : D, D).transpose();
      if (!(sd.array() >= 0).all()) {
        throw DataError("goals.sd", "a standard deviation is negative", block.place(row));
      }
      goal.covariance = sd.array().square().matrix().asDiagonal();
    }
    if (with_duration) {
      goal.duration = block.values(row, block.values.cols() - 1);
      if (!(*goal.duration > 0)) throw DataError("goals.duration", "a duration is not positive", block.place(row));
    }
  }
  return goals;
}

}  // namespace lfd
