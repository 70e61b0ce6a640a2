#include <algorithm>
#include <vector>

#include "json_node.hpp"

namespace lfd {
namespace {

using Node = nlohmann::json;

/// Builds the tree from the parser's events. The library would let the last of duplicate keys win and would nest
/// without end: refused here, where the events pass.
class TreeBuilder : public nlohmann::json_sax<Node> {
 public:
  TreeBuilder(std::string_view text, const std::string& file, const JsonOptions& options, std::size_t line,
              std::size_t column)
      : text_(text), file_(file), options_(options), line_(line), column_(column) {}

  [[nodiscard]] Node take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Node::object()); }
  bool start_array(std::size_t) override { return open(Node::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_ = name;
    if (open_.back()->contains(name)) {
      fail_json(options_, "json.duplicate_key", "the key appears twice", {file_, 0, 0, pointer()});
    }
    keys_.back() = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override {
    constexpr int number_out_of_range = 406;
    if (error.id == number_out_of_range) {
      fail_json(options_, "json.out_of_range", "the number " + token + " is too large for a double",
                {file_, 0, 0, pointer()});
    }
    // The library counts the byte that it stumbled over as read.
    const std::size_t at = std::min(position == 0 ? 0 : position - 1, text_.size());
    Place place{file_, line_, column_, ""};
    for (const char c : text_.substr(0, at)) {
      ++place.column;
      if (c == '\n') {
        ++place.line;
        place.column = 1;
      }
    }
    if (at == text_.size()) fail_json(options_, "json.truncated", "the document ends too early", place);
    std::string what = error.what();
    const std::size_t detail = what.find(": ");
    what.erase(0, detail == std::string::npos ? 0 : detail + 2);
    fail_json(options_, "json.syntax", "not JSON: " + what, place);
  }

 private:
  template <class Value>
  bool add(Value&& value) {
    place_new(std::forward<Value>(value));
    return true;
  }

  template <class Value>
  Node* place_new(Value&& value) {
    if (open_.empty()) {
      root_ = std::forward<Value>(value);
      return &root_;
    }
    Node& parent = *open_.back();
    if (parent.is_object()) return &(parent[keys_.back()] = std::forward<Value>(value));
    if (parent.size() >= options_.array_limit) {
      fail_json(options_, "json.too_large",
                "the array has more than " + std::to_string(options_.array_limit) + " elements",
                {file_, 0, 0, pointer()});
    }
    parent.push_back(std::forward<Value>(value));
    return &parent.back();
  }

  bool open(Node&& container) {
    if (open_.size() >= options_.depth_limit) {
      fail_json(options_, "json.too_deep", "nested deeper than " + std::to_string(options_.depth_limit),
                {file_, 0, 0, pointer()});
    }
    // Moving a container into its parent's place keeps later pointers valid: a parent only grows at its innermost
    // child.
    open_.push_back(place_new(std::move(container)));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  [[nodiscard]] std::string pointer() const {
    std::string out;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const bool innermost = i + 1 == open_.size();
      if (open_[i]->is_object()) {
        out += pointer_part(innermost ? key_ : keys_[i]);
      } else {
        out += '/' + std::to_string(open_[i]->size() - (innermost ? 0 : 1));
      }
    }
    return out;
  }

  std::string_view text_;
  const std::string& file_;
  const JsonOptions& options_;
  std::size_t line_;
  std::size_t column_;
  Node root_;
  std::vector<Node*> open_;        // from the document down to where values are added
  std::vector<std::string> keys_;  // the current key of each open object
  std::string key_;                // the key read last
};

}  // namespace

std::string pointer_part(std::string_view key) {
  std::string out = "/";
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}

void fail_json(const JsonOptions& options, const char* id, const std::string& text, Place place) {
  if (options.fault == Fault::config) throw ConfigError(id, text, std::move(place));
  throw DataError(id, text, std::move(place));
}

nlohmann::json parse_json(std::string_view text, const std::string& file, const JsonOptions& options,
                          std::size_t first_line, std::size_t first_column) {
  TreeBuilder builder(text, file, options, first_line, first_column);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  nlohmann::json root = builder.take();
  if (!root.is_object()) {
    fail_json(options, "json.syntax", "a document is an object in braces", {file, first_line, first_column, ""});
  }
  return root;
}

}  // namespace lfd
