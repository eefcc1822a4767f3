// SPDX-License-Identifier: Apache-2.0
// Finds the visible parts of polygons. Each polygon is clipped by the union of the occluders in front of it:
// visible_parts() clips the polygons of an order, without_hidden() clips polygons that have no order yet. A polygon in
// few cells of the grid is clipped by the occluders in these cells. Any other polygon is halved along the cells; halves
// that are wholly visible are joined again.
//
// Inside a machine nearly everything is hidden. Ordering the hidden parts would take most of the time, because parts
// pass through each other there. One of Newell's plane tests often tells which of two pieces is in front of the other
// wherever they overlap, so that no order is needed. A hidden piece may count as an occluder of others: at any point of
// the screen nothing hides the foremost piece, so not all pieces are left out.
#include <algorithm>
#include <functional>

#include "painter/seen/adjacency.h"
#include "painter/stages.h"

namespace frontmost {
namespace painter_detail {
namespace {

/// A polygon in more cells than this is halved.
constexpr int kFewCells = 4;
/// In pixels. A narrower part has no room for a trap, and viewers show a hairline. So a polygon from which a cut would
/// leave a narrower part stays whole, and is painted over.
constexpr double kNarrowest = 1.0 / 16;
/// The most later polygons of a cell, from the front-most on, that are tried as covers of a polygon. Without a limit, a
/// stack of n planes that each leave a sliver of the next takes n * n steps.
constexpr std::size_t kMostCovers = 4096;

/// The cells in two halves along the longer axis.
struct Halves {
  int axis;
  PieceGrid::Range low, high;
};
Halves halve(const PieceGrid::Range& cells) {
  const int columns = cells.last_x - cells.first_x + 1, rows = cells.last_y - cells.first_y + 1;
  Halves halves{columns >= rows ? 0 : 1, cells, cells};
  if (halves.axis == 0) {
    halves.low.last_x = cells.first_x + columns / 2 - 1;
    halves.high.first_x = halves.low.last_x + 1;
  } else {
    halves.low.last_y = cells.first_y + rows / 2 - 1;
    halves.high.first_y = halves.low.last_y + 1;
  }
  return halves;
}

bool is_few(const PieceGrid::Range& cells) {
  return (cells.last_x - cells.first_x + 1) * (cells.last_y - cells.first_y + 1) <= kFewCells;
}

/// Clips one polygon after another. Not for several threads at once.
class OcclusionClipper {
 public:
  /// Returns whether a polygon is wholly behind a later one where they overlap; both are given by their places. Without
  /// such a function the order decides: the earlier polygon is always behind.
  using IsBehind = std::function<bool(std::uint32_t place, std::uint32_t cover)>;

  OcclusionClipper(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort,
                   IsBehind is_behind = {})
      : screen_(screen), poll_(effort), is_behind_(std::move(is_behind)), union_(screen, adjacency) {}

  /// Returns whether the polygon in a slot is wholly hidden. Also false if the answer would take long. Most polygons
  /// are not hidden, and a look at their middle suffices.
  [[nodiscard]] bool is_hidden(std::size_t slot) {
    cutter_.begin(screen_.outline(slot));
    cutter_.keep_within(glm::dvec2(0), screen_.size());
    if (cutter_.count() == 0) return false;
    const Outline outline = cutter_[0];
    glm::dvec2 middle(0);
    for (const PaintCorner& corner : outline) middle += glm::dvec2(corner.at) / double(outline.size());
    const std::uint32_t hider = hider_at(slot, middle);
    if (hider == no_index) return false;
    const OccluderUnion::Found found = spread(slot, outline, hider, middle);
    if (found != OccluderUnion::Found::unknown) return found == OccluderUnion::Found::hidden;
    const PolygonExtent& extent = screen_.extent(slot);
    const PieceGrid::Range cells = screen_.grid().range(extent);
    return is_few(cells) && take_covers(slot, extent, cells);
  }

