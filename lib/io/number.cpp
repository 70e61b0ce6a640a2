#include "lfdtools/io/number.hpp"

#include <fmt/compile.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace lfd {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether a number that is out of the range of doubles is too small rather than too large: by the decimal exponent of
/// its first digit that is not zero.
bool is_tiny(std::string_view text) {
  const std::size_t mark = text.find_first_of("eE");
  const std::string_view mantissa = text.substr(0, mark);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const double lead = static_cast<double>(point) - static_cast<double>(first);
  double exponent = 0;
  if (mark != std::string_view::npos) {
    for (const char c : text.substr(mark + 1)) {
      if (is_digit(c)) exponent = std::min(exponent * 10 + (c - '0'), 1e18);
    }
    if (text[mark + 1] == '-') exponent = -exponent;
  }
  return lead + exponent < 0;
}

bool means_no_value(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  std::string word(text);
  for (char& c : word) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  for (const char* known : {"", "nan", "inf", "infinity", "na", "n/a", "null"}) {
    if (word == known) return true;
  }
  return false;
}

}  // namespace

char* format_number(double value, char* out) {
  if (value == 0) {
    *out = '0';  // also for -0
    return out + 1;
  }
  return fmt::format_to(out, FMT_COMPILE("{}"), value);
}

std::string number_text(double value) {
  char text[number_room];
  return {text, format_number(value, text)};
}

const char* scan_number(const char* first, const char* last, double& value) {
  const auto [end, status] = std::from_chars(first, last, value);
  return status == std::errc{} && std::isfinite(value) ? end : nullptr;
}

NumberFault parse_number(std::string_view text, double& value) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits.front() == '+' && (is_digit(digits[1]) || digits[1] == '.')) digits.remove_prefix(1);
  const char* const last = digits.data() + digits.size();
  double result = 0;
  const auto [end, status] = std::from_chars(digits.data(), last, result);
  if (end == last && status == std::errc{} && std::isfinite(result)) {
    value = result;
    return NumberFault::none;
  }
  if (end == last && status == std::errc::result_out_of_range) {
    if (!is_tiny(digits)) return NumberFault::overflow;
    value = 0;
    return NumberFault::underflow;
  }
  if (text.size() == 1 && (text[0] == '+' || text[0] == '-')) return NumberFault::not_a_number;
  if (means_no_value(text)) return NumberFault::not_finite;
  if (std::count(text.begin(), text.end(), ',') == 1) {
    std::string with_point(text);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    double ignored = 0;
    if (parse_number(with_point, ignored) == NumberFault::none) return NumberFault::decimal_comma;
  }
  return NumberFault::not_a_number;
}

}  // namespace lfd
