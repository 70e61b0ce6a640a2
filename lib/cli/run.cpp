#include "lfdtools/cli/run.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "lfdtools/io/number.hpp"

namespace lfd::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const auto& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

/// The same for all names of one file, whether it exists or not; empty for a device, which may be written twice.
std::string identity(const std::string& name) {
  namespace fs = std::filesystem;
  const bool standard = name.empty() || name == "-";
  struct stat status {};
  if ((standard ? ::fstat(STDOUT_FILENO, &status) : ::stat(name.c_str(), &status)) == 0) {
    return S_ISCHR(status.st_mode) ? "" : fmt::format("{}:{}", status.st_dev, status.st_ino);
  }
  if (standard) return {};
  std::error_code ignored;
  fs::path path = name;
  for (int links = 0; links < 40 && fs::is_symlink(path, ignored); ++links) {
    path = path.parent_path() / fs::read_symlink(path, ignored);
  }
  return (fs::weakly_canonical(fs::absolute(path, ignored).parent_path(), ignored) / path.filename()).string();
}

void check_written(const CommonOptions& options) {
  std::vector<std::string> names = options.beside;
  if (!options.summary.empty()) names.push_back(options.summary);
  std::vector<std::string> taken = {identity(options.output)};
  for (const auto& name : names) {
    const std::string same = identity(name);
    if (!same.empty() && std::find(taken.begin(), taken.end(), same) != taken.end()) {
      throw UsageError("usage.same_file", fmt::format("{} is to be written twice", name));
    }
    taken.push_back(same);
  }
}

}  // namespace

Run::Run(CommonOptions options, Messages& messages, Provenance provenance)
    : options_(std::move(options)), messages_(messages), provenance_(std::move(provenance)) {
  check_written(options_);
}

JsonOptions Run::json_options() const {
  JsonOptions json;
  json.strict = options_.strict;
  return json;
}

Output& Run::output() {
  if (!output_) output_ = std::make_unique<Output>(options_.output);
  return *output_;
}

Output& Run::beside(const std::string& path) {
  beside_.push_back(std::make_unique<Output>(path));
  return *beside_.back();
}

Provenance Run::provenance(std::string input_sha256) const {
  Provenance entry = provenance_;
  entry.input_sha256 = std::move(input_sha256);
  return entry;
}

void Run::refuse(std::string_view gate, const std::string& text, const Place& place) {
  const std::string id = fmt::format("gate.{}", gate);
  if (!options_.all_lifted && !options_.lifted.contains(std::string(gate))) {
    throw Error(Fault::gate, id, fmt::format("{}; --no-gate {} lets it pass", text, gate), place);
  }
  messages_.warning(id, fmt::format("{} (gate lifted)", text), place);
}

void Run::detail(std::string_view id, const std::string& text) {
  if (options_.verbose) messages_.note(id, text);
}

void Run::figure(const std::string& name, double value) {
  for (auto& [known, largest] : figures_) {
    if (known == name) {
      largest = std::max(largest, value);
      return;
    }
  }
  figures_.emplace_back(name, value);
}

void Run::finish() {
  std::string header = "program,version,inputs,arguments,seed";
  std::string row =
      fmt::format("{},{},{},{},{}", provenance_.program, provenance_.version, quoted(joined(options_.inputs)),
                  quoted(joined(provenance_.arguments)), provenance_.seed ? fmt::format("{}", *provenance_.seed) : "");
  for (const auto& [name, value] : figures_) {
    header += "," + name;
    row += "," + number_text(value);
  }
  if (!options_.summary.empty()) {
    std::string first;
    std::ifstream existing(options_.summary);
    if (std::getline(existing, first) && first != header) {
      throw Error(Fault::cannot_create, "summary.header_differs",
                  "the summary has other columns, of another program: give each program a file of its own",
                  {options_.summary, 1, 0, ""});
    }
  }
  for (const auto& output : beside_) output->finish();
  if (output_) output_->finish();
  if (!options_.summary.empty()) append_record(options_.summary, header + "\n", row + "\n");
}

}  // namespace lfd::cli
