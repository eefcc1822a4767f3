// SPDX-License-Identifier: Apache-2.0
#include "cli/json_list.h"

#include <algorithm>
#include <string_view>

#include "cli/console.h"

namespace frontmost::cli {
namespace {

constexpr std::string_view indent = "    ";  // of an element: that of the object and that of the list

/// dump() without the line break at its end.
std::string text_of(const Json& json) {
  std::string text = dump(json);
  text.pop_back();
  return text;
}

}  // namespace

JsonListPrinter::JsonListPrinter(const Json& before, const std::string& list) {
  text_ = text_of(before);
  text_.resize(text_.rfind('\n'));  // the brace that closes it comes at the end
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
  // Line breaks within texts are escaped: those that there are begin lines.
  const std::string text = text_of(element);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    text_ += begin == 0 ? "" : "\n";
    text_ += indent;
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