  /// Returns the visible parts of the polygon in a slot; valid until the next call.
  [[nodiscard]] const OutlineList& clip(std::size_t slot) {
    seen_.clear();
    const PolygonExtent& extent = screen_.extent(slot);
    if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y)) return seen_;
    const PieceGrid::Range cells = screen_.grid().range(extent);
    cutter_.begin(screen_.outline(slot));
    cutter_.keep_within(glm::dvec2(0), screen_.size());
    if (cutter_.count() == 0) return seen_;
    if (is_few(cells)) {
      if (is_all_seen_at_once(slot, extent, cells)) seen_.add(cutter_[0]);
      return seen_;
    }
    const Corners whole(cutter_[0].begin(), cutter_[0].end());
    if (is_all_seen(slot, whole, cells)) seen_.add(whole);
    return seen_;
  }

 private:
  using Corners = std::vector<PaintCorner>;

  /// Clips the part of a polygon that lies in some cells, and adds the visible parts to seen_. \returns true if all of
  /// it is visible; nothing is added then.
  bool is_all_seen(std::size_t slot, const Corners& outline, const PieceGrid::Range& cells) {
    if (is_few(cells)) {
      cutter_.begin(outline);
      return is_all_seen_at_once(slot, box_of(outline), cells);
    }
    const auto [axis, low, high] = halve(cells);
    glm::dvec2 low_end = screen_.size(), high_begin(0);
    low_end[axis] = high_begin[axis] = screen_.grid().box(high.first_x, high.first_y).low[axis];
    const Corners low_part = part_within(outline, glm::dvec2(0), low_end),
                  high_part = part_within(outline, high_begin, screen_.size());
    const bool sees_low = low_part.empty() || is_all_seen(slot, low_part, low);
    const bool sees_high = high_part.empty() || is_all_seen(slot, high_part, high);
    if (sees_low && sees_high) return true;
    if (sees_low && !low_part.empty()) seen_.add(low_part);
    if (sees_high && !high_part.empty()) seen_.add(high_part);
    return false;
  }
  /// is_all_seen() for the outline in the cutter, if it lies in few cells.
  bool is_all_seen_at_once(std::size_t slot, const PolygonExtent& own, const PieceGrid::Range& cells) {
    cutter_.forget_changes();
    const Corners whole(cutter_[0].begin(), cutter_[0].end());
    take_covers(slot, own, cells);
    if (!cutter_.is_changed()) return true;
    for (std::size_t i = 0; i < cutter_.count(); ++i)
      if (is_narrow(cutter_[i], kNarrowest)) {
        seen_.add(whole);
        return false;
      }
    for (std::size_t i = 0; i < cutter_.count(); ++i) seen_.add(cutter_[i]);
    return false;
  }
  Corners part_within(const Corners& outline, const glm::dvec2& low, const glm::dvec2& high) {
    cutter_.begin(outline);
    cutter_.keep_within(low, high);
    return cutter_.count() == 0 ? Corners() : Corners(cutter_[0].begin(), cutter_[0].end());
  }
  /// The polygons that may hide the polygon in a slot, as OccluderUnion::spread() asks for them.
  struct Hiders {
    OcclusionClipper& clipper;
    std::size_t slot;

