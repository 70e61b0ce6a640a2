#include <algorithm>

#include "csv_table.hpp"
#include "lfdtools/io/number.hpp"
#include "lfdtools/io/utf8.hpp"

namespace lfd {
namespace {

std::optional<std::string>& label_of(Labels& labels, std::size_t i) {
  return i == 0 ? labels.target : i == 1 ? labels.teacher : i == 2 ? labels.demo : labels.sample;
}

bool is_number(const std::string& text) {
  double ignored = 0;
  return parse_number(text, ignored) == NumberFault::none;
}

/// Something that a person would take for a number, or for a missing one: a column of such cells is not text.
bool tries_to_be_number(const std::string& text) {
  double ignored = 0;
  if (parse_number(text, ignored) != NumberFault::not_a_number) return true;
  const std::size_t first = text.find_first_not_of("+-. \t");
  return first != std::string::npos && text[first] >= '0' && text[first] <= '9';
}

/// The column names of the header, the next line of an input. @throws as csv_columns
std::vector<std::string> header_names(const Input& input, LineReader& lines) {
  const std::string& name = input.name();
  char mark[2] = {};
  if (input.read_at(0, mark, 2) == 2 &&
      (std::string_view(mark, 2) == "\xFF\xFE" || std::string_view(mark, 2) == "\xFE\xFF")) {
    fail_csv("csv.utf16", "the file is UTF-16: save it as UTF-8", name, 1, 1);
  }
  std::string_view line;
  if (!lines.next(line)) fail_csv("csv.empty", "the input is empty: is the previous command's output empty?", name);
  std::size_t shift = 0;
  if (line.substr(0, 3) == "\xEF\xBB\xBF") {
    line.remove_prefix(3);
    shift = 3;
  }
  if (line.empty() && lines.last()) {
    fail_csv("csv.empty", "the input is empty: is the previous command's output empty?", name);
  }
  if (!line.empty() && (line.front() == '{' || line.front() == '[')) {
    fail_csv("csv.json", "the input looks like JSON, and a CSV table is needed here", name, 1, 1);
  }
  std::vector<CsvCell> cells;
  split_cells(line, name, 1, cells);
  if (std::all_of(cells.begin(), cells.end(), [](const CsvCell& cell) { return is_number(cell.text); })) {
    fail_csv("csv.no_header", "the first row consists of numbers: a header line with column names is missing", name, 1,
             1);
  }
  std::vector<std::string> names;
  for (const CsvCell& cell : cells) {
    const std::size_t at = cell.column + shift;
    if (!is_utf8(cell.text)) fail_csv("csv.header_not_utf8", "the header is not UTF-8", name, 1, at);
    if (cell.text.empty()) fail_csv("csv.unnamed_column", "a column has no name", name, 1, at);
    if (std::find(names.begin(), names.end(), cell.text) != names.end()) {
      fail_csv("csv.duplicate_column", "there are two columns " + shown(cell.text), name, 1, at);
    }
    names.push_back(cell.text);
  }
  if (names.size() == 1 && names[0].find(';') != std::string::npos) {
    fail_csv("csv.semicolon", "the columns are separated by semicolons: commas, and decimal points, are needed", name,
             1, names[0].find(';') + 1 + shift);
  }
  return names;
}

}  // namespace

const std::vector<std::string>& label_columns() {
  static const std::vector<std::string> names{"target", "teacher", "demo", "sample"};
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::vector<std::string> csv_columns(const Input& input, std::size_t line_limit) {
  LineReader lines(input, 0, input.size(), 1, line_limit, true);
  return header_names(input, lines);
}

void CsvTable::Impl::read_header(std::size_t f, LineReader& lines) {
  const std::string& name = inputs[f].name();
  const std::vector<std::string> names = header_names(inputs[f], lines);
  File& file = files.emplace_back();
  file.data_begin = lines.end();
  if (f == 0) columns = names;
  const auto missing = [&](const std::vector<std::string>& from, const std::vector<std::string>& in) {
    return std::any_of(from.begin(), from.end(),
                       [&](const std::string& column) { return std::find(in.begin(), in.end(), column) == in.end(); });
  };
  if (missing(columns, names) || missing(names, columns)) {
    fail_csv("csv.columns_differ",
             "the columns are " + listed(names) + ", but " + inputs[0].name() + " has " + listed(columns), name, 1, 1);
  }
  for (const std::string& column : columns) {
    file.position.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin()));
  }
  for (std::size_t i = 0; i < 4 && options.grouped; ++i) {
    const std::size_t column = find(label_columns()[i]);
    if (column == no_column) continue;
    file.labels[i] = file.position[column];
    file.last_label = file.last_label == no_column ? file.labels[i] : std::max(file.last_label, file.labels[i]);
  }
}

