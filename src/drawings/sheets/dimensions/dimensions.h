// SPDX-License-Identifier: Apache-2.0
// Dimensions of drawing sheets: overall sizes and diameters, as ISO 129 has them.
//
// Overall sizes are taken of what is drawn and not of the model's box, in the direction in which the view looks. A
// cylinder of which both ends are outermost is measured by its diameter: the corners of its polygon would give a little
// less.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontmost/sheets.h"
#include "sheets/page_marks.h"

namespace frontmost::detail {

/// A view of a sheet that is to have dimensions.
struct DimensionedView {
  const SheetView* sheet = nullptr;  ///< its place on the page is settled
  const Drawing* drawing = nullptr;  ///< in parallel projection
  const Rounds* rounds = nullptr;    ///< of the drawing's surfaces; null for no diameters
  bool with_hidden = true;           ///< its hidden circles have diameters
  bool is_dimensioned = true;        ///< false: only kept free, as pictures at an angle are
  glm::dvec2 taken{0};               ///< millimetres on its left and below it that other marks take
};

struct DimensionOptions {
  double numbers_per_unit = 1;  ///< what the numbers say of a length of 1 in the scene; above 0
  int decimals = 2;             ///< at most, but for what is so small that three digits take more; 0 to 6
  Pen pen{0.25, {}};            ///< of lines and arrows
  double text_height = 3.5;     ///< millimetres, as TextStyle's
};

/// Which overall sizes a view has.
struct OverallSizes {
  bool width = false;   ///< below it
  bool height = false;  ///< on its left
};

/// Each direction of space once: in the first view that shows it in true length upright or level. Views that are not
/// dimensioned have none.
[[nodiscard]] std::vector<OverallSizes> overall_sizes_of(std::span<const DimensionedView> views);
/// Millimetres that these take beside the view, on its left and below, beyond what other marks take.
[[nodiscard]] glm::dvec2 room_for(const OverallSizes& sizes, double text_height);

/// Numbers without trailing zeros, of so many decimals at most, or of three digits where that is more, and one more
/// where that is a five: "50", "12.7", "1.875".
[[nodiscard]] std::string dimension_text(double number, int decimals);

struct Dimensions {
  PageLayer layer{"7 dimensions"};  ///< a group of lines and one of texts, neither with a name
  std::size_t count = 0;            ///< of dimensions on the page
  std::size_t left_out = 0;         ///< diameters for which there was no room
  std::size_t undrawn = 0;          ///< diameters of cylinders that are seen along their axes, but not drawn
  std::size_t prisms = 0;           ///< likewise of cylinders of fewer than 18 sides, which count as polygons
};

/// Overall sizes as overall_sizes_of() shares them out, and diameters of circles and cylinders that are seen along
/// their axes, each once on the sheet, those of one size in a view together ("6x⌀10"). A size that is that of one
/// cylinder has its sign and takes the place of the diameter. Circles that end a cone or a chamfer at a cylinder, and
/// less than a half circle and a bit, have none. Diameters stand on leader lines, where they neither meet a line or
/// text of the drawing nor what is in `taken` and leave `area` (the page within its frame): as near as such a place is,
/// with as few lines crossed. At most 64 of them. O(lines + rounds). \throws Error bad_argument for options out of
/// range.
[[nodiscard]] Dimensions place_dimensions(std::span<const DimensionedView> views, const PageBox& area,
                                          std::span<const PageBox> taken, const DimensionOptions& options = {});

}  // namespace frontmost::detail
