// What the tests of files share: a scratch folder, captured messages, inputs from memory.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/io/input.hpp"
#include "lfdtools/io/message.hpp"
#include "refusal.hpp"

/// A folder of its own, removed at the end.
struct ScratchFolder {
  std::filesystem::path path;

  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lfd-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path = name;
  }
  ~ScratchFolder() { std::filesystem::remove_all(path); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path), {}));
  }
};

inline std::string content(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Messages that go to a file in place of standard error.
struct CapturedMessages {
  ScratchFolder folder;
  std::FILE* sink = std::fopen(folder.file("messages").c_str(), "w");
  lfd::Messages messages;

  explicit CapturedMessages(lfd::MessageFormat format = lfd::MessageFormat::text, bool quiet = false)
      : messages("prog", format, quiet, ::fileno(sink)) {}
  ~CapturedMessages() { std::fclose(sink); }

  [[nodiscard]] std::string text() const { return content(folder.file("messages")); }
};

/// Inputs from memory, named a.csv, b.csv, ...
inline std::vector<lfd::Input> inputs_of(const std::vector<std::string>& texts) {
  std::vector<lfd::Input> inputs;
  for (const std::string& text : texts) {
    inputs.emplace_back(std::string(1, static_cast<char>('a' + inputs.size())) + ".csv", text);
  }
  return inputs;
}
