// SPDX-License-Identifier: Apache-2.0
// The occluders beside a polygon: under these it may have traps.
//
//          ______
//       . |      | .        What lies around a polygon as far as its traps reach is listed once, from the cells of
//       . | poly | .        the grid; each of its sides and corners then asks about its own small part of the list.
//       . |______| .
#pragma once

#include <vector>

#include "painter/limits.h"
#include "painter/seen/adjacency.h"
#include "painter/seen/outlines.h"

namespace frontmost::painter_detail {

/// Answers questions about one polygon after another. A trap is hidden by occluders that are painted after the polygon,
/// and by those of its own group wherever they are in the order, because they look the same. They are listed once for
/// all questions about a polygon, and most polygons have few. Not for several threads at once.
class NearbyOccluders {
 public:
  NearbyOccluders(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort)
      : screen_(screen), adjacency_(adjacency), poll_(effort), listed_(screen.count(), 0) {}

  /// Of the polygon in a slot from now on, as far as `reach` pixels around it.
  void begin(std::size_t slot, double reach);
  /// Whether a side is that of one other polygon which has an area and hides nothing of what lies beyond it.
  [[nodiscard]] bool are_open_beside(std::size_t side) const;
  /// Whether anything hides places on the outer side of a side of the polygon, next to it.
  [[nodiscard]] bool hide_beside(const glm::dvec2& from, const glm::dvec2& to);
  /// What of a convex outline within reach is not hidden, until the next call.
  [[nodiscard]] const OutlineClipper& open_parts(Outline outline);

 private:
  struct Hider {
    glm::vec2 low, high;  ///< the box around it, in pixels
    std::uint32_t slot;
  };
  /// Sets hiders_ to those whose boxes overlap this one.
  void list(const PolygonExtent& box);
  /// Calls visit(hider) for those whose boxes overlap this one, until it returns true. \returns whether it did.
  template <class Visit>
  bool any_of(const PolygonExtent& box, const Visit& visit);

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  Poll poll_;
  OutlineClipper cutter_;
  std::size_t slot_ = 0;
  bool is_listed_ = false;  ///< hiders_ are all around the polygon
  std::vector<Hider> hiders_;
  std::vector<std::uint32_t> listed_;  ///< by slot: in which turn it was listed last
  std::uint32_t turn_ = 0;
};

}  // namespace frontmost::painter_detail
