// SPDX-License-Identifier: Apache-2.0
// JSON as text: indented, but a list of numbers stays on one line, so that a matrix is four lines and not sixteen.
#include <frontmost/text.h>

#include <algorithm>

#include "cli/json_numbers.h"

namespace frontmost::cli {
namespace {

/// Texts are the only values that may hold what is no UTF-8, and keys are all this program's own.
std::string scalar(const Json& json) {
  if (json.is_string()) return Json(utf8_text(json.get_ref<const std::string&>())).dump();
  return json.dump();
}

void append(const Json& json, std::size_t indent, std::string& text) {
  const bool flat = std::none_of(json.begin(), json.end(), [](const Json& element) { return element.is_structured(); });
  if (!json.is_structured() || json.empty()) {
    text += scalar(json);
  } else if (json.is_array() && flat) {
    for (std::size_t i = 0; i < json.size(); ++i) text += (i == 0 ? "[" : ", ") + scalar(json[i]);
    text += ']';
  } else {
    char before = json.is_array() ? '[' : '{';
    for (const auto& [key, value] : json.items()) {
      text += before;
      text += '\n' + std::string(indent + 2, ' ');
      if (json.is_object()) text += scalar(key) + ": ";
      append(value, indent + 2, text);
      before = ',';
    }
    text += '\n' + std::string(indent, ' ') + (json.is_array() ? ']' : '}');
  }
}

}  // namespace

std::string dump(const Json& json) {
  std::string text;
  append(json, 0, text);
  return text + '\n';
}

}  // namespace frontmost::cli
