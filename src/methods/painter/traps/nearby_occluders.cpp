// SPDX-License-Identifier: Apache-2.0
// Occluders around a polygon are listed once, from the cells that its box touches; each question then searches the
// list. A polygon that covers a large part of the grid would list most of the picture. So each of its questions makes a
// list of its own, for the small box in question.
//
// The nearest in the order come first, and at most 4,096 of them are taken from a cell: in a stack of planes thousands
// lie under each other. A trap that the first 4,096 do not hide is not made.
#include "painter/traps/nearby_occluders.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

/// A polygon in more cells of the grid may have thousands of others around it: each outline then has a list of its own.
constexpr int kMostCells = 64;
/// At most so many later polygons, from the front, may hide the surroundings of a polygon in a cell: a stack of n
/// planes would take n * n steps.
constexpr std::size_t kMostHiders = 4096;

template <class A, class B>
bool is_apart(const A& a, const B& b) {
  return a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y;
}

/// Whether an outline has points next to the outer side of a way, at least OutlineClipper::thin away from it.
bool is_beside(Outline outline, const glm::dvec2& from, const glm::dvec2& way) {
  const double length = glm::length(way), thin = OutlineClipper::thin * length;
  double near = std::numeric_limits<double>::infinity(), far = -near, first = near, last = -near;
  for (const PaintCorner& corner : outline) {
    const glm::dvec2 at = glm::dvec2(corner.at) - from;
    const double out = way.x * at.y - way.y * at.x, along = glm::dot(way, at);
    near = std::min(near, out);
    far = std::max(far, out);
    first = std::min(first, along);
    last = std::max(last, along);
  }
  return near <= thin && far > thin && first < length * length && last > 0;
}

}  // namespace

void NearbyOccluders::begin(std::size_t slot, double reach) {
  slot_ = slot;
  PolygonExtent box = box_of(screen_.outline(slot));
  box.low -= float(reach);
  box.high += float(reach);
  const PieceGrid::Range cells = screen_.grid().range(box);
  is_listed_ = (cells.last_x - cells.first_x + 1) * (cells.last_y - cells.first_y + 1) <= kMostCells;
  if (is_listed_) list(box);
}

void NearbyOccluders::list(const PolygonExtent& box) {
  if (++turn_ == 0) {
    std::fill(listed_.begin(), listed_.end(), 0);
    turn_ = 1;
  }
  hiders_.clear();
  const std::uint32_t first_place = screen_.first_place(slot_);
  const PieceGrid::Range cells = screen_.grid().range(box);
  for (int y = cells.first_y; y <= cells.last_y; ++y)
    for (int x = cells.first_x; x <= cells.last_x; ++x) {
      const std::span<const std::uint32_t> cell = screen_.cell(x, y);
      std::size_t count = 0;
      for (std::size_t i = cell.size(); i-- > 0 && count < kMostHiders && screen_.place(cell[i]) >= first_place;) {
        const std::uint32_t other = cell[i];
        if (listed_[other] == turn_) continue;
        listed_[other] = turn_;
        poll_.count();
        const PolygonExtent& e = screen_.extent(other);
        if (other == slot_ || is_apart(e, box) || !screen_.is_occluder(other)) continue;
        hiders_.push_back({e.low, e.high, other});
        ++count;
      }
    }
}

template <class Visit>
bool NearbyOccluders::any_of(const PolygonExtent& box, const Visit& visit) {
  if (!is_listed_) list(box);
  return std::any_of(hiders_.begin(), hiders_.end(), [&](const Hider& hider) {
    if (is_apart(hider, box)) return false;
    poll_.count();
    return visit(hider);
  });
}

bool NearbyOccluders::are_open_beside(std::size_t side) const {
  const std::uint32_t across = adjacency_.across(screen_.first_corner(slot_) + side);
  if (across == no_index) return false;
  const bool may_hide = screen_.place(across) >= screen_.first_place(slot_) && screen_.is_occluder(across);
  // Other polygons begin beyond a polygon without an area.
  return across == slot_ || (!may_hide && !is_flat(screen_.outline(across)));
}

bool NearbyOccluders::hide_beside(const glm::dvec2& from, const glm::dvec2& to) {
  PolygonExtent box{glm::min(glm::vec2(from), glm::vec2(to)), glm::max(glm::vec2(from), glm::vec2(to)), 0, 0};
  box.low -= float(2 * OutlineClipper::thin);
  box.high += float(2 * OutlineClipper::thin);
  return any_of(box, [&](const Hider& hider) { return is_beside(screen_.outline(hider.slot), from, to - from); });
}

const OutlineClipper& NearbyOccluders::open_parts(Outline outline) {
  cutter_.begin(outline);
  any_of(box_of(outline), [&](const Hider& hider) {
    const Cover cover{screen_.outline(hider.slot), glm::dvec2(hider.low), glm::dvec2(hider.high)};
    poll_.count(OutlineClipper::steps_of_part * cutter_.count());
    return cutter_.subtract(cover, cutter_.count() <= OutlineClipper::most_parts);
  });
  return cutter_;
}

}  // namespace frontmost::painter_detail
