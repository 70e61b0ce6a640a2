#include "lfdtools/io/csv.hpp"

#include <algorithm>
#include <cstring>

#include "csv_table.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd {
namespace {

/// 0,1,1,25 under the header t,x: each value is torn in two.
bool looks_like_decimal_commas(const std::vector<CsvCell>& cells, std::size_t columns) {
  if (cells.size() != 2 * columns) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string_view text = cells[i].text;
    if (i % 2 == 0 && !text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
    if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos) return false;
  }
  return true;
}

}  // namespace

void CsvTable::Impl::fail_row(const std::vector<CsvCell>& cells, std::size_t f, const LineReader& lines) const {
  const std::string& name = inputs[f].name();
  const std::string count = "the row has " + std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells") +
                            ", the header has " + std::to_string(columns.size());
  if (looks_like_decimal_commas(cells, columns.size())) {
    fail_csv("csv.decimal_comma", count + ": are these decimal commas? decimal points are needed", name, lines.number(),
             1);
  }
  if (cells.size() == 1 && cells[0].text.empty()) fail_csv("csv.ragged", "the line is empty", name, lines.number(), 1);
  const std::size_t at = cells.size() > columns.size() ? cells[columns.size()].column : cells.back().column;
  if (cells.size() < columns.size() && lines.last()) {
    fail_csv("csv.truncated", count + ": the last row is cut short", name, lines.number(), at);
  }
  const char* hint = cells.size() > columns.size() ? " (a decimal comma? numbers need a decimal point)" : "";
  fail_csv("csv.ragged", count + hint, name, lines.number(), at);
}

void CsvTable::Impl::check_count(const std::vector<CsvCell>& cells, std::size_t f, const LineReader& lines) const {
  // A single column may have a row that is an empty cell: that is refused as a missing number, with its place.
  if (cells.size() != columns.size()) fail_row(cells, f, lines);
}

double CsvTable::Impl::read_cell(const CsvCell& cell, std::size_t i, std::size_t f, std::size_t line) const {
  const std::string& name = inputs[f].name();
  const std::string what = shown(cell.text) + " in column " + columns[i];
  double value = 0;
  switch (parse_number(cell.text, value)) {
    case NumberFault::none:
      break;
    case NumberFault::underflow:
      if (!warned_of_underflow) {
        warned_of_underflow = true;
        messages.warning("csv.underflow", what + " is too small for a double: read as 0",
                         {name, line, cell.column, ""});
      }
      break;
    case NumberFault::overflow:
      fail_csv("csv.out_of_range", what + " is too large for a double", name, line, cell.column);
    case NumberFault::not_finite:
      fail_csv("csv.not_finite",
               cell.text.empty() ? "the cell of column " + columns[i] + " is empty" : what + " is no finite number",
               name, line, cell.column);
    case NumberFault::decimal_comma:
      fail_csv("csv.decimal_comma", what + " has a decimal comma: a decimal point is needed", name, line, cell.column);
    case NumberFault::not_a_number:
      fail_csv("csv.not_a_number", what + " is not a number", name, line, cell.column);
  }
  return value;
}

std::size_t CsvTable::Impl::find(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? no_column : static_cast<std::size_t>(found - columns.begin());
}

LineReader CsvTable::Impl::lines_of(const CsvGroup& group) const {
  return {inputs[group.file], group.begin, group.end, group.first_line, options.line_limit, false};
}

CsvTable::CsvTable(std::vector<Input> inputs, Messages& messages, const CsvOptions& options)
    : impl_(std::make_unique<Impl>(std::move(inputs), messages, options)) {
  for (std::size_t f = 0; f < impl_->inputs.size(); ++f) impl_->index(f);
  impl_->group_of = {};
  impl_->demos_of = {};
}

CsvTable::~CsvTable() = default;
CsvTable::CsvTable(CsvTable&&) noexcept = default;

const std::vector<std::string>& CsvTable::columns() const {
  return impl_->columns;
}
bool CsvTable::has(std::string_view column) const {
  return impl_->find(column) != no_column;
}
const std::vector<CsvGroup>& CsvTable::groups() const {
  return impl_->groups;
}
const std::vector<Input>& CsvTable::inputs() const {
  return impl_->inputs;
}
std::string CsvTable::sha256() const {
  return lfd::sha256(impl_->inputs);
}

bool CsvTable::is_numeric(std::string_view column) const {
  const std::size_t i = impl_->find(column);
  return i != no_column && impl_->numeric[i];
}

NumericBlock CsvTable::read_group(std::size_t i, const std::vector<std::string>& names) const {
  const CsvGroup& group = impl_->groups[i];
  const std::vector<std::size_t>& position = impl_->files[group.file].position;
  const std::size_t width = position.size();
  std::vector<std::size_t> destination(width, no_column);  // in the result, of each cell of a line
  std::vector<std::size_t> source;                         // column of the table, of each column of the result
  for (const std::string& name : names) {
    source.push_back(impl_->find(name));
    if (source.back() == no_column) {
      fail_csv("csv.missing_column", "there is no column " + shown(name) + "; there are: " + listed(impl_->columns),
               impl_->inputs[group.file].name(), 1);
    }
    destination[position[source.back()]] = source.size() - 1;
  }
  NumericBlock block{group.labels, impl_->inputs[group.file].name(), group.first_line, {}};
  block.values.resize(static_cast<Eigen::Index>(group.rows), static_cast<Eigen::Index>(names.size()));

  // The common row: plain numbers and commas, no quotes. False where the row needs the slow way, which also finds the
  // words for a refusal.
  const auto read_plain = [&](std::string_view line, double* values) {
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t cell = 0; cell < width; ++cell) {
      if (cell > 0) {
        if (at == end || *at != ',') return false;
        ++at;
      }
      if (destination[cell] != no_column) {
        at = scan_number(at, end, values[destination[cell]]);
        if (at == nullptr) return false;
      } else {
        if (at != end && *at == '"') return false;
        const void* const comma = at == end ? nullptr : std::memchr(at, ',', static_cast<std::size_t>(end - at));
        at = comma == nullptr ? end : static_cast<const char*>(comma);
      }
    }
    return at == end;
  };

  LineReader lines = impl_->lines_of(group);
  std::vector<CsvCell> cells;
  std::string_view line;
  for (Eigen::Index row = 0; row < block.values.rows() && lines.next(line); ++row) {
    double* const values = block.values.data() + row * block.values.cols();
    if (read_plain(line, values)) continue;
    split_cells(line, block.file, lines.number(), cells);
    impl_->check_count(cells, group.file, lines);
    for (std::size_t k = 0; k < source.size(); ++k) {
      values[k] = impl_->read_cell(cells[position[source[k]]], source[k], group.file, lines.number());
    }
  }
  return block;
}

std::vector<std::string> CsvTable::read_text(std::size_t i, const std::string& name) const {
  const CsvGroup& group = impl_->groups[i];
  const std::size_t column = impl_->find(name);
  if (column == no_column) {
    fail_csv("csv.missing_column", "there is no column " + shown(name) + "; there are: " + listed(impl_->columns),
             impl_->inputs[group.file].name(), 1);
  }
  const std::size_t position = impl_->files[group.file].position[column];
  std::vector<std::string> result;
  LineReader lines = impl_->lines_of(group);
  std::vector<CsvCell> cells;
  std::string_view line;
  while (lines.next(line)) {
    split_cells(line, impl_->inputs[group.file].name(), lines.number(), cells);
    impl_->check_count(cells, group.file, lines);
    result.push_back(cells[position].text);
  }
  return result;
}

}  // namespace lfd