    [[nodiscard]] bool may_hide(std::uint32_t other) const {
      clipper.poll_.count();
      const ScreenPolygons& screen = clipper.screen_;
      return screen.place(other) >= screen.first_place(slot) && other != slot && clipper.may_hide(slot, other);
    }
    [[nodiscard]] std::uint32_t at(const glm::dvec2& place) const { return clipper.hider_at(slot, place); }
  };
  /// Returns the slot of a polygon that hides a point, or points next to it, or no_index if there is none.
  [[nodiscard]] std::uint32_t hider_at(std::size_t slot, const glm::dvec2& at) {
    const std::uint32_t first_place = screen_.first_place(slot);
    const std::span<const std::uint32_t> cell = screen_.cell_at(at);
    for (std::size_t i = cell.size(); i-- > 0 && screen_.place(cell[i]) >= first_place;) {
      const std::uint32_t other = cell[i];
      if (other == slot) continue;
      poll_.count();
      const PolygonExtent& e = screen_.extent(other);
      if (at.x >= e.low.x && at.x <= e.high.x && at.y >= e.low.y && at.y <= e.high.y &&
          is_within(screen_.outline(other), at, OutlineClipper::thin) && may_hide(slot, other))
        return other;
    }
    return no_index;
  }
  /// Returns whether an outline is hidden, given that `hider` hides the point `at`.
  OccluderUnion::Found spread(std::size_t slot, Outline outline, std::uint32_t hider, const glm::dvec2& at) {
    // The hider may have been found for a point next to `at`.
    if (!is_within(screen_.outline(hider), at, 0)) return OccluderUnion::Found::unknown;
    union_.set(outline);
    return union_.spread(hider, Hiders{*this, slot});
  }
  /// Subtracts the later polygons in some cells from the outline in the cutter. \returns true if nothing is left.
  bool take_covers(std::size_t slot, const PolygonExtent& own, const PieceGrid::Range& cells) {
    const bool is_one_cell = cells.first_x == cells.last_x && cells.first_y == cells.last_y;
    for (int y = cells.first_y; y <= cells.last_y; ++y)
      for (int x = cells.first_x; x <= cells.last_x; ++x) {
        const std::span<const std::uint32_t> cell = screen_.cell(x, y);
        std::size_t count = 0;
        for (std::size_t i = cell.size(); i-- > 0 && count < kMostCovers;) {
          const std::uint32_t other = cell[i];
          if (screen_.place(other) <= screen_.place(slot)) break;
          poll_.count();
          const PolygonExtent& e = screen_.extent(other);
          if (is_apart(e, own) || (!is_one_cell && !is_first_meeting(cells, e, x, y))) continue;
          if (!may_hide(slot, other)) continue;
          ++count;
          const Cover cover{screen_.outline(other), glm::dvec2(e.low), glm::dvec2(e.high)};
          poll_.count(cutter_.count());
          if (cutter_.subtract(cover)) return true;
        }
      }
    return false;
  }
  [[nodiscard]] bool may_hide(std::size_t slot, std::size_t cover) const {
    return screen_.is_occluder(cover) && (!is_behind_ || is_behind_(screen_.place(slot), screen_.place(cover)));
  }
  /// Returns whether (x, y) is the first of the cells in which two boxes meet. On each axis, this is the cell in which
  /// the later of the two boxes begins.
  [[nodiscard]] bool is_first_meeting(const PieceGrid::Range& cells, const PolygonExtent& cover, int x, int y) const {
    const PieceGrid::Range other = screen_.grid().range(cover);
    return x == std::max(cells.first_x, other.first_x) && y == std::max(cells.first_y, other.first_y);
  }

  const ScreenPolygons& screen_;
  Poll poll_;
  const IsBehind is_behind_;
  OccluderUnion union_;
  OutlineClipper cutter_;
  OutlineList seen_;
};

/// Returns whether one piece is certainly in front of another wherever they overlap on the screen.
bool is_before(const Pieces& pieces, std::uint32_t piece, std::uint32_t other) {
  if (pieces.extent(piece).farthest <= pieces.extent(other).nearest) return true;
  bool is_flat = false;
  if (pieces.keeps_off(piece, pieces.face(other).plane(), -1, is_flat))
    return !is_flat || pieces.face(piece).id < pieces.face(other).id;
  return pieces.keeps_off(other, pieces.face(piece).plane(), 1, is_flat);
}

/// The parts of consecutive polygons.
struct PartList {
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
  std::vector<std::size_t> ends;  ///< by polygon: end of its parts

