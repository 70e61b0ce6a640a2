// Where a program's data go: all of them or nothing.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lfdtools/io/spool.hpp"

namespace lfd {

/// Collects the output of a program and hands it over whole in finish(). An Output that is destroyed before leaves
/// nothing behind.
///
/// Standard output, and what is not a regular file (named pipe, device, /dev/stdout): spooled, then written.
/// A regular file: written to a temporary file in the same folder, which then takes the file's place (write, fsync,
/// rename, fsync of the folder), so that at any moment the name stands for the whole old or the whole new file.
/// Symbolic links are followed; the mode of an existing file is kept. It may be one of the inputs.
class Output {
 public:
  /// @param name  file name; "" or "-" for standard output
  /// @throws Error(Fault::cannot_create) [output.cannot_create]
  explicit Output(const std::string& name = "");
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// @throws Error(Fault::io) [output.write_failed], [spool.failed]
  void write(std::string_view bytes);
  /// Room for at least `count` bytes (at most 64 KiB); what was filled is told by filled().
  [[nodiscard]] char* room(std::size_t count) {
    if (used_ + count > buffer_.size()) make_room(count);
    return buffer_.data() + used_;
  }
  void filled(std::size_t count) { used_ += count; }

  /// Hands the output over. Call it once, when everything has succeeded.
  /// @throws Error(Fault::io) [output.write_failed], Error(Fault::cannot_create) [output.cannot_create]
  void finish();

  /// Name for messages, "<stdout>" for standard output.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void open_temporary(const std::string& path);
  void make_room(std::size_t count);
  void flush();
  void discard() noexcept;
  void forget_temporary() noexcept;

  std::string name_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  Spool spool_;                 // where the output is no regular file
  Descriptor direct_;           // named pipe or device
  Descriptor temporary_;        // beside the file to be replaced
  std::string temporary_path_;  // empty: there is none
  std::string target_path_;
};

/// Sets up INT, TERM and HUP to remove the temporary file of an Output and end the program (status 130, 143, 129), and
/// lets a write beyond the file-size limit fail (74) instead of killing the program. For programs, once, before the
/// first Output; libraries need not call it.
void install_signal_cleanup();

/// Appends text to a file in one write, after `header` if the file is new or empty; two programs that append at the
/// same time do not mix. @throws Error [output.cannot_create], [output.write_failed]
void append_record(const std::string& path, std::string_view header, std::string_view text);

}  // namespace lfd
