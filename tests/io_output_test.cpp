#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <functional>
#include <thread>

#include "io_fixture.hpp"
#include "lfdtools/io/output.hpp"

using namespace lfd;
namespace fs = std::filesystem;

namespace {

/// Runs the body in a process of its own, whose exit status is the body's, or that of the refusal it ends with.
int status_of_child(const std::function<int()>& body, const std::function<void(pid_t)>& meanwhile = {}) {
  const pid_t child = ::fork();
  if (child == 0) {
    int status = 0;
    const Refusal refusal = refusal_of([&] { status = body(); });
    ::_exit(refusal.id.empty() ? status : static_cast<int>(refusal.fault));
  }
  if (meanwhile) meanwhile(child);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

mode_t mode_of(const std::string& name) {
  struct stat status {};
  REQUIRE(::stat(name.c_str(), &status) == 0);
  return status.st_mode & 07777;
}

const std::string large(200'000, 'x');

}  // namespace

TEST_CASE("a file is the old one until finish and the new one afterwards") {
  const ScratchFolder folder;
  const std::string name = folder.write("out", "old");
  {
    Output out(name);
    out.write(large);
    REQUIRE(content(name) == "old");
    REQUIRE(folder.entries() == 2);  // the temporary file is beside it
    out.finish();
  }
  REQUIRE(content(name) == large);
  REQUIRE(folder.entries() == 1);
}

TEST_CASE("an output that is given up leaves the old file and nothing else") {
  const ScratchFolder folder;
  const std::string name = folder.write("out", "old");
  {
    Output out(name);
    out.write(large);
    Output fresh(folder.file("new"));
    fresh.write("never");
  }
  REQUIRE(content(name) == "old");
  REQUIRE(folder.entries() == 1);
}

TEST_CASE("a new file obeys the umask, an existing one keeps its mode") {
  const ScratchFolder folder;
  const mode_t before = ::umask(027);
  Output(folder.file("new")).finish();
  ::umask(before);
  REQUIRE(mode_of(folder.file("new")) == 0640);
  for (const mode_t mode : {0600, 0664, 0755}) {
    const std::string name = folder.write("old", "x");
    REQUIRE(::chmod(name.c_str(), mode) == 0);
    Output(name).finish();
    REQUIRE(mode_of(name) == mode);
  }
}

TEST_CASE("symbolic links are followed, also to a file that is not there yet") {
  const ScratchFolder folder;
  fs::create_directory(folder.path / "deep");
  for (const bool exists : {true, false}) {
    if (exists) (void)folder.write("deep/target", "old");
    fs::create_symlink("deep/target", folder.path / "middle");
    fs::create_symlink(folder.path / "middle", folder.path / "link");
    Output out(folder.file("link"));
    out.write("new");
    out.finish();
    REQUIRE(fs::is_symlink(folder.path / "link"));
    REQUIRE(content(folder.file("deep/target")) == "new");
    fs::remove_all(folder.path / "deep/target");
    fs::remove(folder.path / "middle");
    fs::remove(folder.path / "link");
  }
  fs::create_symlink("loop", folder.path / "loop");
  REQUIRE(refusal_of([&] { Output out(folder.file("loop")); }).fault == Fault::cannot_create);
}

TEST_CASE("what cannot be created is status 73") {
  const ScratchFolder folder;
  for (const std::string& name : {folder.file("missing/out"), folder.path.string(), folder.file("new/"),
                                  std::string("/proc/out"), folder.file(std::string(300, 'n'))}) {
    INFO(name);
    const Refusal refusal = refusal_of([&] {
      Output out(name);
      out.finish();
    });
    REQUIRE(refusal.id == "output.cannot_create");
    REQUIRE(refusal.fault == Fault::cannot_create);
    REQUIRE(refusal.place.file == name);
  }
  REQUIRE(folder.entries() == 0);
}

TEST_CASE("a full device is status 74, named or as standard output, for little and for much") {
  for (const std::string& bytes : {std::string("x"), large}) {
    const Refusal refusal = refusal_of([&] {
      Output out("/dev/full");
      out.write(bytes);
      out.finish();
    });
    REQUIRE(refusal.id == "output.write_failed");
    REQUIRE(refusal.fault == Fault::io);
    REQUIRE(status_of_child([&] {
              ::dup2(::open("/dev/full", O_WRONLY), 1);
              Output out;
              out.write(bytes);
              out.finish();
              return 0;
            }) == 74);
  }
}

TEST_CASE("a closed standard output is status 74, with something to write or nothing, and spoils no file") {
  const ScratchFolder folder;
  for (const bool prepared : {false, true}) {
    for (const char* bytes : {"", "x"}) {
      const std::string name = folder.write("data", "precious");
      REQUIRE(status_of_child([&] {
                ::close(1);
                if (prepared) install_signal_cleanup();
                const int file = ::open(name.c_str(), O_RDWR);  // gets the number 1 where nobody took care
                if (prepared && file == 1) return 1;
                if (!prepared) ::close(file);
                Output out;
                out.write(bytes);
                out.finish();
                return 0;
              }) == 74);
      REQUIRE(content(name) == "precious");
    }
  }
}

TEST_CASE("standard output gets nothing before finish, then everything") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  std::string received;
  const auto collect = [&](pid_t) {
    ::close(ends[1]);
    char block[4096];
    for (ssize_t n; (n = ::read(ends[0], block, sizeof block)) > 0;)
      received.append(block, static_cast<std::size_t>(n));
    ::close(ends[0]);
  };
  const std::string huge(3 * Spool::memory_limit + 5, 'y');
  REQUIRE(status_of_child(
              [&] {
                ::dup2(ends[1], 1);
                Output out;
                out.write(huge);
                ::write(1, "first", 5) == 5 ? void()
                                            : std::abort();  // had anything been written, it would stand before
                out.finish();
                return 0;
              },
              collect) == 0);
  REQUIRE(received == "first" + huge);
}

TEST_CASE("a reader that stops early ends the program by SIGPIPE") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  ::close(ends[0]);
  REQUIRE(status_of_child([&] {
            ::signal(SIGPIPE, SIG_DFL);
            install_signal_cleanup();
            ::dup2(ends[1], 1);
            Output out;
            out.write("x");
            out.finish();
            return 0;
          }) == 1000 + SIGPIPE);
  ::close(ends[1]);
}

