// SPDX-License-Identifier: Apache-2.0
#include "cli/console.h"

#include <frontmost/base.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace frontmost::cli {

void print(std::string_view text) {
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!whole || std::fflush(stdout) != 0) {
    throw Error(ErrorCode::file_unwritable, "standard output: could not be written");
  }
}

void complain(std::string_view text) {
  // One write, so that lines of several processes do not mix.
  const std::string line = "frontmost: " + std::string(text) + "\n";
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

std::optional<glm::ivec2> output_terminal() {
  if (!isatty(STDOUT_FILENO)) return std::nullopt;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return glm::ivec2(80, 24);
  return glm::ivec2(size.ws_col, size.ws_row);
}

bool error_is_terminal() { return isatty(STDERR_FILENO) != 0; }

std::string printable_name(std::string name) {
  if (name.empty()) return "(no name)";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return (c >= 0 && c < 0x20) || c == 0x7F; }, '?');
  return name;
}

}  // namespace frontmost::cli
