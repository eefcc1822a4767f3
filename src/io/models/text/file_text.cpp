// SPDX-License-Identifier: Apache-2.0
#include "io/models/text/file_text.h"

#include "frontmost/text.h"

namespace frontmost {
namespace {

/// The start of `text`, of at most `longest` bytes and without a part of a character at its end.
std::string_view start_of(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  const auto continues = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  std::size_t end = longest;
  while (end > longest - 3 && continues(end)) --end;
  return text.substr(0, end);
}

}  // namespace

std::string name_of(std::string_view text) { return std::string(start_of(text, longest_name)); }

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 160;
  const std::string out = printable_text(start_of(text, longest));
  return text.size() > longest ? out + "..." : out;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  return '"' + printable(word.substr(0, longest)) + (word.size() > longest ? "...\"" : "\"");
}

}  // namespace frontmost
