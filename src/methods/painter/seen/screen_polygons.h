// SPDX-License-Identifier: Apache-2.0
// Polygons on the screen, the input of all functions of this folder. These functions find which polygons hide others.
//
//   place in the order     1 ____________        An occluder is a polygon that nothing is seen through. It hides
//   of painting              |   2 ______|___    earlier polygons under it. The visible part of 1 is 1 without the
//                            |    |   3 _|___|_  union of the occluders 2 and 3 (visible_parts.cpp, by outlines.h).
//                            |    |    | |   | | Both may together hide a polygon that neither of them hides alone;
//                            |____|____|_|   | | a union is followed from side to side, as polygons of a mesh share
//                                 |____|_____| | sides. If no side without a neighbour crosses, nothing begins or
//                                      |_______| ends (adjacency.h).
#pragma once

#include <atomic>
#include <type_traits>

#include "base/parallel.h"
#include "base/pool.h"
#include "painter/order/piece_grid.h"
#include "painter/seen/outlines.h"

namespace frontmost::painter_detail {

/// Returns a depth that is affine over the screen, so that it can be interpolated between two corners on the screen. In
/// perspective depths are not affine, but their reciprocals are. The function is its own inverse.
[[nodiscard]] inline double affine_depth(const View& view, double depth) {
  return view.projection.orthographic ? depth : 1 / depth;
}

/// Returns the box on the screen, with depths of 0.
[[nodiscard]] inline PolygonExtent box_of(Outline outline) {
  PolygonExtent box{glm::vec2(outline[0].at), glm::vec2(outline[0].at), 0, 0};
  for (const PaintCorner& corner : outline) {
    box.low = glm::min(box.low, glm::vec2(corner.at));
    box.high = glm::max(box.high, glm::vec2(corner.at));
  }
  return box;
}

/// A polygon given by its outline alone: convex, and counter-clockwise to the eye.
struct ScreenPolygon {
  std::span<const glm::dvec2> corners;  ///< pixels; at most a few thousand beyond the picture
  std::uint32_t group = 0;              ///< consecutive polygons of one group look the same
  bool is_occluder = true;              ///< nothing is seen through it
};

/// All polygons of one painting order, projected to the screen, with affine depths. A polygon has a place in the order
/// of painting, and is stored in a slot. Slots are in the order of the grid's cells, so polygons that are near on the
/// screen are near in memory. This pays, because a polygon is always read together with its neighbours.
class ScreenPolygons {
 public:
  ScreenPolygons(const PaintOrder& order, const Occluders& occluders);
  /// Polygons of pieces, in the order of `members`.
  ScreenPolygons(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                 const Occluders& occluders);
  /// Polygons without depths.
  ScreenPolygons(std::span<const ScreenPolygon> polygons, const View& view);

  [[nodiscard]] std::size_t count() const { return slots_.size(); }
  /// Returns the place of the polygon in a slot.
  [[nodiscard]] std::uint32_t place(std::size_t slot) const { return slots_[slot].place; }
  [[nodiscard]] std::uint32_t slot(std::uint32_t place) const { return slot_of_[place]; }
  [[nodiscard]] Outline outline(std::size_t slot) const {
    return {corners_.data() + slots_[slot].first_corner, slots_[slot].corner_count};
  }
  /// All outlines one after another in the order of slots; first_corner(slot) is where a slot's outline begins.
  [[nodiscard]] Outline corners() const { return {corners_.data(), corners_.size()}; }
  [[nodiscard]] std::size_t first_corner(std::size_t slot) const { return slots_[slot].first_corner; }
  /// Returns the first of the consecutive places that have the same primitive, or the same group, as this polygon.
  [[nodiscard]] std::uint32_t first_place(std::size_t slot) const { return slots_[slot].first_place; }
  [[nodiscard]] const PolygonExtent& extent(std::size_t slot) const { return slots_[slot].extent; }
  /// Returns whether the polygon hides polygons behind it, and has an area.
  [[nodiscard]] bool is_occluder(std::size_t slot) const { return slots_[slot].hides; }
  [[nodiscard]] const PieceGrid& grid() const { return grid_; }
  /// The slots of polygons that touch a cell of the grid, in the order of their places.
  [[nodiscard]] std::span<const std::uint32_t> cell(int x, int y) const { return grid_.cell(grid_.number(x, y)); }
  [[nodiscard]] std::span<const std::uint32_t> cell_at(const glm::dvec2& at) const {
    const PieceGrid::Range cells = grid_.range({glm::vec2(at), glm::vec2(at), 0, 0});
    return cell(cells.first_x, cells.first_y);
  }
  [[nodiscard]] glm::dvec2 size() const { return size_; }

 private:
  struct Slot {
    PolygonExtent extent;
    std::size_t first_corner;
    std::uint32_t place, first_place, corner_count;
    bool hides;
  };
  /// Makes room for the corners of all slots.
  void make_room();
  [[nodiscard]] bool is_within_reach(Outline outline) const;
  /// Cuts outlines that reach so far beyond the picture that doubles lose precision in it.
  void cut_at_reach(const std::vector<std::size_t>& far_slots);
  /// A polygon's data other than its corners. Consecutive polygons with the same group number are one group.
  struct Description {
    std::uint32_t group, corner_count;
    bool is_occluder;
  };
  template <class Describe, class Copy>
  void take(const std::vector<PolygonExtent>& extents, const Describe& describe, const Copy& copy);

  const glm::dvec2 size_;
  PieceGrid grid_;
  Buffer<Slot> slots_;
  std::vector<std::uint32_t> slot_of_;
  Buffer<PaintCorner> corners_;
};

inline constexpr std::size_t slots_per_list = 1024;

/// Calls add(worker, slot, list) for every slot. `add` appends the results of the slot's polygon to a List. Each thread
/// has a worker of its own, made by new_worker(). \returns the joined list, by place. `name` names the progress.
///
/// A List has add_polygon(other, i), which adds the results of the list `other` for its i-th polygon, and
/// reserve(lists).
template <class List, class NewWorker, class Add>
List list_by_place(const ScreenPolygons& screen, const Execution& execution, const char* name,
                   const NewWorker& new_worker, const Add& add) {
  const std::size_t count = screen.count();
  std::vector<List> lists((count + slots_per_list - 1) / slots_per_list);
  Pool<typename std::invoke_result_t<NewWorker>::element_type> workers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, slots_per_list, [&](std::size_t begin, std::size_t end) {
    const auto worker = workers.borrow(new_worker);
    for (std::size_t slot = begin; slot < end; ++slot) add(*worker, slot, lists[begin / slots_per_list]);
    report_progress(execution, name, double(done += end - begin) / double(count));
  });
  List all;
  all.reserve(lists);
  for (std::uint32_t place = 0; place < count; ++place) {
    const std::size_t slot = screen.slot(place);
    all.add_polygon(lists[slot / slots_per_list], slot % slots_per_list);
  }
  return all;
}

/// Reserves room for the sum of one vector of all lists.
template <class T, class List>
void reserve_sum(std::vector<T>& all, const std::vector<List>& lists, std::vector<T> List::*member) {
  std::size_t sum = 0;
  for (const List& list : lists) sum += (list.*member).size();
  all.reserve(sum);
}

}  // namespace frontmost::painter_detail
