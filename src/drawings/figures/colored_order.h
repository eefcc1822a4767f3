// SPDX-License-Identifier: Apache-2.0
// The steps from visible polygons in painting order to a figure. Each can be tested, or left out, separately.
//
//    VisibleParts --color_order()--> one shape for each colour of each polygon
//                 --merge_neighbours()--> fewer shapes: neighbours of one colour are merged
//                 --gather_blend_groups()--> translucent neighbours in blend groups
//                 --outlined()--> Figure: closed rings, with traps
#pragma once

#include <span>
#include <vector>

#include "frontmost/painter.h"
#include "frontmost/pictures.h"
#include "frontmost/sheets.h"

namespace frontmost {

namespace shading {
struct PreparedScene;
}

/// Polygons of one colour that can form a single path: they are neighbours, and none is painted over another. A shape
/// has `polygon_count` polygons, which begin at index `first_polygon` of ColoredOrder::polygons.
struct ColoredShape {
  glm::u8vec4 color{0};  ///< sRGB, not premultiplied, as in files
  std::uint32_t polygon_count = 0;
  std::size_t first_polygon = 0;
  /// Number of the blend group, ascending. Translucent shapes of one group have the same opacity, and none is painted
  /// over another. Ignored for opaque shapes.
  std::uint32_t blend_group = 0;
};

/// Shapes in painting order. Each consists of convex polygons with corners in pixels, counter-clockwise on the screen.
struct ColoredOrder {
  View view;
  std::vector<ColoredShape> shapes;  ///< the first is painted first
  std::vector<PaintPolygon> polygons;
  std::vector<glm::dvec2> corners;

  [[nodiscard]] std::span<const PaintPolygon> polygons_of(const ColoredShape& shape) const {
    return {polygons.data() + shape.first_polygon, shape.polygon_count};
  }
  [[nodiscard]] std::span<const glm::dvec2> corners_of(const PaintPolygon& polygon) const {
    return {corners.data() + polygon.first_corner, polygon.corner_count};
  }
  /// For each polygon, the number of its shape.
  [[nodiscard]] std::vector<std::uint32_t> shapes_of_polygons() const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(polygons.size());
    for (std::uint32_t i = 0; i < shapes.size(); ++i) numbers.insert(numbers.end(), shapes[i].polygon_count, i);
    return numbers;
  }
  /// Appends a shape with a blend group of its own. The polygons that are added next belong to it.
  void begin_shape(const glm::u8vec4& color) {
    shapes.push_back({color, 0, polygons.size(), shapes.empty() ? 0 : shapes.back().blend_group + 1});
  }
  void add_polygon(PrimitiveId id, std::span<const glm::dvec2> outline) {
    polygons.push_back({id, std::uint32_t(outline.size()), corners.size()});
    corners.insert(corners.end(), outline.begin(), outline.end());
    ++shapes.back().polygon_count;
  }
};

/// Whether a triangle hides what is behind it. A triangle with holes does once its holes are cut out.
[[nodiscard]] inline bool is_opaque(const Surfaces& surfaces, PrimitiveId id, bool holes_are_cut_out = false) {
  const PrimitiveSource source = surfaces.source(id);
  const Scene& scene = surfaces.scene();
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  if (material >= scene.materials.size()) return true;
  const Material& m = scene.materials[material];
  return !m.is_see_through() && (m.alpha == Material::Alpha::opaque || holes_are_cut_out);
}

/// Colours polygons like the picture of `input`, which has the same view as `parts`. Uses the data that `scene` has
/// prepared. Polygons of varying colour are cut in place, along texture coordinates or lines of equal light, into
/// pieces as large as the tolerance allows. Details and MASK holes narrower than about 1.5 pixels are left out. Each
/// shape is a blend group by itself. If neighbours will be merged, pieces of a polygon with nearly equal colours become
/// one shape, which uses up a third of the tolerance; otherwise each piece of an opaque polygon is a shape. Threads do
/// not change the result. O(pixels that polygons cover, visible or not). \throws Error bad_argument for an opacity out
/// of range; limit_exceeded for more polygons and pieces than FigureOptions::most_polygons.
[[nodiscard]] ColoredOrder color_order(shading::PreparedScene& scene, const ShadeInput& input,
                                       const VisibleParts& parts, const FigureOptions& options,
                                       const Execution& execution);

/// Merges polygons of one colour that share a part of a side, if no later polygon covers any of them. Their place in
/// the painting order then does not matter, so they are painted in the place of the last one. The picture stays the
/// same. Each shape is a blend group by itself. O(n log n) in the number of polygons if their overlap is bounded, on
/// one thread.
[[nodiscard]] ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution = {});

/// Gathers translucent neighbours of one opacity in blend groups, so that no hairlines show between them. The picture
/// stays the same: shapes change places only where neither is over the other. A surface that winds over and under
/// itself has several groups, with hairlines between these. O(n log n) in polygons and overlapping pairs, on one
/// thread. With more than 16 million overlapping pairs of shapes at or above translucent ones, the figure stays
/// unchanged.
[[nodiscard]] ColoredOrder gather_blend_groups(ColoredOrder colored, const Execution& execution = {});

/// The outlines of all shapes, without sides that their own polygons share, and with traps of `width` pixels under
/// later shapes. `occluders` holds polygons by their ids; translucent shapes never are occluders. A translucent shape
/// has traps only under other shapes of its blend group. Corners of a shape with several polygons are rounded to 1/4096
/// pixel.
[[nodiscard]] Figure outlined(const ColoredOrder& colored, double width, const Occluders& occluders = Occluders::all(),
                              const Execution& execution = {});

}  // namespace frontmost
