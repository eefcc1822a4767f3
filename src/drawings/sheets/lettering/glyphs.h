// SPDX-License-Identifier: Apache-2.0
// The shapes of letters, as text that can be read and edited beside a letter on squared paper.
//
//     9 |      /.        capitals     "A" is  0,0 3,9 6,0;1,3 5,3  : up and down again, and the bar
//     6 |     /  .       small
//     3 |    /----.                   An arc is given by its two ends and the number of eighths of a circle that it
//     0 |   /      .     baseline     turns between them.
#pragma once

namespace frontmost::detail {

/// Strokes of a letter, in tenths of the height of its lettering: the path of the pen's centre, x to the right from the
/// letter's left, y up from the baseline. Capitals end at 9 and small letters at 6. Points "x,y" are joined in order;
/// ";" separates strokes. Before a point, each ( turns the way to it by an eighth of a circle to the left, and each )
/// to the right: "5,6 ((((0,6" is the upper half of a circle.
struct Glyph {
  char32_t code;
  double width;  ///< of the strokes, which stay within [0, width]
  const char* strokes;
};

/// The letter, or null if there is none.
[[nodiscard]] const Glyph* find_glyph(char32_t code);
/// The replacement for characters without a letter.
[[nodiscard]] const Glyph& missing_glyph();

/// A letter composed of another letter and a mark.
struct Composite {
  char32_t base;     ///< without its own mark: the dotless i for i
  const char* mark;  ///< strokes about x = 0, above a small letter or below the baseline
  bool is_below;
};
/// The composition of `code`; its mark is null if there is none.
[[nodiscard]] Composite find_composite(char32_t code);

}  // namespace frontmost::detail
