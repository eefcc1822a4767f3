// SPDX-License-Identifier: Apache-2.0
// Hems of a figure's polygons.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "painter/traps/make_traps.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/side_net.h"

namespace frontmost::shading {

/// What the polygons of a figure reach under each other: opaque ones under those after them, translucent ones under
/// others of their sheet.
class FigureTraps {
 public:
  /// Borrows `colored`. \throws Error as with_hems().
  FigureTraps(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
              const Execution& execution);

  /// Of a polygon, until the next call.
  [[nodiscard]] std::span<const NetCorner> sides(std::size_t polygon);
  /// The corners of a hem beside a part of its side, until the next call.
  [[nodiscard]] std::span<const glm::dvec2> part(std::uint32_t hem, const glm::dvec2& from, const glm::dvec2& to);

 private:
  struct Range {
    std::size_t begin, end;
  };
  [[nodiscard]] PaintOrder grouped_by_color(std::vector<std::uint8_t>& hiding,
                                            const std::function<bool(PrimitiveId)>& hides) const;
  void hem_sheets(const PaintOrder& grouped, double width, const Execution& execution);
  const ColoredOrder& colored_;
  painter_detail::HemList hems_;
  std::vector<Range> hems_of_;  ///< by polygon: of hems_.hems
  std::vector<NetCorner> sides_;
  std::vector<glm::dvec2> part_;
};

}  // namespace frontmost::shading
