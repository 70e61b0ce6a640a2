#include "lfdtools/cli/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <new>

#include "lfdtools/cli/values.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd::cli {

struct Program::Implementation {
  std::string name;
  CLI::App app;
  CommonOptions common;
  std::string reads;
  bool uses_seed = false;
  std::vector<std::string> gates;
  std::string gate_lines;
  std::string topics;
  std::string examples;
  std::vector<std::function<void()>> checks;
  std::vector<std::string> optional_values;                     // options whose value may be left out
  std::vector<std::function<void(std::vector<std::string>&)>> recorders;  // append canonical arguments

  Implementation(const std::string& program, const std::string& purpose) : name(program), app(purpose, program) {}

  /// An option with one value that goes through `assign`. The text that it had is recorded as an argument if it differs
  /// from the default's.
  CLI::Option* add(const std::string& names, const std::string& type, const std::string& standard,
                   const std::string& doc, std::function<std::string(const std::string&)> assign, bool recorded = true) {
    auto value = std::make_shared<std::string>(standard);
    auto* option = app.add_option_function<std::string>(
        names, [value, assign](const std::string& word) { *value = assign(word); }, doc);
    option->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::Throw)->trigger_on_parse(false);
    if (!standard.empty()) option->default_str(standard);
    if (recorded) record(option, value, standard);
    return option;
  }

  void record(CLI::Option* option, std::shared_ptr<std::string> value, const std::string& standard) {
    recorders.push_back([option, value, standard](std::vector<std::string>& arguments) {
      if (option->count() > 0 && *value != standard) {
        arguments.push_back(option->get_name(false, false) + "=" + *value);
      }
    });
  }
};

namespace {

std::string long_name(const std::string& names) {
  const std::size_t dashes = names.rfind("--");
  return dashes == std::string::npos ? names : names.substr(dashes);
}

void check_range(const std::string& names, double value, double low, double high, bool open_low) {
  if (value < low || value > high || (open_low && value == low)) {
    std::string wanted;
    if (high >= infinity) {
      wanted = fmt::format("{} {}", open_low ? "a number over" : "a number of at least", number_text(low));
    } else {
      wanted = fmt::format("a number {} {} to {}", open_low ? "over" : "from", number_text(low), number_text(high));
    }
    throw UsageError("usage.range", fmt::format("{} takes {}, not {}", long_name(names), wanted, number_text(value)));
  }
}

std::string canonical(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + number_text(value);
  return text;
}

/// `--trim 0.1` as well as `--trim=0.1`: CLI11 would take the number for a file.
std::vector<std::string> arguments_of(int argc, char** argv, const std::vector<std::string>& optional_values) {
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    double value = 0;
    if (std::find(optional_values.begin(), optional_values.end(), word) != optional_values.end() && i + 1 < argc &&
        parse_number(argv[i + 1], value) == NumberFault::none) {
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
    app.add_flag(names, value, doc)->multi_option_policy(CLI::MultiOptionPolicy::Throw)->disable_flag_override()->group(group);
  };
  impl_->add("-o,--output", "FILE", "", "write to this file, whole or not at all (default: standard output)",
             [&](const std::string& word) { return common.output = word; }, false)->group(group);
  flag("-q,--quiet", common.quiet, "no warnings and notes");
  flag("-v,--verbose", common.verbose, "more notes");
  impl_->add("--errors", "text|json", "text", "form of the messages on standard error",
             [](const std::string& word) {
               if (word != "text" && word != "json") {
                 throw UsageError("usage.value", fmt::format("--errors takes text or json, not '{}'", word));
               }
               return word;
             }, false)->group(group);
  impl_->add("--summary", "FILE", "", "append one CSV row about this run to this file",
             [&](const std::string& word) { return common.summary = word; }, false)->group(group);
  app.add_flag_function("-h,--help", [](std::int64_t) {}, "this page")->group(group);
  app.add_flag_function("-V,--version", [](std::int64_t) {}, "name and version")->group(group);
}

Program::~Program() = default;

Program& Program::reads(const std::string& what) {
  impl_->reads = what;
  impl_->app.add_option("FILE", impl_->common.inputs, what + "; - or none: standard input")->type_name("");
  impl_->app.add_flag("--strict", impl_->common.strict, "refuse unknown JSON keys instead of warning")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)->disable_flag_override()->group("Every program");
  return *this;
}

