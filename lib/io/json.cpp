#include "lfdtools/io/json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "json_node.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd {
namespace {

using Node = nlohmann::json;

const Node& of(const void* node) {
  return *static_cast<const Node*>(node);
}

const char* kind(const Node& node) {
  switch (node.type()) {
    case Node::value_t::null:
      return "null";
    case Node::value_t::object:
      return "an object";
    case Node::value_t::array:
      return "an array";
    case Node::value_t::string:
      return "a string";
    case Node::value_t::boolean:
      return node.get<bool>() ? "true" : "false";
    default:
      return "a number";
  }
}

/// The programs that read a format.
const char* reader_of(std::string_view format) {
  constexpr std::pair<std::string_view, const char*> readers[] = {
      {"lfdtools.experiment", "demo-synth"},
      {"lfdtools.gmm", "gmr-regress"},
      {"lfdtools.dmp", "mvgpr-train and skill-generate"},
      {"lfdtools.skill", "skill-generate"},
      {"lfdtools.scene", "arm-clearance --scene"},
      {"lfdtools.robot", "ur10-ik --robot"},
      {"lfdtools.transform", "skill-generate --camera"},
      {"lfdtools.covariance", "arm-clearance --covariance"},
  };
  for (const auto& [name, programs] : readers) {
    if (name == format) return programs;
  }
  return nullptr;
}

std::string elements(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " element" : " elements");
}

}  // namespace

Place JsonView::place() const {
  return {context_->file, 0, 0, pointer_};
}

void JsonView::fail(std::string id, const std::string& text) const {
  fail_json(context_->options, id.c_str(), text, place());
}

std::optional<JsonView> JsonView::find(std::string_view key) const {
  const Node& node = of(node_);
  if (!node.is_object()) fail("json.wrong_type", std::string("an object is needed, this is ") + kind(node));
  const auto found = node.find(std::string(key));
  if (found == node.end()) return {};
  return JsonView(context_, &*found, pointer_ + pointer_part(key));
}

std::vector<std::string> JsonView::keys() const {
  if (!is_object()) fail("json.wrong_type", std::string("an object is needed, this is ") + kind(of(node_)));
  std::vector<std::string> out;
  for (const auto& [key, value] : of(node_).items()) out.push_back(key);
  return out;
}

bool JsonView::has(std::string_view key) const {
  return find(key).has_value();
}

JsonView JsonView::at(std::string_view key) const {
  if (std::optional<JsonView> member = find(key)) return *member;
  if (of(node_).contains(std::string(key))) {
    JsonView(context_, node_, pointer_ + pointer_part(key)).fail("json.wrong_type", "a value is needed, this is null");
  }
  fail("json.missing_key", "the key \"" + std::string(key) + "\" is missing");
}

std::size_t JsonView::size() const {
  if (!is_array()) fail("json.wrong_type", std::string("an array is needed, this is ") + kind(of(node_)));
  return of(node_).size();
}

JsonView JsonView::at(std::size_t index) const {
  if (index >= size()) fail("json.wrong_length", "the array has " + elements(size()) + ", too few");
  return JsonView(context_, &of(node_)[index], pointer_ + '/' + std::to_string(index));
}

bool JsonView::is_null() const {
  return of(node_).is_null();
}
bool JsonView::is_string() const {
  return of(node_).is_string();
}
bool JsonView::is_array() const {
  return of(node_).is_array();
}
bool JsonView::is_object() const {
  return of(node_).is_object();
}

double JsonView::number() const {
  const Node& node = of(node_);
  if (!node.is_number()) fail("json.not_a_number", std::string("a number is needed, this is ") + kind(node));
  return node.get<double>();  // the parser has refused what is not finite
}

double JsonView::number(double low, double high) const {
  const double value = number();
  if (!(value >= low && value <= high)) {
    fail("json.out_of_range", number_text(value) + " is not in " + number_text(low) + " to " + number_text(high));
  }
  return value;
}

double JsonView::positive() const {
  const double value = number();
  if (!(value > 0)) fail("json.out_of_range", number_text(value) + " is not over 0");
  return value;
}

