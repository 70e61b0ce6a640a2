// A store of bytes that grows: memory first, then an unlinked temporary file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lfd {

/// An open file descriptor that is closed at the end. -1: none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool open() const { return number_ >= 0; }
  int release();
  /// @return false if close reports a write that failed
  bool close();

 private:
  int number_;
};

/// Writes all bytes: goes on after interruptions and short writes.
/// @param name  of the file, for the message
/// @throws Error(Fault::io) [output.write_failed]
void write_all(int descriptor, std::string_view bytes, const std::string& name);

/// Reads up to `count` bytes; 0 at the end. Goes on after interruptions.
/// @throws Error(Fault::io) [input.read_failed]
[[nodiscard]] std::size_t read_some(int descriptor, char* data, std::size_t count, const std::string& name);
/// The same from a place in a seekable file.
[[nodiscard]] std::size_t read_some_at(int descriptor, std::uint64_t offset, char* data, std::size_t count,
                                       const std::string& name);

/// Bytes appended in order, read back from any place. Up to memory_limit they stay in memory, then they go to a file in
/// $TMPDIR (or /tmp) that has no name any more, so that nothing is left behind however the program ends.
class Spool {
 public:
  static constexpr std::size_t memory_limit = std::size_t{1} << 20;

  /// @throws Error(Fault::io) [spool.failed] if there is no room for temporary files
  void append(std::string_view bytes);
  [[nodiscard]] std::uint64_t size() const { return file_size_ + memory_.size(); }
  /// @return number of bytes read, 0 beyond the end
  [[nodiscard]] std::size_t read_at(std::uint64_t offset, char* data, std::size_t count) const;
  /// Writes everything to a descriptor. @param name  of the destination
  void copy_to(int descriptor, const std::string& name) const;

 private:
  void spill(std::string_view bytes);

  std::string memory_;  // what is not in the file yet
  Descriptor file_;
  std::uint64_t file_size_ = 0;
};

}  // namespace lfd
