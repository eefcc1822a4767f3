// SPDX-License-Identifier: Apache-2.0
// Splits the command line. Only this file includes CLI11, which takes seconds to compile. The option tables give the
// words their meaning.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <utility>

#include "cli/command.h"
#include "cli/failure.h"
#include "cli/option.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

/// An option of the command, and the texts given for it.
struct GivenOption {
  const Option* option;
  std::vector<std::string> texts;
  bool is_set = false;
};

void declare(CLI::App& app, GivenOption& found) {
  const Option& option = *found.option;
  std::string names = fmt::format("--{}", option.name);
  if (option.letter) names = fmt::format("-{},{}", option.letter, names);
  if (option.is_switch()) {
    app.add_flag(names, found.is_set)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  } else {
    // Each flag has one value, whatever the value looks like: -1,2,3 is a vector, and - is a file.
    app.add_option(names, found.texts)->expected(1)->take_all()->allow_extra_args(false);
  }
}

std::vector<std::string_view> known_flags(const Command& command) {
  std::vector<std::string_view> names = {"help"};
  for_each_option([&](const Option& option) {
    if (option.commands & command.bit) names.push_back(option.name);
  });
  return names;
}

[[noreturn]] void complain_of_unknown(const Command& command, const std::string& word) {
  const std::size_t dashes = std::min(word.find_first_not_of('-'), word.size());
  const std::string_view name = std::string_view(word).substr(dashes, word.find('=', dashes) - dashes);
  bool elsewhere = false;
  for_each_option([&](const Option& option) { elsewhere |= option.name == name && dashes == 2; });
  if (elsewhere) throw UsageError(fmt::format("--{} is not an option of 'frontmost {}'", name, command.name));
  const std::vector<std::string_view> known = known_flags(command);
  const std::string_view nearest = nearest_word(name, known);
  throw UsageError(fmt::format("unknown option {}{}", word.substr(0, word.find('=')),
                               nearest.empty() ? fmt::format("; see frontmost {} --help", command.name)
                                               : fmt::format("; did you mean --{}?", nearest)));
}

/// Takes the words that belong to no option. They are further models, if the command takes several.
void take_leftovers(const Command& command, const std::vector<std::string>& words, Settings& settings) {
  bool options_ended = false;
  for (const std::string& word : words) {
    if (word == "--" && !std::exchange(options_ended, true)) continue;
    if (word.size() > 1 && word[0] == '-' && !options_ended) complain_of_unknown(command, word);
    if (command.argument.empty()) throw UsageError(fmt::format("unexpected argument '{}'", word));
    if (command.takes_object())
      throw UsageError(fmt::format("two objects are given, '{}' and '{}'; this command takes one object at a time",
                                   *settings.report.why, word));
    if (!command.takes_several())
      throw UsageError(fmt::format("two models are given, '{}' and '{}'; this command takes one model at a time",
                                   settings.model, word));
    settings.more_models.push_back(word);
  }
}

/// Returns the message for an option without value, as in "--hidden needs a value: none, dashed or thin".
std::string value_needed(const Option& option) {
  std::vector<std::string_view> words = split(option.choices(), '|');
  if (option.choices().empty()) return fmt::format("--{} needs a value", option.name);
  const std::string_view last = words.back();
  words.pop_back();
  return fmt::format("--{} needs a value: {} or {}", option.name, fmt::join(words, ", "), last);
}

/// Refuses a flag in the place of a value, as in "--output --hash". A file of that name can be written as ./--hash.
void refuse_flag_as_value(const Command& command, const GivenOption& found) {
  for (const std::string& text : found.texts) {
    if (text.substr(0, 2) != "--") continue;
    for (const std::string_view flag : known_flags(command)) {
      if (text.substr(2) == flag) throw UsageError(fmt::format("{}, not {}", value_needed(*found.option), text));
    }
  }
}

void apply_found(const Command& command, const GivenOption& found, Settings& settings) {
  if (found.is_set) apply(*found.option, {}, settings);
  refuse_flag_as_value(command, found);
  if (found.texts.size() > 1 && !(found.option->commands & may_repeat)) {
    throw UsageError(fmt::format("--{} is given {} times", found.option->name, found.texts.size()));
  }
  for (const std::string& text : found.texts) apply(*found.option, text, settings);
}

}  // namespace

Settings parse_command_line(const Command& command, std::span<const char* const> words) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  Settings settings;
  if (!command.argument.empty()) app.add_option("model", settings.model);
  std::string object;
  if (command.takes_object()) app.add_option("object", object);
  std::vector<GivenOption> all;
  for_each_option([&](const Option& option) {
    if (option.commands & command.bit) all.push_back({&option, {}, false});
  });
  for (GivenOption& found : all) declare(app, found);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ArgumentMismatch&) {
    const std::string_view last = words.back();
    for (const GivenOption& found : all)
      if (last == fmt::format("--{}", found.option->name)) throw UsageError(value_needed(*found.option));
    throw UsageError(fmt::format("{} needs a value", last));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  if (command.takes_object()) settings.report.why = object;
  take_leftovers(command, app.remaining(), settings);
  for (const GivenOption& found : all) apply_found(command, found, settings);
  if (settings.model.empty() && command.is_argument_needed()) {
    throw UsageError(fmt::format("no {} given; see frontmost {} --help", command.argument_name(), command.name));
  }
  if (command.takes_object() && object.empty())
    throw UsageError(
        fmt::format("no OBJECT given; give the name or the number of an object, as frontmost report {} lists them",
                    settings.model));
  return settings;
}

}  // namespace frontmost::cli