Program& Program::uses_jobs() {
  impl_->add("-j,--jobs", "N", "", "threads (default: one a processor); results do not depend on it",
             [this](const std::string& word) {
               impl_->common.jobs = integer_value("--jobs", word);
               check_range("--jobs", static_cast<double>(impl_->common.jobs), 1, 1024, false);
               return word;
             }, false)->group("Every program");
  return *this;
}

Program& Program::uses_seed() {
  impl_->uses_seed = true;
  impl_->add("--seed", "N", "1", "seed of the random numbers", [this](const std::string& word) {
    impl_->common.seed = integer_value("--seed", word);
    check_range("--seed", static_cast<double>(impl_->common.seed), 0, 9e18, false);
    return word;
  }, false)->group("Every program");
  return *this;
}

Program& Program::uses_columns() {
  impl_->add("--columns", "NAME,...", "", "signals (default: x,y,z if they are there, else every numeric column)",
             [this](const std::string& word) {
               impl_->common.columns = word_list("--columns", word);
               return word;
             })->group("Every program");
  impl_->app.add_flag("--renumber", impl_->common.renumber, "give the demonstrations of later files new numbers")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)->disable_flag_override()->group("Every program");
  return *this;
}

Program& Program::gate(const std::string& name, const std::string& doc) {
  if (impl_->gates.empty()) {
    impl_->app.add_option_function<std::vector<std::string>>("--no-gate", [this](const std::vector<std::string>& names) {
      for (const auto& word : names) {
        if (std::find(impl_->gates.begin(), impl_->gates.end(), word) == impl_->gates.end()) {
          throw UsageError("usage.gate", fmt::format("there is no gate '{}' here; gates: {}", word,
                                                     fmt::join(impl_->gates, ", ")));
        }
        impl_->common.lifted.insert(word);
      }
    }, "lift a gate by name; repeatable")->type_name("NAME")->expected(1)->take_all()->allow_extra_args(false)->group("Gates");
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

Program& Program::flag(const std::string& names, bool& value, const std::string& doc) {
  auto* option = impl_->app.add_flag(names, value, doc);
  option->multi_option_policy(CLI::MultiOptionPolicy::Throw)->disable_flag_override();
  impl_->recorders.push_back([option](std::vector<std::string>& arguments) {
    if (option->count() > 0) arguments.push_back(option->get_name(false, false));
  });
  return *this;
}

Program& Program::integer(const std::string& names, std::int64_t& value, Range<std::int64_t> range,
                          const std::string& doc) {
  impl_->add(names, "N", fmt::format("{}", value), doc, [=, &value](const std::string& word) {
    value = integer_value(long_name(names), word);
    check_range(names, static_cast<double>(value), static_cast<double>(range.low), static_cast<double>(range.high), false);
    return word;
  });
  return *this;
}

Program& Program::integer(const std::string& names, std::optional<std::int64_t>& value, Range<std::int64_t> range,
                          const std::string& doc) {
  impl_->add(names, "N", "", doc, [=, &value](const std::string& word) {
    value = integer_value(long_name(names), word);
    check_range(names, static_cast<double>(*value), static_cast<double>(range.low), static_cast<double>(range.high), false);
    return word;
  });
  return *this;
}

Program& Program::number(const std::string& names, double& value, Range<double> range, const std::string& doc) {
  impl_->add(names, "X", number_text(value), doc, [=, &value](const std::string& word) {
    value = number_value(long_name(names), word);
    check_range(names, value, range.low, range.high, range.open_low);
    return number_text(value);
  });
  return *this;
}

Program& Program::number(const std::string& names, std::optional<double>& value, Range<double> range,
                         const std::string& doc) {
  impl_->add(names, "X", "", doc, [=, &value](const std::string& word) {
    value = number_value(long_name(names), word);
    check_range(names, *value, range.low, range.high, range.open_low);
    return number_text(*value);
  });
  return *this;
}

Program& Program::number_or_default(const std::string& names, std::optional<double>& value, double otherwise,
                                    Range<double> range, const std::string& doc) {
  auto text = std::make_shared<std::string>();
  auto* option = impl_->app.add_flag(names, *text, doc);
  option->multi_option_policy(CLI::MultiOptionPolicy::Throw)->type_name("[=X]");
  impl_->optional_values.push_back(long_name(names));
  impl_->checks.push_back([=, &value] {
    if (option->count() == 0) return;
    value = *text == "true" ? otherwise : number_value(long_name(names), *text);
    check_range(names, *value, range.low, range.high, range.open_low);
    *text = number_text(*value);
  });
  impl_->record(option, text, "");
  return *this;
}

Program& Program::numbers(const std::string& names, std::optional<std::vector<double>>& value,
                          std::vector<std::size_t> arities, const std::string& doc) {
  impl_->add(names, "X,...", "", doc, [=, &value](const std::string& word) {
    value = number_list(long_name(names), word);
    if (std::find(arities.begin(), arities.end(), value->size()) == arities.end()) {
      throw UsageError("usage.arity", fmt::format("{} takes {} numbers with commas between, not {}", long_name(names),
                                                  fmt::join(arities, " or "), value->size()));
    }
    return canonical(*value);
  });
  return *this;
}

Program& Program::number_lists(const std::string& names, std::vector<std::vector<double>>& value, std::size_t arity,
                               const std::string& doc) {
  auto* option = impl_->app.add_option_function<std::vector<std::string>>(
      names, [=, &value](const std::vector<std::string>& words) {
        for (const auto& word : words) {
          value.push_back(number_list(long_name(names), word));
          if (arity != 0 && value.back().size() != arity) {
            throw UsageError("usage.arity", fmt::format("{} takes {} numbers with commas between, not {}",
                                                        long_name(names), arity, value.back().size()));
          }
        }
      }, doc);
  option->type_name("X,...")->expected(1)->take_all()->allow_extra_args(false);
  impl_->recorders.push_back([option, &value](std::vector<std::string>& arguments) {
    for (const auto& list : value) arguments.push_back(option->get_name(false, false) + "=" + canonical(list));
  });
  return *this;
}

Program& Program::integer_range(const std::string& names, std::pair<std::int64_t, std::int64_t>& value,
                                Range<std::int64_t> range, const std::string& doc) {
  const auto text = [](const auto& pair) { return fmt::format("{}:{}", pair.first, pair.second); };
  impl_->add(names, "N|LOW:HIGH", text(value), doc, [=, &value](const std::string& word) {
    value = integer_range_value(long_name(names), word);
    for (const std::int64_t end : {value.first, value.second}) {
      check_range(names, static_cast<double>(end), static_cast<double>(range.low), static_cast<double>(range.high), false);
    }
    return text(value);
  });
  return *this;
}

Program& Program::text(const std::string& names, std::string& value, const std::string& doc) {
  impl_->add(names, "TEXT", value, doc, [&value](const std::string& word) { return value = word; });
  return *this;
}

Program& Program::words(const std::string& names, std::vector<std::string>& value, const std::string& doc) {
  impl_->add(names, "NAME,...", fmt::format("{}", fmt::join(value, ",")), doc, [=, &value](const std::string& word) {
    value = word_list(long_name(names), word);
    return word;
  });
  return *this;
}

Program& Program::path(const std::string& names, std::string& value, const std::string& doc) {
  impl_->add(names, "FILE", value, doc, [&value](const std::string& word) { return value = word; }, false);
  return *this;
}

Program& Program::choice_of_words(const std::string& names, const std::vector<std::string>& words,
                                  const std::string& chosen, const std::string& doc,
                                  std::function<void(const std::string&)> assign) {
  const std::string all = fmt::format("{}", fmt::join(words, "|"));
  impl_->add(names, all, chosen, doc, [=](const std::string& word) {
    if (std::find(words.begin(), words.end(), word) == words.end()) {
      throw UsageError("usage.value",
                       fmt::format("{} takes {}, not '{}'", long_name(names), fmt::join(words, ", "), word));
    }
    assign(word);
    return word;
  });
  return *this;
}

Program& Program::check(std::function<void()> rule) {
  impl_->checks.push_back(std::move(rule));
  return *this;
}

bool Program::given(const std::string& name) const { return impl_->app.count(name) > 0; }

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
      app.parse(arguments_of(argc, argv, impl_->optional_values));
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
    for (const auto& check : impl_->checks) check();
    if (!impl_->reads.empty() && common.inputs.empty() && isatty(STDIN_FILENO) == 1) {
      throw UsageError("usage.terminal", fmt::format("reads {} from files or standard input, and standard input is a "
                                                     "terminal; {} --help tells more", impl_->reads, impl_->name));
    }
    messages = Messages(impl_->name, message_format(argc, argv), common.quiet);
    Provenance entry{impl_->name, LFD_VERSION, {}, {}, {}};
    for (const auto& recorder : impl_->recorders) recorder(entry.arguments);
    if (impl_->uses_seed) entry.seed = static_cast<std::uint64_t>(common.seed);
    check_summary(common.summary);
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
