#include "lfdtools/io/provenance.hpp"

#include <algorithm>

namespace lfd {
namespace {

/// A label that is a plainly written integer stands as a number, any other as a string; both read back to the same
/// text.
void write_label(JsonWriter& json, const char* key, const std::optional<std::string>& label) {
  if (!label) return;
  json.key(key);
  const std::string_view digits = std::string_view(*label).substr(label->starts_with('-') ? 1 : 0);
  const bool plain = !digits.empty() && digits.size() <= 15 &&
                     digits.find_first_not_of("0123456789") == std::string_view::npos &&
                     (digits.front() != '0' || *label == "0");
  plain ? json.integer(std::stoll(*label)) : json.string(*label);
}

std::optional<std::string> read_label(const JsonView& object, const char* key) {
  const std::optional<JsonView> value = object.find(key);
  return value ? std::optional(value->label()) : std::nullopt;
}

Provenance read_entry(const JsonView& view) {
  view.only({"program", "version", "arguments", "seed", "input_sha256"});
  Provenance entry;
  entry.program = view.at("program").string();
  entry.version = view.at("version").string();
  entry.arguments = view.at("arguments").strings();
  if (const auto seed = view.find("seed")) entry.seed = seed->unsigned_integer();
  if (const auto digest = view.find("input_sha256")) entry.input_sha256 = digest->string();
  return entry;
}

}  // namespace

Labels read_labels(const JsonView& object) {
  return {read_label(object, "target"), read_label(object, "teacher"), read_label(object, "demo"), {}};
}

void write_labels(JsonWriter& json, const Labels& labels) {
  write_label(json, "target", labels.target);
  write_label(json, "demo", labels.demo);
  write_label(json, "teacher", labels.teacher);
}

FileHeader read_header(const JsonDocument& document, std::string_view format) {
  document.expect(format);
  const JsonView root = document.root();
  FileHeader header;
  const JsonView columns = root.at("columns");
  header.columns = columns.strings();
  if (header.columns.empty()) columns.fail("json.wrong_length", "there must be at least one column");
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    if (header.columns[i].empty()) columns.at(i).fail("json.out_of_range", "a column must have a name");
    if (std::find(header.columns.begin(), header.columns.begin() + static_cast<std::ptrdiff_t>(i), header.columns[i]) !=
        header.columns.begin() + static_cast<std::ptrdiff_t>(i)) {
      columns.at(i).fail("json.duplicate_column", "the column \"" + header.columns[i] + "\" appears twice");
    }
  }
  header.labels = read_labels(root);
  if (const auto list = root.find("provenance")) {
    for (std::size_t i = 0; i < list->size(); ++i) header.provenance.push_back(read_entry(list->at(i)));
  }
  return header;
}

void write_header(JsonWriter& json, std::string_view format, const FileHeader& header) {
  json.begin_object().member("format", format).member("version", 1).member("columns", header.columns);
  write_labels(json, header.labels);
}

void write_provenance(JsonWriter& json, const FileHeader& header) {
  json.key("provenance").begin_array();
  for (const Provenance& entry : header.provenance) {
    json.begin_object().member("program", entry.program).member("version", entry.version);
    json.member("arguments", entry.arguments);
    if (entry.seed) json.key("seed").unsigned_integer(*entry.seed);
    if (!entry.input_sha256.empty()) json.member("input_sha256", entry.input_sha256);
    json.end_object();
  }
  json.end_array().end_object();
}

std::vector<Provenance> append(std::vector<Provenance> list, Provenance entry) {
  list.push_back(std::move(entry));
  return list;
}

}  // namespace lfd
