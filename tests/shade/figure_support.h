// SPDX-License-Identifier: Apache-2.0
// Figures made by hand, and areas of the resulting shapes.
#pragma once

#include "figures/colored_order.h"
#include "shade/prepared_scene.h"
#include "shade/support.h"

namespace frontmost::test {

/// Colours of a figure of these surfaces.
inline ColoredOrder color_order(const Surfaces& surfaces, const Visible& visible, const VisibleParts& parts,
                                const FigureOptions& options = {}, const Execution& execution = {}) {
  shading::PreparedScene scene(surfaces);
  return frontmost::color_order(scene, {.visible = &visible}, parts, options, execution);
}

/// A polygon of a figure made by hand, counter-clockwise as seen.
struct Tile {
  std::vector<glm::dvec2> corners;
  glm::u8vec4 color{0};
};
inline constexpr glm::u8vec4 kRed(255, 0, 0, 255), kBlue(0, 0, 255, 255), kGlass(255, 0, 0, 99);

inline Tile box(double x, double y, double width, double height, const glm::u8vec4& color = kRed) {
  return {{{x, y}, {x, y + height}, {x + width, y + height}, {x + width, y}}, color};
}

/// An order of tiles, each a shape of its own.
inline ColoredOrder order_of(const std::vector<Tile>& tiles) {
  ColoredOrder colored;
  colored.view = front_view();
  for (const Tile& tile : tiles) {
    colored.begin_shape(tile.color);
    colored.add_polygon(PrimitiveId(colored.polygons.size()), tile.corners);
  }
  return colored;
}

/// The figure without traps, as nothing hides.
inline Figure bare(const ColoredOrder& colored) { return outlined(colored, 1, Occluders::none()); }
inline double area_of(const Figure& figure, const FigureRing& ring) {
  double twice = 0;
  for (std::size_t k = 0; k < ring.corner_count; ++k) {
    const glm::dvec2 p = figure.corners[ring.first_corner + k];
    const glm::dvec2 q = figure.corners[ring.first_corner + (k + 1) % ring.corner_count];
    twice += q.x * p.y - p.x * q.y;
  }
  return twice / 2;
}
/// Area of a shape; its holes turn the other way.
inline double area_of(const Figure& figure, std::size_t shape) {
  double area = 0;
  for (std::uint32_t i = 0; i < figure.shapes[shape].ring_count; ++i)
    area += area_of(figure, figure.rings[figure.shapes[shape].first_ring + i]);
  return area;
}

}  // namespace frontmost::test
