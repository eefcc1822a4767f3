// SPDX-License-Identifier: Apache-2.0
// A polygon in a few cells of the grid is compared with all polygons that cover it there. A polygon in many cells is
// halved along the cells until the parts are in few cells, so that each part meets only near polygons. Parts from which
// nothing was removed are joined again.
//
//    polygon --> in few cells?  --yes-->  clipped by its covers in these cells
//                     |
//                     no --> halved along the cells, both halves likewise
//                            both wholly visible: the polygon stays as it was
//
// A cut that would leave a part narrower than 1/16 pixel is not made: the polygon stays whole there and is painted
// over, which shows the same.
#include "painter/seen/occlusion_clipper.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

/// Polygons in more cells are halved.
constexpr int kFewCells = 4;
/// Pixels. A narrower part has no room for a hem, and viewers show a hairline. So a polygon from which a cut would
/// leave a narrower part stays whole, and is painted over.
constexpr double kNarrowest = 1.0 / 16;
/// At most so many later polygons, from the front, may hide a polygon in a cell. Without a limit, a stack of n planes
/// that each leave a sliver of the next takes n * n steps.
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

bool is_apart(const PolygonExtent& a, const PolygonExtent& b) {
  return a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y;
}

}  // namespace

std::uint32_t OcclusionClipper::hider_at(std::size_t slot, const glm::dvec2& at) {
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

/// Polygons that may hide things behind or beside the polygon in a slot.
struct OcclusionClipper::Hiders {
  OcclusionClipper& clipper;
  std::size_t slot;

  [[nodiscard]] bool may_hide(std::uint32_t other) const {
    clipper.poll_.count();
    const ScreenPolygons& screen = clipper.screen_;
    return screen.place(other) >= screen.first_place(slot) && other != slot && clipper.may_hide(slot, other);
  }
  [[nodiscard]] std::uint32_t at(const glm::dvec2& place) const { return clipper.hider_at(slot, place); }
};

OccluderUnion::Found OcclusionClipper::spread(std::size_t slot, Outline outline, std::uint32_t hider,
                                              const glm::dvec2& at) {
  // The hider may have been found for a point next to `at`.
  if (!is_within(screen_.outline(hider), at, 0)) return OccluderUnion::Found::unknown;
  union_.set(outline);
  return union_.spread(hider, Hiders{*this, slot});
}

/// Most polygons are not hidden, and their middles tell.
bool OcclusionClipper::is_hidden(std::size_t slot) {
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
  return is_few(cells) && take_covers(slot, screen_.place(slot) + 1, extent, cells);
}

const OutlineList& OcclusionClipper::clip(std::size_t slot) {
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

bool OcclusionClipper::is_all_seen(std::size_t slot, const Corners& outline, const PieceGrid::Range& cells) {
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

OcclusionClipper::Corners OcclusionClipper::part_within(const Corners& outline, const glm::dvec2& low,
                                                        const glm::dvec2& high) {
  cutter_.begin(outline);
  cutter_.keep_within(low, high);
  return cutter_.count() == 0 ? Corners() : Corners(cutter_[0].begin(), cutter_[0].end());
}

bool OcclusionClipper::is_all_seen_at_once(std::size_t slot, const PolygonExtent& own, const PieceGrid::Range& cells) {
  cutter_.forget_changes();
  const Corners whole(cutter_[0].begin(), cutter_[0].end());
  take_covers(slot, screen_.place(slot) + 1, own, cells);
  if (!cutter_.is_changed()) return true;
  for (std::size_t i = 0; i < cutter_.count(); ++i)
    if (is_narrow(cutter_[i], kNarrowest)) {
      seen_.add(whole);
      return false;
    }
  for (std::size_t i = 0; i < cutter_.count(); ++i) seen_.add(cutter_[i]);
  return false;
}

/// Boxes that overlap meet in several cells. The first of these is the one in which the later box begins, on each axis.
bool OcclusionClipper::is_first_meeting(const PieceGrid::Range& cells, const PolygonExtent& cover, int x, int y) const {
  const PieceGrid::Range other = screen_.grid().range(cover);
  return x == std::max(cells.first_x, other.first_x) && y == std::max(cells.first_y, other.first_y);
}

bool OcclusionClipper::take_covers(std::size_t slot, std::uint32_t first_place, const PolygonExtent& own,
                                   const PieceGrid::Range& cells) {
  const bool is_one_cell = cells.first_x == cells.last_x && cells.first_y == cells.last_y;
  for (int y = cells.first_y; y <= cells.last_y; ++y)
    for (int x = cells.first_x; x <= cells.last_x; ++x) {
      const std::span<const std::uint32_t> cell = screen_.cell(x, y);
      std::size_t count = 0;
      for (std::size_t i = cell.size(); i-- > 0 && count < kMostCovers;) {
        const std::uint32_t other = cell[i];
        if (screen_.place(other) < first_place) break;
        if (other == slot) continue;
        poll_.count();
        const PolygonExtent& e = screen_.extent(other);
        if (is_apart(e, own) || (!is_one_cell && !is_first_meeting(cells, e, x, y))) continue;
        if (!may_hide(slot, other)) continue;
        ++count;
        const Cover cover{screen_.outline(other), glm::dvec2(e.low), glm::dvec2(e.high)};
        poll_.count(OutlineClipper::steps_of_part * cutter_.count());
        if (cutter_.subtract(cover, cutter_.count() <= OutlineClipper::most_parts)) return true;
      }
    }
  return false;
}

}  // namespace frontmost::painter_detail
