#include "lfdtools/io/message.hpp"

#include <unistd.h>

#include <cerrno>

#include "lfdtools/io/json_writer.hpp"
#include "lfdtools/io/utf8.hpp"

namespace lfd {
namespace {

void append_hexadecimal(std::string& out, unsigned char byte) {
  out += "\\x";
  out += "0123456789abcdef"[byte >> 4];
  out += "0123456789abcdef"[byte & 15];
}

void write_line(int descriptor, std::string_view line) {
  while (!line.empty()) {
    const ssize_t n = ::write(descriptor, line.data(), line.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    line.remove_prefix(static_cast<std::size_t>(n));
  }
}

void member_or_null(JsonWriter& json, std::string_view key, std::string_view value) {
  json.key(key);
  value.empty() ? json.null() : json.string(value);
}

void member_or_null(JsonWriter& json, std::string_view key, std::size_t value) {
  json.key(key);
  value == 0 ? json.null() : json.unsigned_integer(value);
}

}  // namespace

std::string escape_controls(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_sequence(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    // U+0080 to U+009F, 0xC2 0x80..0x9F, are control characters too: some terminals obey them.
    const bool second_control = length == 2 && byte == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (length == 0) {
      append_hexadecimal(out, byte);
      ++i;
      continue;
    }
    if (byte == '\n') {
      out += "\\n";
    } else if (byte == '\r') {
      out += "\\r";
    } else if (byte == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      append_hexadecimal(out, byte);
    } else if (second_control) {
      append_hexadecimal(out, byte);
      append_hexadecimal(out, static_cast<unsigned char>(text[i + 1]));
    } else {
      out += text.substr(i, length);
    }
    i += length;
  }
  return out;
}

std::string describe(const Place& place) {
  std::string out = place.file;
  const auto add = [&out](const std::string& part) {
    if (!out.empty()) out += ':';
    out += part;
  };
  if (place.line > 0) add(std::to_string(place.line));
  if (place.line > 0 && place.column > 0) add(std::to_string(place.column));
  if (!place.pointer.empty()) add(place.pointer);
  return out;
}

Messages::Messages(std::string program, MessageFormat format, bool quiet, int descriptor)
    : program_(std::move(program)), format_(format), quiet_(quiet), descriptor_(descriptor) {}

void Messages::error(const Error& error) const noexcept {
  write("error", static_cast<int>(error.fault()), error.id(), error.what(), error.place());
}

void Messages::error(int status, std::string_view id, std::string_view text, const Place& place) const noexcept {
  write("error", status, id, text, place);
}

void Messages::warning(std::string_view id, std::string_view text, const Place& place) noexcept {
  ++warnings_;
  if (!quiet_) write("warning", 0, id, text, place);
}

void Messages::note(std::string_view id, std::string_view text, const Place& place) const noexcept {
  if (!quiet_) write("note", 0, id, text, place);
}

void Messages::write(std::string_view severity, int status, std::string_view id, std::string_view text,
                     const Place& place) const noexcept {
  try {
    std::string line;
    if (format_ == MessageFormat::json) {
      JsonWriter json;
      json.begin_object().member("program", program_).member("severity", severity).member("id", id);
      member_or_null(json, "file", place.file);
      member_or_null(json, "line", place.line);
      member_or_null(json, "column", place.column);
      member_or_null(json, "pointer", place.pointer);
      json.member("text", text).key("status");
      status == 0 ? json.null() : json.integer(status);
      line = json.end_object().text();
    } else {
      line = program_ + ':';
      const std::string where = describe(place);
      if (!where.empty()) line += where + ':';
      line += ' ';
      if (severity != "error") line.append(severity).append(": ");
      line = escape_controls(line.append(text));
      if (!id.empty()) line.append(" [").append(id).append("]");
    }
    line += '\n';
    write_line(descriptor_, line);  // one write: lines of the programs of a pipe do not mix
  } catch (...) {
    write_line(descriptor_, "out of memory while writing a message\n");
  }
}

}  // namespace lfd
