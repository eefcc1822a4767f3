// SPDX-License-Identifier: Apache-2.0
// The tables of options. The parser, --help, the manual page, shell completion and batch files all read them.
#pragma once

#include <span>
#include <string_view>

#include "cli/settings.h"
#include "cli/values.h"

namespace frontmost::cli {

enum class Group : std::uint8_t {
  model,
  camera,
  vision,
  grid,
  depth,
  precision,
  sight,
  lidar,
  compare,
  drawing,
  report,
  faces,
  program,
  output,
  look,
  run
};
inline constexpr std::string_view group_titles[] = {"Model",
                                                    "Camera, with the names of f3d",
                                                    "Camera, with the names of computer vision",
                                                    "Pixels and planes",
                                                    "Depth buffer, with the names of OpenGL",
                                                    "Precision",
                                                    "Points",
                                                    "The scanner",
                                                    "Comparison",
                                                    "The drawing",
                                                    "The report",
                                                    "Views",
                                                    "The program",
                                                    "Output files",
                                                    "Look of the picture",
                                                    "Running"};

/// Bits of Option::commands.
enum CommandBit : unsigned {
  for_render = 1,
  for_info = 2,
  for_camera = 4,
  may_repeat = 8,
  for_precision = 16,
  for_sight = 32,
  for_lidar = 64,
  for_compare = 128,
  for_lines = 256,
  for_report = 512,
  for_visible = 1024,
  for_batch_merge = 2048,
  for_explain = 4096,
  for_gl = 8192,
  for_every_model = for_render | for_info | for_camera | for_precision | for_sight | for_lidar | for_compare |
                    for_lines | for_report | for_visible | for_explain
};

/// The text given for an option, and its allowed words.
struct Given {
  std::string_view text, choices;

  [[nodiscard]] double number(const NumberLimits& range = any_number) const { return parse_number(text, range); }
  [[nodiscard]] int integer(const NumberLimits& range) const { return parse_integer(text, range); }
  /// Returns the enumerator of the given word. Precondition: the words in the table are in the order of the
  /// enumerators.
  template <class Enum>
  [[nodiscard]] Enum choice() const {
    return static_cast<Enum>(parse_choice(text, choices));
  }
  [[nodiscard]] std::string string() const { return std::string(text); }
  /// Returns the text as a file name. \throws UsageError if the text is empty.
  [[nodiscard]] std::string file_name() const;
};

struct Option {
  std::string_view name;   ///< without dashes; also the key in a batch file
  char letter;             ///< letter of the short form, as in "-o"; 0: none
  std::string_view value;  ///< the value: "FILE", "X,Y,Z", or "a|b|c" for one of these; empty: a switch
  std::string_view help;
  Group group;
  unsigned commands;
  void (*apply)(Settings&, const Given&);  ///< applies a given value; throws UsageError if it is invalid

  [[nodiscard]] bool is_switch() const { return value.empty(); }
  [[nodiscard]] bool is_file() const { return value.find("FILE") != std::string_view::npos; }
  [[nodiscard]] std::string_view choices() const {
    return value.find('|') != std::string_view::npos ? value : std::string_view();
  }
};

/// The tables in the order of the help. Each table is in the file of its command, or in a file of its own if several
/// commands share it.
[[nodiscard]] std::span<const Option> view_option_table();
[[nodiscard]] std::span<const Option> depth_option_table();
[[nodiscard]] std::span<const Option> precision_option_table();
[[nodiscard]] std::span<const Option> sight_option_table();
[[nodiscard]] std::span<const Option> lidar_option_table();
[[nodiscard]] std::span<const Option> compare_option_table();
[[nodiscard]] std::span<const Option> drawing_option_table();
[[nodiscard]] std::span<const Option> report_option_table();
[[nodiscard]] std::span<const Option> visible_option_table();
[[nodiscard]] std::span<const Option> gl_option_table();
[[nodiscard]] std::span<const Option> output_option_table();
[[nodiscard]] std::span<const Option> batch_merge_option_table();
[[nodiscard]] std::span<const Option> run_option_table();

/// Calls visit(option) for each option, in the order of the help.
template <class Visit>
void for_each_option(const Visit& visit) {
  for (const auto table :
       {view_option_table(), depth_option_table(), precision_option_table(), sight_option_table(), lidar_option_table(),
        compare_option_table(), drawing_option_table(), report_option_table(), visible_option_table(),
        gl_option_table(), output_option_table(), batch_merge_option_table(), run_option_table()}) {
    for (const Option& option : table) visit(option);
  }
}

/// Applies one option and notes in the settings that it was given. \throws UsageError as Option::apply does.
void apply_as_given(const Option& option, std::string_view text, Settings& settings);
/// Applies one option like apply_as_given(). Errors begin with the option's name.
void apply(const Option& option, std::string_view text, Settings& settings);

}  // namespace frontmost::cli
