// SPDX-License-Identifier: Apache-2.0
// Polygons come from three sources: an order, a list of pieces, or outlines alone. Each source provides the box, the
// description and the corners of the polygon at a place; everything else is the same. Slots are assigned by counting
// how many polygons begin in each cell of the grid.
//
//    place in the order   0   1   2   3   4        painted in this order
//    first cell           7   2   7   0   2
//    slot                 3   1   4   0   2        by cell, then by place
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {
namespace {

glm::vec2 place_of(const PaintCorner& corner) { return glm::vec2(corner.at); }
glm::vec2 place_of(const glm::dvec2& corner) { return glm::vec2(corner); }

/// Returns the box around corners, as far as it lies in the picture.
template <class Corner>
PolygonExtent extent_within(const glm::vec2& size, std::span<const Corner> corners) {
  PolygonExtent extent{size, glm::vec2(0), 0, 0};
  for (const Corner& corner : corners) {
    const glm::vec2 at = place_of(corner);
    extent.low = glm::min(extent.low, at);
    extent.high = glm::max(extent.high, at);
  }
  extent.low = glm::max(extent.low, glm::vec2(0));
  extent.high = glm::min(extent.high, size);
  return extent;
}

/// In pixels beyond the picture. Polygons next to the eye's plane may reach farther, and are cut at this distance, at
/// which doubles still give a point of the picture to 1e-9 pixel.
constexpr double kReach = 1 << 22;

/// Returns the part of a convex outline on the lower, or the upper, side of the line at `border` on an axis. The cut is
/// computed from the nearer end of a side, because an end at 1e17 pixels has no digits for a point near the picture. If
/// both ends are so far away, the cut is inaccurate, but it is on the line, so nothing lies beyond the line.
std::vector<PaintCorner> cut_along_axis(Outline outline, int axis, double border, bool is_lower) {
  std::vector<PaintCorner> left;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const PaintCorner &corner = outline[i], &after = outline[i + 1 == outline.size() ? 0 : i + 1];
    const double a = corner.at[axis] - border, b = after.at[axis] - border;
    const auto is_left = [&](double beyond) { return is_lower ? beyond <= 0 : beyond >= 0; };
    if (is_left(a)) left.push_back(corner);
    if (is_left(a) == is_left(b)) continue;
    const bool is_nearer = std::abs(a) < std::abs(b);
    const glm::dvec3 &near = is_nearer ? corner.at : after.at, &far = is_nearer ? after.at : corner.at;
    PaintCorner cut{near + (far - near) * (is_nearer ? a / (a - b) : b / (b - a)), is_left(a) || corner.is_cut};
    cut.at[axis] = border;
    left.push_back(cut);
  }
  return left;
}

/// Returns the slots of places, found by counting how many polygons begin in each cell.
std::vector<std::uint32_t> slots_of(const std::vector<PolygonExtent>& extents, const PieceGrid& grid) {
  std::vector<std::uint32_t> slots;
  slots.reserve(extents.size());
  std::vector<std::uint32_t> next(grid.cell_count() + 1, 0);
  for (const PolygonExtent& extent : extents) {
    const PieceGrid::Range cells = grid.range(extent);
    slots.push_back(std::uint32_t(grid.number(cells.first_x, cells.first_y)));
    ++next[slots.back() + 1];
  }
  for (std::size_t cell = 1; cell < next.size(); ++cell) next[cell] += next[cell - 1];
  for (std::uint32_t& slot : slots) slot = next[slot]++;
  return slots;
}

}  // namespace

/// Takes polygons by their places: `extents` are their boxes, describe(place) returns a Description, and copy(place,
/// corners) sets the corners.
template <class Describe, class Copy>
void ScreenPolygons::take(const std::vector<PolygonExtent>& extents, const Describe& describe, const Copy& copy) {
  slots_ = Buffer<Slot>(extents.size());
  grid_ = PieceGrid(extents);
  slot_of_ = slots_of(extents, grid_);
  std::uint32_t first_place = 0, group = 0;
  for (std::uint32_t place = 0; place < slot_of_.size(); ++place) {
    const Description polygon = describe(place);
    if (place == 0 || polygon.group != group) first_place = place;
    group = polygon.group;
    slots_[slot_of_[place]] = {extents[place], 0, place, first_place, polygon.corner_count, polygon.is_occluder};
  }
  make_room();
  std::vector<std::size_t> far_slots;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    copy(slots_[slot].place, corners_.data() + slots_[slot].first_corner);
    if (!is_within_reach(outline(slot))) far_slots.push_back(slot);
  }
  if (!far_slots.empty()) cut_at_reach(far_slots);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot)
    slots_[slot].hides = slots_[slot].hides && !is_flat(outline(slot));
  grid_.renumber(slot_of_);
}

