#include <algorithm>
#include <cstring>
#include <vector>

#include "json_node.hpp"

namespace lfd {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

/// Cuts the inputs into documents by counting brackets outside strings, so that one document at a time is in memory.
struct JsonStream::Impl {
  std::vector<Input> inputs;
  Messages& messages;
  JsonOptions options;

  std::size_t current = 0;    // input
  std::size_t documents = 0;  // found in it so far
  std::uint64_t offset = 0;   // of the next block in it
  std::vector<char> block = std::vector<char>(std::size_t{1} << 16);
  std::size_t first = 0;  // what is left of the block
  std::size_t last = 0;
  std::size_t line = 1;  // of the next byte
  std::size_t column = 1;

  Impl(std::vector<Input> sources, Messages& sink, const JsonOptions& how)
      : inputs(std::move(sources)), messages(sink), options(how) {}

  /// Whether there is a next byte.
  bool ready() {
    if (first < last) return true;
    first = 0;
    last = inputs[current].read_at(offset, block.data(), block.size());
    if (offset == 0 && last >= 3 && std::memcmp(block.data(), "\xEF\xBB\xBF", 3) == 0) first = 3;
    offset += last;
    return first < last;
  }

  char take() {
    const char c = block[first++];
    ++column;
    if (c == '\n') {
      ++line;
      column = 1;
    }
    return c;
  }

  [[noreturn]] void fail(const char* id, const std::string& text, std::size_t at_line, std::size_t at_column) const {
    fail_json(options, id, text, {inputs[current].name(), at_line, at_column, ""});
  }

  bool skip_space() {
    while (ready()) {
      if (!is_space(block[first])) return true;
      take();
    }
    return false;
  }

  void next_input() {
    if (documents == 0) fail("json.empty", "the input has no document: is the previous command's output empty?", 0, 0);
    ++current;
    documents = 0;
    offset = 0;
    first = last = 0;
    line = column = 1;
  }

  /// The text of the document that begins at the next byte.
  std::string read_document() {
    if (block[first] != '{') {
      const std::string text = block[first] == '\0' ? "a NUL byte"
                               : documents > 0      ? "what follows the document is no further document"
                                                    : "a JSON document begins with '{' (is this a CSV file?)";
      fail("json.syntax", text, line, column);
    }
    std::string text;
    std::size_t depth = 0;
    bool in_string = false;
    bool escaped = false;
    while (ready()) {
      const std::size_t at_line = line;
      const std::size_t at_column = column;
      const char c = take();
      if (c == '\0') fail("json.syntax", "a NUL byte", at_line, at_column);
      text += c;
      if (text.size() > options.document_limit) {
        fail("json.too_large", "the document is longer than " + std::to_string(options.document_limit) + " bytes",
             at_line, at_column);
      }
      if (escaped) {
        escaped = false;
      } else if (c == '"') {
        in_string = !in_string;
      } else if (in_string) {
        escaped = c == '\\';
      } else if (c == '{' || c == '[') {
        if (++depth > options.depth_limit) {
          fail("json.too_deep", "nested deeper than " + std::to_string(options.depth_limit), at_line, at_column);
        }
      } else if ((c == '}' || c == ']') && --depth == 0) {
        return text;
      }
    }
    fail("json.truncated", "the input ends inside a document", line, column);
  }
};

JsonStream::JsonStream(std::vector<Input> inputs, Messages& messages, const JsonOptions& options)
    : impl_(std::make_unique<Impl>(std::move(inputs), messages, options)) {}
JsonStream::~JsonStream() = default;
JsonStream::JsonStream(JsonStream&&) noexcept = default;

std::optional<JsonDocument> JsonStream::next() {
  for (; impl_->current < impl_->inputs.size(); impl_->next_input()) {
    if (!impl_->skip_space()) continue;
    const std::size_t line = impl_->line;
    const std::size_t column = impl_->column;
    const std::string text = impl_->read_document();
    ++impl_->documents;
    return JsonDocument(text, impl_->inputs[impl_->current].name(), impl_->messages, impl_->options, line, column);
  }
  return {};
}

std::string JsonStream::sha256() const {
  return lfd::sha256(impl_->inputs);
}

JsonDocument read_json(const std::string& name, Messages& messages, const JsonOptions& options) {
  std::vector<Input> inputs;
  inputs.emplace_back(name);
  JsonStream stream(std::move(inputs), messages, options);
  std::optional<JsonDocument> document = stream.next();
  if (stream.next()) {
    fail_json(options, "json.one_document", "the file holds several documents, and one is needed",
              {name == "-" ? "<stdin>" : name, 0, 0, ""});
  }
  return std::move(*document);
}

}  // namespace lfd
