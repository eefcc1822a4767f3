// SPDX-License-Identifier: Apache-2.0
// A drawing has millions of numbers of a few digits. They are integers here (thousandths of a millimetre), so writing
// them needs no library that rounds, and gives the same bytes everywhere.
#include "pages/formats.h"

#include <algorithm>

#include "frontmost/base.h"

namespace frontmost::detail {

void append_hex(unsigned value, std::string& text, int digits) {
  constexpr char hex[] = "0123456789ABCDEF";
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text += hex[value >> shift & 15];
}

std::optional<Arc> arc_between(const glm::dvec2& from, const glm::dvec2& to, double bulge) {
  constexpr double flat = 1e-4;  // a tenth of the rounding unit of coordinates
  const glm::dvec2 chord = to - from;
  const double length = glm::length(chord);
  if (std::abs(bulge) * length * 0.5 < flat) return std::nullopt;  // the height of the arc over its chord
  // The centre lies on the chord's bisector, and changes sides if the arc is more than a half circle.
  const glm::dvec2 middle = (from + to) * 0.5, across(-chord.y, chord.x);
  Arc arc;
  arc.centre = middle + across * ((1 - bulge * bulge) / (4 * bulge));
  arc.radius = length * (1 + bulge * bulge) / (4 * std::abs(bulge));
  arc.begin = std::atan2(from.y - arc.centre.y, from.x - arc.centre.x);
  arc.turn = 4 * std::atan(bulge);
  return arc;
}

std::optional<Arc> whole_arc(const PageGroup& group, const PagePath& path) {
  constexpr double near = 2e-3;  // millimetres: ends are rounded
  std::optional<Arc> whole;
  for (std::uint32_t i = 0; i < join_count(path); ++i) {
    const Join join = join_of(group, path, i);
    const std::optional<Arc> arc = arc_between(join.from, join.to, join.bulge);
    if (!arc) return std::nullopt;
    if (!whole) {
      whole = arc;
      continue;
    }
    const bool same = glm::distance(arc->centre, whole->centre) < near &&
                      std::abs(arc->radius - whole->radius) < near && (arc->turn > 0) == (whole->turn > 0);
    if (!same) return std::nullopt;
    whole->turn += arc->turn;
  }
  // A path that goes around more than once is no arc.
  if (whole && std::abs(whole->turn) > 6.2832) return std::nullopt;
  return whole;
}

char32_t take_character(std::string_view& text) {
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};  // by length, the least code that needs so many bytes
  const auto byte = [&](std::size_t i) { return char32_t(static_cast<unsigned char>(text[i])); };
  const char32_t lead = byte(0);
  const std::size_t length = lead < 0x80 ? 1 : lead < 0xC2 || lead > 0xF4 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  bool is_whole = length > 0 && length <= text.size();
  char32_t code = length == 1 ? lead : lead & 0x7Fu >> length;
  for (std::size_t i = 1; is_whole && i < length; ++i) {
    is_whole = (byte(i) & 0xC0u) == 0x80u;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  is_whole = is_whole && code >= least[length] && code < 0x110000 && !(code >= 0xD800 && code < 0xE000);
  text.remove_prefix(is_whole ? length : 1);
  return is_whole ? code : U'\uFFFD';
}

PageText& PageText::operator<<(std::string_view text) {
  while (!text.empty()) {
    if (used_ == capacity) pass_on();
    const std::size_t count = std::min(text.size(), capacity - used_);
    std::copy_n(text.data(), count, buffer_.data() + used_);
    used_ += count;
    text.remove_prefix(count);
  }
  return *this;
}

PageText& PageText::fixed(std::int64_t value, int digits) {
  std::uint64_t rest = value < 0 ? 0 - std::uint64_t(value) : std::uint64_t(value);
  while (digits > 0 && rest % 10 == 0) {
    rest /= 10;
    --digits;
  }
  char text[24];
  char* first = std::end(text);
  for (int i = 0; i < digits; ++i, rest /= 10) *--first = char('0' + rest % 10);
  if (digits > 0) *--first = '.';
  if (digits == 0 || rest != 0) do
      *--first = char('0' + rest % 10);
    while (rest /= 10);
  if (value < 0) *--first = '-';
  return *this << std::string_view(first, std::size_t(std::end(text) - first));
}

PageText& PageText::decimal(double value, int digits) {
  std::int64_t unit = 1;
  for (int i = 0; i < digits; ++i) unit *= 10;
  const std::int64_t scaled = std::llround(value * double(unit));
  if (scaled == 0 || std::abs(scaled) >= unit) return fixed(scaled, digits);
  *this << (scaled < 0 ? "-0" : "0");
  return fixed(std::abs(scaled), digits);
}

void PageText::pass_on() {
  sink_(std::string_view(buffer_.data(), used_));
  passed_on_ += used_;
  used_ = 0;
}

std::string xml_text(std::string_view name) {
  std::string text;
  for (const char c : printable_text(name)) {
    switch (c) {
      case '&': text += "&amp;"; break;
      case '<': text += "&lt;"; break;
      case '>': text += "&gt;"; break;
      case '"': text += "&quot;"; break;
      default: text += c;
    }
  }
  return text;
}

std::string json_text(std::string_view name) {
  std::string text = "\"";
  for (const char c : utf8_text(name)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      text += "\\u";
      append_hex(byte, text);
    } else {
      if (c == '"' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text + '"';
}

std::string pdf_text(std::string_view name) {
  const std::string shown = printable_text(name);
  std::string text = "<FEFF";
  for (std::string_view rest = shown; !rest.empty();) {
    const char32_t code = take_character(rest);
    const bool is_pair = code >= 0x10000;  // of surrogates
    if (is_pair) append_hex(0xD800 + unsigned((code - 0x10000) >> 10), text);
    append_hex(is_pair ? 0xDC00 + unsigned((code - 0x10000) & 0x3FF) : unsigned(code), text);
  }
  return text + '>';
}

PathPaint paint_of(const PageGroup& group, std::size_t path) {
  PathPaint paint;
  if (!group.fills.empty() && group.fills[path].opacity > 0) paint.fill = group.fills[path];
  if (group.pen.width > 0 && group.pen.color.opacity > 0) paint.line = group.pen.color;
  return paint;
}

}  // namespace frontmost::detail
