// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/console.h"
#include "cli/interruption.h"

namespace frontmost::cli {
namespace {

// Work that ends sooner than this needs no announcement; a line more often than this only flickers.
constexpr std::chrono::milliseconds patience{500}, interval{50};
constexpr std::string_view clear_line = "\r\033[K";

}  // namespace

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
  if (shown_) (void)std::fwrite(clear_line.data(), 1, clear_line.size(), stderr);
  shown_ = false;
  clear_line_when_interrupted(false);
}

void Progress::show(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + interval;
  shown_ = true;
  clear_line_when_interrupted(true);
  const std::string line =
      fmt::format("{}{}{} {:3.0f} %", clear_line, prefix_, stage, 100 * std::clamp(fraction, 0.0, 1.0));
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace frontmost::cli
