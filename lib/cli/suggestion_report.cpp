#include "lfdtools/cli/suggestion_report.hpp"

#include <fmt/format.h>

#include "lfdtools/io/csv.hpp"
#include "lfdtools/io/labelled_table.hpp"

namespace lfd::cli {

void write_suggestion(const Suggestion& suggestion, const std::vector<std::string>& columns,
                      const std::vector<SkillRow>& rows, Output& out) {
  const auto names = label_columns(rows.front().labels);
  CsvWriter table(out, joined(joined({"kind"}, names), joined(columns, {"sd_before", "sd_after", "change"})));
  const auto cells = [&](const Vector& goal, double after, double change) {
    for (const double value : goal) table.number(value);
    for (const double value : {suggestion.sd_before, after, change}) table.number(value);
    table.end_row();
  };
  table.text("suggestion");
  for (std::size_t i = 0; i < names.size(); ++i) table.text("");
  cells(suggestion.goal, suggestion.sd_after, -suggestion.fall);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table.text("demonstration");
    table.labels(rows[i].labels);
    cells(rows[i].primitive.goal, suggestion.rows[i].largest_sd, suggestion.rows[i].growth);
  }
}

void report(const Suggestion& suggestion, const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
            Run& run) {
  std::string where;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    where += fmt::format("{}{} {:.4g}", j > 0 ? ", " : "", columns[j], suggestion.goal[static_cast<Eigen::Index>(j)]);
  }
  run.messages().note("validate.suggestion",
                      fmt::format("a target at {} lowers the largest sd in the box most, from {:.2f} to {:.2f} mm",
                                  where, 1e3 * suggestion.sd_before, 1e3 * suggestion.sd_after));
  const auto& least = suggestion.rows[suggestion.least];
  run.messages().note("validate.least_demonstration",
                      fmt::format("{} adds least: without it the sd grows by at most {:.2g} mm, to at most {:.2f} mm",
                                  describe(rows[suggestion.least].labels), 1e3 * least.growth, 1e3 * least.largest_sd));
  run.figure("sd_before", suggestion.sd_before);
  run.figure("sd_after", suggestion.sd_after);
}

}  // namespace lfd::cli
