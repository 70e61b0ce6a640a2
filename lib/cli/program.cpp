#include "lfdtools/cli/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <new>

#include "lfdtools/cli/values.hpp"
#include "lfdtools/io/number.hpp"
#include "program_implementation.hpp"

namespace lfd::cli {
namespace {

/// `--trim 0.1` as well as `--trim=0.1`: CLI11 would take the number for a file.
std::vector<std::string> arguments_of(int argc, char** argv, const std::vector<std::string>& optional_values,
                                      const std::map<std::string, std::vector<std::string>>& optional_words) {
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    double value = 0;
    if (std::find(optional_values.begin(), optional_values.end(), word) != optional_values.end() && i + 1 < argc &&
        parse_number(argv[i + 1], value) == NumberFault::none) {
      word += std::string("=") + argv[++i];
    }
    const auto known = optional_words.find(word);
    if (known != optional_words.end() && i + 1 < argc &&
        std::find(known->second.begin(), known->second.end(), argv[i + 1]) != known->second.end()) {
      word += std::string("=") + argv[++i];
    }
    words.push_back(word);
  }
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the back
  return words;
}

/// Wanted before the options are parsed, as it says how a usage error looks.
MessageFormat message_format(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--errors=json" || (word == "--errors" && i + 1 < argc && std::string_view(argv[i + 1]) == "json")) {
      return MessageFormat::json;
    }
  }
  return MessageFormat::text;
}

/// CLI11's refusals in our words.
UsageError usage_error(const CLI::ParseError& error) {
  std::string text = error.what();
  if (error.get_name() == "ExtrasError") {
    text = "unknown option or argument: " + text.substr(text.find(':') + 2);
  } else if (error.get_name() == "ArgumentMismatch") {
    text = text.substr(0, text.find(':')) + ": a value is missing, or the option is given more than once";
  } else if (!text.empty()) {
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  }
  return {"usage.option", text};
}

/// Refuses a summary file that cannot be appended to before anything is computed.
void check_summary(const std::string& path) {
  if (path.empty() || access(path.c_str(), W_OK) == 0) return;
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  if (access(path.c_str(), F_OK) == 0 || access(folder.c_str(), W_OK) != 0) {
    throw Error(Fault::cannot_create, "output.cannot_create", "the summary cannot be written", {path, 0, 0, ""});
  }
}

void print(const std::string& text) {
  Output out;
  out.write(text);
  out.finish();
}

}  // namespace

Program::Program(std::string name, std::string purpose) : impl_(std::make_unique<Implementation>(name, purpose)) {
  auto& app = impl_->app;
  auto& common = impl_->common;
  app.set_help_flag();
  app.get_formatter()->column_width(34);
  constexpr auto group = "Every program";
  const auto flag = [&](const std::string& names, bool& value, const std::string& doc) {
    app.add_flag(names, value, doc)
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
        ->disable_flag_override()
        ->group(group);
  };
  impl_
      ->add(
          "-o,--output", "FILE", "", "write to this file, whole or not at all (default: standard output)",
          [&](const std::string& word) { return common.output = word; }, false)
      ->group(group);
  flag("-q,--quiet", common.quiet, "no warnings and notes");
  flag("-v,--verbose", common.verbose, "more notes");
  impl_
      ->add(
          "--errors", "text|json", "text", "form of the messages on standard error",
          [](const std::string& word) {
            if (word != "text" && word != "json") {
              throw UsageError("usage.value", fmt::format("--errors takes text or json, not '{}'", word));
            }
            return word;
          },
          false)
      ->group(group);
  impl_
      ->add(
          "--summary", "FILE", "", "append one CSV row about this run to this file",
          [&](const std::string& word) { return common.summary = word; }, false)
      ->group(group);
  app.add_flag_function(
         "-h,--help", [](std::int64_t) {}, "this page")
      ->group(group);
  app.add_flag_function(
         "-V,--version", [](std::int64_t) {}, "name and version")
      ->group(group);
}

Program::~Program() = default;

Program& Program::reads(const std::string& what) {
  impl_->reads = what;
  impl_->app.add_option("FILE", impl_->common.inputs, what + "; - or none: standard input")->type_name("");
  impl_->app.add_flag("--strict", impl_->common.strict, "refuse unknown JSON keys instead of warning")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
      ->disable_flag_override()
      ->group("Every program");
  return *this;
}

Program& Program::uses_jobs() {
  impl_
      ->add(
          "-j,--jobs", "N", "", "threads (default: one a processor); results do not depend on it",
          [this](const std::string& word) {
            impl_->common.jobs = integer_value("--jobs", word);
            check_range("--jobs", static_cast<double>(impl_->common.jobs), 1, 1024, false);
            return word;
          },
          false)
      ->group("Every program");
  return *this;
}

