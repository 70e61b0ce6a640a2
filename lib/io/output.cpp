#include "lfdtools/io/output.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;

// What a signal handler must know has to be static: the one file to remove. The flag says that the name is complete.
char registered_path[PATH_MAX];
volatile std::sig_atomic_t registered = 0;

void unlink_registered(int signal) {
  if (registered != 0) ::unlink(registered_path);
  ::_exit(128 + signal);
}

/// Holds back the signals that remove the temporary file while file and registration change together.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
    ::pthread_sigmask(SIG_BLOCK, &set, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_{};
};

[[noreturn]] void fail_create(const std::string& name, const std::string& why) {
  throw Error(Fault::cannot_create, "output.cannot_create", "cannot create: " + why, {name, 0, 0, ""});
}

[[noreturn]] void fail_write(const std::string& name) {
  throw Error(Fault::io, "output.write_failed", std::string("cannot write: ") + std::strerror(errno), {name, 0, 0, ""});
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// The number N of a name such as /dev/stdout or /dev/fd/N: a file that the caller has open already. Replacing the file
/// behind it would leave the caller with the old one.
std::optional<int> open_descriptor_named(const std::string& name) {
  if (name == "/dev/stdout") return STDOUT_FILENO;
  if (name == "/dev/stderr") return STDERR_FILENO;
  for (const std::string prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    const std::string digits = name.rfind(prefix, 0) == 0 ? name.substr(prefix.size()) : "";
    if (!digits.empty() && digits.size() < 7 && digits.find_first_not_of("0123456789") == std::string::npos) {
      return std::stoi(digits);
    }
  }
  return {};
}

/// The file that the name stands for in the end, whether it exists or not.
std::string follow_links(const std::string& name) {
  std::string path = name;
  for (int links = 0; links < 40; ++links) {
    char target[PATH_MAX];
    const ssize_t n = ::readlink(path.c_str(), target, sizeof target);
    if (n < 0) return path;
    const std::string next(target, static_cast<std::size_t>(n));
    path = next.front() == '/' ? next : folder_of(path) + '/' + next;
  }
  fail_create(name, std::strerror(ELOOP));
}

}  // namespace

Output::Output(const std::string& name) : name_(name.empty() || name == "-" ? "<stdout>" : name) {
  if (name_ == "<stdout>" && name != name_) return;
  if (const std::optional<int> number = open_descriptor_named(name)) {
    direct_ = Descriptor(::fcntl(*number, F_DUPFD_CLOEXEC, 3));
    if (!direct_.open()) fail_create(name_, std::strerror(errno));
    return;
  }
  struct stat status {};
  const bool exists = ::stat(name.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail_create(name_, std::strerror(errno));
  if ((exists && S_ISDIR(status.st_mode)) || name.back() == '/') fail_create(name_, "it is a folder");
  if (exists && !S_ISREG(status.st_mode)) {
    direct_ = Descriptor(::open(name.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (!direct_.open()) fail_create(name_, std::strerror(errno));
    return;
  }
  target_path_ = follow_links(name);
  // A file that may not be written is not replaced either, though its folder would allow it.
  if (exists && ::faccessat(AT_FDCWD, target_path_.c_str(), W_OK, AT_EACCESS) != 0)
    fail_create(name_, std::strerror(errno));
  open_temporary(target_path_);
  if (exists) {
    // The owner is kept where that is allowed; the mode afterwards, as a change of owner clears bits of it.
    const int owner_kept = ::fchown(temporary_.number(), status.st_uid, status.st_gid);
    const mode_t mode = status.st_mode & (owner_kept == 0 ? 07777 : 0777);
    if (::fchmod(temporary_.number(), mode) != 0) {
      const int reason = errno;
      discard();
      fail_create(name_, std::strerror(reason));
    }
  }
}

void Output::open_temporary(const std::string& path) {
  const SignalsHeld held;
  const std::string stem = folder_of(path) + "/.lfd-" + std::to_string(::getpid()) + "-";
  // A name may be left over from a program that was killed.
  for (int attempt = 0; attempt < 1000 && !temporary_.open(); ++attempt) {
    temporary_path_ = stem + std::to_string(attempt);
    temporary_ = Descriptor(::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!temporary_.open() && errno != EEXIST) break;
  }
  if (!temporary_.open()) {
    temporary_path_.clear();  // nothing to remove
    fail_create(name_, std::strerror(errno));
  }
  if (registered == 0 && temporary_path_.size() < sizeof registered_path) {
    std::strcpy(registered_path, temporary_path_.c_str());
    registered = 1;
  }
}

Output::~Output() {
  discard();
}

void Output::discard() noexcept {
  temporary_.close();
  if (temporary_path_.empty()) return;
  const SignalsHeld held;
  ::unlink(temporary_path_.c_str());
  forget_temporary();
}

void Output::forget_temporary() noexcept {
  if (registered != 0 && temporary_path_ == registered_path) registered = 0;
  temporary_path_.clear();
}

void Output::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), buffer_size);
    std::memcpy(room(n), bytes.data(), n);
    filled(n);
    bytes.remove_prefix(n);
  }
}

