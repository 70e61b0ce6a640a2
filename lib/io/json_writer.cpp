#include "lfdtools/io/json_writer.hpp"

#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/io/number.hpp"
#include "lfdtools/io/utf8.hpp"

namespace lfd {

std::string json_quoted(std::string_view text) {
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_sequence(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      out += "\xEF\xBF\xBD";
      ++i;
      continue;
    }
    switch (byte) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (byte < 0x20 || byte == 0x7F) {
          out += "\\u00";
          out += "0123456789abcdef"[byte >> 4];
          out += "0123456789abcdef"[byte & 15];
        } else {
          out += text.substr(i, length);
        }
    }
    i += length;
  }
  return out += '"';
}

void JsonWriter::separate() {
  if (!first_) text_ += ',';
  first_ = false;
}

JsonWriter& JsonWriter::begin_object() {
  separate();
  text_ += '{';
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::end_object() {
  text_ += '}';
  first_ = false;
  return *this;
}

JsonWriter& JsonWriter::begin_array() {
  separate();
  text_ += '[';
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::end_array() {
  text_ += ']';
  first_ = false;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  text_ += json_quoted(name);
  text_ += ':';
  first_ = true;  // no comma before the value
  return *this;
}

JsonWriter& JsonWriter::number(double value) {
  if (!std::isfinite(value)) throw Error(Fault::internal, "json.write_not_finite", "a result is no finite number");
  separate();
  char text[number_room];
  text_.append(text, format_number(value, text));
  return *this;
}

JsonWriter& JsonWriter::integer(long long value) {
  separate();
  text_ += std::to_string(value);
  return *this;
}

JsonWriter& JsonWriter::unsigned_integer(unsigned long long value) {
  separate();
  text_ += std::to_string(value);
  return *this;
}

JsonWriter& JsonWriter::boolean(bool value) {
  separate();
  text_ += value ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::string(std::string_view value) {
  separate();
  text_ += json_quoted(value);
  return *this;
}

JsonWriter& JsonWriter::null() {
  separate();
  text_ += "null";
  return *this;
}

JsonWriter& JsonWriter::vector(const Eigen::Ref<const Vector>& values) {
  begin_array();
  for (Eigen::Index i = 0; i < values.size(); ++i) number(values[i]);
  return end_array();
}

JsonWriter& JsonWriter::matrix(const Eigen::Ref<const Matrix>& values) {
  begin_array();
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    begin_array();
    for (Eigen::Index j = 0; j < values.cols(); ++j) number(values(i, j));
    end_array();
  }
  return end_array();
}

JsonWriter& JsonWriter::strings(std::span<const std::string> values) {
  begin_array();
  for (const std::string& value : values) string(value);
  return end_array();
}

void JsonWriter::write_line(Output& out) {
  out.write(text_);
  out.write("\n");
  text_.clear();
  first_ = true;
}

}  // namespace lfd
