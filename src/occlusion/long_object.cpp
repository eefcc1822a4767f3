// SPDX-License-Identifier: Apache-2.0
#include "occlusion/long_object.h"

#include <cmath>

namespace frontmost::occlusion_detail {

void LongObject::sort_by_slab(const DistanceRanges& range_of, const Slabs& slabs) {
  const std::size_t count = on_screen.triangles.size(), slab_count = std::size_t(slabs.count());
  slabs_.resize(count);
  slab_begin_.assign(slab_count + 2, 0);
  for (std::size_t t = 0; t < count; ++t) {
    const int range = std::clamp(range_of(on_screen.triangles[t].farthest), slabs.first, slabs.last);
    slabs_[t] = std::uint16_t((range - slabs.first) / slabs.length);
    ++slab_begin_[std::size_t(slabs_[t]) + 2];
  }
  for (std::size_t s = 2; s < slab_begin_.size(); ++s) slab_begin_[s] += slab_begin_[s - 1];
  // Each slab's begin moves to its end, which is where the next one begins.
  by_slab_.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) by_slab_[slab_begin_[std::size_t(slabs_[t]) + 1]++] = t;
  marks_.assign(count, 0);
}

CoverPass LongObject::choose(const CellGrid& grid, const HidingObject& occluder, int slab, const CellRect& rect) {
  const auto begin = by_slab_.begin() + slab_begin_[std::size_t(slab)];
  const auto end = by_slab_.begin() + slab_begin_[std::size_t(slab) + 1];
  const auto mark = std::uint16_t(slab + 1);
  chosen_.assign(begin, end);
  for (const std::uint32_t t : chosen_) marks_[t] = mark;
  const std::uint32_t first = occluder.part.first_triangle;
  const auto is_of_slab = [&](std::uint32_t t) { return t == no_index || slabs_[t - first] == slab; };
  for (auto t = begin; t != end; ++t) {
    const glm::uvec3& beyond = occluder.mesh.neighbours[first + *t];
    for (int corner = 0; corner < 3; ++corner) {
      if (is_of_slab(beyond[corner]) && is_of_slab(beyond[corner == 0 ? 2 : corner - 1])) continue;
      occluder.mesh.visit_around(first + *t, corner, [&](std::uint32_t around) {
        const std::uint32_t own = around - first;
        if (slabs_[own] >= slab || marks_[own] == mark) return;
        marks_[own] = mark;
        chosen_.push_back(own);
      });
    }
  }
  float farthest = -std::numeric_limits<float>::infinity();
  for (const std::uint32_t t : chosen_) farthest = std::max(farthest, on_screen.triangles[t].farthest);
  return {.rect = rect_of_chosen(grid, occluder, rect),
          .distance = farthest,
          .chosen = chosen_,
          .marks = marks_,
          .mark = mark};
}

CellRect LongObject::rect_of_chosen(const CellGrid& grid, const HidingObject& occluder, const CellRect& rect) const {
  if (!on_screen.cut.empty()) return rect;
  glm::ivec2 low(std::numeric_limits<std::int32_t>::max()), high(std::numeric_limits<std::int32_t>::min());
  for (const std::uint32_t t : chosen_)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = occluder.mesh.triangles[occluder.part.first_triangle + t][k];
      const VertexOnScreen& v = on_screen.vertices[vertex - occluder.part.first_vertex];
      low = glm::min(low, glm::ivec2(v.x, v.y));
      high = glm::max(high, glm::ivec2(v.x, v.y));
    }
  const auto cell = [&](std::int32_t v, std::int32_t centre) {
    return int(std::floor(float(v + centre) * grid.cells_per_unit));
  };
  const ScreenTransform& t = grid.transform;
  return {std::max(rect.x0, cell(low.x, t.centre_x)), std::max(rect.y0, cell(low.y, t.centre_y)),
          std::min(rect.x1, cell(high.x, t.centre_x) + 1), std::min(rect.y1, cell(high.y, t.centre_y) + 1)};
}

}  // namespace frontmost::occlusion_detail
