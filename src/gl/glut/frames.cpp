// SPDX-License-Identifier: Apache-2.0
// The main loop: time, frames and pictures.

#include <frontmost/files.h>
#include <frontmost/image.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <utility>

#include "glut/glut.h"

namespace frontmost::glut {
namespace {

/// Time passes up to the next frame. A timer runs at its own time, so one that sets itself again may run several times.
void pass_time() {
  GlutState& s = state();
  const int end = int(++s.frame * 1000LL / 60);
  s.clock_queries = 0;
  while (!s.timers.empty()) {
    const auto next = std::min_element(s.timers.begin(), s.timers.end(),
                                       [](const GlutTimer& a, const GlutTimer& b) { return a.due < b.due; });
    if (next->due > end || !shown_window().context) break;
    const GlutTimer timer = *next;
    s.timers.erase(next);
    s.clock = std::max(s.clock, timer.due);
    call(timer.call, timer.value);
  }
  s.clock = std::max(s.clock, end);
  if (shown_window().context) call(s.idle);
}

/// Runs the next step of the script. \returns false at its end, after the last picture is written.
bool run_step() {
  GlutState& s = state();
  while (s.step < s.script.size() && s.script[s.step].times == 0) ++s.step;
  if (shown_window().context && s.step < s.script.size() && !s.is_left) {
    --s.script[s.step].times;
    s.script[s.step].run();
    return true;
  }
  draw_events();
  if (shown_window().context) write_last_picture();
  return false;
}

}  // namespace

void draw_shown_window() {
  GlutWindow& w = shown_window();
  if (!w.context) return;
  const bool has_new_size = w.wanted != w.size;
  if (has_new_size) make_pixels(w);
  if (has_new_size || !w.is_shown) {
    w.needs_display = true;
    if (!w.reshape) glViewport(0, 0, w.size.x, w.size.y);
    call(w.reshape, w.size.x, w.size.y);
  }
  if (!std::exchange(w.is_shown, true)) call(w.visibility, 1);
  if (&shown_window() != &w || !w.needs_display) return;  // a callback may have destroyed the window
  if (!w.display) fail(1, "the window has no display callback; call glutDisplayFunc before glutMainLoop");
  w.needs_display = state().has_events = false;
  w.is_drawn = true;
  w.display();
}

void draw_events() {
  if (!shown_window().is_shown || state().has_events) draw_shown_window();
}

void draw_frame() {
  if (shown_window().is_shown) pass_time();
  draw_shown_window();
}

void write_picture(const std::string& path) {
  const GlutWindow& w = shown_window();
  if (!w.context) return;
  glFinish();
  try {
    const std::size_t width = std::size_t(w.size.x), height = std::size_t(w.size.y);
    Bitmap picture{w.size.x, w.size.y, Buffer<std::uint8_t>(4 * width * height)};
    for (std::size_t y = 0; y < height; ++y)
      std::memcpy(picture.rgba.data() + 4 * width * y, w.pixels.data() + width * (height - 1 - y), 4 * width);
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;  // windows are opaque
    save(picture, path);
  } catch (const std::exception& error) {
    fail(1, error.what());
  }
}

void write_last_picture() {
  GlutState& s = state();
  const std::string given = variable("FRONTMOST_GL_OUTPUT");
  s.has_picture = true;
  if (!given.empty() || !s.script_writes) write_picture(given.empty() ? s.program + ".png" : given);
}

FRONTMOST_GLUT void glutMainLoop() {
  if (!shown_window().context) fail(1, "glutMainLoop is called without a window; call glutCreateWindow before");
  while (run_step()) {
  }
  if (!std::exchange(state().is_left, false) && !state().returns) std::exit(0);
}

/// Runs one step of the script. At its end the program ends, because the program's own loop may have no end.
FRONTMOST_GLUT void glutMainLoopEvent() {
  if (!run_step()) std::exit(0);
}

FRONTMOST_GLUT void glutLeaveMainLoop() { state().is_left = true; }
FRONTMOST_GLUT void glutIdleFunc(void (*callback)()) { state().idle = callback; }
FRONTMOST_GLUT void glutTimerFunc(unsigned time, void (*callback)(int), int value) {
  constexpr unsigned kMostWait = 1 << 30;  // ms
  state().timers.push_back({state().clock + int(std::clamp(time, 1u, kMostWait)), callback, value});
}
FRONTMOST_GLUT void glutPostRedisplay() { window().needs_display = true; }
FRONTMOST_GLUT void glutPostWindowRedisplay(int number) { window(number).needs_display = true; }
FRONTMOST_GLUT void glutSwapBuffers() { window().is_drawn = true; }

}  // namespace frontmost::glut
