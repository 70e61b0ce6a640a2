// One command-line program: options into a struct, a body, an exit status.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/error.hpp"

namespace lfd::cli {

/// Bounds of a number, both inclusive unless `open_low`.
template <typename Number>
struct Range {
  Number low;
  Number high;
  bool open_low = false;
};

inline constexpr double infinity = 1e308;
inline constexpr Range<double> positive{0.0, infinity, true};
inline constexpr Range<double> not_negative{0.0, infinity};

/// The declaration of a program. Every option function binds a variable, whose value at that moment is the default
/// shown by --help; each value is checked before any input is read. Values are decimal: `010`, `0x10`, `1e3` are no
/// integers, `nan` and `inf` no numbers.
///
/// Options that change the result are recorded, in the order of their declaration and unless they have their default
/// value, as the canonical `arguments` of the provenance; `path` options and the shared ones are not.
class Program {
 public:
  /// @param name  as installed   @param purpose  one sentence for --help
  Program(std::string name, std::string purpose);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// The program reads files or standard input. @param what  e.g. "demonstrations CSV"
  Program& reads(const std::string& what);
  Program& uses_jobs();
  Program& uses_seed();
  Program& uses_columns();
  /// Declares a gate that `--no-gate NAME` may lift.
  Program& gate(const std::string& name, const std::string& doc);
  /// A list of words and their meanings for --help.
  Program& topic(const std::string& title, const std::vector<std::pair<std::string, std::string>>& lines);
  Program& example(const std::string& command, const std::string& says);

  Program& flag(const std::string& names, bool& value, const std::string& doc);
  Program& integer(const std::string& names, std::int64_t& value, Range<std::int64_t> range, const std::string& doc);
  Program& integer(const std::string& names, std::optional<std::int64_t>& value, Range<std::int64_t> range,
                   const std::string& doc);
  Program& number(const std::string& names, double& value, Range<double> range, const std::string& doc);
  Program& number(const std::string& names, std::optional<double>& value, Range<double> range, const std::string& doc);
  /// A number that may be left out after its option (`--trim` or `--trim=0.1`).
  Program& number_or_default(const std::string& names, std::optional<double>& value, double otherwise,
                             Range<double> range, const std::string& doc);
  /// A word that may be left out after its option (`--sd`, `--sd=latent` or `--sd latent`).
  Program& word_or_default(const std::string& names, std::string& value, const std::string& otherwise,
                           const std::vector<std::string>& words, const std::string& doc);
  /// Comma-separated numbers, as many as one of `arities` says (none: any number of them).
  Program& numbers(const std::string& names, std::optional<std::vector<double>>& value,
                   std::vector<std::size_t> arities, const std::string& doc);
  /// The same, repeatable; `arity` 0: any number of them.
  Program& number_lists(const std::string& names, std::vector<std::vector<double>>& value, std::size_t arity,
                        const std::string& doc);
  /// One integer, or a range `low:high`.
  Program& integer_range(const std::string& names, std::pair<std::int64_t, std::int64_t>& value,
                         Range<std::int64_t> range, const std::string& doc);
  Program& text(const std::string& names, std::string& value, const std::string& doc);
  Program& words(const std::string& names, std::vector<std::string>& value, const std::string& doc);
  /// A file name: not part of the provenance.
  Program& path(const std::string& names, std::string& value, const std::string& doc);
  /// The same of a file that is written.
  Program& written_path(const std::string& names, std::string& value, const std::string& doc);
  /// The same, whose file name may be left out after the option (`--table` or `--table=FILE`): then it is empty.
  Program& optional_written_path(const std::string& names, std::optional<std::string>& value, const std::string& doc);
  /// One of named values.
  template <typename Value>
  Program& choice(const std::string& names, Value& value, const std::vector<std::pair<std::string, Value>>& choices,
                  const std::string& doc) {
    std::vector<std::string> words;
    std::string chosen;
    for (const auto& [word, meaning] : choices) {
      words.push_back(word);
      if (meaning == value) chosen = word;
    }
    return choice_of_words(names, words, chosen, doc, [&value, choices](const std::string& word) {
      for (const auto& [name, meaning] : choices) {
        if (name == word) value = meaning;
      }
    });
  }

  /// Checks that need several options at once; throws UsageError. Runs before any input is opened.
  Program& check(std::function<void()> rule);

  /// True if the user gave the option. @param name  as declared, e.g. "--fit"
  [[nodiscard]] bool given(const std::string& name) const;

  /// Parses, runs the body, reports failures, and gives the exit status.
  int run(int argc, char** argv, const std::function<void(Run&)>& body);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;

  Program& choice_of_words(const std::string& names, const std::vector<std::string>& words, const std::string& chosen,
                           const std::string& doc, std::function<void(const std::string&)> assign);
};

}  // namespace lfd::cli
