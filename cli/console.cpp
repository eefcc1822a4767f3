// SPDX-License-Identifier: Apache-2.0
// A failed write to standard output is an error, as for any file: a full disk behind a redirection must not end in
// success. Failed writes to standard error are ignored, because there is nowhere to report them.
#include "cli/console.h"

#include <fmt/format.h>
#include <frontmost/base.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

// Work shorter than `patience` shows no progress; a line updated more often than each `interval` only flickers.
constexpr std::chrono::milliseconds patience{500}, interval{50};

}  // namespace

void print(std::string_view text) {
  errno = 0;
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (whole && std::fflush(stdout) == 0) return;
  const int code = errno;  // before strings are made, which may change errno
  throw Error(ErrorCode::file_unwritable, "standard output", "",
              "could not be written: " + std::generic_category().message(code));
}

void complain(std::string_view text) {
  // A single write keeps lines of several processes apart.
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

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, 1, ',');
  return text;
}

std::string printable_name(std::string_view name) { return name.empty() ? "(no name)" : printable_text(name); }

Progress::Progress(bool quiet) : enabled_(!quiet && error_is_terminal()), next_(Clock::now() + patience) {
  watch_.cancelled = [] { return is_interrupted(); };
  if (enabled_) watch_.progress = [this](std::string_view stage, double fraction) { show(stage, fraction); };
}

Progress::~Progress() { clear(); }

void Progress::set_prefix(std::string prefix) {
  const std::lock_guard lock(mutex_);
  prefix_ = std::move(prefix);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void Progress::show(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + interval;
  show_line(fmt::format("{}{} {:3.0f} %", prefix_, stage, 100 * std::clamp(fraction, 0.0, 1.0)));
}

}  // namespace frontmost::cli
