// A table whose label columns are those of the first group written.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lfdtools/io/csv.hpp"

namespace lfd {

/// Writes groups of numeric rows behind their labels.
class LabelledTable {
 public:
  /// @param columns  names behind the labels   @param out  must outlive the table
  LabelledTable(Output& out, std::vector<std::string> columns) : out_(out), columns_(std::move(columns)) {}

  /// @param values  rows x columns
  /// @throws DataError [csv.labels_differ] if the labels are not those of the first group, [csv.group_reappears]
  void write(const Labels& labels, const Samples& values);

  /// The writer, for rows with other cells than numbers; begins the table if it has not begun.
  CsvWriter& begin(const Labels& labels);

 private:
  Output& out_;
  std::vector<std::string> columns_;
  std::vector<std::string> label_columns_;
  std::optional<CsvWriter> writer_;
  std::set<std::string> seen_;  // groups written so far, as words
  Labels last_;
};

/// {first..., second...}
[[nodiscard]] std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& second);
/// Each name behind a prefix, such as start_x.
[[nodiscard]] std::vector<std::string> prefixed(const std::string& prefix, const std::vector<std::string>& names);
/// (a | b)
[[nodiscard]] Samples beside(const Samples& a, const Samples& b);

}  // namespace lfd
