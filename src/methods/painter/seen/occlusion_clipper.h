// SPDX-License-Identifier: Apache-2.0
// Clips one polygon of an order by the union of the occluders that are painted after it.
//
// The clipper has two uses. Before there is an order, it only tells whether polygons are hidden, by occluders that a
// plane test found to be before them. With an order, it makes the visible parts, and the order itself tells which
// polygon is before which: the later one.
#pragma once

#include <functional>

#include "painter/limits.h"
#include "painter/seen/occluder_union.h"
#include "painter/seen/outlines.h"

namespace frontmost::painter_detail {

/// Clips one polygon after another. Not for several threads at once.
class OcclusionClipper {
 public:
  /// Whether a polygon is wholly behind a later one where they overlap; both are given by their places. Without such a
  /// function the order decides: the earlier polygon is always behind.
  using IsBehind = std::function<bool(std::uint32_t place, std::uint32_t cover)>;

  OcclusionClipper(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort,
                   IsBehind is_behind = {})
      : screen_(screen), poll_(effort), is_behind_(std::move(is_behind)), union_(screen, adjacency) {}

  /// Whether the polygon in a slot is wholly hidden. Also false if the answer would take long.
  [[nodiscard]] bool is_hidden(std::size_t slot);

  /// The visible parts of the polygon in a slot; valid until the next call.
  [[nodiscard]] const OutlineList& clip(std::size_t slot);

 private:
  using Corners = std::vector<PaintCorner>;

  /// Clips the part of a polygon that lies in some cells, and adds the visible parts to seen_. \returns true if all of
  /// it is visible; nothing is added then.
  bool is_all_seen(std::size_t slot, const Corners& outline, const PieceGrid::Range& cells);
  /// is_all_seen() for the outline in the cutter, if it lies in few cells.
  bool is_all_seen_at_once(std::size_t slot, const PolygonExtent& own, const PieceGrid::Range& cells);
  Corners part_within(const Corners& outline, const glm::dvec2& low, const glm::dvec2& high);
  struct Hiders;
  /// The slot of a polygon that hides a point, or points next to it; no_index: none.
  [[nodiscard]] std::uint32_t hider_at(std::size_t slot, const glm::dvec2& at);
  /// Whether an outline is hidden, if `hider` hides the point `at`.
  OccluderUnion::Found spread(std::size_t slot, Outline outline, std::uint32_t hider, const glm::dvec2& at);
  /// Subtracts the polygons from a place on from the outline in the cutter. \returns true if nothing is left.
  bool take_covers(std::size_t slot, std::uint32_t first_place, const PolygonExtent& own,
                   const PieceGrid::Range& cells);
  [[nodiscard]] bool may_hide(std::size_t slot, std::size_t cover) const {
    return screen_.is_occluder(cover) && (!is_behind_ || is_behind_(screen_.place(slot), screen_.place(cover)));
  }
  [[nodiscard]] bool is_first_meeting(const PieceGrid::Range& cells, const PolygonExtent& cover, int x, int y) const;

  const ScreenPolygons& screen_;
  Poll poll_;
  const IsBehind is_behind_;
  OccluderUnion union_;
  OutlineClipper cutter_;
  OutlineList seen_;
};

}  // namespace frontmost::painter_detail
