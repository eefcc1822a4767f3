// SPDX-License-Identifier: Apache-2.0
// Clipping of one polygon of an order by the union of the occluders that are painted after it.
//
// It is used twice. Before there is an order it asks only whether polygons are hidden, by occluders that a plane test
// has told to be before them. Of an order it makes the visible parts, and there the order itself tells: whatever comes
// later lies before.
#pragma once

#include <functional>

#include "painter/limits.h"
#include "painter/seen/occluder_union.h"
#include "painter/seen/outlines.h"

namespace frontmost::painter_detail {

/// Clips one polygon after another. Not for several threads at once.
class OcclusionClipper {
 public:
  /// Whether a polygon is wholly behind a later one where they overlap, both by their places. Without such a function
  /// it always is: the order says so.
  using IsBehind = std::function<bool(std::uint32_t place, std::uint32_t cover)>;

  OcclusionClipper(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort,
                   IsBehind is_behind = {})
      : screen_(screen), poll_(effort), is_behind_(std::move(is_behind)), union_(screen, adjacency) {}

  /// Whether the polygon in a slot is hidden wholly. False also where that takes long to tell.
  [[nodiscard]] bool is_hidden(std::size_t slot);

  /// The visible parts of the polygon in a slot, which stay until the next call.
  [[nodiscard]] const OutlineList& clip(std::size_t slot);

 private:
  using Corners = std::vector<PaintCorner>;

  /// Clips the part of a polygon that lies in some cells, and adds what is seen to seen_. \returns true where all of it
  /// is seen; then nothing was added.
  bool is_all_seen(std::size_t slot, const Corners& outline, const PieceGrid::Range& cells);
  /// The same for what is in the cutter, where the cells are few.
  bool is_all_seen_at_once(std::size_t slot, const PolygonExtent& own, const PieceGrid::Range& cells);
  Corners part_within(const Corners& outline, const glm::dvec2& low, const glm::dvec2& high);
  struct Hiders;
  /// One that hides a point, or what is next to it; no_index: none.
  [[nodiscard]] std::uint32_t hider_at(std::size_t slot, const glm::dvec2& at);
  /// Whether an outline is hidden, by `hider` at a point.
  OccluderUnion::Found spread(std::size_t slot, Outline outline, std::uint32_t hider, const glm::dvec2& at);
  /// Takes what those from a place on cover from what is in the cutter. \returns true when nothing is left.
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
