// Where a program's data come from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lfdtools/io/spool.hpp"

namespace lfd {

/// One source of bytes, readable from any place and more than once. A regular file is read where it is; a pipe
/// (standard input, a named pipe) is spooled when it is opened.
class Input {
 public:
  /// @param name  file name, or "-" for standard input
  /// @throws Error(Fault::no_input) [input.cannot_open] for what is missing, unreadable or a folder;
  ///         Error(Fault::io) [input.read_failed], [spool.failed]
  explicit Input(const std::string& name);
  /// Bytes that are already in memory, under the given name.
  Input(std::string name, std::string_view bytes);

  /// As the user gave it; "<stdin>" for standard input.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Bytes, as of when it was opened.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Fills `data` unless the end comes first. @return number of bytes read
  /// @throws Error(Fault::io) [input.read_failed], also for a file that has become shorter
  std::size_t read_at(std::uint64_t offset, char* data, std::size_t count) const;

 private:
  void spool(int descriptor);

  std::string name_;
  Descriptor file_;           // a regular file, else closed
  std::uint64_t origin_ = 0;  // where in the file the input begins (standard input that was read before)
  Spool spool_;
  std::uint64_t size_ = 0;
};

/// Opens all of them in order; none given means standard input.
/// @throws UsageError [input.stdin_twice] if "-" is given twice; otherwise as Input
[[nodiscard]] std::vector<Input> open_inputs(const std::vector<std::string>& names);

/// SHA-256 of the bytes of all inputs, one after the other, in hexadecimal.
[[nodiscard]] std::string sha256(const std::vector<Input>& inputs);

}  // namespace lfd
