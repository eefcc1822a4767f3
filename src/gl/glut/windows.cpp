// SPDX-License-Identifier: Apache-2.0
// Initialisation, windows with their callbacks, menus, and what programs may ask.

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "glut/glut.h"

namespace frontmost::glut {
namespace {

using GlutFunction = void (*)();

/// The size that the user wants for windows, or else the program's.
glm::ivec2 size_for(const glm::ivec2& programs) {
  const std::string text = variable("FRONTMOST_GL_SIZE");
  glm::ivec2 size = programs;
  int end = 0;
  const bool is_size = std::sscanf(text.c_str(), "%5dx%5d%n", &size.x, &size.y, &end) == 2 &&
                       std::size_t(end) == text.size() && size == glm::clamp(size, 1, 16384);
  if (!text.empty() && !is_size)
    fail(2, "FRONTMOST_GL_SIZE: expected a width and a height from 1 to 16384, such as 640x480; not '" + text + "'");
  return glm::clamp(size, 1, 16384);
}

/// Writes the picture of a program that ends before its script does, or without a main loop.
void write_missing_picture() {
  if (shown_window().is_drawn && !state().has_picture && !state().has_failed) write_last_picture();
}

int add_window(const glm::ivec2& size, int parent) {
  GlutState& s = state();
  if (s.windows.empty()) {
    s.script = read_script();
    std::atexit([] {
      state().is_exiting = true;
      write_missing_picture();
    });
  }
  const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_STENCIL_BITS, 8, 0};
  s.windows.push_back(std::make_unique<GlutWindow>());
  GlutWindow& w = *s.windows.back();
  w.context = OSMesaCreateContextAttribs(attributes, nullptr);
  w.wanted = size;
  w.parent = parent;
  make_pixels(w);
  return s.window = int(s.windows.size());
}

/// The object of that number, counted from 1, or an empty one.
template <class T>
T& numbered(const std::vector<std::unique_ptr<T>>& list, int number) {
  static T none;
  none = {};
  return number < 1 || std::size_t(number) > list.size() ? none : *list[std::size_t(number - 1)];
}

/// Replaces entry `item` of the current menu, counted from 1, by these entries.
void replace_entry(int item, const std::vector<GlutMenu::Entry>& by) {
  auto& entries = numbered(state().menus, state().menu).entries;
  if (item < 1 || std::size_t(item) > entries.size() + by.size()) return;
  const auto at = entries.begin() + (item - 1);
  entries.insert(at == entries.end() ? at : entries.erase(at), by.begin(), by.end());
}

void add_entry(const GlutMenu::Entry& entry) { numbered(state().menus, state().menu).entries.push_back(entry); }

}  // namespace

