// SPDX-License-Identifier: Apache-2.0
// Help on the terminal, generated from the tables of commands and options.
//
//     -o, --output FILE               The picture: .png, .exr, .pfm or .npy, or its polygons: ...
//         --depth FILE                Distance along the viewing axis, in scene units.
//   ^                                 ^
//   one column for names              one for texts, which are wrapped at blanks
#include <fmt/format.h>

#include "cli/command.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t line_width = 100;
constexpr std::size_t help_column = 36;

/// Wraps text at blanks into lines that start at a column. The first line continues at the caller's position.
std::string wrapped(std::string_view text, std::size_t column) {
  std::string result;
  std::size_t used = column;
  for (const std::string_view word : split(text, ' ')) {
    if (used > column && used + 1 + word.size() > line_width) {
      result += '\n' + std::string(column, ' ');
      used = column;
    }
    if (used > column) result += ' ', ++used;
    result += word;
    used += word.size();
  }
  return result;
}

std::string option_line(const Option& option) {
  std::string left =
      option.letter ? fmt::format("  -{}, --{}", option.letter, option.name) : fmt::format("      --{}", option.name);
  if (!option.is_switch()) left += fmt::format(" {}", option.value);
  // A long list of words gets a line of its own.
  if (left.size() + 2 > help_column) {
    left += '\n' + std::string(help_column, ' ');
  } else {
    left.resize(help_column, ' ');
  }
  return left + wrapped(option.help, help_column) + '\n';
}

}  // namespace

std::string usage_of(const Command& command, std::string_view before, std::string_view after) {
  std::string text;
  if (!command.argument.empty()) text = fmt::format("{}{}{}", before, command.argument, after);
  if (command.bit) text += fmt::format("{}[options]", text.empty() ? "" : " ");
  return text;
}

std::string help_overview() {
  std::string text =
      "Frontmost finds the visible surfaces of 3D models, exactly and on any CPU.\n"
      "\n"
      "usage: frontmost COMMAND [MODEL...] [options]\n"
      "\n"
      "commands:\n";
  for (const Command& command : commands()) text += fmt::format("  {:12}{}\n", command.name, command.summary);
  text +=
      "\n"
      "options:\n"
      "  -h, --help  show this help, or the help of a command\n"
      "  --version   show the version\n"
      "\n"
      "examples:\n";
  for (const Command& command : commands()) {
    const std::string_view first = split(command.examples, '\n').front();
    if (!first.empty()) text += fmt::format("  {}\n", first);
  }
  return text;
}

std::string help_for(const Command& command) {
  const std::string usage = usage_of(command);
  std::string text =
      fmt::format("{}\n\nusage: frontmost {}{}{}\n", command.summary, command.name, usage.empty() ? "" : " ", usage);
  if (!command.details.empty()) text += fmt::format("\n{}\n", wrapped(command.details, 0));
  int last = -1;
  for_each_option([&](const Option& option) {
    if (!(option.commands & command.bit)) return;
    if (int(option.group) != last) text += fmt::format("\n{}:\n", group_titles[int(option.group)]);
    last = int(option.group);
    text += option_line(option);
  });
  text += "\nexamples:\n";
  for (const std::string_view line : split(command.examples, '\n')) text += fmt::format("  {}\n", line);
  return text;
}

}  // namespace frontmost::cli
