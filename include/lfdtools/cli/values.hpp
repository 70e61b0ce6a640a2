// Option values: strict decimal numbers, whole words only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lfd::cli {

// Each throws UsageError [usage.value] with a sentence that names the option and the value.

/// A decimal integer: digits with an optional minus sign, no leading zeros, no `+`, no exponent.
[[nodiscard]] std::int64_t integer_value(std::string_view option, std::string_view word);

/// A finite decimal number; `+1.5` is taken, hexadecimal, nan and inf are not.
[[nodiscard]] double number_value(std::string_view option, std::string_view word);

/// The same, over 0.
[[nodiscard]] double positive_number(std::string_view option, std::string_view word);

/// Comma-separated numbers.
[[nodiscard]] std::vector<double> number_list(std::string_view option, std::string_view word);

/// `4` (meaning 4:4) or `1:12`, low no greater than high.
[[nodiscard]] std::pair<std::int64_t, std::int64_t> integer_range_value(std::string_view option, std::string_view word);

/// Comma-separated words, none empty, none twice.
[[nodiscard]] std::vector<std::string> word_list(std::string_view option, std::string_view word);

}  // namespace lfd::cli
