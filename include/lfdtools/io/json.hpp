// JSON documents, read strictly.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/io/input.hpp"
#include "lfdtools/io/message.hpp"
#include "lfdtools/linalg.hpp"

namespace lfd {

/// How to read documents.
struct JsonOptions {
  Fault fault = Fault::data;                              ///< of all refusals: config for robots and scenes
  bool strict = false;                                    ///< unknown keys are refused, not warned of
  std::size_t depth_limit = 64;                           ///< nested arrays and objects
  std::size_t array_limit = 10'000'000;                   ///< elements of one array
  std::uint64_t document_limit = std::uint64_t{1} << 30;  ///< bytes of one document
};

/// A value inside a document, and where it stands. Valid as long as its document. Every getter checks; a refusal is a
/// DataError (ConfigError for robots and scenes) with the JSON pointer: json.wrong_type, not_a_number, not_an_integer,
/// out_of_range, missing_key, wrong_length, unknown_key.
class JsonView {
 public:
  /// The member of an object. @throws [json.missing_key], [json.wrong_type] if this is no object
  [[nodiscard]] JsonView at(std::string_view key) const;
  /// The member, or nothing if it is absent. A null is there: every getter refuses it.
  [[nodiscard]] std::optional<JsonView> find(std::string_view key) const;
  [[nodiscard]] bool has(std::string_view key) const;
  /// The keys of an object, sorted. @throws [json.wrong_type] if this is none
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Element of an array.
  [[nodiscard]] JsonView at(std::size_t index) const;
  /// Number of elements of an array. @throws [json.wrong_type] if this is none
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_object() const;

  [[nodiscard]] double number() const;
  /// @throws [json.out_of_range] unless low <= number <= high
  [[nodiscard]] double number(double low, double high) const;
  /// A number over zero.
  [[nodiscard]] double positive() const;
  /// An integer written without point and exponent. @throws [json.not_an_integer], [json.out_of_range]
  [[nodiscard]] long long integer(long long low, long long high) const;
  [[nodiscard]] std::uint64_t unsigned_integer() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string string() const;
  /// A string or an integer, as text: a label.
  [[nodiscard]] std::string label() const;
  [[nodiscard]] std::vector<std::string> strings() const;
  /// An array of numbers. @param length  refused otherwise, [json.wrong_length]; -1: any
  [[nodiscard]] Vector vector(Eigen::Index length = -1) const;
  /// A list of rows of the same length. @param rows, columns  refused otherwise; -1: any
  [[nodiscard]] Matrix matrix(Eigen::Index rows = -1, Eigen::Index columns = -1) const;

  /// Refuses (strict) or warns of members of an object that are not named here, [json.unknown_key].
  void only(std::initializer_list<std::string_view> keys) const;
  /// Throws the refusal of this value with a text of the caller's.
  [[noreturn]] void fail(std::string id, const std::string& text) const;
  /// File and pointer.
  [[nodiscard]] Place place() const;

 private:
  friend class JsonDocument;
  struct Context;
  JsonView(const Context* context, const void* node, std::string pointer)
      : context_(context), node_(node), pointer_(std::move(pointer)) {}

  const Context* context_;
  const void* node_;
  std::string pointer_;  // empty: the document itself
};

/// One parsed document, an object.
class JsonDocument {
 public:
  /// Parses exactly one document. @throws as JsonStream::next
  JsonDocument(std::string_view text, const std::string& file, Messages& messages, const JsonOptions& options = {},
               std::size_t first_line = 1, std::size_t first_column = 1);
  ~JsonDocument();
  JsonDocument(JsonDocument&&) noexcept;
  JsonDocument& operator=(JsonDocument&&) noexcept;

  [[nodiscard]] JsonView root() const;
  /// The value of "format". @throws [json.wrong_format] if there is none or it is not one of lfdtools
  [[nodiscard]] std::string format() const;
  /// Checks "format" and "version" 1. @param format  such as "lfdtools.gmm"
  /// @throws [json.wrong_format], which says the program that reads the format found; [json.newer_version]
  void expect(std::string_view format) const;

 private:
  std::unique_ptr<JsonView::Context> context_;
};

/// The documents of one or several inputs, one at a time, separated by white space.
class JsonStream {
 public:
  /// @param messages  takes warnings; must outlive the stream and its documents
  JsonStream(std::vector<Input> inputs, Messages& messages, const JsonOptions& options = {});
  ~JsonStream();
  JsonStream(JsonStream&&) noexcept;

  /// The next document, or nothing at the end of the last input.
  /// @throws DataError or ConfigError, with line and column: json.empty (an input without any document), json.syntax
  ///         (also NUL, bytes after a document), json.truncated, json.duplicate_key, json.too_deep, json.too_large,
  ///         json.out_of_range (a number such as 1e400)
  [[nodiscard]] std::optional<JsonDocument> next();
  /// Of all inputs' bytes.
  [[nodiscard]] std::string sha256() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The only document of a file.
/// @throws as JsonStream::next; [json.one_document] if there are more
[[nodiscard]] JsonDocument read_json(const std::string& name, Messages& messages, const JsonOptions& options = {});

}  // namespace lfd
