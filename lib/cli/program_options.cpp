#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/cli/values.hpp"
#include "lfdtools/io/number.hpp"
#include "program_implementation.hpp"

namespace lfd::cli {

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

namespace {

std::string canonical(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + number_text(value);
  return text;
}

}  // namespace

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
    check_range(names, static_cast<double>(value), static_cast<double>(range.low), static_cast<double>(range.high),
                false);
    return word;
  });
  return *this;
}

Program& Program::integer(const std::string& names, std::optional<std::int64_t>& value, Range<std::int64_t> range,
                          const std::string& doc) {
  impl_->add(names, "N", "", doc, [=, &value](const std::string& word) {
    value = integer_value(long_name(names), word);
    check_range(names, static_cast<double>(*value), static_cast<double>(range.low), static_cast<double>(range.high),
                false);
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

Program& Program::word_or_default(const std::string& names, std::string& value, const std::string& otherwise,
                                  const std::vector<std::string>& words, const std::string& doc) {
  auto text = std::make_shared<std::string>();
  auto* option = impl_->app.add_flag(names, *text, doc);
  const std::string all = fmt::format("{}", fmt::join(words, "|"));
  option->multi_option_policy(CLI::MultiOptionPolicy::Throw)->type_name("[=" + all + "]");
  impl_->optional_words[long_name(names)] = words;
  impl_->checks.push_back([=, &value] {
    if (option->count() == 0) return;
    if (*text == "true") *text = otherwise;
    if (std::find(words.begin(), words.end(), *text) == words.end()) {
      throw UsageError("usage.value",
                       fmt::format("{} takes {}, not '{}'", long_name(names), fmt::join(words, ", "), *text));
    }
    value = *text;
  });
  impl_->record(option, text, "");
  return *this;
}

Program& Program::numbers(const std::string& names, std::optional<std::vector<double>>& value,
                          std::vector<std::size_t> arities, const std::string& doc) {
  impl_->add(names, "X,...", "", doc, [=, &value](const std::string& word) {
    value = number_list(long_name(names), word);
    if (!arities.empty() && std::find(arities.begin(), arities.end(), value->size()) == arities.end()) {
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
      names,
      [=, &value](const std::vector<std::string>& words) {
        for (const auto& word : words) {
          value.push_back(number_list(long_name(names), word));
          if (arity != 0 && value.back().size() != arity) {
            throw UsageError("usage.arity", fmt::format("{} takes {} numbers with commas between, not {}",
                                                        long_name(names), arity, value.back().size()));
          }
        }
      },
      doc);
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
      check_range(names, static_cast<double>(end), static_cast<double>(range.low), static_cast<double>(range.high),
                  false);
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
  impl_->add(
      names, "FILE", value, doc, [&value](const std::string& word) { return value = word; }, false);
  return *this;
}

Program& Program::written_path(const std::string& names, std::string& value, const std::string& doc) {
  impl_->written.push_back([&value] { return value; });
  return path(names, value, doc);
}

Program& Program::optional_written_path(const std::string& names, std::optional<std::string>& value,
                                        const std::string& doc) {
  auto text = std::make_shared<std::string>();
  auto* option = impl_->app.add_flag(names, *text, doc);
  impl_->written.push_back([&value] { return value.value_or(""); });
  option->multi_option_policy(CLI::MultiOptionPolicy::Throw)->type_name("[=FILE]");
  impl_->checks.push_back([text, option, &value] {
    if (option->count() > 0) value = *text == "true" ? "" : *text;  // what CLI11 calls a flag without a value
  });
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

}  // namespace lfd::cli
