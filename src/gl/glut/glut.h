// SPDX-License-Identifier: Apache-2.0
// A GLUT without windows: programs run unchanged, and a script in place of a user drives them.
//
//   glutMainLoop --for each step of the script--> a frame, an event, or a picture in a file --> exit(0)
//
// Each window is an off-screen context with memory of its own, so that calls for a second window do not disturb the
// first. Only the first window that the program has not destroyed is drawn and gets events. The clock is simulated:
// frame n is drawn at n / 60 s, however long the machine takes.
#pragma once

#include <GL/osmesa.h>

#include <algorithm>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#define FRONTMOST_GLUT extern "C" __attribute__((visibility("default")))

/// Callbacks of a window: its field, the function that sets it, and its parameters.
#define FRONTMOST_GLUT_CALLBACKS(X)                             \
  X(display, glutDisplayFunc, ())                               \
  X(reshape, glutReshapeFunc, (int, int))                       \
  X(keyboard, glutKeyboardFunc, (unsigned char, int, int))      \
  X(keyboard_up, glutKeyboardUpFunc, (unsigned char, int, int)) \
  X(special, glutSpecialFunc, (int, int, int))                  \
  X(special_up, glutSpecialUpFunc, (int, int, int))             \
  X(mouse, glutMouseFunc, (int, int, int, int))                 \
  X(motion, glutMotionFunc, (int, int))                         \
  X(passive_motion, glutPassiveMotionFunc, (int, int))          \
  X(entry, glutEntryFunc, (int))                                \
  X(visibility, glutVisibilityFunc, (int))

namespace frontmost::glut {

struct GlutWindow {
  OSMesaContext context = nullptr;  ///< null once the window is destroyed
  std::vector<std::uint32_t> pixels;
  glm::ivec2 size{0}, wanted{0};  ///< `wanted` becomes the size before the next frame
  int parent = 0;                 ///< number of the window that this one is part of; 0: none
  bool is_shown = false, needs_display = true, is_drawn = false;
  void* data = nullptr;
#define FRONTMOST_GLUT_FIELD(field, name, parameters) void(*field) parameters = nullptr;
  FRONTMOST_GLUT_CALLBACKS(FRONTMOST_GLUT_FIELD)
};

struct GlutMenu {
  struct Entry {
    std::string label;
    int value;
    bool is_menu;  ///< whether it opens the menu of the number `value`
  };
  void (*call)(int) = nullptr;
  std::vector<Entry> entries;
};

struct GlutTimer {
  int due;  ///< ms
  void (*call)(int);
  int value;
};

struct ScriptStep {
  std::function<void()> run;
  int times = 1;
};

struct GlutState {
  std::string program = "program";
  glm::ivec2 init_position{0}, init_size{300};
  int init_mode = 0;
  std::vector<std::unique_ptr<GlutWindow>> windows;  ///< window n is windows[n - 1]
  std::vector<std::unique_ptr<GlutMenu>> menus;
  int window = 0, menu = 0;  ///< numbers of the current ones; 0: none
  std::vector<GlutTimer> timers;
  void (*idle)() = nullptr;
  int frame = 0, clock = 0, clock_queries = 0;  ///< clock: ms; queries in this frame
  glm::ivec2 pointer{0};
  int buttons = 0, modifiers = 0;  ///< bits of those that are down
  std::vector<ScriptStep> script;
  std::size_t step = 0;
  bool script_writes = false, has_events = false;  ///< events since the last frame
  bool is_left = false, returns = false;  ///< glutLeaveMainLoop was called; glutMainLoop returns at the script's end
  bool has_picture = false, has_failed = false, is_exiting = false;
};

/// The state of the process. It is never destroyed, because programs call GLUT from their exit handlers, too.
[[nodiscard]] GlutState& state();
/// The window of that number, by default the current one. If there is none, a window without context.
[[nodiscard]] GlutWindow& window(int number = state().window);
/// The first window that is not destroyed, as window() returns it. It becomes the current window.
GlutWindow& shown_window();
/// Gives the window memory of its wanted size, and makes its context current.
void make_pixels(GlutWindow& w);

/// The value of an environment variable; empty if it is not set.
[[nodiscard]] std::string variable(const char* name);
/// Ends the program with a message.
[[noreturn]] void fail(int status, const std::string& message);

/// Calls the shown window's reshape callback if its size is new, and its display callback if something asked for it.
void draw_shown_window();
/// Draws a window that is new, or had events since its last frame: a frame more would animate the program.
void draw_events();
/// Draws the next frame: time passes, timers and the idle callback run before it. The first frame has time 0.
void draw_frame();
/// Writes the shown window's picture in the format that the suffix names.
void write_picture(const std::string& path);
/// Writes the picture of a program that ends to $FRONTMOST_GL_OUTPUT. If that is not set, to PROGRAM.png, unless the
/// script writes files.
void write_last_picture();

/// The steps of $FRONTMOST_GL_SCRIPT, see script.cpp. Ends the program with status 2 if a line is wrong.
[[nodiscard]] std::vector<ScriptStep> read_script();

template <class... Parameters, class... Arguments>
void call(void (*callback)(Parameters...), Arguments... arguments) {
  if (callback) callback(arguments...);
}

}  // namespace frontmost::glut
