// SPDX-License-Identifier: Apache-2.0
// The shapes of letters, as text that can be read and mended beside a letter on squared paper.
//
//     9 |      /.        capitals     "A" is  0,0 3,9 6,0;1,3 5,3  : up and down again, and the bar
//     6 |     /  .       small
//     3 |    /----.                   An arc is told by how many eighths of a circle it turns on the way to the
//     0 |   /      .     baseline     next point; that and its ends are all that there is to it.
#pragma once

namespace frontmost::detail {

/// Strokes of a letter, in tenths of the height of its lettering: the middle of the pen, x to the right from the
/// letter's left, y up from the baseline; capitals end at 9 and small letters at 6. Points "x,y" are joined in their
/// order, strokes are parted by ";". In front of a point, each ( is an eighth of a circle to the left on the way to it,
/// and each ) one to the right: "5,6 ((((0,6" is the upper half of a circle.
struct Glyph {
  char32_t code;
  double width;  ///< of the strokes; nothing reaches beyond it, or left of 0
  const char* strokes;
};

/// The letter, or null where there is none.
[[nodiscard]] const Glyph* find_glyph(char32_t code);
/// Stands for all that there is no letter for.
[[nodiscard]] const Glyph& missing_glyph();

/// A letter that is made of another one and a mark.
struct Composite {
  char32_t base;     ///< without its own mark: the dotless i for i
  const char* mark;  ///< strokes about x = 0, above a small letter, or below the baseline
  bool is_below;
};
/// Composite with a null mark where `code` is none.
[[nodiscard]] Composite find_composite(char32_t code);

}  // namespace frontmost::detail
