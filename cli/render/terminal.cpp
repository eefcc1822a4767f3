// SPDX-License-Identifier: Apache-2.0
#include "cli/render/terminal.h"

#include <frontmost/io.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "cli/console.h"

namespace frontmost::cli {
namespace {

// Room below the picture for the prompt that comes next.
constexpr int rows_kept = 2;

glm::ivec2 room(const glm::ivec2& terminal) { return {std::max(terminal.x, 1), std::max(terminal.y - rows_kept, 1)}; }

/// Terminals say so in COLORTERM; the others are given the 256-colour palette, which all know.
bool has_true_color() {
  const char* const value = std::getenv("COLORTERM");
  return value && (std::string_view(value) == "truecolor" || std::string_view(value) == "24bit");
}

}  // namespace

void prepare_for_terminal(Job& job, const glm::ivec2& terminal) {
  // Two pixels a character; the samples do the smoothing.
  if (!job.view.resolution && !job.view.intrinsics) job.view.resolution = room(terminal) * glm::ivec2(1, 2);
  if (!job.output.background_given) job.output.background = std::nullopt;
}

void show_on_terminal(const Image& picture) {
  const glm::ivec2 size = room(output_terminal().value_or(glm::ivec2(80, 24)));
  print(terminal_picture(picture, size.x, size.y, has_true_color()));
}

}  // namespace frontmost::cli
