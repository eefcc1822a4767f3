// SPDX-License-Identifier: Apache-2.0
// The sub-commands, and what help says of them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

struct Command {
  std::string_view name;
  unsigned bit;  ///< the options it takes; 0: none
  std::string_view argument;
  std::string_view summary;
  std::string_view details;
  std::string_view examples;  ///< one a line: command, two blanks or more, what it does
  int (*run)(const Settings&);
};

[[nodiscard]] std::span<const Command> commands();
/// Null where no command has that name.
[[nodiscard]] const Command* find_command(std::string_view name);

int run_render(const Settings& settings);
int run_info(const Settings& settings);
int run_camera(const Settings& settings);
int run_precision(const Settings& settings);
int run_sight(const Settings& settings);
int run_lidar(const Settings& settings);
int run_compare(const Settings& settings);
int run_lines(const Settings& settings);

/// Fills Settings from the words after the command's name.
/// \throws UsageError
[[nodiscard]] Settings parse_command_line(const Command& command, std::span<const char* const> words);

/// Texts made from the tables.
[[nodiscard]] std::string help_overview();
[[nodiscard]] std::string help_for(const Command& command);
[[nodiscard]] std::string man_page();
/// For bash, zsh or fish. \throws UsageError on another.
[[nodiscard]] std::string completion_script(std::string_view shell);

}  // namespace frontmost::cli
