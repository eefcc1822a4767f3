// SPDX-License-Identifier: Apache-2.0
// The sub-commands, and their texts for help.
//
//   words --parse_command_line()--> Settings --run_...()--> exit status
//              |                                                 |
//              options' tables                                   the library, and files
//
// The parser, --help, the manual page, completion and batch files all read the table of commands and the tables of
// options, so they cannot contradict each other.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

struct Command {
  std::string_view name;
  unsigned bit;               ///< bit in Option::commands; 0: no options
  std::string_view argument;  ///< as usage lines show it; with "..." at its end, several may be given; in [ ], it may
                              ///< be left out; a second argument behind a blank is an object of the model
  std::string_view summary;
  std::string_view details;
  std::string_view examples;  ///< one per line: the command, two or more blanks, and its effect
  int (*run)(const Settings&);

  /// Returns the argument's name, up to "..." or to a second argument.
  [[nodiscard]] std::string_view argument_name() const { return argument.substr(0, argument.find_first_of(". ")); }
  [[nodiscard]] bool is_argument_needed() const { return !argument.empty() && argument.front() != '['; }
  [[nodiscard]] bool takes_several() const { return argument.ends_with("..."); }
  [[nodiscard]] bool takes_object() const { return argument.ends_with(" OBJECT"); }
};

[[nodiscard]] std::span<const Command> commands();
/// Returns the command of that name, or null if there is none.
[[nodiscard]] const Command* find_command(std::string_view name);

int run_render(const Settings& settings);
int run_info(const Settings& settings);
int run_camera(const Settings& settings);
int run_precision(const Settings& settings);
int run_sight(const Settings& settings);
int run_lidar(const Settings& settings);
int run_compare(const Settings& settings);
int run_lines(const Settings& settings);
int run_report(const Settings& settings);
int run_visible(const Settings& settings);
int run_batch_merge(const Settings& settings);
int run_gl(const Settings& settings);

/// Fills Settings from the words after the command's name.
/// \throws UsageError
[[nodiscard]] Settings parse_command_line(const Command& command, std::span<const char* const> words);

/// Returns the rest of a usage line, behind the command's name, as in "MODEL... [options]". The argument is put between
/// `before` and `after`.
[[nodiscard]] std::string usage_of(const Command& command, std::string_view before = "", std::string_view after = "");

/// Return texts that are generated from the tables.
[[nodiscard]] std::string help_overview();
[[nodiscard]] std::string help_for(const Command& command);
[[nodiscard]] std::string man_page();
/// Returns a script for bash, zsh or fish. \throws UsageError for other shells.
[[nodiscard]] std::string completion_script(std::string_view shell);

}  // namespace frontmost::cli
