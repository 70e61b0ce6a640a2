// Doubles as text: the shortest form that reads back to the same double, and strict reading.
#pragma once

#include <string>
#include <string_view>

namespace lfd {

/// Room that format_number needs.
inline constexpr std::size_t number_room = 32;

/// Writes the shortest decimal that reads back to the same double; -0 is written as 0. Valid in CSV and in JSON.
/// @param value  finite   @param out  at least number_room bytes   @return one past the last character
char* format_number(double value, char* out);

/// The same as a string.
[[nodiscard]] std::string number_text(double value);

/// What is wrong with a cell that should be a number.
enum class NumberFault {
  none,
  underflow,      ///< a number too small for a double: read as 0
  overflow,       ///< a number too large for a double, such as 1e400
  not_finite,     ///< nan, inf, NA or empty
  decimal_comma,  ///< 1,5
  not_a_number    ///< anything else
};

/// Reads the whole of `text` as a decimal number: an optional sign, digits with a point, an exponent; no blanks, no
/// hexadecimal. @param value  set where the result is none or underflow
[[nodiscard]] NumberFault parse_number(std::string_view text, double& value);

/// Reads one number at the start of [first, last). The common case of parse_number, for long rows.
/// @return one past the number, or nullptr if parse_number must decide
[[nodiscard]] const char* scan_number(const char* first, const char* last, double& value);

}  // namespace lfd
