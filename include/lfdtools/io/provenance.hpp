// How a file came to be.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/io/json.hpp"
#include "lfdtools/io/json_writer.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// One program that had a part in a file.
struct Provenance {
  std::string program;
  std::string version;
  std::vector<std::string> arguments;  ///< those that change the result, canonical, without paths
  std::optional<std::uint64_t> seed;   ///< of programs that draw random numbers
  std::string input_sha256;            ///< of the bytes read, 64 hexadecimal digits

  friend bool operator==(const Provenance&, const Provenance&) = default;
};

/// What every document of the toolchain says about itself beside its content.
struct FileHeader {
  std::vector<std::string> columns;    ///< signals (a mixture also has t, first)
  Labels labels;                       ///< target, demo, teacher; sample is never set
  std::vector<Provenance> provenance;  ///< oldest first
};

/// Labels among the members of an object: an integer or a string each, as text.
[[nodiscard]] Labels read_labels(const JsonView& object);
/// The labels that are set as members: integers as such, words as strings.
void write_labels(JsonWriter& json, const Labels& labels);

/// Checks format and version, and reads columns, labels and provenance.
/// @throws as JsonDocument::expect and JsonView
[[nodiscard]] FileHeader read_header(const JsonDocument& document, std::string_view format);

/// Begins a document: format, version, columns and labels. The object stays open.
void write_header(JsonWriter& json, std::string_view format, const FileHeader& header);
/// Ends it with the provenance, and closes the object.
void write_provenance(JsonWriter& json, const FileHeader& header);

/// The list with one more entry.
[[nodiscard]] std::vector<Provenance> append(std::vector<Provenance> list, Provenance entry);

}  // namespace lfd
