// SPDX-License-Identifier: Apache-2.0
#include "occlusion/long_object.h"

#include <cmath>

namespace frontmost::occlusion_detail {
namespace {

/// At most so many cuts are made for one object; no triangle is cut if more would be needed.
constexpr std::size_t kMostCuts = 1 << 13;

/// A triangle is worth cutting if it begins so many slabs before the slab of its farthest vertex, and reaches so many
/// cells across and down.
constexpr int kLeastSlabs = 12, kLeastCells = 8;
/// Triangles are cut for every third slab, except slabs nearer than a sixty-fourth of the object's farthest end.
constexpr int kSlabsBetweenCuts = 3, kMostSlabs = 36;

bool is_cut_for(int slab) { return slab % kSlabsBetweenCuts == 0; }

glm::uvec3 corners_of(const HidingObject& occluder, std::uint32_t triangle) {
  return occluder.mesh.triangles[occluder.part.first_triangle + triangle] - occluder.part.first_vertex;
}

/// The least rectangle around places on the screen.
class ScreenExtent {
 public:
  template <class Place>
  void include(const Place& place) {
    low_ = glm::min(low_, glm::ivec2(place.x, place.y));
    high_ = glm::max(high_, glm::ivec2(place.x, place.y));
  }
  void include(const ClippedPolygon& polygon) {
    for (int i = 0; i < polygon.count; ++i) include(polygon.corners[std::size_t(i)]);
  }
  /// The cells of the extent within a rectangle.
  [[nodiscard]] CellRect cells(const CellGrid& grid, const CellRect& rect) const {
    if (low_.x > high_.x) return {};
    const auto cell = [&](std::int32_t v, std::int32_t centre) {
      return int(std::floor(float(v + centre) * grid.cells_per_unit));
    };
    const ScreenTransform& t = grid.transform;
    return {std::max(rect.x0, cell(low_.x, t.centre_x)), std::max(rect.y0, cell(low_.y, t.centre_y)),
            std::min(rect.x1, cell(high_.x, t.centre_x) + 1), std::min(rect.y1, cell(high_.y, t.centre_y) + 1)};
  }

 private:
  glm::ivec2 low_ = glm::ivec2(std::numeric_limits<std::int32_t>::max());
  glm::ivec2 high_ = glm::ivec2(std::numeric_limits<std::int32_t>::min());
};

}  // namespace

void LongObject::sort_by_slab(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                              const Slabs& slabs) {
  const std::size_t count = on_screen.triangles.size(), slab_count = std::size_t(slabs.count());
  find_far_sides(grid, range_of, slabs);
  slabs_.resize(count);
  slab_begin_.assign(slab_count + 2, 0);
  for (std::size_t t = 0; t < count; ++t) {
    const float farthest = on_screen.triangles[t].farthest;
    std::size_t slab = std::size_t(slabs.of(range_of(farthest)));
    while (farthest > far_sides_[slab]) ++slab;
    slabs_[t] = std::uint16_t(slab);
    ++slab_begin_[slab + 2];
  }
  for (std::size_t s = 2; s < slab_begin_.size(); ++s) slab_begin_[s] += slab_begin_[s - 1];
  // Filling moves each slab's beginning to its end, which is where the next slab begins.
  by_slab_.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) by_slab_[slab_begin_[std::size_t(slabs_[t]) + 1]++] = t;
  marks_.assign(count, 0);
  find_reaching(grid, occluder, range_of, slabs);
}

/// Finds far sides such that nearer points certainly lie in ranges before those behind the slab, despite rounding.
void LongObject::find_far_sides(const CellGrid& grid, const DistanceRanges& range_of, const Slabs& slabs) {
  float rounding = 0;
  for (const glm::vec3& world : on_screen.world) {
    const float its = distance_rounding(grid.transform, world);
    if (its < infinite_distance) rounding = std::max(rounding, its);
  }
  far_sides_.resize(std::size_t(slabs.count()));
  for (int slab = 0; slab < slabs.count(); ++slab)
    far_sides_[std::size_t(slab)] = range_of.least_of(slabs.behind(slab)) - 2 * rounding;
  far_sides_.back() = infinite_distance;
  screen_ = grid.transform;
}

void LongObject::find_reaching(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                               const Slabs& slabs) {
  reaching_.clear();
  std::size_t cuts = 0;
  auto cut = on_screen.cut.begin();
  for (std::uint32_t t = 0; t < slabs_.size(); ++t) {
    while (cut != on_screen.cut.end() && cut->triangle < t) ++cut;
    if (slabs_[t] < kLeastSlabs || on_screen.triangles[t].turn == ScreenTurn::none) continue;
    const bool is_cut = on_screen.triangles[t].is_cut;
    const glm::uvec3 corners = corners_of(occluder, t);
    float nearest = infinite_distance;
    ScreenExtent extent;
    for (int k = 0; k < 3; ++k) {
      const VertexOnScreen& v = on_screen.vertices[corners[k]];
      nearest = std::min(nearest, is_cut ? grid.transform.near : v.distance);
      if (!is_cut) extent.include(v);
    }
    if (is_cut) extent.include(cut->polygon);
    const int first_slab = std::max(slabs.of(range_of(nearest)), slabs.count() - kMostSlabs);
    const CellRect cells = extent.cells(grid, {0, 0, grid.columns, grid.rows});
    if (slabs_[t] - first_slab < kLeastSlabs || cells.x1 - cells.x0 < kLeastCells || cells.y1 - cells.y0 < kLeastCells)
      continue;
    reaching_.push_back({t, first_slab});
    cuts += std::size_t(slabs_[t] - first_slab) / kSlabsBetweenCuts;
  }
  if (cuts > kMostCuts) reaching_.clear();
  first_reached_ = slabs.count();
  for (const Reaching& r : reaching_) first_reached_ = std::min(first_reached_, r.first_slab);
}

