// SPDX-License-Identifier: Apache-2.0
// The steps from an order of painting to a figure: colours, neighbours in one, sheets, outlines. See draw_figure().
#pragma once

#include <vector>

#include "frontmost/figure.h"
#include "frontmost/painter.h"
#include "frontmost/shade.h"

namespace frontmost {

struct ColorOptions {
  /// Shading, shadows and opacity count; see-through and the background do not.
  ShadeOptions shade;
  /// Steps of 8-bit sRGB, 0 to 255, by which the colour of a piece may differ from what is seen there. 255: a polygon
  /// has the colour of its middle, and is never cut.
  double tolerance = 6;
  /// Pieces of a polygon whose colours nearly agree get the same colour and become one shape, as merge_neighbours() can
  /// use them; a third of the tolerance goes into that. Otherwise each piece of an opaque polygon is a shape of its
  /// own, and there are fewer of them.
  bool groups_pieces = true;
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
  /// Set by gather_sheets(): one for each polygon, rising. Consecutive translucent polygons with the same number have
  /// the same opacity and lie nowhere above each other. Empty: each is a sheet of its own.
  std::vector<std::uint32_t> sheets;
};

/// Colours as the picture of the same view has them, with textures, shadows and smooth normals; `visible` is what is
/// visible in the order's view, which shadows and colours of depth depend on. Polygons whose colour varies are cut
/// within their own place in the order, along lines that part their colours best: those of their textures' coordinates,
/// those along which light is the same. Pieces are as large as the tolerance allows; details narrower than about a
/// pixel and a half are left out. Holes of alpha mode MASK are left out, too, and what lies beside the picture.
/// O(pixels of the picture that polygons cover, seen or not), in parallel; the result does not depend on threads.
/// \throws Error bad_argument for an order or a Visible that does not match, an opacity or a tolerance out of range;
/// limit_exceeded for more than ColorOptions::most_polygons.
[[nodiscard]] ColoredOrder color_order(const Surfaces& surfaces, const Visible& visible, const PaintOrder& order,
                                       const ColorOptions& options = {}, const Execution& execution = {});

/// The same picture of fewer shapes: polygons of one colour that share a part of a side become one shape, where no
/// later polygon covers any of them, so that their place in the order does not matter; it is then that of the last.
/// O(n log n) in the number of polygons of bounded overlap, on one thread.
[[nodiscard]] ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution = {});

/// The same picture with translucent neighbours of one opacity in sheets, against hairlines between them: what is of
/// one sheet can be painted as if it were opaque, with hems, and then be laid on as a whole. Shapes change their places
/// in the order where none is over the other; each stays whole. Where two surfaces lie over each other they are sheets
/// one after the other, and one that winds over and under itself is in several, with hairlines between these. After
/// merge_neighbours(), whose result has no sheets. O(n log n) in the number of polygons and of pairs that overlap, on
/// one thread; with more than 16 million such pairs that have translucent ones between or under them the figure stays
/// as it is. \throws Error bad_argument for a ColoredOrder whose parts do not match.
[[nodiscard]] ColoredOrder gather_sheets(ColoredOrder colored, const Execution& execution = {});

/// The outlines of all shapes, without the sides that their own polygons share, and with hems as with_hems() makes
/// them. Corners of shapes of several polygons are rounded to 1/4096 pixel.
/// Translucent shapes have them beside others of their sheet alone.
/// \throws Error bad_argument as with_hems(), and for a ColoredOrder whose parts do not match.
[[nodiscard]] Figure outlined(const ColoredOrder& colored, double hem,
                              const std::function<bool(PrimitiveId)>& hides = {}, const Execution& execution = {});

}  // namespace frontmost
