// SPDX-License-Identifier: Apache-2.0
// Answers to questions that OpenGL has no calls for.

#include "calls/answers.h"

#include <cstdio>
#include <cstdlib>
#include <optional>

#include "calls/call.h"
#include "frontmost/gl.h"

namespace frontmost::gl_detail {
namespace {

const char* name_of_function(GLenum func) {
  constexpr const char* kNames[] = {"NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"};
  return kNames[func & 7];
}

/// What became of a fragment.
std::string outcome_of(const FragmentEvent& e) {
  const State& s = e.state->state;
  const auto depth = [](std::uint32_t stored) { return double(stored) / kMostDepth; };
  char text[160];
  switch (e.verdict) {
    case FragmentEvent::Verdict::culled:
      std::snprintf(text, sizeof text, "culled: seen from the %s", e.is_back ? "back" : "front");
      break;
    case FragmentEvent::Verdict::clipped:
      std::snprintf(text, sizeof text, "clipped: behind the %s plane",
                    (e.planes & 1) != 0   ? "near"
                    : (e.planes & 2) != 0 ? "far"
                                          : "user's clip");
      break;
    case FragmentEvent::Verdict::scissored: return "scissored: the pixel is outside of the viewport or the scissor box";
    case FragmentEvent::Verdict::alpha_fails:
      std::snprintf(text, sizeof text, "alpha %s: %.6g %s %.6g fails", name_of_function(s.color.alpha_func),
                    double(e.alpha), name_of_function(s.color.alpha_func), double(s.color.alpha_ref));
      break;
    case FragmentEvent::Verdict::stencil_fails:
      std::snprintf(text, sizeof text, "stencil %s: %u against %u, by mask %u, fails", name_of_function(s.stencil.func),
                    unsigned(s.stencil.ref) & 255, e.kept_stencil, s.stencil.value_mask & 255);
      break;
    case FragmentEvent::Verdict::depth_fails:
      std::snprintf(text, sizeof text, "depth %s: %.7f against %.7f fails", name_of_function(s.depth.func),
                    depth(e.depth), depth(e.kept_depth));
      break;
    case FragmentEvent::Verdict::passes:
      if (e.state->tests_depth)
        std::snprintf(text, sizeof text, "drawn: depth %s: %.7f against %.7f passes", name_of_function(s.depth.func),
                      depth(e.depth), depth(e.kept_depth));
      else
        std::snprintf(text, sizeof text, "drawn: depth %.7f, not tested", depth(e.depth));
      break;
  }
  return text;
}

std::string explanation(Context& c, int x, int y) {
  std::string all;
  for (const FragmentEvent& event : c.stream.explain(c, x, y)) {
    const PrimitiveName name = c.stream.name_of(event.id);
    all += "draw " + std::to_string(name.draw) + ", primitive " + std::to_string(name.primitive) + ": " +
           outcome_of(event) + "\n";
  }
  return all;
}

/// The pixel that FRONTMOST_GL_EXPLAIN names: its column and row, counted from the upper left corner.
std::optional<glm::ivec2> asked_pixel() {
  static const auto pixel = []() -> std::optional<glm::ivec2> {
    const char* const text = std::getenv("FRONTMOST_GL_EXPLAIN");
    glm::ivec2 at(-1);
    int end = 0;
    if (!text) return std::nullopt;
    if (std::sscanf(text, "%d,%d%n", &at.x, &at.y, &end) == 2 && text[end] == 0 && at.x >= 0 && at.y >= 0) return at;
    std::fprintf(stderr, "frontmost-gl: FRONTMOST_GL_EXPLAIN: expected x,y, not '%s'\n", text);
    return std::nullopt;
  }();
  return pixel;
}

}  // namespace

void keep_if_asked(Context& c) {
  if (!asked_pixel()) return;
  [[maybe_unused]] static const int once = std::atexit([] {
    if (thread_context) explain_if_asked(*thread_context);
  });
  c.stream.keep_draws(c, true);
}

void explain_if_asked(Context& c) {
  const std::optional<glm::ivec2> at = asked_pixel();
  if (!at || c.frame.width == 0) return;
  std::string text = "it is outside of the picture, which has " + std::to_string(c.frame.width) + " x " +
                     std::to_string(c.frame.height) + " pixels\n";
  if (at->x < c.frame.width && at->y < c.frame.height) {
    text = explanation(c, at->x, c.frame.height - 1 - at->y);
    if (text.empty()) text = "nothing came to it since the colors were cleared\n";
  }
  std::printf("pixel %d,%d:\n%s", at->x, at->y, text.c_str());
  std::fflush(stdout);
}

FRONTMOST_GL void frontmostKeepDraws(int keep) {
  client_call([=](Context& c) { c.stream.keep_draws(c, keep != 0); });
}

FRONTMOST_GL void frontmostGetVisible(int x, int y, int width, int height, unsigned* draws, unsigned* primitives) {
  client_call([=](Context& c) {
    c.finish();
    for (std::int64_t j = 0; j < height; ++j)
      for (std::int64_t i = 0; i < width; ++i) {
        const std::int64_t px = x + i, py = y + j;
        const bool is_inside = px >= 0 && py >= 0 && px < c.frame.width && py < c.frame.height && !c.frame.ids.empty();
        const std::uint32_t id = is_inside ? c.frame.ids[c.frame.at(int(px), int(py))] : no_primitive;
        const PrimitiveName name =
            id == no_primitive ? PrimitiveName{no_primitive, no_primitive} : c.stream.name_of(id);
        if (draws) draws[j * width + i] = name.draw;
        if (primitives) primitives[j * width + i] = name.primitive;
      }
  });
}

FRONTMOST_GL std::size_t frontmostExplain(int x, int y, char* text, std::size_t size) {
  return client_call([=](Context& c) -> std::size_t {
    const std::string all = explanation(c, x, y);
    if (text && size > 0) text[all.copy(text, size - 1)] = 0;
    return all.size();
  });
}

}  // namespace frontmost::gl_detail