TEST_CASE("a named pipe and the names of open descriptors are written to, not replaced") {
  const ScratchFolder folder;
  const std::string fifo = folder.file("fifo");
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  std::string received;
  std::thread reader([&] { received = content(fifo); });
  {
    Output out(fifo);
    out.write("through");
    out.finish();
  }
  reader.join();
  REQUIRE(received == "through");
  REQUIRE(fs::is_fifo(fifo));

  // A script that has redirected standard output to a file goes on writing to it after us.
  for (const std::string name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    const std::string file = folder.file("redirected");
    REQUIRE(status_of_child([&] {
              ::dup2(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
              Output out(name);
              out.write("ours ");
              out.finish();
              return ::write(1, "theirs", 6) == 6 ? 0 : 1;
            }) == 0);
    REQUIRE(content(file) == "ours theirs");
  }
}

TEST_CASE("INT, TERM and HUP remove the temporary file and end with 128 + signal") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const ScratchFolder folder;
    const std::string name = folder.write("out", "old");
    REQUIRE(status_of_child([&] {
              ::signal(signal, SIG_DFL);
              install_signal_cleanup();
              Output out(name);
              out.write(large);
              ::raise(signal);
              return 0;
            }) == 128 + signal);
    REQUIRE(content(name) == "old");
    REQUIRE(folder.entries() == 1);
  }
}

TEST_CASE("the file-size limit is status 74 and leaves the old file") {
  const ScratchFolder folder;
  const std::string name = folder.write("out", "old");
  REQUIRE(status_of_child([&] {
            install_signal_cleanup();
            const rlimit limit{100'000, 100'000};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            Output out(name);
            out.write(large);
            out.finish();
            return 0;
          }) == 74);
  REQUIRE(content(name) == "old");
  REQUIRE(folder.entries() == 1);
}

TEST_CASE("two writers leave one whole result") {
  const ScratchFolder folder;
  const std::string name = folder.file("out");
  const std::string a(300'000, 'a');
  const std::string b(200'000, 'b');
  const auto write = [&](const std::string& bytes) {
    for (int i = 0; i < 20; ++i) {
      Output out(name);
      out.write(bytes);
      out.finish();
    }
    return 0;
  };
  REQUIRE(status_of_child([&] { return write(a); }, [&](pid_t) { (void)write(b); }) == 0);
  const std::string left = content(name);
  REQUIRE((left == a || left == b));
  REQUIRE(folder.entries() == 1);
}

TEST_CASE("records are appended, the header once") {
  const ScratchFolder folder;
  const std::string name = folder.file("summary.csv");
  append_record(name, "a,b\n", "1,2\n");
  append_record(name, "a,b\n", "3,4\n");
  REQUIRE(content(name) == "a,b\n1,2\n3,4\n");
  REQUIRE(refusal_of([&] { append_record(folder.file("no/file"), "", "x"); }).fault == Fault::cannot_create);
  REQUIRE(refusal_of([&] { append_record("/dev/full", "", "x"); }).fault == Fault::io);
}
