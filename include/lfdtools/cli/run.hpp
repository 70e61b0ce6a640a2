// What the body of a program sees: the shared options, messages, output, gates.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lfdtools/io/input.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/io/message.hpp"
#include "lfdtools/io/output.hpp"
#include "lfdtools/io/provenance.hpp"

namespace lfd::cli {

/// Options of every program that they apply to.
struct CommonOptions {
  std::vector<std::string> inputs;  ///< empty: standard input
  std::string output;               ///< empty: standard output
  bool quiet = false;
  bool verbose = false;
  bool strict = false;    ///< unknown JSON keys are refused
  bool renumber = false;  ///< later files get new demo numbers
  std::int64_t jobs = 0;  ///< 0: one a processor
  std::int64_t seed = 1;
  std::vector<std::string> columns;  ///< signals; empty: by rule
  std::string summary;               ///< file that gets one row about this run
  std::vector<std::string> beside;   ///< further files that options name for output
  std::set<std::string> lifted;      ///< gates
  bool all_lifted = false;
};

/// One run of a program, from parsed options to the finished output.
class Run {
 public:
  /// @throws UsageError [usage.same_file] if two of output, summary and the files beside are one
  Run(CommonOptions options, Messages& messages, Provenance provenance);

  [[nodiscard]] const CommonOptions& options() const { return options_; }
  [[nodiscard]] Messages& messages() { return messages_; }
  [[nodiscard]] unsigned jobs() const { return static_cast<unsigned>(options_.jobs); }
  [[nodiscard]] std::uint64_t seed() const { return static_cast<std::uint64_t>(options_.seed); }
  [[nodiscard]] JsonOptions json_options() const;

  /// Opens the inputs of the command line.
  [[nodiscard]] std::vector<Input> open() const { return open_inputs(options_.inputs); }
  /// The output of the command line, opened at the first call; handed over when the body has returned.
  Output& output();
  /// One more output, a file that an option names; handed over together with the other.
  Output& beside(const std::string& path);

  /// This program's entry for the files it writes.
  [[nodiscard]] Provenance provenance(std::string input_sha256) const;

  /// Refuses by a gate: throws Error(Fault::gate) [gate.NAME], or warns if the user has lifted the gate.
  void refuse(std::string_view gate, const std::string& text, const Place& place = {});
  /// A note that --verbose asks for.
  void detail(std::string_view id, const std::string& text);
  /// A figure of this run for --summary: the largest value given under the name.
  void figure(const std::string& name, double value);

  /// Hands the output over and appends the row of --summary.
  void finish();

 private:
  CommonOptions options_;
  Messages& messages_;
  Provenance provenance_;
  std::unique_ptr<Output> output_;
  std::vector<std::unique_ptr<Output>> beside_;
  std::vector<std::pair<std::string, double>> figures_;
};

}  // namespace lfd::cli