GlutState& state() {
  static auto* const s = new GlutState;
  return *s;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

void fail(int status, const std::string& message) {
  state().has_failed = true;
  std::fprintf(stderr, "frontmost-glut: %s\n", message.c_str());
  if (!state().is_exiting) std::exit(status);
  std::fflush(nullptr);
  std::_Exit(status);
}

GlutWindow& window(int number) { return numbered(state().windows, number); }

FRONTMOST_GLUT void glutSetWindow(int number) {
  GlutWindow& w = window(number);
  if (!w.context) return;
  state().window = number;
  if (OSMesaGetCurrentContext() != w.context)
    OSMesaMakeCurrent(w.context, w.pixels.data(), GL_UNSIGNED_BYTE, w.size.x, w.size.y);
}

GlutWindow& shown_window() {
  int number = 1;
  while (std::size_t(number) < state().windows.size() && !window(number).context) ++number;
  glutSetWindow(number);
  return window(number);
}

void make_pixels(GlutWindow& w) {
  try {
    // OSMesa writes to the old memory once more, so the old memory goes last.
    std::vector<std::uint32_t> pixels(std::size_t(w.wanted.x) * std::size_t(w.wanted.y));
    if (!w.context || !OSMesaMakeCurrent(w.context, pixels.data(), GL_UNSIGNED_BYTE, w.wanted.x, w.wanted.y))
      throw std::bad_alloc();
    w.pixels.swap(pixels);
    w.size = w.wanted;
  } catch (const std::exception&) {
    fail(1, "no memory for a window of " + std::to_string(w.wanted.x) + "x" + std::to_string(w.wanted.y));
  }
}

FRONTMOST_GLUT void glutInitDisplayMode(unsigned mode) { state().init_mode = int(mode); }
FRONTMOST_GLUT void glutInitWindowPosition(int x, int y) { state().init_position = {x, y}; }
FRONTMOST_GLUT void glutInitWindowSize(int width, int height) {
  if (width > 0 && height > 0) state().init_size = {width, height};
}

/// Takes GLUT's own options from the command line.
FRONTMOST_GLUT void glutInit(int* count, char** words) {
  if (!count || !words || *count < 1 || !words[0]) return;
  const std::string path = words[0];
  state().program = path.substr(path.rfind('/') + 1);
  int kept = 1;
  for (int i = 1; i < *count; ++i) {
    const std::string word = words[i];
    int width = 0, height = 0;
    if ((word == "-geometry" || word == "-display") && i + 1 < *count) {
      if (std::sscanf(words[++i], "%5dx%5d", &width, &height) == 2) glutInitWindowSize(width, height);
    } else if (word != "-iconic" && word != "-direct" && word != "-indirect" && word != "-sync" && word != "-gldebug") {
      words[kept++] = words[i];
    }
  }
  words[*count = kept] = nullptr;
}

FRONTMOST_GLUT int glutCreateWindow(const char*) { return add_window(size_for(state().init_size), 0); }
FRONTMOST_GLUT int glutCreateSubWindow(int parent, int, int, int width, int height) {
  return add_window(glm::clamp(glm::ivec2(width, height), 1, 16384), parent);
}
FRONTMOST_GLUT void glutDestroyWindow(int number) {
  if (&shown_window() == &window(number)) write_missing_picture();
  if (window(number).context) OSMesaDestroyContext(std::exchange(window(number).context, nullptr));
  state().window = 0;
}
FRONTMOST_GLUT int glutGetWindow() { return state().window; }
FRONTMOST_GLUT void glutReshapeWindow(int width, int height) { window().wanted = size_for({width, height}); }
FRONTMOST_GLUT void* glutGetWindowData() { return window().data; }
FRONTMOST_GLUT void glutSetWindowData(void* data) { window().data = data; }

#define FRONTMOST_GLUT_SETTER(field, name, parameters) \
  FRONTMOST_GLUT void name(void(*callback) parameters) { window().field = callback; }
FRONTMOST_GLUT_CALLBACKS(FRONTMOST_GLUT_SETTER)

FRONTMOST_GLUT int glutCreateMenu(void (*callback)(int)) {
  state().menus.push_back(std::make_unique<GlutMenu>(GlutMenu{callback, {}}));
  return state().menu = int(state().menus.size());
}
FRONTMOST_GLUT void glutDestroyMenu(int number) { numbered(state().menus, number) = {}; }
FRONTMOST_GLUT int glutGetMenu() { return state().menu; }
FRONTMOST_GLUT void glutSetMenu(int number) { state().menu = number; }
FRONTMOST_GLUT void glutAddMenuEntry(const char* label, int value) { add_entry({label, value, false}); }
FRONTMOST_GLUT void glutAddSubMenu(const char* label, int number) { add_entry({label, number, true}); }
FRONTMOST_GLUT void glutChangeToMenuEntry(int i, const char* label, int v) { replace_entry(i, {{label, v, false}}); }
FRONTMOST_GLUT void glutChangeToSubMenu(int i, const char* label, int v) { replace_entry(i, {{label, v, true}}); }
FRONTMOST_GLUT void glutRemoveMenuItem(int item) { replace_entry(item, {}); }

/// Answers by the number of the name, see freeglut's headers; each list begins at a number.
FRONTMOST_GLUT int glutGet(GLenum name) {
  GlutState& s = state();
  const GlutWindow& w = window();
  if (name == 0x2BC) return s.clock += ++s.clock_queries > 10'000;  // GLUT_ELAPSED_TIME; programs may wait for it
  const int is_double = s.init_mode >> 1 & 1, items = int(numbered(s.menus, s.menu).entries.size());
  const std::pair<GLenum, std::vector<int>> answers[] = {
      {0x64,
       {0, 0, w.size.x, w.size.y, 32, 8, 24, 8, 8, 8, 8, 0, 0, 0, 0, is_double, 1, w.parent}},  // GLUT_WINDOW_X...
      {0x7C, {1}},                                                                              // GLUT_INIT_STATE
      {0xC8, {1920, 1080, 508, 286}},                                                           // GLUT_SCREEN_WIDTH...
      {0x12C, {items}},                                                                         // GLUT_MENU_NUM_ITEMS
      {0x190, {1}},  // GLUT_DISPLAY_MODE_POSSIBLE
      {0x1F4,
       {s.init_position.x, s.init_position.y, s.init_size.x, s.init_size.y, s.init_mode}},  // GLUT_INIT_WINDOW_X...
      {0x1FC, {30000}},                                                                     // GLUT_VERSION
      {0x258, {1, 1, 0, 0, 0, 3}},                                                          // GLUT_HAS_KEYBOARD...
      {0x323, {-1}},                                                                        // GLUT_TRANSPARENT_INDEX
  };
  for (const auto& [first, values] : answers)
    if (name >= first && name - first < values.size()) return values[name - first];
  return 0;
}
FRONTMOST_GLUT int glutDeviceGet(GLenum name) { return glutGet(name); }
FRONTMOST_GLUT int glutLayerGet(GLenum name) { return glutGet(name); }
FRONTMOST_GLUT int glutGetModifiers() { return state().modifiers; }
FRONTMOST_GLUT void glutSetOption(GLenum name, int value) {
  if (name == 0x1F9) state().returns = value != 0;  // GLUT_ACTION_ON_WINDOW_CLOSE
}
FRONTMOST_GLUT int glutExtensionSupported(const char* extension) {
  const auto* const all = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  if (!all || !extension) return 0;
  const std::string name = extension, names = " " + std::string(all) + " ";
  return !name.empty() && name.find(' ') == std::string::npos && names.find(" " + name + " ") != std::string::npos;
}
FRONTMOST_GLUT GlutFunction glutGetProcAddress(const char* name) {
  if (!name || std::string(name).rfind("glut", 0) != 0) return OSMesaGetProcAddress(name);
  return reinterpret_cast<GlutFunction>(dlsym(RTLD_DEFAULT, name));
}
FRONTMOST_GLUT void glutReportErrors() {
  for (GLenum error; (error = glGetError()) != GL_NO_ERROR;)
    std::fprintf(stderr, "frontmost-glut: OpenGL error 0x%04X\n", error);
}

// What has no effect here: titles, cursors, overlays, other devices, and the state of windows on a screen.
#define NOTHING(name, ...) \
  FRONTMOST_GLUT void name(__VA_ARGS__) {}
#define NO_CALLBACK(name, ...) \
  FRONTMOST_GLUT void name(void (*)(__VA_ARGS__)) {}
#define ZERO(name, ...) \
  FRONTMOST_GLUT int name(__VA_ARGS__) { return 0; }
// clang-format off
NOTHING(glutInitDisplayString, const char*) NOTHING(glutInitContextVersion, int, int) NOTHING(glutInitContextFlags, int)
NOTHING(glutInitContextProfile, int) NOTHING(glutSetWindowTitle, const char*) NOTHING(glutSetIconTitle, const char*)
NOTHING(glutPositionWindow, int, int) NOTHING(glutShowWindow) NOTHING(glutHideWindow) NOTHING(glutIconifyWindow)
NOTHING(glutPushWindow) NOTHING(glutPopWindow) NOTHING(glutFullScreen) NOTHING(glutFullScreenToggle)
NOTHING(glutLeaveFullScreen) NOTHING(glutWarpPointer, int, int) NOTHING(glutSetCursor, int) NOTHING(glutEstablishOverlay)
NOTHING(glutRemoveOverlay) NOTHING(glutUseLayer, GLenum) NOTHING(glutPostOverlayRedisplay) NOTHING(glutShowOverlay)
NOTHING(glutPostWindowOverlayRedisplay, int) NOTHING(glutHideOverlay) NOTHING(glutAttachMenu, int)
NOTHING(glutDetachMenu, int) NOTHING(glutSetMenuFont, int, void*) NOTHING(glutGameModeString, const char*)
NOTHING(glutLeaveGameMode) NOTHING(glutSetupVideoResizing) NOTHING(glutStopVideoResizing)
NOTHING(glutVideoResize, int, int, int, int) NOTHING(glutVideoPan, int, int, int, int) NOTHING(glutCopyColormap, int)
NOTHING(glutSetColor, int, float, float, float) NOTHING(glutIgnoreKeyRepeat, int) NOTHING(glutSetKeyRepeat, int)
NOTHING(glutForceJoystickFunc) NOTHING(glutExit) NOTHING(glutJoystickFunc, void (*)(unsigned, int, int, int), int)
NO_CALLBACK(glutWindowStatusFunc, int) NO_CALLBACK(glutMenuStatusFunc, int, int, int) NO_CALLBACK(glutMenuStateFunc, int)
NO_CALLBACK(glutOverlayDisplayFunc) NO_CALLBACK(glutSpaceballMotionFunc, int, int, int) NO_CALLBACK(glutDialsFunc, int, int)
NO_CALLBACK(glutSpaceballRotateFunc, int, int, int) NO_CALLBACK(glutSpaceballButtonFunc, int, int)
NO_CALLBACK(glutButtonBoxFunc, int, int) NO_CALLBACK(glutTabletMotionFunc, int, int) NO_CALLBACK(glutCloseFunc)
NO_CALLBACK(glutTabletButtonFunc, int, int, int, int) NO_CALLBACK(glutMouseWheelFunc, int, int, int, int)
NO_CALLBACK(glutPositionFunc, int, int) NO_CALLBACK(glutWMCloseFunc) NO_CALLBACK(glutMenuDestroyFunc)
ZERO(glutEnterGameMode) ZERO(glutGameModeGet, GLenum) ZERO(glutVideoResizeGet, GLenum)
FRONTMOST_GLUT float glutGetColor(int, int) { return 0; }
// clang-format on

}  // namespace frontmost::glut
