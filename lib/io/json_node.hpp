// The tree behind a JsonView, and the strict parser that makes it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "lfdtools/io/json.hpp"

namespace lfd {

/// What all views of a document share.
struct JsonView::Context {
  nlohmann::json root;
  std::string file;
  Messages* messages = nullptr;
  JsonOptions options;
};

/// Throws a refusal of the kind that the options ask for.
[[noreturn]] void fail_json(const JsonOptions& options, const char* id, const std::string& text, Place place);

/// Parses exactly one document.
/// @param first_line, first_column  where the text begins in its file, for places
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& file, const JsonOptions& options,
                                        std::size_t first_line, std::size_t first_column);

/// A key or an index as a part of a JSON pointer (RFC 6901).
[[nodiscard]] std::string pointer_part(std::string_view key);

}  // namespace lfd
