#include "csv_lines.hpp"

#include <algorithm>
#include <cstring>

namespace lfd {

void fail_csv(const char* id, const std::string& text, const std::string& file, std::size_t line, std::size_t column) {
  throw DataError(id, text, {file, line, column, ""});
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string out = "'";
  out += text.substr(0, longest);
  if (text.size() > longest) out += "...";
  return out + "'";
}

LineReader::LineReader(const Input& input, std::uint64_t begin, std::uint64_t end, std::size_t first_line,
                       std::size_t line_limit, bool scan)
    : input_(input),
      read_(begin),
      stop_(end),
      line_limit_(line_limit),
      scan_(scan),
      block_(static_cast<std::size_t>(std::min<std::uint64_t>(end - begin, std::uint64_t{1} << 18))),
      number_(first_line - 1),
      line_begin_(begin),
      line_end_(begin) {}

bool LineReader::fill() {
  if (read_ == stop_) return false;
  const std::size_t kept = last_ - first_;
  if (kept > 0) std::memmove(block_.data(), block_.data() + first_, kept);
  if (kept == block_.size()) block_.resize(2 * block_.size());
  const auto want = static_cast<std::size_t>(std::min<std::uint64_t>(block_.size() - kept, stop_ - read_));
  const std::size_t n = input_.read_at(read_, block_.data() + kept, want);
  read_ = n == 0 ? stop_ : read_ + n;
  first_ = 0;
  last_ = kept + n;
  if (scan_) {
    suspicious_ =
        std::memchr(block_.data(), '\0', last_) != nullptr || std::memchr(block_.data(), '\r', last_) != nullptr;
  }
  return n > 0;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const std::size_t left = last_ - first_;
    const char* const begin = block_.data() + first_;
    const void* const found = left > searched ? std::memchr(begin + searched, '\n', left - searched) : nullptr;
    const std::size_t length =
        found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - begin) : left;
    if (length > line_limit_) {
      fail_csv("csv.line_too_long", "the line is longer than " + std::to_string(line_limit_) + " bytes", input_.name(),
               number_ + 1);
    }
    if (found == nullptr) {
      searched = left;
      if (fill()) continue;
      if (left == 0) return false;
    }
    ++number_;
    line = {block_.data() + first_, length};
    const std::size_t with_end = length + (found != nullptr ? 1 : 0);
    first_ += with_end;
    line_begin_ = line_end_;
    line_end_ += with_end;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (suspicious_) check_line(line);
    return true;
  }
}

void LineReader::check_line(std::string_view line) const {
  const std::size_t nul = line.find('\0');
  if (nul != std::string_view::npos) {
    fail_csv("csv.nul", "the line contains a NUL byte: is the file binary, or UTF-16?", input_.name(), number_,
             nul + 1);
  }
  const std::size_t cr = line.find('\r');
  if (cr != std::string_view::npos) {
    fail_csv("csv.lone_cr", "a carriage return without a line feed: lines end in LF or CRLF", input_.name(), number_,
             cr + 1);
  }
}

void split_cells(std::string_view line, const std::string& file, std::size_t number, std::vector<CsvCell>& cells) {
  cells.clear();
  for (std::size_t at = 0;;) {
    CsvCell& cell = cells.emplace_back();
    cell.column = at + 1;
    if (at < line.size() && line[at] == '"') {
      for (++at;;) {
        const std::size_t quote = line.find('"', at);
        if (quote == std::string_view::npos) {
          fail_csv("csv.unclosed_quote", "the quoted field does not end on its line", file, number, cell.column);
        }
        cell.text += line.substr(at, quote - at);
        at = quote + 1;
        if (at == line.size() || line[at] != '"') break;
        cell.text += '"';
        ++at;
      }
      if (at < line.size() && line[at] != ',') {
        fail_csv("csv.bad_quote", "text after the closing quote of a field", file, number, at + 1);
      }
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      cell.text = line.substr(at, comma - at);
      at = comma;
    }
    if (at == line.size()) return;
    ++at;  // the comma
  }
}

}  // namespace lfd
