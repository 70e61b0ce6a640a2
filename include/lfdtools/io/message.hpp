// What the programs say on standard error.
#pragma once

#include <string>
#include <string_view>

#include "lfdtools/error.hpp"

namespace lfd {

enum class MessageFormat {
  text,  ///< PROGRAM:FILE:LINE:COLUMN: text [stable.id]
  json   ///< one compact JSON object a line
};

/// The text with control characters, the byte 0x7f and bytes that are not UTF-8 written as \n, \t, \xNN.
[[nodiscard]] std::string escape_controls(std::string_view text);

/// `FILE:LINE:COLUMN` or `FILE:/pointer`; unknown parts are left out, so that an unknown place is empty.
[[nodiscard]] std::string describe(const Place& place);

/// Writes messages, one line each. Writing never throws: a standard error that cannot be written is ignored.
class Messages {
 public:
  /// @param program  name of the program   @param quiet  leaves out warnings and notes
  /// @param descriptor  where to write
  explicit Messages(std::string program, MessageFormat format = MessageFormat::text, bool quiet = false,
                    int descriptor = 2);

  /// `PROGRAM:PLACE: text [id]`
  void error(const Error& error) const noexcept;
  /// The same from its parts. @param status  exit status that will follow
  void error(int status, std::string_view id, std::string_view text, const Place& place = {}) const noexcept;
  /// `PROGRAM:PLACE: warning: text [id]`
  void warning(std::string_view id, std::string_view text, const Place& place = {}) noexcept;
  /// `PROGRAM:PLACE: note: text [id]`
  void note(std::string_view id, std::string_view text, const Place& place = {}) const noexcept;

  [[nodiscard]] const std::string& program() const { return program_; }
  [[nodiscard]] bool quiet() const { return quiet_; }
  /// How many warnings there were, silenced ones included.
  [[nodiscard]] std::size_t warnings() const { return warnings_; }

 private:
  void write(std::string_view severity, int status, std::string_view id, std::string_view text,
             const Place& place) const noexcept;

  std::string program_;
  MessageFormat format_;
  bool quiet_;
  int descriptor_;
  std::size_t warnings_ = 0;
};

}  // namespace lfd
