// SPDX-License-Identifier: Apache-2.0
// Lettering: text as strokes of one pen, the same in every format and on every machine.
//
// Formats of pages have fonts of their own, which look otherwise in every viewer, and plotters have none. So a text
// becomes paths of lines and arcs, and is placed by one of nine points of the box around its capitals:
//
//   left         centre         right
//    x-------------x-------------x     top: the upper edge of capitals
//    |  A  4      1 2 . 5    m m  |     middle
//    x-------------x-------------x     bottom: the line on which letters stand
#pragma once

#include <string_view>

#include "frontmost/page.h"

namespace frontmost {

/// Which part of a text lies at its place: its beginning, its middle or its end.
enum class TextAlign : std::uint8_t { left, centre, right };
/// Likewise of its height: the lower edge of capitals, their middle or their upper edge.
enum class TextLine : std::uint8_t { bottom, middle, top };

struct TextStyle {
  double height = 3.5;  ///< millimetres, of capitals and figures with their pen: 1.8, 2.5, 3.5, 5, 7, 10, 14 or 20
  double angle = 0;     ///< radians that the text is turned about its place, counter-clockwise for who reads the page
  TextAlign align = TextAlign::left;
  TextLine line = TextLine::bottom;
};

/// What ISO 3098 type B letters are drawn with: a tenth of their height.
[[nodiscard]] Pen text_pen(double height);

/// Appends `text`, in UTF-8, as paths of lines and arcs: upright letters after ISO 3098-1 type B, small ones 7/10 as
/// high as capitals, descending 3/10 below. `group` should have text_pen() of the same height. There are ASCII, Latin-1
/// with its signs of diameter, degree, plus-minus and times, the letters of Central and Northern Europe, quotes, dashes
/// and a few signs of drawings; all else, bytes that are not UTF-8 and control characters too, is a box as high as a
/// capital. Blanks have no path. O(text).
void add_text(PageGroup& group, std::string_view text, const glm::dvec2& at, const TextStyle& style = {});

/// Millimetres from the left edge of the first character to the right edge of the last, with their pen; 0 without any.
[[nodiscard]] double text_width(std::string_view text, double height = 3.5);

}  // namespace frontmost