void Output::make_room(std::size_t count) {
  if (count > buffer_size) throw Error(Fault::internal, "output.room", "a piece of output is too long");
  flush();
  buffer_.resize(buffer_size);
}

void Output::flush() {
  const std::string_view bytes(buffer_.data(), used_);
  temporary_.open() ? write_all(temporary_.number(), bytes, name_) : spool_.append(bytes);
  used_ = 0;
}

void Output::finish() {
  flush();
  if (!temporary_.open()) {
    const int number = direct_.open() ? direct_.number() : STDOUT_FILENO;
    const int flags = ::fcntl(number, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) {
      errno = EBADF;  // closed, or put in its place when the program began: seen even if there is nothing to write
      fail_write(name_);
    }
    spool_.copy_to(number, name_);
    // A file system may report a failed write only when a descriptor is closed; closing a copy keeps ours.
    Descriptor copy(::fcntl(number, F_DUPFD_CLOEXEC, 3));
    if (copy.open() && !copy.close()) fail_write(name_);
    return;
  }
  if (::fsync(temporary_.number()) != 0 && errno != EINVAL) fail_write(name_);
  if (!temporary_.close()) fail_write(name_);  // before the rename: what was not written must not replace the old file
  const Descriptor folder(::open(folder_of(target_path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const SignalsHeld held;
  if (::rename(temporary_path_.c_str(), target_path_.c_str()) != 0) fail_create(name_, std::strerror(errno));
  forget_temporary();
  if (folder.open() && ::fsync(folder.number()) != 0 && errno != EINVAL) fail_write(name_);
}

void install_signal_cleanup() {
  // A closed standard descriptor would be given to the next file opened, which output or messages would then spoil.
  // What takes its place cannot be used: reading from 0 and writing to 1 fail as if it were closed.
  const int directions[] = {O_WRONLY, O_RDONLY, O_RDWR};
  for (int number = 0; number < 3; ++number) {
    if (::fcntl(number, F_GETFD) < 0 && ::open("/dev/null", directions[number]) < 0) std::abort();
  }
  struct sigaction action {};
  action.sa_handler = unlink_registered;
  sigfillset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    // A program started with nohup, or in the background by a script, keeps ignoring.
    if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
  ::signal(SIGXFSZ, SIG_IGN);
}

void append_record(const std::string& path, std::string_view header, std::string_view text) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
  if (!file.open()) fail_create(path, std::strerror(errno));
  ::flock(file.number(), LOCK_EX);  // so that only one program finds the file empty; devices may refuse it
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail_write(path);
  write_all(file.number(), std::string(status.st_size == 0 ? header : "").append(text), path);
  if (!file.close()) fail_write(path);
}

}  // namespace lfd
