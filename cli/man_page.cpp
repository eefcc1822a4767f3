// SPDX-License-Identifier: Apache-2.0
// The manual page frontmost(1) in man's macros, generated from the tables.
#include <fmt/format.h>
#include <frontmost/version.h>

#include "cli/command.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

/// Escapes plain text: backslashes, hyphens and leading dots have a meaning for man.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (result.empty() && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

std::string option_entry(const Option& option) {
  std::string head = ".TP\n";
  if (option.letter) head += fmt::format("\\fB\\-{}\\fR, ", option.letter);
  head += fmt::format("\\fB\\-\\-{}\\fR", plain(option.name));
  if (!option.is_switch()) head += fmt::format(" \\fI{}\\fR", plain(option.value));
  std::string commands_named;
  for (const Command& command : commands()) {
    if (option.commands & command.bit)
      commands_named += fmt::format("{}{}", commands_named.empty() ? "" : ", ", command.name);
  }
  return fmt::format("{}\n{}\n({})\n", head, plain(option.help), commands_named);
}

constexpr std::string_view batch_section = R"(.SH BATCH FILES
A batch file is a JSON object with a list \fIviews\fR and an optional object \fIoutputs\fR, which holds for every view.
Keys are the names of options without dashes: in a view the options of the camera, of pixels and of planes, in outputs
those of output files and of the look of the picture. A view may have a \fIname\fR, which replaces {view} in file names,
and \fIoutputs\fR of its own.
Values are strings, numbers, true, or lists if an option takes several numbers; \fIids\fR is an object.
The command line gives all options that the batch file does not give.
.PP
.nf
{
  "views": [
    {"name": "front", "view": "front"},
    {"name": "eye", "camera\-position": [3, 2, 1], "resolution": [640, 480]}
  ],
  "outputs": {
    "output": "{model}_{view}.png",
    "depth": "{model}_{view}.exr",
    "ids": {"object": "{model}_{view}_objects.png"}
  }
}
.fi
)";

constexpr std::string_view status_section = R"(.SH EXIT STATUS
.TP
0
Success, even if nothing is seen in the picture; standard error then says why.
.TP
1
Failure: a file could not be read or written, a limit was exceeded, or time ran out.
.TP
2
Wrong use of the command line.
.TP
3
The picture differs from the reference.
.TP
130
Interrupted. No half\-written file is left.
)";

}  // namespace

std::string man_page() {
  std::string page = fmt::format(
      ".TH FRONTMOST 1 \"\" \"frontmost {}\" \"User Commands\"\n"
      ".SH NAME\nfrontmost \\- visible surfaces of 3D models\n.SH SYNOPSIS\n",
      FRONTMOST_VERSION);
  for (const Command& command : commands()) {
    const std::string usage = usage_of(command, "\\fI", "\\fR");
    page += fmt::format(".B frontmost {}\n{}{}.br\n", command.name, usage, usage.empty() ? "" : "\n");
  }
  page +=
      ".SH DESCRIPTION\nFrontmost finds what is visible in 3D models, exactly and with the same bytes on every "
      "machine, on any CPU, and writes pictures, depth, ids and normals.\n";
  for (const Command& command : commands()) {
    page += fmt::format(".TP\n.B {}\n{}\n{}\n", command.name, plain(command.summary), plain(command.details));
  }
  int last = -1;
  page += ".SH OPTIONS\n";
  for_each_option([&](const Option& option) {
    if (int(option.group) != last) page += fmt::format(".SS {}\n", plain(group_titles[int(option.group)]));
    last = int(option.group);
    page += option_entry(option);
  });
  page += batch_section;
  page += status_section;
  page += ".SH EXAMPLES\n.nf\n";
  for (const Command& command : commands()) page += plain(command.examples) + '\n';
  return page + ".fi\n";
}

}  // namespace frontmost::cli
