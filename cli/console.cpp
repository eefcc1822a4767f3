// SPDX-License-Identifier: Apache-2.0
#include "cli/console.h"

#include <frontmost/base.h>
#include <frontmost/text.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace frontmost::cli {

void print(std::string_view text) {
  errno = 0;
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (whole && std::fflush(stdout) == 0) return;
  const int code = errno;  // before strings are made: that may change it
  throw Error(ErrorCode::file_unwritable,
              "standard output: could not be written: " + std::generic_category().message(code));
}

void complain(std::string_view text) {
  // One write, so that lines of several processes do not mix.
  const std::string line = "frontmost: " + printable_text(text) + "\n";
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

std::optional<glm::ivec2> output_terminal() {
  if (!isatty(STDOUT_FILENO)) return std::nullopt;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return glm::ivec2(80, 24);
  return glm::ivec2(size.ws_col, size.ws_row);
}

bool error_is_terminal() { return isatty(STDERR_FILENO) != 0; }

std::string printable_name(std::string_view name) { return name.empty() ? "(no name)" : printable_text(name); }

}  // namespace frontmost::cli