bool LongObject::has_triangles(int slab) const {
  const bool has_whole = slab_begin_[std::size_t(slab) + 1] > slab_begin_[std::size_t(slab)];
  return has_whole || (slab >= first_reached_ && is_cut_for(slab));
}

CoverPass LongObject::choose(const CellGrid& grid, const HidingObject& occluder, int slab, const CellRect& rect) {
  const auto begin = by_slab_.begin() + slab_begin_[std::size_t(slab)];
  const auto end = by_slab_.begin() + slab_begin_[std::size_t(slab) + 1];
  whole_.assign(begin, end);
  cut_.clear();
  screen_->far = std::min(grid.transform.far, far_sides_[std::size_t(slab)]);
  screen_->inverse_range = 1.0f / (screen_->far - screen_->near);
  for (const std::uint32_t t : whole_) marks_[t] = std::uint16_t(slab + 1);
  if (is_cut_for(slab)) choose_cut(occluder, slab);
  const std::size_t cut_by_slab = cut_.size();
  for (auto t = begin; t != end; ++t) choose_around(occluder, slab, *t);
  for (std::size_t i = 0; i < cut_by_slab; ++i) choose_around(occluder, slab, cut_[i].triangle);
  // Triangles that the view cuts are not whole either.
  const auto is_cut = [&](std::uint32_t t) { return on_screen.triangles[t].is_cut; };
  if (!on_screen.cut.empty()) whole_.erase(std::remove_if(whole_.begin(), whole_.end(), is_cut), whole_.end());
  for (const ClippedTriangle& cut : on_screen.cut)
    if (slabs_[cut.triangle] <= slab && marks_[cut.triangle] == slab + 1) cut_.push_back(cut);
  float farthest = cut_by_slab > 0 ? screen_->far : -infinite_distance;
  for (const std::uint32_t t : whole_) farthest = std::max(farthest, on_screen.triangles[t].farthest);
  for (std::size_t i = cut_by_slab; i < cut_.size(); ++i)
    farthest = std::max(farthest, on_screen.triangles[cut_[i].triangle].farthest);
  chosen_ = {whole_, cut_, marks_, std::uint16_t(slab + 1), &*screen_};
  return {.rect = rect_of_chosen(grid, occluder, rect), .distance = farthest, .chosen = &chosen_};
}

/// Chooses triangles that reach through a slab.
void LongObject::choose_cut(const HidingObject& occluder, int slab) {
  if (!(screen_->far > screen_->near)) return;
  for (const Reaching& r : reaching_) {
    if (r.first_slab > slab || slabs_[r.triangle] <= slab) continue;
    const glm::uvec3 c = corners_of(occluder, r.triangle);
    const ClippedTriangle cut{
        r.triangle, clip_triangle(*screen_, {on_screen.world[c.x], on_screen.world[c.y], on_screen.world[c.z]})};
    if (turn_of(cut.polygon) != on_screen.triangles[r.triangle].turn) continue;
    marks_[r.triangle] = std::uint16_t(slab + 1);
    cut_.push_back(cut);
  }
}

/// Chooses triangles of nearer slabs that share a vertex with `triangle`, at edges whose neighbours are not of the
/// slab.
void LongObject::choose_around(const HidingObject& occluder, int slab, std::uint32_t triangle) {
  const std::uint32_t first = occluder.part.first_triangle;
  const auto mark = std::uint16_t(slab + 1);
  const auto is_of_slab = [&](std::uint32_t t) { return t == no_index || slabs_[t - first] == slab; };
  const glm::uvec3& beyond = occluder.mesh.neighbours[first + triangle];
  for (int corner = 0; corner < 3; ++corner) {
    if (is_of_slab(beyond[corner]) && is_of_slab(beyond[corner == 0 ? 2 : corner - 1])) continue;
    occluder.mesh.visit_around(first + triangle, corner, [&](std::uint32_t around) {
      const std::uint32_t own = around - first;
      if (slabs_[own] >= slab || marks_[own] == mark) return;
      marks_[own] = mark;
      whole_.push_back(own);
    });
  }
}

CellRect LongObject::rect_of_chosen(const CellGrid& grid, const HidingObject& occluder, const CellRect& rect) const {
  ScreenExtent extent;
  for (const std::uint32_t t : whole_)
    for (int k = 0; k < 3; ++k) extent.include(on_screen.vertices[corners_of(occluder, t)[k]]);
  for (const ClippedTriangle& cut : cut_) extent.include(cut.polygon);
  return extent.cells(grid, rect);
}

}  // namespace frontmost::occlusion_detail
