// The shape of UTF-8 (RFC 3629).
#pragma once

#include <cstddef>
#include <string_view>

namespace lfd {

/// Length of the well-formed sequence at `position`, 1 to 4 bytes; 0 if there is none (overlong forms, surrogates and
/// what lies beyond U+10FFFF are not well formed).
[[nodiscard]] std::size_t utf8_sequence(std::string_view text, std::size_t position);

/// Whether the whole text is well formed.
[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace lfd
