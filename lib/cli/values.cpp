#include "lfdtools/cli/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "lfdtools/error.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd::cli {
namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view word, std::string_view wanted) {
  throw UsageError("usage.value", fmt::format("{} takes {}, not '{}'", option, wanted, word));
}

std::vector<std::string_view> split(std::string_view word) {
  std::vector<std::string_view> parts;
  for (std::size_t from = 0;;) {
    const std::size_t comma = word.find(',', from);
    parts.push_back(word.substr(from, comma - from));
    if (comma == std::string_view::npos) return parts;
    from = comma + 1;
  }
}

}  // namespace

std::int64_t integer_value(std::string_view option, std::string_view word) {
  const std::string_view digits = word.starts_with('-') ? word.substr(1) : word;
  const bool leading_zero = digits.size() > 1 && digits[0] == '0';
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (leading_zero || error != std::errc() || end != word.data() + word.size()) {
    refuse(option, word, "a whole decimal number");
  }
  return value;
}

double number_value(std::string_view option, std::string_view word) {
  double value = 0;
  const NumberFault fault = parse_number(word, value);
  if (fault != NumberFault::none && fault != NumberFault::underflow) refuse(option, word, "a finite number");
  return value;
}

double positive_number(std::string_view option, std::string_view word) {
  const double value = number_value(option, word);
  if (!(value > 0)) refuse(option, word, "a number over 0");
  return value;
}

std::vector<double> number_list(std::string_view option, std::string_view word) {
  std::vector<double> values;
  for (const auto part : split(word)) values.push_back(number_value(option, part));
  return values;
}

std::pair<std::int64_t, std::int64_t> integer_range_value(std::string_view option, std::string_view word) {
  const std::size_t colon = word.find(':');
  const std::int64_t low = integer_value(option, word.substr(0, colon));
  const std::int64_t high = colon == std::string_view::npos ? low : integer_value(option, word.substr(colon + 1));
  if (low > high) refuse(option, word, "a number or a rising range such as 1:12");
  return {low, high};
}

std::vector<std::string> word_list(std::string_view option, std::string_view word) {
  std::vector<std::string> words;
  for (const auto part : split(word)) {
    if (part.empty() || std::find(words.begin(), words.end(), part) != words.end()) {
      refuse(option, word, "different words with commas between");
    }
    words.emplace_back(part);
  }
  return words;
}

}  // namespace lfd::cli
