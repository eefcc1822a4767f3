// SPDX-License-Identifier: Apache-2.0
// Hems of a figure's polygons: made for what they are pieces of, and handed on to the pieces.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "frontmost/figure.h"
#include "painter/side_hems.h"
#include "shade/figure/side_net.h"

namespace frontmost::shading {

/// Pieces that reach under each other need no hems between them, and what is beside a polygon is found once for the
/// whole, not for each of its pieces.
class WholeHems {
 public:
  /// Borrows `colored`. \throws Error as with_hems().
  WholeHems(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
            const Execution& execution);

  /// Of a polygon, until the next call.
  [[nodiscard]] std::span<const NetCorner> sides(std::size_t polygon);
  /// The corners of a hem beside a part of its side, until the next call.
  [[nodiscard]] std::span<const glm::dvec2> part(std::uint32_t hem, const glm::dvec2& from, const glm::dvec2& to);

 private:
  using Corners = std::span<const PaintCorner>;
  struct Range {
    std::size_t begin, end;
  };
  [[nodiscard]] PaintOrder grouped_by_color(std::vector<std::uint8_t>& hiding,
                                            const std::function<bool(PrimitiveId)>& hides) const;
  void hem_sheets(const PaintOrder& grouped, double width, const Execution& execution);
  [[nodiscard]] std::size_t whole_of(std::size_t polygon) const {
    return colored_.whole_of.empty() ? polygon : colored_.whole_of[polygon];
  }
  void list_whole(std::size_t whole);
  void add_side(const Range& hems, const glm::dvec2& from, const glm::dvec2& to);

  const ColoredOrder& colored_;
  const PaintOrder& wholes_;
  painter_detail::HemList hems_;
  std::vector<Range> hems_of_;  ///< by whole: of hems_.hems
  std::vector<NetCorner> sides_;
  std::vector<glm::dvec2> part_;
};

}  // namespace frontmost::shading
