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
A batch file is JSON: an object with \fIviews\fR, a list, and perhaps \fIoutputs\fR, which every view makes.
Keys are the names of options without dashes, in a view those of cameras, pixels and planes, in outputs those of what to
write and how the picture looks. A view may have \fIname\fR, for {view} in file names, and \fIoutputs\fR of its own.
Values are strings, numbers, true, or lists where an option takes several numbers; \fIids\fR is an object.
What the batch file does not say is taken from the command line.
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
Done. A picture in which nothing is seen is done too; standard error says why.
.TP
1
Could not: a file could not be read or written, or time ran out.
.TP
2
Bad usage.
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
      ".SH NAME\nfrontmost \\- what can be seen from here\n.SH SYNOPSIS\n",
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