void CsvTable::Impl::index(std::size_t f) {
  const Input& input = inputs[f];
  LineReader lines(input, 0, input.size(), 1, options.line_limit, true);
  read_header(f, lines);
  const File& file = files[f];
  std::string prefix;  // the line of the row before, up to and with its last label: an equal one has equal labels
  std::unordered_map<std::string, std::string> renamed;
  std::string_view line;
  bool first = true;
  Labels labels;
  while (lines.next(line)) {
    if (first && f == 0) {
      std::vector<CsvCell> cells;
      split_cells(line, input.name(), lines.number(), cells);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        numeric.push_back(i < cells.size() && tries_to_be_number(cells[i].text));
      }
    }
    bool same = !first;
    if (file.last_label != no_column && (first || line.substr(0, prefix.size()) != prefix)) {
      Labels here = read_labels(file, line, f, lines);
      if (options.renumber) renumber(here, renamed);
      same = !first && here == labels;
      labels = std::move(here);
      prefix.clear();
      // Only where the labels stand first is the prefix short and the comparison worth it.
      if (file.last_label < 4 && line.find('"') == std::string_view::npos) {
        std::size_t end = 0;
        for (std::size_t i = 0; i <= file.last_label && end != std::string_view::npos; ++i)
          end = line.find(',', end) + 1;
        if (end != 0) prefix = line.substr(0, end);
      }
      if (prefix.empty()) prefix = std::string(line) + '\n';  // equals no line
    } else if (first && file.last_label == no_column && options.grouped && options.renumber && inputs.size() > 1) {
      renumber(labels, renamed);
    }
    if (!same) open_group(labels, f, lines);
    groups.back().end = lines.end();
    ++groups.back().rows;
    first = false;
  }
  if (first) {
    fail_csv("csv.header_only", "there is a header but no row: is the previous command's output empty?", input.name(),
             1);
  }
}

Labels CsvTable::Impl::read_labels(const File& file, std::string_view line, std::size_t f,
                                   const LineReader& lines) const {
  std::vector<CsvCell> cells;
  split_cells(line, inputs[f].name(), lines.number(), cells);
  if (cells.size() <= file.last_label) fail_row(cells, f, lines);
  Labels labels;
  for (std::size_t i = 0; i < 4; ++i) {
    if (file.labels[i] == no_column) continue;
    const CsvCell& cell = cells[file.labels[i]];
    if (cell.text.empty()) {
      fail_csv("csv.empty_label", "the cell of column " + label_columns()[i] + " is empty", inputs[f].name(),
               lines.number(), cell.column);
    }
    if (!is_utf8(cell.text)) {
      fail_csv("csv.label_not_utf8", "the label in column " + label_columns()[i] + " is not UTF-8", inputs[f].name(),
               lines.number(), cell.column);
    }
    label_of(labels, i) = cell.text;
  }
  return labels;
}

/// @param renamed  the demo numbers of this file by target and old number
void CsvTable::Impl::renumber(Labels& labels, std::unordered_map<std::string, std::string>& renamed) {
  const std::string target = labels.target.value_or("");
  const std::string old = labels.demo.value_or("");
  const auto [known, is_new] = renamed.try_emplace(target + '\0' + old, old);
  if (is_new) {
    std::unordered_set<std::string>& used = demos_of[target];
    if (old.empty() || used.count(old) > 0) {
      unsigned long long free = used.size() + 1;
      while (used.count(std::to_string(free)) > 0) ++free;
      known->second = std::to_string(free);
    }
    used.insert(known->second);
  }
  labels.demo = known->second;
}

void CsvTable::Impl::open_group(const Labels& labels, std::size_t f, const LineReader& lines) {
  std::string key;
  for (const auto& label : {labels.target, labels.teacher, labels.demo, labels.sample})
    key += label.value_or("") + '\0';
  if (!options.grouped) key = std::to_string(f);
  const auto [found, is_new] = group_of.try_emplace(key, groups.size());
  if (!is_new) {
    const CsvGroup& before = groups[found->second];
    const std::string words = describe(labels);
    fail_csv(
        "csv.group_reappears",
        (words.empty() ? "rows of an input without labels" : words) + " began in line " +
            std::to_string(before.first_line) + " of " + inputs[before.file].name() + " and reappears here" +
            (before.file != f ? ": --renumber gives later files new demo numbers" : ": rows of a group stand together"),
        inputs[f].name(), lines.number());
  }
  groups.push_back({labels, f, lines.begin(), lines.end(), lines.number(), 0});
}

}  // namespace lfd
