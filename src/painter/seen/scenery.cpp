// SPDX-License-Identifier: Apache-2.0
#include "painter/seen/scenery.h"

#include "painter/emit.h"

namespace frontmost::painter_detail {
namespace {

class OrderPolygons {
 public:
  explicit OrderPolygons(const PaintOrder& order) : order_(order), most_(order.view.width, order.view.height) {}

  [[nodiscard]] std::size_t count() const { return order_.polygons.size(); }
  [[nodiscard]] PrimitiveId id(std::size_t place) const { return order_.polygons[place].id; }
  [[nodiscard]] std::uint32_t corner_count(std::size_t place) const { return order_.polygons[place].corner_count; }
  void copy(std::size_t place, PaintCorner* corners) const {
    const PaintCorner* const from = order_.corners.data() + order_.polygons[place].first_corner;
    std::copy(from, from + corner_count(place), corners);
  }
  [[nodiscard]] Extent extent(std::size_t place) const {
    Extent extent{most_, glm::vec2(0), 0, 0};
    for (std::size_t i = 0; i < corner_count(place); ++i) {
      const glm::vec2 at(order_.corners[order_.polygons[place].first_corner + i].at);
      extent.low = glm::min(extent.low, at);
      extent.high = glm::max(extent.high, at);
    }
    extent.low = glm::max(extent.low, glm::vec2(0));
    extent.high = glm::min(extent.high, most_);
    return extent;
  }

 private:
  const PaintOrder& order_;
  const glm::vec2 most_;
};

class PiecePolygons {
 public:
  PiecePolygons(const Pieces& pieces, const std::vector<std::uint32_t>& members) : pieces_(pieces), members_(members) {}

  [[nodiscard]] std::size_t count() const { return members_.size(); }
  [[nodiscard]] PrimitiveId id(std::size_t place) const { return pieces_.face(members_[place]).id; }
  [[nodiscard]] std::uint32_t corner_count(std::size_t place) const {
    return painter_detail::corner_count(pieces_, members_[place]);
  }
  void copy(std::size_t place, PaintCorner* corners) const { emit(pieces_, members_[place], corners); }
  [[nodiscard]] const Extent& extent(std::size_t place) const { return pieces_.extent(members_[place]); }

 private:
  const Pieces& pieces_;
  const std::vector<std::uint32_t>& members_;
};

template <class Polygons>
std::vector<Extent> extents_of(const Polygons& polygons) {
  std::vector<Extent> extents;
  extents.reserve(polygons.count());
  for (std::size_t place = 0; place < polygons.count(); ++place) extents.push_back(polygons.extent(place));
  return extents;
}

/// The slots of places, by counting how many begin in each cell.
std::vector<std::uint32_t> slots_of(const std::vector<Extent>& extents, const PieceGrid& grid) {
  std::vector<std::uint32_t> slots;
  slots.reserve(extents.size());
  std::vector<std::uint32_t> next(grid.cell_count() + 1, 0);
  for (const Extent& extent : extents) {
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
Scenery::Scenery(const Polygons& polygons, const View& view, const Hides& hides)
    : size_(view.width, view.height), slots_(polygons.count()) {
  const std::vector<Extent> extents = extents_of(polygons);
  grid_ = PieceGrid(extents);
  slot_of_ = slots_of(extents, grid_);
  std::uint32_t first_place = 0;
  for (std::uint32_t place = 0; place < slot_of_.size(); ++place) {
    const PrimitiveId id = polygons.id(place);
    if (place == 0 || id != polygons.id(place - 1)) first_place = place;
    slots_[slot_of_[place]] = {extents[place],     0, place, first_place, polygons.corner_count(place),
                               !hides || hides(id)};
  }
  std::size_t corners = 0;
  for (Slot& slot : slots_) {
    slot.first_corner = corners;
    corners += slot.corner_count;
  }
  corners_ = Buffer<PaintCorner>(corners);
  for (Slot& slot : slots_) {
    PaintCorner* const first = corners_.data() + slot.first_corner;
    polygons.copy(slot.place, first);
    slot.hides = slot.hides && !is_flat({first, slot.corner_count});
  }
  for (PaintCorner& corner : corners_) corner.at.z = affine_depth(view, corner.at.z);
  grid_.renumber(slot_of_);
}

Scenery::Scenery(const PaintOrder& order, const Hides& hides) : Scenery(OrderPolygons(order), order.view, hides) {}

Scenery::Scenery(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view, const Hides& hides)
    : Scenery(PiecePolygons(pieces, members), view, hides) {}

}  // namespace frontmost::painter_detail
