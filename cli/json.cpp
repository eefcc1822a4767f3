// SPDX-License-Identifier: Apache-2.0
// JSON as indented text. A list of numbers stays on one line, so that a matrix takes four lines and not sixteen.
#include "cli/json.h"

#include <frontmost/base.h>

#include <algorithm>
#include <string_view>

#include "cli/console.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

/// Returns the text of a value without elements. Only string values may hold invalid UTF-8; keys are this program's
/// own.
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

constexpr std::string_view list_indent = "    ";  // indentation of an element: one level for the object, and one for
                                                  // the list

/// Returns the text of dump() without the line break at its end.
std::string text_of(const Json& json) {
  std::string text = dump(json);
  text.pop_back();
  return text;
}

}  // namespace

Json times_json(const std::vector<double>& times) {
  const auto [low, high] = std::minmax_element(times.begin(), times.end());
  return {{"min", *low}, {"median", median(times)}, {"max", *high}};
}

std::string dump(const Json& json) {
  std::string text;
  append(json, 0, text);
  return text + '\n';
}

JsonListPrinter::JsonListPrinter(const Json& before, const std::string& list) {
  text_ = text_of(before);
  text_.resize(text_.rfind('\n'));  // the closing brace follows at the end
  text_ += ",\n  " + text_of(list) + ": [";
}

void JsonListPrinter::add(const Json& element) {
  constexpr std::size_t enough = 1 << 16;
  text_ += is_empty_ ? "\n" : ",\n";
  is_empty_ = false;
  append(element);
  if (text_.size() < enough) return;
  print(text_);
  text_.clear();
}

void JsonListPrinter::append(const Json& element) {
  // Line breaks within strings are escaped, so each line break in the text starts a line.
  const std::string text = text_of(element);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    text_ += begin == 0 ? "" : "\n";
    text_ += list_indent;
    text_.append(text, begin, end - begin);
    begin = end + 1;
  }
}

void JsonListPrinter::finish(const Json& after) {
  if (!is_empty_) text_ += "\n  ";
  text_ += "]," + dump(after).substr(1);
  print(text_);
}

}  // namespace frontmost::cli
