// SPDX-License-Identifier: Apache-2.0
// A text is set letter by letter: strokes are scaled and rotated, and the next letter begins at a fixed distance behind
// them. Letters with marks are composed of a base and a mark, which is higher on tall letters. Characters without a
// letter become missing_glyph(), so that nothing disappears silently.
#include <algorithm>
#include <cmath>

#include "frontmost/sheets.h"
#include "pages/page_text.h"
#include "sheets/lettering/glyphs.h"

namespace frontmost {
namespace {

using detail::Glyph;

constexpr double gap = 3;       // between the middles of strokes: ISO 3098-1 has two pen widths between letters
constexpr double rise = 3;      // of a mark above a tall letter
constexpr double tall = 6.5;    // letters that reach higher are tall
constexpr double edge = 0.5;    // half of the pen width
constexpr double capital = 10;  // height of capitals, from edge to edge
constexpr double eighth = 0.7853981633974483;

/// Visits the points of strokes: visit(point, bulge of the arc that leads to it, whether a stroke begins at it).
template <class Visit>
void for_each_point(const char* strokes, const Visit& visit) {
  bool begins = true;
  for (const char* at = strokes; *at != '\0';) {
    int turns = 0;
    for (; *at == '(' || *at == ')' || *at == ' ' || *at == ';'; ++at) {
      begins |= *at == ';';
      turns += *at == ')' ? 1 : *at == '(' ? -1 : 0;
    }
    const auto number = [&at] {
      const bool is_negative = *at == '-';
      double value = 0, unit = 1;
      for (at += is_negative; *at >= '0' && *at <= '9'; ++at) value = value * 10 + (*at - '0');
      if (*at == '.')
        for (++at; *at >= '0' && *at <= '9'; ++at) value += (*at - '0') * (unit /= 10);
      return is_negative ? -value : value;
    };
    const double x = number();
    ++at;  // the comma
    const double y = number();
    visit(glm::dvec2(x, y), std::tan(turns * eighth / 4), begins);
    begins = false;
  }
}

/// A character to be drawn: a letter, possibly with a mark.
struct Character {
  const Glyph* glyph = nullptr;
  const char* mark = nullptr;
  glm::dvec2 mark_at{0};
  double indent = 0, width = 0;  ///< `indent`: the letter's offset within the common width
};

Character character_of(char32_t code) {
  Character character;
  const detail::Composite composite = detail::find_composite(code);
  character.glyph = detail::find_glyph(composite.mark ? composite.base : code);
  if (!character.glyph) character.glyph = &detail::missing_glyph();
  character.width = character.glyph->width;
  if (!composite.mark) return character;
  character.mark = composite.mark;
  double half = 0, top = composite.base < U'a' ? capital : 0;
  for_each_point(composite.mark, [&](const glm::dvec2& p, double, bool) { half = std::max(half, std::abs(p.x)); });
  for_each_point(character.glyph->strokes, [&](const glm::dvec2& p, double, bool) { top = std::max(top, p.y); });
  character.width = std::max(character.width, 2 * half);
  character.indent = (character.width - character.glyph->width) / 2;
  character.mark_at = {character.width / 2, !composite.is_below && top > tall ? rise : 0};
  return character;
}

/// Calls visit(character, its left) for every character. \returns the end of the last one; negative if there is none.
template <class Visit>
double for_each_character(std::string_view text, const Visit& visit) {
  double left = 0;
  while (!text.empty()) {
    const Character character = character_of(detail::take_character(text));
    visit(character, left);
    left += character.width + gap;
  }
  return left - gap;
}

/// Appends strokes to a group, transformed from tenths of the height to the text's place on the page.
class LetterPen {
 public:
  LetterPen(PageGroup& group, const glm::dvec2& at, const TextStyle& style, const glm::dvec2& shift)
      : group_(group),
        at_(at),
        shift_(shift),
        along_(glm::dvec2(std::cos(style.angle), -std::sin(style.angle)) * (style.height / capital)) {
    group_.bulges.resize(group_.points.size());
  }

  void draw(const char* strokes, const glm::dvec2& place) {
    for_each_point(strokes, [&](const glm::dvec2& p, double bulge, bool begins) {
      if (begins) {
        group_.paths.push_back({std::uint32_t(group_.points.size()), 0, false});
      } else {
        group_.bulges.back() = bulge;
      }
      const glm::dvec2 q = p + place + shift_;
      group_.points.push_back(at_ + along_ * q.x + glm::dvec2(along_.y, -along_.x) * q.y);
      group_.bulges.push_back(0);
      ++group_.paths.back().count;
    });
  }

 private:
  PageGroup& group_;
  const glm::dvec2 at_, shift_, along_;
};

double width_in_tenths(std::string_view text) {
  const double end = for_each_character(text, [](const Character&, double) {});
  return text.empty() ? 0 : end + 2 * edge;
}

}  // namespace

Pen text_pen(double height) { return {height / capital, {}}; }

void add_text(PageGroup& group, std::string_view text, const glm::dvec2& at, const TextStyle& style) {
  if (text.empty()) return;
  const double before = style.align == TextAlign::left ? 0 : style.align == TextAlign::centre ? 0.5 : 1;
  const double below = style.line == TextLine::bottom ? 0 : style.line == TextLine::middle ? 0.5 : 1;
  LetterPen pen(group, at, style, {edge - before * width_in_tenths(text), edge - below * capital});
  for_each_character(text, [&](const Character& character, double left) {
    pen.draw(character.glyph->strokes, {left + character.indent, 0});
    if (character.mark) pen.draw(character.mark, glm::dvec2(left, 0) + character.mark_at);
  });
}

double text_width(std::string_view text, double height) { return width_in_tenths(text) * height / capital; }

}  // namespace frontmost
