// Lines and cells of comma-separated values: what the two passes over a table share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/io/input.hpp"

namespace lfd {

/// A refusal with its place.
[[noreturn]] void fail_csv(const char* id, const std::string& text, const std::string& file, std::size_t line = 0,
                           std::size_t column = 0);

/// The text in quotes for a message; a long one is cut.
[[nodiscard]] std::string shown(std::string_view text);

/// Reads the lines of a range of bytes.
class LineReader {
 public:
  /// @param scan  refuse NUL and lone CR: for the first pass over a file
  LineReader(const Input& input, std::uint64_t begin, std::uint64_t end, std::size_t first_line, std::size_t line_limit,
             bool scan);

  /// The next line without its end. Valid until the next call.
  /// @throws DataError [csv.line_too_long], [csv.nul], [csv.lone_cr]
  [[nodiscard]] bool next(std::string_view& line);
  /// Number of the line that next() gave last.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Its first byte in the file.
  [[nodiscard]] std::uint64_t begin() const { return line_begin_; }
  /// One past its last byte, its end included.
  [[nodiscard]] std::uint64_t end() const { return line_end_; }
  /// Whether it is the last of the file.
  [[nodiscard]] bool last() const { return line_end_ == input_.size(); }

 private:
  bool fill();
  void check_line(std::string_view line) const;

  const Input& input_;
  std::uint64_t read_;  // next byte of the file to read
  std::uint64_t stop_;
  std::size_t line_limit_;
  bool scan_;
  bool suspicious_ = false;  // the block has a NUL or a CR
  std::vector<char> block_;
  std::size_t first_ = 0;  // what is left of the block
  std::size_t last_ = 0;
  std::size_t number_;
  std::uint64_t line_begin_;
  std::uint64_t line_end_;
};

/// A cell and the byte column where it starts, from 1.
struct CsvCell {
  std::string text;
  std::size_t column = 1;
};

/// Splits a line into its cells, quotes undone.
/// @throws DataError [csv.unclosed_quote], [csv.bad_quote]
void split_cells(std::string_view line, const std::string& file, std::size_t number, std::vector<CsvCell>& cells);

}  // namespace lfd
