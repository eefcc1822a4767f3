// SPDX-License-Identifier: Apache-2.0
// The script that drives a program, $FRONTMOST_GL_SCRIPT: the name of a file with a step a line, or ":" and steps that
// are separated by ";". Lines that begin with # are comments. Without a script, one frame is drawn.
//
//   frames 30                timers and the idle callback run before each frame but the first of the run
//   key ctrl+a               modifiers shift+, ctrl+ and alt+ may stand before any key or button
//   mouse left down 100 50   x and y are counted from the upper left; `motion` then drags
//   menu Wire frame          chooses the first entry of a menu with that label
//   write gears.png          draws what the program asked for, and writes the picture
//
// The first event draws a frame before, because users react to what they see. What an event changes is drawn by the
// next `frames` or `write`.

#include <frontmost/files.h>

#include <charconv>
#include <exception>
#include <iterator>
#include <optional>
#include <sstream>

#include "glut/glut.h"

namespace frontmost::glut {
namespace {

struct ScriptLine {
  std::string place, text;  ///< the text goes on behind the first word
  std::vector<int> values;  ///< one for each word of the form
  int modifiers = 0;
};

void press_key(const ScriptLine& line, GlutState& s, GlutWindow& w) {
  const bool is_control = (line.modifiers & 2) && line.values[1] >= '@' && line.values[1] < 127;
  const auto code = static_cast<unsigned char>(is_control ? line.values[1] & 31 : line.values[1]);
  call(w.keyboard, code, s.pointer.x, s.pointer.y);
  call(w.keyboard_up, code, s.pointer.x, s.pointer.y);
}

void press_special_key(const ScriptLine& line, GlutState& s, GlutWindow& w) {
  const int code = line.values[1] < 12 ? 1 + line.values[1] : 100 + line.values[1] - 12;
  call(w.special, code, s.pointer.x, s.pointer.y);
  call(w.special_up, code, s.pointer.x, s.pointer.y);
}

void use_button(const ScriptLine& line, GlutState& s, GlutWindow& w) {
  const int button = line.values[1], is_up = line.values[2];
  s.pointer = {line.values[3], line.values[4]};
  s.buttons = (s.buttons & ~(1 << button)) | (1 - is_up) << button;
  call(w.mouse, button, is_up, s.pointer.x, s.pointer.y);
}

void move_pointer(const ScriptLine& line, GlutState& s, GlutWindow& w) {
  s.pointer = {line.values[1], line.values[2]};
  call(s.buttons ? w.motion : w.passive_motion, s.pointer.x, s.pointer.y);
}

void choose_entry(const ScriptLine& line, GlutState& s, GlutWindow&) {
  for (const auto& menu : s.menus)
    for (const GlutMenu::Entry& entry : menu->entries)
      if (!entry.is_menu && entry.label == line.text) return call(menu->call, entry.value);
  fail(2, line.place + ": the program has no menu entry '" + line.text + "'");
}

void write_file(const ScriptLine& line, GlutState&, GlutWindow&) {
  draw_events();
  write_picture(line.text);
}

/// A form of lines. Words in capitals stand for numbers and texts, others for themselves; a|b|c is one of these words.
struct LineForm {
  const char* text;
  void (*act)(const ScriptLine&, GlutState&, GlutWindow&);
};
constexpr LineForm kForms[] = {
    {"frames N", [](const ScriptLine&, GlutState&, GlutWindow&) { draw_frame(); }},
    {"key CHARACTER|space|tab|enter|escape|backspace|delete|semicolon", press_key},
    {"special F1|F2|F3|F4|F5|F6|F7|F8|F9|F10|F11|F12|left|up|right|down|page-up|page-down|home|end|insert",
     press_special_key},
    {"mouse left|middle|right|wheel-up|wheel-down down|up X Y", use_button},
    {"motion X Y", move_pointer},
    {"pointer leaves|enters", [](const ScriptLine& l, GlutState&, GlutWindow& w) { call(w.entry, l.values[1]); }},
    {"menu LABEL", choose_entry},
    {"reshape WIDTH HEIGHT",
     [](const ScriptLine& l, GlutState&, GlutWindow& w) {
       w.wanted = {l.values[1], l.values[2]};
     }},
    {"write FILE", write_file},
};

/// The value of a word by its form; nothing if the word does not fit.
std::optional<int> value_of(const std::string& word, const std::string& form) {
  constexpr int kCodes[] = {0, ' ', '\t', '\r', 27, '\b', 127, ';'};
  const bool is_point = form == "X" || form == "Y";
  if (is_point || form == "N" || form == "WIDTH" || form == "HEIGHT") {
    int value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const int least = is_point ? -32768 : 1, most = is_point ? 32767 : form == "N" ? 1'000'000 : 16384;
    const bool fits = error == std::errc() && stop == word.data() + word.size() && value >= least && value <= most;
    return fits ? std::optional(value) : std::nullopt;
  }
  const bool is_key = form.starts_with("CHARACTER");
  if (is_key && word.size() == 1) return static_cast<unsigned char>(word[0]);
  std::istringstream names(form);
  int index = 0;
  for (std::string name; std::getline(names, name, '|'); ++index)
    if (name == word || name == "LABEL" || name == "FILE") return is_key ? kCodes[index] : index;
  return {};
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

/// Removes the names of modifiers before a key or button. \returns their bits.
int take_modifiers(std::string& word) {
  for (const auto& [name, bit] : {std::pair("shift+", 1), {"ctrl+", 2}, {"alt+", 4}})
    if (word.starts_with(name)) return bit | take_modifiers(word.erase(0, word.find('+') + 1));
  return 0;
}

/// Whether the line has this form. If so, fills in its values.
bool has_form(ScriptLine& line, const LineForm& form) {
  const std::vector<std::string> forms = words_of(form.text);
  std::vector<std::string> words = words_of(line.text);
  const bool has_text = forms.back() == "LABEL" || forms.back() == "FILE";
  if (words.size() < forms.size() || (words.size() > forms.size() && !has_text)) return false;
  if (has_text) line.text.erase(0, line.text.find(words[1], words[0].size()));
  if (!has_text) line.modifiers = take_modifiers(words[1]);
  for (std::size_t i = 0; i < forms.size(); ++i)
    if (const auto value = value_of(words[i], forms[i])) line.values.push_back(*value);
  return line.values.size() == forms.size();
}

ScriptStep step_of(ScriptLine line) {
  const std::string text = line.text, name = words_of(text)[0];
  std::string expected;
  for (const LineForm& form : kForms) {
    const std::string of_form = words_of(form.text)[0];
    expected += (expected.empty() ? "" : ", ") + of_form;
    if (of_form != name) continue;
    if (!has_form(line, form)) fail(2, line.place + ": expected '" + form.text + "', not '" + text + "'");
    const bool is_frame = name == "frames", is_event = !is_frame && name != "write";
    state().script_writes |= name == "write";
    const auto run = [line, is_event, act = form.act] {
      if (is_event && !shown_window().is_shown) draw_shown_window();
      state().has_events |= is_event;
      state().modifiers = line.modifiers;
      if (shown_window().context) act(line, state(), shown_window());
      state().modifiers = 0;
    };
    return {run, is_frame ? line.values[1] : 1};
  }
  fail(2, line.place + ": expected " + expected + "; not '" + name + "'");
}

}  // namespace

std::vector<ScriptStep> read_script() {
  std::string given = variable("FRONTMOST_GL_SCRIPT");
  if (given.empty()) given = ":frames 1";
  std::string text = given.substr(1), place = "FRONTMOST_GL_SCRIPT";
  std::replace(text.begin(), text.end(), ';', '\n');
  if (given[0] != ':') {
    try {
      text = load_text(place = given, 1 << 20);
    } catch (const std::exception& error) {
      fail(2, error.what());
    }
  }
  std::vector<ScriptStep> steps;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.erase(line.find_last_not_of(" \t\r") + 1).erase(0, line.find_first_not_of(" \t"));
    if (!line.empty() && line[0] != '#') steps.push_back(step_of({place + ":" + std::to_string(number), line, {}}));
  }
  return steps;
}

}  // namespace frontmost::glut
