// SPDX-License-Identifier: Apache-2.0
// Dimensions of drawing sheets by ISO 129: diameters and positions of circles, and overall sizes of the drawn lines,
// not of the model's box.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontmost/sheets.h"
#include "sheets/paper.h"

namespace frontmost::detail {

/// A view of a sheet, with the settings for its dimensions.
struct DimensionedView {
  const SheetView* sheet = nullptr;    ///< its place on the page; position_rooms_of() accepts any
  const Drawing* drawing = nullptr;    ///< in parallel projection
  const Rounds* rounds = nullptr;      ///< circles of the drawing's surfaces; null for no diameters
  const Surfaces* surfaces = nullptr;  ///< those of the drawing; null for no steps
  bool is_dimensioned = true;          ///< false: only an obstacle, like views at an angle
  glm::dvec2 taken{0};                 ///< millimetres on the left and below that other marks occupy
};

/// How numbers are written.
struct NumberStyle {
  int most_decimals = 2;        ///< 0 to 6; numbers below 1 have three significant digits
  bool with_fractions = false;  ///< true: numbers within 0.0005 of a multiple of 1/64 are fractions, "1 7/8"
};

struct DimensionOptions {
  Dimensioning level = Dimensioning::diameters;
  double numbers_per_unit = 1;  ///< numbers per unit of length of the scene; above 0
  NumberStyle number_style{};
  double text_height = 3.5;  ///< millimetres, as in TextStyle
  Lettering lettering = Lettering::strokes;
};

/// The overall sizes of a view.
struct OverallSizes {
  bool width = false;   ///< drawn below the view
  bool height = false;  ///< drawn on the left of the view
};

/// Decides which overall sizes each view has. Each direction of space has one size, in the first view that shows the
/// direction in true length, level or upright. Views that are not dimensioned have no sizes.
[[nodiscard]] std::vector<OverallSizes> overall_sizes_of(std::span<const DimensionedView> views);
/// Millimetres that rows of running dimensions occupy on the left of each view (x) and below it (y); 0 without a row.
/// Views that show circles, or widths across flats, have both rows; steps need one. Positions are measured in units of
/// the scene, so the place and scale of the views do not matter.
[[nodiscard]] std::vector<glm::dvec2> position_rooms_of(std::span<const DimensionedView> views,
                                                        const DimensionOptions& options);
/// Millimetres that sizes and positions occupy on the left of the view and below it, in addition to other marks.
/// `positions` is from position_rooms_of().
[[nodiscard]] glm::dvec2 room_for(const OverallSizes& sizes, const glm::dvec2& positions, double text_height);

/// The text of a number: a reduced fraction if the style has them and one fits ("1 7/8", "3/64", "2"), or else decimals
/// without trailing zeros, at most as many as the style says or three significant digits, whichever is more. If a half
/// would have to be rounded, the text has one more digit: "50", "12.7", "1.875".
[[nodiscard]] std::string dimension_text(double number, const NumberStyle& style);

struct Dimensions {
  /// One group of lines and one of strokes of texts, both without names; texts and dimensions are in the first group.
  PageLayer layer{"7 dimensions"};
  std::size_t count = 0;     ///< number of dimensions on the page
  std::size_t left_out = 0;  ///< diameters, radii, widths across flats, positions and steps without room
  std::size_t undrawn = 0;   ///< as Sheet::undrawn
  std::size_t prisms = 0;    ///< diameters of cylinders of fewer than 18 sides, which count as polygons
};

/// Places overall sizes by overall_sizes_of(), and the diameters of circles and cylinders seen along their axes, each
/// once on the sheet, those of one size in a view together ("6x⌀10"). An overall size of a single cylinder is its
/// diameter, which the corners of its polygon do not reach. Circles at the end of a cone or chamfer, and arcs of little
/// more than a half circle or less, have none. Circles with a diameter have positions, too: running dimensions from the
/// lower left corner of their view, one for each distance, unless a round part bounds the view there. Steps share these
/// rows (steps_of()), at most 16 in one. Blind holes have depths behind their diameters; hexagons and squares of plane
/// faces have a width across flats. Hidden circles and faces have no dimension. At most 64 diameters stand on leader
/// lines. They avoid lines and texts of the drawing and `taken`, and stay within `area` (the page within its frame).
/// O(lines + rounds). \throws Error bad_argument for options out of range.
[[nodiscard]] Dimensions place_dimensions(std::span<const DimensionedView> views, const PageBox& area,
                                          std::span<const PageBox> taken, const DimensionOptions& options = {});

}  // namespace frontmost::detail