Program& Program::uses_seed() {
  impl_->uses_seed = true;
  impl_
      ->add(
          "--seed", "N", "1", "seed of the random numbers",
          [this](const std::string& word) {
            impl_->common.seed = integer_value("--seed", word);
            check_range("--seed", static_cast<double>(impl_->common.seed), 0, 9e18, false);
            return word;
          },
          false)
      ->group("Every program");
  return *this;
}

Program& Program::uses_columns() {
  impl_
      ->add("--columns", "NAME,...", "", "signals (default: x,y,z if they are there, else every numeric column)",
            [this](const std::string& word) {
              impl_->common.columns = word_list("--columns", word);
              return word;
            })
      ->group("Every program");
  impl_->app.add_flag("--renumber", impl_->common.renumber, "give the demonstrations of later files new numbers")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
      ->disable_flag_override()
      ->group("Every program");
  return *this;
}

Program& Program::gate(const std::string& name, const std::string& doc) {
  if (impl_->gates.empty()) {
    impl_->app
        .add_option_function<std::vector<std::string>>(
            "--no-gate",
            [this](const std::vector<std::string>& names) {
              for (const auto& word : names) {
                if (std::find(impl_->gates.begin(), impl_->gates.end(), word) == impl_->gates.end()) {
                  throw UsageError("usage.gate", fmt::format("there is no gate '{}' here; gates: {}", word,
                                                             fmt::join(impl_->gates, ", ")));
                }
                impl_->common.lifted.insert(word);
              }
            },
            "lift a gate by name; repeatable")
        ->type_name("NAME")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false)
        ->group("Gates");
    impl_->app.add_flag("--no-gates", impl_->common.all_lifted, "lift every gate: what they would refuse is a warning")
        ->group("Gates");
  }
  impl_->gates.push_back(name);
  impl_->gate_lines += fmt::format("  {:<18} {}\n", name, doc);
  return *this;
}

Program& Program::example(const std::string& command, const std::string& says) {
  auto& text = impl_->examples;
  text += fmt::format("  {}\n      {}\n", command, says);
  return *this;
}

Program& Program::topic(const std::string& title, const std::vector<std::pair<std::string, std::string>>& lines) {
  impl_->topics += fmt::format("\n{}:\n", title);
  for (const auto& [word, meaning] : lines) impl_->topics += fmt::format("  {:<18} {}\n", word, meaning);
  return *this;
}

Program& Program::check(std::function<void()> rule) {
  impl_->checks.push_back(std::move(rule));
  return *this;
}

bool Program::given(const std::string& name) const {
  return impl_->app.count(name) > 0;
}

int Program::run(int argc, char** argv, const std::function<void(Run&)>& body) {
  install_signal_cleanup();
  auto& app = impl_->app;
  auto& common = impl_->common;
  Messages messages(impl_->name, message_format(argc, argv));
  try {
    std::string footer = impl_->topics;
    if (!impl_->gates.empty()) footer += "\nGates (exit 1):\n" + impl_->gate_lines;
    app.footer(footer + "\nExamples:\n" + impl_->examples);
    try {
      app.parse(arguments_of(argc, argv, impl_->optional_values, impl_->optional_words));
    } catch (const CLI::ParseError& error) {
      if (app.count("--help") == 0 && app.count("--version") == 0) {
        throw usage_error(error);
      }
    }
    if (app.count("--help") > 0) {
      print(app.help());
      return 0;
    }
    if (app.count("--version") > 0) {
      print(fmt::format("{} {}\n", impl_->name, LFD_VERSION));
      return 0;
    }
    for (const auto& check : impl_->checks) {
      try {
        check();
      } catch (const DataError& error) {
        throw UsageError(error.id(), error.what());  // an option's value is no data
      }
    }
    if (!impl_->reads.empty() && common.inputs.empty() && isatty(STDIN_FILENO) == 1) {
      throw UsageError("usage.terminal", fmt::format("reads {} from files or standard input, and standard input is a "
                                                     "terminal; {} --help tells more",
                                                     impl_->reads, impl_->name));
    }
    messages = Messages(impl_->name, message_format(argc, argv), common.quiet);
    Provenance entry{impl_->name, LFD_VERSION, {}, {}, {}};
    for (const auto& recorder : impl_->recorders) recorder(entry.arguments);
    if (impl_->uses_seed) entry.seed = static_cast<std::uint64_t>(common.seed);
    check_summary(common.summary);
    for (const auto& name : impl_->written) {
      if (!name().empty()) common.beside.push_back(name());
    }
    Run run(common, messages, std::move(entry));
    body(run);
    run.finish();
    return 0;
  } catch (const Error& error) {
    messages.error(error);
    return static_cast<int>(error.fault());
  } catch (const std::bad_alloc&) {
    messages.error(static_cast<int>(Fault::memory), "memory.exhausted", "not enough memory");
    return static_cast<int>(Fault::memory);
  } catch (const std::exception& error) {
    messages.error(static_cast<int>(Fault::internal), "internal.error", error.what());
    return static_cast<int>(Fault::internal);
  }
}

}  // namespace lfd::cli
