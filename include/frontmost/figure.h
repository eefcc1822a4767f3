// SPDX-License-Identifier: Apache-2.0
// Figure: a picture of polygons, for vector files, as Image is one of pixels. draw_figure() makes it, save() writes it.
//
// A million polygons are three arrays, each of which names a run of the next:
//
//   shapes   | shape 0           | shape 1 | ...    filled one after the other, each with one colour
//   rings    | ring 0  | ring 1  | ring 2  | ...    the outlines of a shape: its rim, its holes, its other parts
//   corners  | a b c d | e f g   | h i j k | ...    the corners of a ring, which closes by itself
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frontmost/view.h"

namespace frontmost {

/// A closed path of a figure: `corner_count` of Figure::corners from `first_corner` on.
struct FigureRing {
  std::size_t first_corner = 0;
  std::uint32_t corner_count = 0;
};
/// What is filled with one colour by the nonzero rule: `ring_count` of Figure::rings from `first_ring` on.
struct FigureShape {
  glm::u8vec4 color{0};
  std::uint32_t ring_count = 0;
  std::size_t first_ring = 0;
  /// Rising. Translucent shapes with the same number are filled without their opacity, which they share, one after the
  /// other on clear ground; the whole is then laid on with it.
  std::uint32_t sheet = 0;
};
/// A picture of polygons: paths to be filled one after the other. Pixels of the view, x right, y down.
struct Figure {
  View view;
  std::string title;                    ///< what files call it; any text
  std::optional<glm::vec3> background;  ///< sRGB, 0 to 1; none: transparent
  std::vector<FigureShape> shapes;
  std::vector<FigureRing> rings;
  std::vector<glm::dvec2> corners;
};

}  // namespace frontmost
