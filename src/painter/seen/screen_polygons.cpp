// SPDX-License-Identifier: Apache-2.0
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {
namespace {

glm::vec2 place_of(const PaintCorner& corner) { return glm::vec2(corner.at); }
glm::vec2 place_of(const glm::dvec2& corner) { return glm::vec2(corner); }

/// The box around corners, as far as it lies in the picture.
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

/// The polygons of ScreenPolygons's constructors, by place. Consecutive ones with the same group belong together.
class OrderPolygons {
 public:
  OrderPolygons(const PaintOrder& order, const Occluders& occluders) : order_(order), occluders_(occluders) {}

  [[nodiscard]] std::size_t count() const { return order_.polygons.size(); }
  [[nodiscard]] std::uint32_t group(std::size_t place) const { return order_.polygons[place].id; }
  [[nodiscard]] bool is_occluder(std::size_t place) const { return occluders_.contain(order_.polygons[place].id); }
  [[nodiscard]] std::uint32_t corner_count(std::size_t place) const { return order_.polygons[place].corner_count; }
  void copy(std::size_t place, PaintCorner* corners) const {
    for (PaintCorner corner : corners_of(place)) {
      corner.at.z = affine_depth(order_.view, corner.at.z);
      *corners++ = corner;
    }
  }
  [[nodiscard]] PolygonExtent extent(std::size_t place) const {
    return extent_within({order_.view.width, order_.view.height}, corners_of(place));
  }

 private:
  [[nodiscard]] Outline corners_of(std::size_t place) const {
    return {order_.corners.data() + order_.polygons[place].first_corner, corner_count(place)};
  }

  const PaintOrder& order_;
  const Occluders& occluders_;
};

class PiecePolygons {
 public:
  PiecePolygons(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                const Occluders& occluders)
      : pieces_(pieces), members_(members), view_(view), occluders_(occluders) {}

  [[nodiscard]] std::size_t count() const { return members_.size(); }
  [[nodiscard]] std::uint32_t group(std::size_t place) const { return pieces_.face(members_[place]).id; }
  [[nodiscard]] bool is_occluder(std::size_t place) const { return occluders_.contain(group(place)); }
  [[nodiscard]] std::uint32_t corner_count(std::size_t place) const { return pieces_.corner_count(members_[place]); }
  void copy(std::size_t place, PaintCorner* corners) const {
    pieces_.copy_corners(members_[place], corners);
    for (std::size_t i = 0; i < corner_count(place); ++i) corners[i].at.z = affine_depth(view_, corners[i].at.z);
  }
  [[nodiscard]] const PolygonExtent& extent(std::size_t place) const { return pieces_.extent(members_[place]); }

 private:
  const Pieces& pieces_;
  const std::vector<std::uint32_t>& members_;
  const View& view_;
  const Occluders& occluders_;
};

class ListedPolygons {
 public:
  ListedPolygons(std::span<const ScreenPolygon> polygons, const View& view)
      : polygons_(polygons), size_(view.width, view.height) {}

  [[nodiscard]] std::size_t count() const { return polygons_.size(); }
  [[nodiscard]] std::uint32_t group(std::size_t place) const { return polygons_[place].group; }
  [[nodiscard]] bool is_occluder(std::size_t place) const { return polygons_[place].is_occluder; }
  [[nodiscard]] std::uint32_t corner_count(std::size_t place) const {
    return std::uint32_t(polygons_[place].corners.size());
  }
  void copy(std::size_t place, PaintCorner* corners) const {
    for (const glm::dvec2& at : polygons_[place].corners) *corners++ = {glm::dvec3(at, 1), false};
  }
  [[nodiscard]] PolygonExtent extent(std::size_t place) const { return extent_within(size_, polygons_[place].corners); }

 private:
  const std::span<const ScreenPolygon> polygons_;
  const glm::vec2 size_;
};

/// Pixels beyond the picture. Sides that reach farther, as they may next to the eye's plane, are cut there: to doubles
/// so far away a place in the picture is known to 1e-9 pixel.
constexpr double kReach = 1 << 22;

/// What of a convex outline is on the lower side of a line along an axis, or on the upper one. Cut from the nearer end
/// of a side: one at 1e17 pixels has no digits for a place near the picture. Where both are so far away neither has,
/// but the cut is on the line, so that nothing is beyond it.
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

template <class Polygons>
std::vector<PolygonExtent> extents_of(const Polygons& polygons) {
  std::vector<PolygonExtent> extents;
  extents.reserve(polygons.count());
  for (std::size_t place = 0; place < polygons.count(); ++place) extents.push_back(polygons.extent(place));
  return extents;
}

/// The slots of places, by counting how many begin in each cell.
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

template <class Polygons>
ScreenPolygons::ScreenPolygons(const Polygons& polygons, const View& view)
    : size_(view.width, view.height), slots_(polygons.count()) {
  const std::vector<PolygonExtent> extents = extents_of(polygons);
  grid_ = PieceGrid(extents);
  slot_of_ = slots_of(extents, grid_);
  std::uint32_t first_place = 0;
  for (std::uint32_t place = 0; place < slot_of_.size(); ++place) {
    if (place == 0 || polygons.group(place) != polygons.group(place - 1)) first_place = place;
    slots_[slot_of_[place]] = {
        extents[place], 0, place, first_place, polygons.corner_count(place), polygons.is_occluder(place)};
  }
  make_room();
  std::vector<std::size_t> far_slots;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    polygons.copy(slots_[slot].place, corners_.data() + slots_[slot].first_corner);
    if (!is_within_reach(outline(slot))) far_slots.push_back(slot);
  }
  if (!far_slots.empty()) cut_at_reach(far_slots);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot)
    slots_[slot].hides = slots_[slot].hides && !is_flat(outline(slot));
  grid_.renumber(slot_of_);
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
    // Nothing of it is nearer: then a point of the border stands for it.
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

ScreenPolygons::ScreenPolygons(const PaintOrder& order, const Occluders& occluders)
    : ScreenPolygons(OrderPolygons(order, occluders), order.view) {}

ScreenPolygons::ScreenPolygons(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                               const Occluders& occluders)
    : ScreenPolygons(PiecePolygons(pieces, members, view, occluders), view) {}

ScreenPolygons::ScreenPolygons(std::span<const ScreenPolygon> polygons, const View& view)
    : ScreenPolygons(ListedPolygons(polygons, view), view) {}

}  // namespace frontmost::painter_detail