  void add(PrimitiveId id, Outline outline, const View& view) {
    polygons.push_back({id, std::uint32_t(outline.size()), corners.size()});
    for (const PaintCorner& corner : outline)
      corners.push_back({{corner.at.x, corner.at.y, affine_depth(view, corner.at.z)}, corner.is_cut});
  }
  void reserve(const std::vector<PartList>& lists) {
    reserve_sum(polygons, lists, &PartList::polygons);
    reserve_sum(corners, lists, &PartList::corners);
  }
  void add_polygon(const PartList& other, std::size_t number) {
    for (std::size_t i = number == 0 ? 0 : other.ends[number - 1]; i < other.ends[number]; ++i) {
      PaintPolygon part = other.polygons[i];
      const PaintCorner* const from = other.corners.data() + part.first_corner;
      part.first_corner = corners.size();
      polygons.push_back(part);
      corners.insert(corners.end(), from, from + part.corner_count);
    }
  }
};

}  // namespace

Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                        const Occluders& occluders, PaintEffort& effort) {
  const Execution& execution = effort.execution();
  // The nearest piece comes last, so a piece that is in front of another mostly comes after it.
  std::vector<std::uint32_t> sorted = members;
  sort_by_nearest(pieces, sorted, execution);
  const ScreenPolygons screen(pieces, sorted, view, occluders);
  const Adjacency adjacency(screen);
  const auto is_behind = [&](std::uint32_t place, std::uint32_t cover) {
    return is_before(pieces, sorted[cover], sorted[place]);
  };
  std::vector<std::uint8_t> is_hidden(screen.count(), 0);
  Pool<OcclusionClipper> clippers;
  parallel_for(execution, screen.count(), slots_per_list, [&](std::size_t begin, std::size_t end) {
    const auto clipper =
        clippers.borrow([&] { return std::make_unique<OcclusionClipper>(screen, adjacency, effort, is_behind); });
    for (std::size_t slot = begin; slot < end; ++slot) is_hidden[slot] = clipper->is_hidden(slot);
  });
  const std::vector<std::uint8_t> is_unoverlapped = find_unoverlapped(screen, adjacency, is_hidden, effort);
  Unhidden left;
  std::vector<std::uint8_t> is_other(pieces.size(), 0);
  for (std::size_t slot = 0; slot < screen.count(); ++slot) {
    const std::uint32_t piece = sorted[screen.place(slot)];
    if (is_unoverlapped[slot]) left.unoverlapped.push_back(piece);
    is_other[piece] = !is_hidden[slot] && !is_unoverlapped[slot];
  }
  for (const std::uint32_t piece : members)
    if (is_other[piece]) left.others.push_back(piece);
  return left;
}

}  // namespace painter_detail

VisibleParts visible_parts(const PaintOrder& order, const Occluders& occluders, const Execution& execution) {
  using namespace painter_detail;
  const IeeeScope ieee;
  const ScreenPolygons screen(order, occluders);
  const Adjacency adjacency(screen);
  PaintEffort effort(execution, screen.count());
  const std::vector<std::uint8_t> is_unoverlapped = find_unoverlapped(screen, adjacency, {}, effort);
  PartList parts = list_by_place<PartList>(
      screen, execution, "visible parts", [&] { return std::make_unique<OcclusionClipper>(screen, adjacency, effort); },
      [&](OcclusionClipper& clipper, std::size_t slot, PartList& list) {
        const PrimitiveId id = order.polygons[screen.place(slot)].id;
        if (is_unoverlapped[slot]) {
          list.add(id, screen.outline(slot), order.view);
        } else {
          const OutlineList& seen = clipper.clip(slot);
          for (std::size_t i = 0; i < seen.count(); ++i) list.add(id, seen[i], order.view);
        }
        list.ends.push_back(list.polygons.size());
      });
  return {order.view, std::move(parts.polygons), std::move(parts.corners)};
}

}  // namespace frontmost
