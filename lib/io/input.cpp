#include "lfdtools/io/input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "lfdtools/error.hpp"
#include "lfdtools/io/digest.hpp"

namespace lfd {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;

[[noreturn]] void fail_open(const std::string& name, const std::string& why) {
  throw Error(Fault::no_input, "input.cannot_open", "cannot open: " + why, {name, 0, 0, ""});
}

}  // namespace

Input::Input(const std::string& name) : name_(name == "-" ? "<stdin>" : name) {
  Descriptor source;
  int number = STDIN_FILENO;
  if (name != "-") {
    source = Descriptor(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
    if (!source.open()) fail_open(name_, std::strerror(errno));
    number = source.number();
  }
  struct stat status {};
  if (::fstat(number, &status) != 0) fail_open(name_, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) fail_open(name_, "it is a folder");
  if (!S_ISREG(status.st_mode)) {
    spool(number);
    return;
  }
  if (!source.open()) {
    source = Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 3));
    if (!source.open()) fail_open(name_, std::strerror(errno));
    // What a shell script has read of its own standard input already is not ours.
    origin_ = static_cast<std::uint64_t>(std::max<off_t>(::lseek(number, 0, SEEK_CUR), 0));
  }
  // Files of /proc say that they are empty, and are not.
  char first = 0;
  if (status.st_size == 0 && read_some_at(source.number(), origin_, &first, 1, name_) > 0) {
    spool(number);
    return;
  }
  size_ = static_cast<std::uint64_t>(status.st_size) - std::min(origin_, static_cast<std::uint64_t>(status.st_size));
  file_ = std::move(source);
}

Input::Input(std::string name, std::string_view bytes) : name_(std::move(name)), size_(bytes.size()) {
  spool_.append(bytes);
}

void Input::spool(int descriptor) {
  std::vector<char> block(block_size);
  while (const std::size_t n = read_some(descriptor, block.data(), block.size(), name_))
    spool_.append({block.data(), n});
  size_ = spool_.size();
}

std::size_t Input::read_at(std::uint64_t offset, char* data, std::size_t count) const {
  if (!file_.open()) return spool_.read_at(offset, data, count);
  if (offset >= size_) return 0;
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset));
  for (std::size_t done = 0; done < count;) {
    const std::size_t n = read_some_at(file_.number(), origin_ + offset + done, data + done, count - done, name_);
    if (n == 0) {
      throw Error(Fault::io, "input.read_failed", "the file has become shorter while it was read", {name_, 0, 0, ""});
    }
    done += n;
  }
  return count;
}

std::vector<Input> open_inputs(const std::vector<std::string>& names) {
  if (std::count(names.begin(), names.end(), "-") > 1) {
    throw UsageError("input.stdin_twice", "standard input (-) can be given once only");
  }
  std::vector<Input> inputs;
  for (const std::string& name : names) inputs.emplace_back(name);
  if (names.empty()) inputs.emplace_back("-");
  return inputs;
}

std::string sha256(const std::vector<Input>& inputs) {
  Sha256 digest;
  std::vector<char> block(block_size);
  for (const Input& input : inputs) {
    std::uint64_t at = 0;
    while (const std::size_t n = input.read_at(at, block.data(), block.size())) {
      digest.update({block.data(), n});
      at += n;
    }
  }
  return digest.hex();
}

}  // namespace lfd