long long JsonView::integer(long long low, long long high) const {
  const Node& node = of(node_);
  if (!node.is_number_integer()) {
    fail("json.not_an_integer", "an integer is needed, this is " +
                                    (node.is_number() ? number_text(node.get<double>()) : std::string(kind(node))));
  }
  const bool too_large = node.is_number_unsigned() &&
                         node.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<long long>::max());
  const long long value = too_large ? 0 : node.get<long long>();
  if (too_large || value < low || value > high) {
    fail("json.out_of_range", node.dump() + " is not in " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

std::uint64_t JsonView::unsigned_integer() const {
  const Node& node = of(node_);
  if (!node.is_number_unsigned()) {
    if (node.is_number())
      fail("json.out_of_range", number_text(node.get<double>()) + " is no integer from 0 to 2^64 - 1");
    fail("json.not_an_integer", std::string("an integer is needed, this is ") + kind(node));
  }
  return node.get<std::uint64_t>();
}

bool JsonView::boolean() const {
  if (!of(node_).is_boolean())
    fail("json.wrong_type", std::string("true or false is needed, this is ") + kind(of(node_)));
  return of(node_).get<bool>();
}

std::string JsonView::string() const {
  if (!is_string()) fail("json.wrong_type", std::string("a string is needed, this is ") + kind(of(node_)));
  return of(node_).get<std::string>();
}

std::string JsonView::label() const {
  const Node& node = of(node_);
  if (node.is_number_integer()) return node.dump();
  const std::string text = string();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (text.empty() || std::any_of(text.begin(), text.end(), is_control)) {
    fail("json.out_of_range", "a label is an integer or a word without control characters");
  }
  return text;
}

std::vector<std::string> JsonView::strings() const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < size(); ++i) out.push_back(at(i).string());
  return out;
}

Vector JsonView::vector(Eigen::Index length) const {
  const auto n = static_cast<Eigen::Index>(size());
  if (length >= 0 && n != length) {
    fail("json.wrong_length", "the array has " + elements(size()) + ", " + std::to_string(length) + " are needed");
  }
  Vector out(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Node& node = of(node_)[static_cast<std::size_t>(i)];
    out[i] = node.is_number() ? node.get<double>() : at(static_cast<std::size_t>(i)).number();
  }
  return out;
}

Matrix JsonView::matrix(Eigen::Index rows, Eigen::Index columns) const {
  const auto m = static_cast<Eigen::Index>(size());
  if (rows >= 0 && m != rows) {
    fail("json.wrong_length", "the matrix has " + std::to_string(m) + " rows, " + std::to_string(rows) + " are needed");
  }
  Matrix out(m, m == 0 ? std::max<Eigen::Index>(columns, 0) : 0);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Vector row = at(static_cast<std::size_t>(i)).vector(i == 0 ? columns : out.cols());
    if (i == 0) out.resize(m, row.size());
    out.row(i) = row.transpose();
  }
  return out;
}

void JsonView::only(std::initializer_list<std::string_view> keys) const {
  if (!is_object()) fail("json.wrong_type", std::string("an object is needed, this is ") + kind(of(node_)));
  for (const auto& [key, value] : of(node_).items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const JsonView member(context_, &value, pointer_ + pointer_part(key));
    if (context_->options.strict) member.fail("json.unknown_key", "the key is unknown");
    context_->messages->warning("json.unknown_key", "the key is unknown and ignored", member.place());
  }
}

JsonDocument::JsonDocument(std::string_view text, const std::string& file, Messages& messages,
                           const JsonOptions& options, std::size_t first_line, std::size_t first_column)
    : context_(std::make_unique<JsonView::Context>()) {
  context_->root = parse_json(text, file, options, first_line, first_column);
  context_->file = file;
  context_->messages = &messages;
  context_->options = options;
}

JsonDocument::~JsonDocument() = default;
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;

JsonView JsonDocument::root() const {
  return {context_.get(), &context_->root, ""};
}

std::string JsonDocument::format() const {
  const std::optional<JsonView> format = root().find("format");
  if (!format) root().fail("json.wrong_format", "the document has no \"format\": it is none of lfdtools");
  const std::string name = format->string();
  if (reader_of(name) == nullptr) format->fail("json.wrong_format", "the format \"" + name + "\" is unknown");
  return name;
}

void JsonDocument::expect(std::string_view wanted) const {
  const std::string found = format();
  if (found != wanted) {
    root().at("format").fail("json.wrong_format", "the format is " + found + ", read by " + reader_of(found) + "; " +
                                                      std::string(wanted) + " is needed");
  }
  const JsonView version = root().at("version");
  const long long number = version.integer(1, std::numeric_limits<long long>::max());
  if (number > 1) {
    version.fail("json.newer_version", "version " + std::to_string(number) +
                                           " of the format is newer than this program, which reads version 1");
  }
}

}  // namespace lfd
