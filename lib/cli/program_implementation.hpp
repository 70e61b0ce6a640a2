// Inside of Program, shared by the files that implement it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lfdtools/cli/program.hpp"

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
  std::vector<std::function<std::string()>> written;                      // files beside the output, empty: none
  std::vector<std::string> optional_values;                               // options whose number may be left out
  std::map<std::string, std::vector<std::string>> optional_words;         // the same, and the words they take
  std::vector<std::function<void(std::vector<std::string>&)>> recorders;  // append canonical arguments

  Implementation(const std::string& program, const std::string& purpose) : name(program), app(purpose, program) {}

  /// An option with one value that goes through `assign`. The text that it had is recorded as an argument if it differs
  /// from the default's.
  CLI::Option* add(const std::string& names, const std::string& type, const std::string& standard,
                   const std::string& doc, std::function<std::string(const std::string&)> assign,
                   bool recorded = true) {
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

/// The last name of an option: `--basis` of "-n,--basis".
std::string long_name(const std::string& names);

/// @throws UsageError [usage.range]
void check_range(const std::string& names, double value, double low, double high, bool open_low);

}  // namespace lfd::cli
