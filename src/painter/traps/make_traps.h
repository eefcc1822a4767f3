// SPDX-License-Identifier: Apache-2.0
// What polygons reach under each other, side by side.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "frontmost/painter.h"

namespace frontmost::painter_detail {

/// What a polygon reaches under others along a side, or along a part of one: convex, from `from` over the corners of
/// the hem to `to`.
struct SideHem {
  std::uint32_t side = 0;  ///< the polygon's, from that corner on
  std::uint32_t corner_count = 0;
  std::size_t first_corner = 0;  ///< of HemList::corners
  glm::dvec2 from{0}, to{0};
};

/// Hems of all polygons of an order, by place and by side.
struct HemList {
  std::vector<SideHem> hems;
  std::vector<glm::dvec2> corners;
  std::vector<std::size_t> ends;  ///< by place: of its hems

  [[nodiscard]] std::size_t begin_of(std::size_t place) const { return place == 0 ? 0 : ends[place - 1]; }
  [[nodiscard]] std::span<const SideHem> of(std::size_t place) const {
    return {hems.data() + begin_of(place), ends[place] - begin_of(place)};
  }
  [[nodiscard]] std::span<const glm::dvec2> corners_of(const SideHem& hem) const {
    return {corners.data() + hem.first_corner, hem.corner_count};
  }
};

/// As with_hems() adds them.
[[nodiscard]] HemList side_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                                const Execution& execution);

}  // namespace frontmost::painter_detail
