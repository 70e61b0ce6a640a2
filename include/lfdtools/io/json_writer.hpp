// JSON written compactly, keys in the order in which they are given.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lfdtools/io/output.hpp"
#include "lfdtools/linalg.hpp"

namespace lfd {

/// The text as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_quoted(std::string_view text);

/// Builds one document. Numbers are written in the shortest form that reads back to the same double.
///
///     JsonWriter json;
///     json.begin_object().member("format", "lfdtools.gmm").key("means").matrix(means).end_object();
///     json.write_line(out);
class JsonWriter {
 public:
  JsonWriter& begin_object();
  JsonWriter& end_object();
  JsonWriter& begin_array();
  JsonWriter& end_array();
  JsonWriter& key(std::string_view name);

  /// @throws Error(Fault::internal) [json.write_not_finite] for nan and inf: JSON has no such numbers
  JsonWriter& number(double value);
  JsonWriter& integer(long long value);
  JsonWriter& unsigned_integer(unsigned long long value);
  JsonWriter& boolean(bool value);
  JsonWriter& string(std::string_view value);
  JsonWriter& null();
  JsonWriter& vector(const Eigen::Ref<const Vector>& values);
  JsonWriter& matrix(const Eigen::Ref<const Matrix>& values);  ///< a list of rows
  JsonWriter& strings(std::span<const std::string> values);

  JsonWriter& member(std::string_view name, double value) { return key(name).number(value); }
  JsonWriter& member(std::string_view name, std::string_view value) { return key(name).string(value); }
  JsonWriter& member(std::string_view name, const char* value) { return key(name).string(value); }
  JsonWriter& member(std::string_view name, bool value) { return key(name).boolean(value); }
  template <std::signed_integral T>
  JsonWriter& member(std::string_view name, T value) {
    return key(name).integer(value);
  }
  JsonWriter& member(std::string_view name, const Vector& values) { return key(name).vector(values); }
  JsonWriter& member(std::string_view name, const Matrix& values) { return key(name).matrix(values); }
  JsonWriter& member(std::string_view name, const std::vector<std::string>& values) {
    return key(name).strings(values);
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  /// The document and a line feed; the writer is empty afterwards.
  void write_line(Output& out);

 private:
  void separate();

  std::string text_;
  bool first_ = true;  // nothing stands yet in the innermost array or object
};

}  // namespace lfd
