// SPDX-License-Identifier: Apache-2.0
// The steps from what is seen of an order of painting to a figure: colours, neighbours in one, sheets, outlines. See
// draw_figure().
//
//    VisibleParts --color_order()--> one shape for each colour of each polygon
//                 --merge_neighbours()--> fewer shapes, where neighbours have one colour
//                 --gather_sheets()--> translucent neighbours in sheets
//                 --outlined()--> Figure: closed rings, with traps
//
// Each step takes a ColoredOrder and gives one, so each can be tested, and left out, by itself. The order of painting
// is that of the shapes throughout.
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

/// Polygons of one colour that lie beside each other and nowhere above each other, so that they may be one path:
/// `polygon_count` of ColoredOrder::polygons from `first_polygon` on.
struct ColoredShape {
  glm::u8vec4 color{0};  ///< sRGB and straight alpha, as files have them
  std::uint32_t polygon_count = 0;
  std::size_t first_polygon = 0;
  /// Rising. Translucent shapes with the same number have the same opacity and lie nowhere above each other. Opaque
  /// ones have no use for it.
  std::uint32_t sheet = 0;
};

/// An order of painting of shapes, each of convex polygons, which have their corners in pixels, counter-clockwise as
/// they are seen.
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
  /// The number of the shape of each polygon.
  [[nodiscard]] std::vector<std::uint32_t> shapes_of_polygons() const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(polygons.size());
    for (std::uint32_t i = 0; i < shapes.size(); ++i) numbers.insert(numbers.end(), shapes[i].polygon_count, i);
    return numbers;
  }
  /// Appends a shape, a sheet by itself, whose polygons are those that are added next.
  void begin_shape(const glm::u8vec4& color) {
    shapes.push_back({color, 0, polygons.size(), shapes.empty() ? 0 : shapes.back().sheet + 1});
  }
  void add_polygon(PrimitiveId id, std::span<const glm::dvec2> outline) {
    polygons.push_back({id, std::uint32_t(outline.size()), corners.size()});
    corners.insert(corners.end(), outline.begin(), outline.end());
    ++shapes.back().polygon_count;
  }
};

/// Colours as the picture of the same view has them, found with what pictures before made ready, with textures, shadows
/// and smooth normals. Shadows and colours of depth depend on the input, which is of the parts' view. Polygons whose
/// colour varies are cut within their own place in the order, along lines that part their colours best: those of their
/// textures' coordinates, those along which light is the same. Pieces are as large as the tolerance allows; details
/// narrower than about a pixel and a half are left out, and so are holes of alpha mode MASK. Each shape is a sheet by
/// itself.
///
/// Where neighbours are to be merged afterwards, pieces of a polygon whose colours nearly agree get the same colour and
/// become one shape, as merge_neighbours() can use them; a third of the tolerance goes into that. Otherwise each piece
/// of an opaque polygon is a shape of its own, and there are fewer of them.
/// O(pixels of the picture that polygons cover, seen or not), in parallel; the result does not depend on threads.
/// \throws Error bad_argument for an opacity out of range; limit_exceeded for more polygons and pieces
/// than FigureOptions::most_polygons.
[[nodiscard]] ColoredOrder color_order(shading::PreparedScene& scene, const ShadeInput& input,
                                       const VisibleParts& parts, const FigureOptions& options,
                                       const Execution& execution);

/// The same picture of fewer shapes: polygons of one colour that share a part of a side become one shape, where no
/// later polygon covers any of them, so that their place in the order does not matter; it is then that of the last.
/// Each shape is a sheet by itself. O(n log n) in the number of polygons of bounded overlap, on one thread.
[[nodiscard]] ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution = {});

/// The same picture with translucent neighbours of one opacity in sheets, against hairlines between them: what is of
/// one sheet can be painted as if it were opaque, with traps, and then be laid on as a whole. Shapes change their
/// places in the order where none is over the other; each stays whole. Where two surfaces lie over each other they are
/// sheets one after the other, and one that winds over and under itself is in several, with hairlines between these.
/// O(n log n) in the number of polygons and of pairs that overlap, on one thread; with more than 16 million such pairs
/// that have translucent ones between or under them the figure stays as it is.
[[nodiscard]] ColoredOrder gather_sheets(ColoredOrder colored, const Execution& execution = {});

/// The outlines of all shapes, without the sides that their own polygons share, and with traps of `width` pixels under
/// later shapes; `occluders` are told by the polygons' ids, and translucent shapes are none. Translucent shapes have
/// traps under others of their sheet alone. Corners of shapes of several polygons are rounded to 1/4096 pixel.
[[nodiscard]] Figure outlined(const ColoredOrder& colored, double width, const Occluders& occluders = Occluders::all(),
                              const Execution& execution = {});

}  // namespace frontmost
