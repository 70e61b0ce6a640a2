// Tables of numbers in comma-separated values, group by group.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/io/input.hpp"
#include "lfdtools/io/message.hpp"
#include "lfdtools/io/output.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// How to read tables.
struct CsvOptions {
  /// Rows of one target, teacher, demo and sample stand together and form a group; false: a file is one group, label
  /// columns are ordinary text (a list of goals).
  bool grouped = true;
  /// Later files get new demo numbers where theirs are taken already within the target; files without a demo column get
  /// one each.
  bool renumber = false;
  std::size_t line_limit = std::size_t{1} << 20;  ///< longest line [bytes]
};

/// A run of rows that belong together.
struct CsvGroup {
  Labels labels;
  std::size_t file = 0;        ///< index of the input
  std::uint64_t begin = 0;     ///< first byte in it
  std::uint64_t end = 0;       ///< one past the last byte
  std::size_t first_line = 0;  ///< line of the first row, from 1
  std::size_t rows = 0;
};

/// The numbers of a group.
struct NumericBlock {
  Labels labels;
  std::string file;            ///< name of the input
  std::size_t first_line = 0;  ///< line of the first row: a row is a line
  Samples values;              ///< rows x the columns asked for

  /// Where a row stands in the input.
  [[nodiscard]] Place place(Eigen::Index row) const {
    return {file, first_line + static_cast<std::size_t>(row), 0, ""};
  }
};

/// One or several files with the same columns, in any order. A first pass finds the groups; rows are read on request,
/// so that memory is that of one group. Faults are DataError with line and byte column, both from 1: csv.empty,
/// header_only, no_header, header_not_utf8, utf16, unnamed_column, duplicate_column, columns_differ, missing_column,
/// ragged, truncated (short last row), not_a_number, not_finite, out_of_range, decimal_comma, semicolon, lone_cr, nul,
/// unclosed_quote, bad_quote, line_too_long, empty_label, group_reappears. A number below the range of doubles is 0,
/// with a warning (csv.underflow). A quoted field ends on the line where it begins.
class CsvTable {
 public:
  /// @param messages  takes warnings; must live as long as the table
  CsvTable(std::vector<Input> inputs, Messages& messages, const CsvOptions& options = {});
  ~CsvTable();
  CsvTable(CsvTable&&) noexcept;

  /// All names in the order of the first file.
  [[nodiscard]] const std::vector<std::string>& columns() const;
  [[nodiscard]] bool has(std::string_view column) const;
  /// Whether the first row has a number, or something that tries to be one, in this column.
  [[nodiscard]] bool is_numeric(std::string_view column) const;
  /// Groups in order of first appearance.
  [[nodiscard]] const std::vector<CsvGroup>& groups() const;
  [[nodiscard]] const std::vector<Input>& inputs() const;
  /// Of all inputs' bytes.
  [[nodiscard]] std::string sha256() const;

  /// The numbers of group i in the named columns, in that order. Every row is checked.
  [[nodiscard]] NumericBlock read_group(std::size_t i, const std::vector<std::string>& names) const;
  /// The cells of one column of group i, as text.
  [[nodiscard]] std::vector<std::string> read_text(std::size_t i, const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The label columns, in the order in which they are written.
[[nodiscard]] const std::vector<std::string>& label_columns();
/// Those that are set, in that order.
[[nodiscard]] std::vector<std::string> label_columns(const Labels& labels);

/// The column names of a file, without a look at its rows: what is in it may be told by them.
/// @throws DataError as CsvTable does for a header
[[nodiscard]] std::vector<std::string> csv_columns(const Input& input, std::size_t line_limit = std::size_t{1} << 20);

/// Writes a table cell by cell. Text is quoted where it must be.
class CsvWriter {
 public:
  /// Writes the header. @param out  must live as long as the writer
  CsvWriter(Output& out, const std::vector<std::string>& columns);

  /// @throws Error(Fault::internal) [csv.write_not_finite] for nan and inf: a result that is no number is a defect
  void number(double value);
  void integer(long long value);
  void text(std::string_view value);
  /// The labels that are set; rows of one table must all set the same.
  void labels(const Labels& labels);
  /// @throws Error(Fault::internal) [csv.write_ragged] if the row has not as many cells as the header
  void end_row();

  /// A row a sample: the labels, then the numbers.
  void rows(const Labels& labels, const Samples& values);

 private:
  void separate();
  void finite(double value);

  Output& out_;
  std::size_t columns_;
  std::size_t cells_ = 0;
};

}  // namespace lfd
