#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <thread>

#include "io_fixture.hpp"
#include "lfdtools/io/digest.hpp"
#include "lfdtools/io/input.hpp"

using namespace lfd;

namespace {

std::string everything(const Input& input) {
  std::string bytes(static_cast<std::size_t>(input.size()), '\0');
  REQUIRE(input.read_at(0, bytes.data(), bytes.size()) == bytes.size());
  return bytes;
}

std::string pattern(std::size_t size) {
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>((i * 131 + i / 977) % 251);
  return bytes;
}

/// Standard input is another descriptor while this lives.
struct StandardInput {
  int saved = ::dup(0);
  explicit StandardInput(int descriptor) {
    ::dup2(descriptor, 0);
    ::close(descriptor);
  }
  ~StandardInput() {
    ::dup2(saved, 0);
    ::close(saved);
  }
};

}  // namespace

TEST_CASE("SHA-256 agrees with the examples of FIPS 180-4") {
  REQUIRE(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  REQUIRE(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  REQUIRE(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  Sha256 pieces;
  for (int i = 0; i < 1'000'000; i += 1000) pieces.update(std::string(1000, 'a'));
  REQUIRE(pieces.hex() == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a file is read from any place, as often as wanted") {
  const ScratchFolder folder;
  const Input input(folder.write("a", "0123456789"));
  REQUIRE(input.size() == 10);
  char bytes[4] = {};
  REQUIRE(input.read_at(8, bytes, 4) == 2);
  REQUIRE(std::string(bytes, 2) == "89");
  REQUIRE(input.read_at(3, bytes, 4) == 4);
  REQUIRE(std::string(bytes, 4) == "3456");
  REQUIRE(input.read_at(10, bytes, 4) == 0);
}

TEST_CASE("what cannot be opened is status 66 and names the file") {
  const ScratchFolder folder;
  for (const std::string& name : {folder.file("missing"), folder.path.string(), folder.file("a/b"), std::string()}) {
    const Refusal refusal = refusal_of([&] { Input input(name); });
    REQUIRE(refusal.id == "input.cannot_open");
    REQUIRE(refusal.fault == Fault::no_input);
    REQUIRE(refusal.place.file == name);
  }
}

TEST_CASE("a read that fails is status 74") {
  const ScratchFolder folder;
  const std::string name = folder.write("a", "0123456789");
  const Input input(name);
  REQUIRE(::truncate(name.c_str(), 3) == 0);
  char bytes[10];
  const Refusal refusal = refusal_of([&] { (void)input.read_at(0, bytes, 10); });
  REQUIRE(refusal.id == "input.read_failed");
  REQUIRE(refusal.fault == Fault::io);
}

TEST_CASE("a pipe is spooled, small or large, and can be read twice") {
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, Spool::memory_limit, Spool::memory_limit + 1,
                                 3 * Spool::memory_limit + 12345}) {
    const std::string bytes = pattern(size);
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    std::thread writer([&] {
      write_all(ends[1], bytes, "pipe");
      ::close(ends[1]);
    });
    const StandardInput redirected(ends[0]);
    const Input input("-");
    writer.join();
    REQUIRE(input.name() == "<stdin>");
    REQUIRE(input.size() == size);
    REQUIRE(everything(input) == bytes);
    REQUIRE(everything(input) == bytes);
    if (size > Spool::memory_limit) {
      char around[100];  // across the border between file and memory
      REQUIRE(input.read_at(Spool::memory_limit - 50, around, 100) ==
              std::min<std::size_t>(100, size - Spool::memory_limit + 50));
      REQUIRE(std::string(around, 51) == bytes.substr(Spool::memory_limit - 50, 51));
    }
  }
}

TEST_CASE("standard input from a file begins where an earlier reader stopped") {
  const ScratchFolder folder;
  const int file = ::open(folder.write("a", "header\nrest").c_str(), O_RDONLY);
  REQUIRE(::lseek(file, 7, SEEK_SET) == 7);
  const StandardInput redirected(file);
  REQUIRE(everything(Input("-")) == "rest");
}

TEST_CASE("a named pipe is an input like any other") {
  const ScratchFolder folder;
  const std::string name = folder.file("fifo");
  REQUIRE(::mkfifo(name.c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(name) << "through a pipe"; });
  const Input input(name);
  writer.join();
  REQUIRE(everything(input) == "through a pipe");
}

TEST_CASE("files of /proc, which say that they are empty, are read") {
  const Input input("/proc/self/status");
  REQUIRE(input.size() > 0);
}

TEST_CASE("inputs are opened in order, standard input at most once") {
  const ScratchFolder folder;
  const std::vector<Input> inputs = open_inputs({folder.write("a", "ab"), folder.write("b", "c")});
  REQUIRE(inputs.size() == 2);
  REQUIRE(sha256(inputs) == sha256("abc"));
  REQUIRE(refusal_of([] { (void)open_inputs({"-", "-"}); }).id == "input.stdin_twice");
  REQUIRE(refusal_of([] { (void)open_inputs({"-", "-"}); }).fault == Fault::usage);
}

TEST_CASE("a spool that has no room is status 74") {
  const ScratchFolder folder;
  const char* before = std::getenv("TMPDIR");
  const std::string saved = before == nullptr ? "" : before;
  ::setenv("TMPDIR", folder.file("missing").c_str(), 1);
  Spool spool;
  spool.append("small things stay in memory");
  const Refusal refusal = refusal_of([&] { spool.append(pattern(2 * Spool::memory_limit)); });
  saved.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", saved.c_str(), 1);
  REQUIRE(refusal.id == "spool.failed");
  REQUIRE(refusal.fault == Fault::io);
}
