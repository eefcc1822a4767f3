// SPDX-License-Identifier: Apache-2.0
// What is seen of one polygon of an order beside those after it.
#pragma once

#include <functional>

#include "painter/outlines.h"
#include "painter/piece_grid.h"
#include "painter/poll.h"

namespace frontmost::painter_detail {

/// Perspective: depths are not affine over the screen, their reciprocals are. Its own inverse.
[[nodiscard]] inline double affine_depth(const View& view, double depth) {
  return view.projection.orthographic ? depth : 1 / depth;
}

/// All polygons of an order on the screen, with depths affine. They are known by their places in the order, and kept in
/// slots in the order of the grid's cells: what is near on the screen is near in memory, for every other one is read
/// beside its neighbours.
class Scenery {
 public:
  Scenery(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides);

  [[nodiscard]] std::size_t count() const { return slots_.size(); }
  /// The place of the polygon in a slot.
  [[nodiscard]] std::uint32_t place(std::size_t slot) const { return slots_[slot].place; }
  [[nodiscard]] std::uint32_t slot(std::uint32_t place) const { return slot_of_[place]; }
  [[nodiscard]] Outline outline(std::size_t slot) const {
    return {corners_.data() + slots_[slot].first_corner, slots_[slot].corner_count};
  }
  /// The first of the consecutive places of the same primitive.
  [[nodiscard]] std::uint32_t first_place(std::size_t slot) const { return slots_[slot].first_place; }
  [[nodiscard]] const Extent& extent(std::size_t slot) const { return slots_[slot].extent; }
  [[nodiscard]] bool hides(std::size_t slot) const { return slots_[slot].hides; }
  /// Its entries are places.
  [[nodiscard]] const PieceGrid& grid() const { return grid_; }
  [[nodiscard]] glm::dvec2 size() const { return size_; }

 private:
  struct Slot {
    Extent extent;
    std::uint32_t place, first_place, corner_count;
    std::size_t first_corner;
    bool hides;
  };
  Scenery(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides, const std::vector<Extent>& extents);
  void fill_slots(const PaintOrder& order, const std::vector<Extent>& extents);

  const glm::dvec2 size_;
  const PieceGrid grid_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> slot_of_;
  std::vector<PaintCorner> corners_;
};

/// One polygon after another. Not for several threads at once.
class Looker {
 public:
  /// Whether a polygon is wholly behind a later one where they overlap, both by their places. None: always.
  using IsBehind = std::function<bool(std::uint32_t place, std::uint32_t cover)>;

  Looker(const Scenery& scenery, const Execution& execution, IsBehind is_behind = {})
      : scenery_(scenery), poll_(execution), is_behind_(std::move(is_behind)) {}

  /// Whether those after the polygon in a slot hide all of it, as far as that is quickly told: large ones are not.
  [[nodiscard]] bool is_all_hidden(std::size_t slot);

  /// Whether those after the polygon in a slot hide an outline together, whose first and last corners are its own.
  /// Other parts of the same primitive hide it too, also those before it: it shows nothing else than they do.
  [[nodiscard]] bool is_hidden(std::size_t slot, Outline outline);

  /// The parts of the polygon in a slot that are seen, until the next call.
  [[nodiscard]] const OutlineList& look(std::size_t slot);

 private:
  using Corners = std::vector<PaintCorner>;

  /// Looks at the part of a polygon that lies in some cells. \returns true where all of it is seen; then it was not
  /// added to seen_.
  bool is_all_seen(std::size_t slot, const Corners& outline, const PieceGrid::Range& cells);
  /// The same for what is in the cutter, where the cells are few.
  bool is_all_seen_at_once(std::size_t slot, const Extent& own, const PieceGrid::Range& cells);
  Corners part_within(const Corners& outline, const glm::dvec2& low, const glm::dvec2& high);
  /// Whether one after the polygon hides a point.
  [[nodiscard]] bool is_hidden_at(std::size_t slot, const glm::dvec2& at);
  /// What may cover: all from a place on, but the polygon's own. Nothing is split into more parts than these.
  struct Covers {
    std::uint32_t own, first;
    std::size_t most_parts;
  };
  /// Takes what is covered from what is in the cutter. \returns true when nothing is left.
  bool take_covers(const Covers& covers, const Extent& own, const PieceGrid::Range& cells);
  [[nodiscard]] bool may_hide(std::uint32_t place, std::size_t cover) const {
    return scenery_.hides(cover) && (!is_behind_ || is_behind_(place, scenery_.place(cover)));
  }
  [[nodiscard]] bool is_first_meeting(const PieceGrid::Range& cells, const Extent& cover, int x, int y) const;

  const Scenery& scenery_;
  Poll poll_;
  const IsBehind is_behind_;
  OutlineCutter cutter_;
  OutlineList seen_;
};

}  // namespace frontmost::painter_detail
