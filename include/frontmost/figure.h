// SPDX-License-Identifier: Apache-2.0
// Figures: polygons in the order of painting, each in one colour, for vector pictures.
#pragma once

#include <vector>

#include "frontmost/painter.h"
#include "frontmost/shade.h"

namespace frontmost {

struct ColorOptions {
  /// Shading, shadows and opacity count; see-through and the background do not.
  ShadeOptions shade;
  /// Steps of 8-bit sRGB, 0 to 255, by which the colour of a piece may differ from what is seen there. 255: a polygon
  /// has the colour of its middle, and is never cut.
  double tolerance = 6;
  /// More polygons and pieces are an error.
  std::size_t most_polygons = std::size_t(1) << 27;
};

/// An order of painting whose polygons have colours.
struct ColoredOrder {
  PaintOrder order;
  std::vector<glm::u8vec4> colors;  ///< one for each polygon: sRGB and straight alpha, as files have them
  /// One for each polygon, rising: consecutive polygons with the same number have the same colour, lie beside each
  /// other and nowhere above each other, so that they may be one path.
  std::vector<std::uint32_t> shapes;
};

/// Colours as the picture of the same view has them, with textures, shadows and smooth normals; `visible` is what is
/// visible in the order's view, which shadows and colours of depth depend on. Polygons whose colour varies are cut
/// within their own place in the order, along lines that part their colours best: those of their textures' coordinates,
/// those along which light is the same. Pieces are as large as the tolerance allows; details narrower than about a
/// pixel and a half are left out. Holes of alpha mode MASK are left out, too.
/// O(pixels that polygons cover, seen or not), in parallel; the result does not depend on threads.
/// \throws Error bad_argument for an order or a Visible that does not match, an opacity or a tolerance out of range;
/// limit_exceeded for more than ColorOptions::most_polygons.
[[nodiscard]] ColoredOrder color_order(const Surfaces& surfaces, const Visible& visible, const PaintOrder& order,
                                       const ColorOptions& options = {}, const Execution& execution = {});

}  // namespace frontmost
