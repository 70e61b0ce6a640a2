// What a table knows: made by the first pass over its files, used by the second.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "csv_lines.hpp"
#include "lfdtools/io/csv.hpp"

namespace lfd {

inline constexpr std::size_t no_column = static_cast<std::size_t>(-1);

/// Names with commas between them.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

struct CsvTable::Impl {
  /// What differs between files.
  struct File {
    std::vector<std::size_t> position;                                     // in the file, of each column of the table
    std::uint64_t data_begin = 0;                                          // first byte after the header
    std::size_t labels[4] = {no_column, no_column, no_column, no_column};  // position of each label column
    std::size_t last_label = no_column;
  };

  std::vector<Input> inputs;
  Messages& messages;
  CsvOptions options;
  std::vector<std::string> columns;
  std::vector<bool> numeric;
  std::vector<File> files;
  std::vector<CsvGroup> groups;
  mutable bool warned_of_underflow = false;

  // For the first pass.
  std::unordered_map<std::string, std::size_t> group_of;
  std::unordered_map<std::string, std::unordered_set<std::string>> demos_of;  // by target

  Impl(std::vector<Input> sources, Messages& sink, const CsvOptions& how)
      : inputs(std::move(sources)), messages(sink), options(how) {}

  void read_header(std::size_t f, LineReader& lines);
  void index(std::size_t f);
  Labels read_labels(const File& file, std::string_view line, std::size_t f, const LineReader& lines) const;
  void renumber(Labels& labels, std::unordered_map<std::string, std::string>& renamed);
  void open_group(const Labels& labels, std::size_t f, const LineReader& lines);
  [[noreturn]] void fail_row(const std::vector<CsvCell>& cells, std::size_t f, const LineReader& lines) const;
  void check_count(const std::vector<CsvCell>& cells, std::size_t f, const LineReader& lines) const;
  double read_cell(const CsvCell& cell, std::size_t i, std::size_t f, std::size_t line) const;
  std::size_t find(std::string_view name) const;
  LineReader lines_of(const CsvGroup& group) const;
};

}  // namespace lfd
