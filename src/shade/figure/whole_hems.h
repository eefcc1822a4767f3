// SPDX-License-Identifier: Apache-2.0
// Hems of a figure's polygons: made for what they are pieces of, and handed on to the pieces.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "frontmost/figure.h"
#include "shade/figure/side_net.h"

namespace frontmost::shading {

/// A side of a polygon, and the hem of the whole's side that it is a part of.
struct HemmedSide {
  glm::dvec2 from{0};
  SideHem hem;
  /// Where this side begins on the whole's, and how long that is; pixels.
  double begin = 0, whole_length = 0;
};

/// Pieces that reach under each other need no hems between them, and what is beside a polygon is found once for the
/// whole, not for each of its pieces.
class WholeHems {
 public:
  /// Borrows `colored`. \throws Error as with_hems().
  WholeHems(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
            const Execution& execution);

  /// Of a polygon, until the next call.
  [[nodiscard]] std::span<const HemmedSide> sides(std::size_t polygon);

 private:
  using Corners = std::span<const PaintCorner>;
  [[nodiscard]] PaintOrder grouped_by_color(std::vector<std::uint8_t>& hiding,
                                            const std::function<bool(PrimitiveId)>& hides) const;
  void hem_sheets(const PaintOrder& grouped, double width, const Execution& execution);
  [[nodiscard]] std::size_t whole_of(std::size_t polygon) const {
    return colored_.whole_of.empty() ? polygon : colored_.whole_of[polygon];
  }
  void read_whole(std::size_t whole);
  void add_side(const glm::dvec2& from, const glm::dvec2& to);

  const ColoredOrder& colored_;
  const PaintOrder& wholes_;
  const double most_beside_;  ///< pixels: of what lies on a side
  PaintOrder hemmed_;
  std::size_t read_ = std::size_t(-1);  ///< the whole that whole_sides_ are of
  std::vector<HemmedSide> whole_sides_, sides_;
};

}  // namespace frontmost::shading
