#include "lfdtools/io/spool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr const char* temporary_name = "a temporary file";

[[noreturn]] void fail_spool(const std::string& folder) {
  throw Error(
      Fault::io, "spool.failed",
      "cannot use a temporary file in " + folder + ": " + std::strerror(errno) + " (TMPDIR names another folder)");
}

std::string temporary_folder() {
  const char* folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

Descriptor unlinked_file() {
  const std::string folder = temporary_folder();
  const int nameless = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC | O_EXCL, 0600);
  if (nameless >= 0) return Descriptor(nameless);
  // Not every file system has nameless files: make one with a name, and take the name away at once.
  std::string path = folder + "/lfd-XXXXXX";
  Descriptor file(::mkostemp(path.data(), O_CLOEXEC));
  if (!file.open()) fail_spool(folder);
  ::unlink(path.c_str());
  return file;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    close();
    number_ = other.release();
  }
  return *this;
}

int Descriptor::release() {
  return std::exchange(number_, -1);
}

bool Descriptor::close() {
  const int number = release();
  // After EINTR the descriptor is closed all the same (Linux): closing it again could close another thread's.
  return number < 0 || ::close(number) == 0 || errno == EINTR;
}

void write_all(int descriptor, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      throw Error(Fault::io, "output.write_failed", std::string("cannot write: ") + std::strerror(errno),
                  {name, 0, 0, ""});
    }
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

namespace {

template <class Read>
std::size_t checked_read(const std::string& name, Read read) {
  for (;;) {
    const ssize_t n = read();
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR) {
      throw Error(Fault::io, "input.read_failed", std::string("cannot read: ") + std::strerror(errno),
                  {name, 0, 0, ""});
    }
  }
}

}  // namespace

std::size_t read_some(int descriptor, char* data, std::size_t count, const std::string& name) {
  return checked_read(name, [&] { return ::read(descriptor, data, count); });
}

std::size_t read_some_at(int descriptor, std::uint64_t offset, char* data, std::size_t count, const std::string& name) {
  return checked_read(name, [&] { return ::pread(descriptor, data, count, static_cast<off_t>(offset)); });
}

void Spool::append(std::string_view bytes) {
  if (memory_.size() + bytes.size() <= memory_limit) {
    memory_.append(bytes);
    return;
  }
  spill(memory_);
  memory_.clear();
  if (bytes.size() > memory_limit) {
    spill(bytes);
  } else {
    memory_ = bytes;
  }
}

void Spool::spill(std::string_view bytes) {
  if (!file_.open()) file_ = unlinked_file();
  try {
    write_all(file_.number(), bytes, temporary_name);
  } catch (const Error&) {
    fail_spool(temporary_folder());
  }
  file_size_ += bytes.size();
}

std::size_t Spool::read_at(std::uint64_t offset, char* data, std::size_t count) const {
  std::size_t done = 0;
  while (done < count && offset + done < file_size_) {
    const std::uint64_t left = file_size_ - offset - done;
    const std::size_t n =
        read_some_at(file_.number(), offset + done, data + done,
                     static_cast<std::size_t>(std::min<std::uint64_t>(count - done, left)), temporary_name);
    if (n == 0) throw Error(Fault::io, "input.read_failed", "a temporary file has become shorter");
    done += n;
  }
  if (done < count && offset + done < size()) {
    const auto first = static_cast<std::size_t>(offset + done - file_size_);
    const std::size_t n = std::min(count - done, memory_.size() - first);
    std::memcpy(data + done, memory_.data() + first, n);
    done += n;
  }
  return done;
}

void Spool::copy_to(int descriptor, const std::string& name) const {
  if (file_size_ > 0) {
    std::vector<char> block(std::size_t{1} << 18);
    for (std::uint64_t at = 0; at < file_size_;) {
      const auto want = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), file_size_ - at));
      const std::size_t n = read_at(at, block.data(), want);
      write_all(descriptor, {block.data(), n}, name);
      at += n;
    }
  }
  write_all(descriptor, memory_, name);
}

}  // namespace lfd
