// SPDX-License-Identifier: Apache-2.0
// Errors, and names in texts. Names come from files and may be any bytes. Programs that show them expect UTF-8, and
// some obey control characters.
#include "frontmost/base.h"

#include <utility>

namespace frontmost {
namespace {

/// Joins the texts that are not empty with ": ".
std::string joined(std::initializer_list<std::string_view> texts) {
  std::string all;
  for (const std::string_view text : texts) {
    if (!all.empty() && !text.empty()) all += ": ";
    all += text;
  }
  return all;
}

}  // namespace

Error::Error(ErrorCode code, std::string reason) : Error(code, "", "", std::move(reason)) {}

Error::Error(ErrorCode code, std::string place, std::string reason)
    : Error(code, "", std::move(place), std::move(reason)) {}

Error::Error(ErrorCode code, std::string file, std::string place, std::string reason)
    : std::runtime_error(joined({file, place, reason})),
      code_(code),
      parts_(std::make_shared<Parts>(Parts{std::move(file), std::move(place), std::move(reason)})) {}

Error Error::within(const std::string& file, const std::string& place) const {
  return {code_, file, joined({place, parts_->file, parts_->place}), parts_->reason};
}

namespace {

/// Number of bytes of the character at the beginning of `text`; 0 if there is no valid character.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // The encoding is longer than needed, half of a surrogate pair, or beyond the last character.
  const bool is_none = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xED && byte(1) >= 0xA0) ||
                       (byte(0) == 0xF0 && byte(1) < 0x90) || (byte(0) == 0xF4 && byte(1) >= 0x90);
  return is_none ? 0 : length;
}

/// Whether a character is a control character: U+0000 to U+001F, U+007F to U+009F, or U+FFFE and U+FFFF, which are no
/// characters and which XML does not allow.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") return true;
  return first < 0x20 || first == 0x7F || (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

void append_escaped(std::string_view bytes, std::string& text) {
  constexpr char digits[] = "0123456789ABCDEF";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
  }
}

std::string written(std::string_view text, bool shows_controls) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length == 0 || (shows_controls && is_control(character)))
      append_escaped(character, result);
    else
      result += character;
    text.remove_prefix(character.size());
  }
  return result;
}

}  // namespace

std::string utf8_text(std::string_view text) { return written(text, false); }

std::string printable_text(std::string_view text) { return written(text, true); }

}  // namespace frontmost