ScreenPolygons::ScreenPolygons(const PaintOrder& order, const Occluders& occluders)
    : size_(order.view.width, order.view.height) {
  const auto corners_of = [&](const PaintPolygon& polygon) {
    return Outline(order.corners.data() + polygon.first_corner, polygon.corner_count);
  };
  std::vector<PolygonExtent> extents;
  extents.reserve(order.polygons.size());
  for (const PaintPolygon& polygon : order.polygons) extents.push_back(extent_within(size_, corners_of(polygon)));
  take(
      extents,
      [&](std::size_t place) {
        const PaintPolygon& polygon = order.polygons[place];
        return Description{polygon.id, polygon.corner_count, occluders.contain(polygon.id)};
      },
      [&](std::size_t place, PaintCorner* corners) {
        for (const PaintCorner& from : corners_of(order.polygons[place]))
          *corners++ = {{from.at.x, from.at.y, affine_depth(order.view, from.at.z)}, from.is_cut};
      });
}

ScreenPolygons::ScreenPolygons(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                               const Occluders& occluders)
    : size_(view.width, view.height) {
  std::vector<PolygonExtent> extents;
  extents.reserve(members.size());
  for (const std::uint32_t piece : members) extents.push_back(pieces.extent(piece));
  take(
      extents,
      [&](std::size_t place) {
        const PrimitiveId id = pieces.face(members[place]).id;
        return Description{id, pieces.corner_count(members[place]), occluders.contain(id)};
      },
      [&](std::size_t place, PaintCorner* corners) {
        pieces.copy_corners(members[place], corners);
        for (std::size_t i = 0; i < pieces.corner_count(members[place]); ++i)
          corners[i].at.z = affine_depth(view, corners[i].at.z);
      });
}

ScreenPolygons::ScreenPolygons(std::span<const ScreenPolygon> polygons, const View& view)
    : size_(view.width, view.height) {
  std::vector<PolygonExtent> extents;
  extents.reserve(polygons.size());
  for (const ScreenPolygon& polygon : polygons) extents.push_back(extent_within(size_, polygon.corners));
  take(
      extents,
      [&](std::size_t place) {
        const ScreenPolygon& polygon = polygons[place];
        return Description{polygon.group, std::uint32_t(polygon.corners.size()), polygon.is_occluder};
      },
      [&](std::size_t place, PaintCorner* corners) {
        for (const glm::dvec2& at : polygons[place].corners) *corners++ = {glm::dvec3(at, 1), false};
      });
}

void ScreenPolygons::make_room() {
  std::size_t corners = 0;
  for (Slot& slot : slots_) {
    slot.first_corner = corners;
    corners += slot.corner_count;
  }
  corners_ = Buffer<PaintCorner>(corners);
}

bool ScreenPolygons::is_within_reach(Outline outline) const {
  return std::all_of(outline.begin(), outline.end(), [&](const PaintCorner& corner) {
    const glm::dvec2 at(corner.at);
    return glm::all(glm::greaterThanEqual(at, glm::dvec2(-kReach))) && glm::all(glm::lessThanEqual(at, size_ + kReach));
  });
}

void ScreenPolygons::cut_at_reach(const std::vector<std::size_t>& far_slots) {
  std::vector<std::vector<PaintCorner>> parts;
  for (const std::size_t slot : far_slots) {
    std::vector<PaintCorner> part(outline(slot).begin(), outline(slot).end());
    for (int axis = 0; axis < 2; ++axis) {
      part = cut_along_axis(part, axis, -kReach, false);
      part = cut_along_axis(part, axis, size_[axis] + kReach, true);
    }
    // If no part of the outline is within reach, a point of the border stands for it.
    if (part.size() < 3) {
      part.assign(3, outline(slot)[0]);
      for (PaintCorner& corner : part)
        corner.at = glm::clamp(corner.at, glm::dvec3(glm::dvec2(-kReach), corner.at.z),
                               glm::dvec3(size_ + kReach, corner.at.z));
    }
    parts.push_back(std::move(part));
  }
  const std::vector<Slot> before(slots_.begin(), slots_.end());
  const Buffer<PaintCorner> corners = std::move(corners_);
  for (std::size_t i = 0; i < far_slots.size(); ++i) slots_[far_slots[i]].corner_count = std::uint32_t(parts[i].size());
  make_room();
  for (std::size_t slot = 0, far = 0; slot < slots_.size(); ++slot) {
    const bool is_far = far < far_slots.size() && far_slots[far] == slot;
    const PaintCorner* const from = is_far ? parts[far++].data() : corners.data() + before[slot].first_corner;
    std::copy(from, from + slots_[slot].corner_count, corners_.data() + slots_[slot].first_corner);
  }
}

}  // namespace frontmost::painter_detail
