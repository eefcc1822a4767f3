// SPDX-License-Identifier: Apache-2.0
// The occluders beside a polygon, under which the polygon may have traps.
//
//          ______
//       . |      | .        Occluders within reach of a polygon's traps are listed once, from the cells of
//       . | poly | .        the grid. Each side and corner of the polygon then searches its own small part
//       . |______| .        of the list.
#pragma once

#include <vector>

#include "painter/limits.h"
#include "painter/seen/adjacency.h"
#include "painter/seen/outlines.h"

namespace frontmost::painter_detail {

/// Answers questions about one polygon after another. A trap is hidden by occluders that are painted after the polygon,
/// and by occluders of the polygon's own group wherever they are in the order, because they look the same. They are
/// listed once for all questions about a polygon, and most polygons have few. Not for several threads at once.
class NearbyOccluders {
 public:
  NearbyOccluders(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort)
      : screen_(screen), adjacency_(adjacency), poll_(effort), listed_(screen.count(), 0) {}

  /// Selects the polygon in a slot, and occluders up to `reach` pixels around it.
  void begin(std::size_t slot, double reach);
  /// Whether another polygon that has an area and hides nothing beyond it shares this side.
  [[nodiscard]] bool are_open_beside(std::size_t side) const;
  /// Whether anything hides points on the outer side of a side of the polygon, next to it.
  [[nodiscard]] bool hide_beside(const glm::dvec2& from, const glm::dvec2& to);
  /// The parts of a convex outline within reach that are not hidden; valid until the next call.
  [[nodiscard]] const OutlineClipper& open_parts(Outline outline);

 private:
  struct Hider {
    glm::vec2 low, high;  ///< the box around it, in pixels
    std::uint32_t slot;
  };
  /// Sets hiders_ to occluders whose boxes overlap `box`.
  void list(const PolygonExtent& box);
  /// Calls visit(hider) for occluders whose boxes overlap `box`, until it returns true. \returns whether it did.
  template <class Visit>
  bool any_of(const PolygonExtent& box, const Visit& visit);

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  Poll poll_;
  OutlineClipper cutter_;
  std::size_t slot_ = 0;
  bool is_listed_ = false;  ///< hiders_ holds all occluders around the polygon
  std::vector<Hider> hiders_;
  std::vector<std::uint32_t> listed_;  ///< by slot: the turn in which it was listed last
  std::uint32_t turn_ = 0;
};

}  // namespace frontmost::painter_detail
