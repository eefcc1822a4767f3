// SPDX-License-Identifier: Apache-2.0
// Passes over the vertices and triangles of a scene, a vector of them at a time: places in the world, boxes, extremes
// of vertex numbers, and cells of a grid.
//
// Vertices are transformed to world space in doubles, each product and sum in the order of to_world(), and are rounded
// once, so the bits are the same as there. A vertex that is not finite must not get into a box. Such a vertex is found
// by adding x - x to a sum, which adds 0 for finite numbers and NaN for others.
//
// The cell of a triangle is that of the sum of its vertices. One matrix (CellMap) combines the factor of a third, the
// transform of the instance and the size of a cell, so that none of them takes a step of its own. The order of cells
// does not affect where a triangle is drawn, so floats suffice.
#include <algorithm>

#include "surfaces/cells.h"
#include "surfaces/placed_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfaces/triangles_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// On targets without vectors, Highway converts doubles beyond the range of floats to the greatest float, not to
// infinity.
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128

void PlaceVertices(const glm::dmat4& m, std::span<const glm::vec3> from, glm::vec3* to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = to_world(m, from[i]);
}

#else

/// One row of a transform, which computes one coordinate.
template <class DD>
class WorldRow {
 public:
  using V = hn::Vec<DD>;

  HWY_INLINE WorldRow(const glm::dmat4& m, int row)
      : x_(hn::Set(DD(), m[0][row])),
        y_(hn::Set(DD(), m[1][row])),
        z_(hn::Set(DD(), m[2][row])),
        offset_(hn::Set(DD(), m[3][row])) {}

  [[nodiscard]] HWY_INLINE V operator()(V x, V y, V z) const {
    return hn::Add(hn::Add(hn::Add(hn::Mul(x_, x), hn::Mul(y_, y)), hn::Mul(z_, z)), offset_);
  }

 private:
  V x_, y_, z_, offset_;
};

void PlaceVertices(const glm::dmat4& m, std::span<const glm::vec3> from, glm::vec3* to) {
  using DD = hn::Repartition<double, DF>;
  const DF d;
  const hn::Half<DF> half;
  const DD dd;
  const WorldRow<DD> rows[3] = {{m, 0}, {m, 1}, {m, 2}};
  const auto place = [&](const float* p, float* q) HWY_ATTR {
    VF x, y, z, world[3];
    hn::LoadInterleaved3(d, p, x, y, z);
    const auto x0 = hn::PromoteTo(dd, hn::LowerHalf(half, x)), x1 = hn::PromoteTo(dd, hn::UpperHalf(half, x));
    const auto y0 = hn::PromoteTo(dd, hn::LowerHalf(half, y)), y1 = hn::PromoteTo(dd, hn::UpperHalf(half, y));
    const auto z0 = hn::PromoteTo(dd, hn::LowerHalf(half, z)), z1 = hn::PromoteTo(dd, hn::UpperHalf(half, z));
    for (int axis = 0; axis < 3; ++axis)
      world[axis] =
          hn::Combine(d, hn::DemoteTo(half, rows[axis](x1, y1, z1)), hn::DemoteTo(half, rows[axis](x0, y0, z0)));
    hn::StoreInterleaved3(world[0], world[1], world[2], d, q);
  };
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= from.size(); i += lanes) place(&from[i].x, &to[i].x);
  if (i == from.size()) return;
  glm::vec3 rest[kMaxLanes];
  for (std::size_t k = 0; k < lanes; ++k) rest[k] = from[HWY_MIN(i + k, from.size() - 1)];
  place(&rest[0].x, &rest[0].x);
  std::copy_n(rest, from.size() - i, to + i);
}

#endif

NumberRange RangeOfNumbers(std::span<const glm::uvec3> corners) {
  const DU d;
  const std::uint32_t* numbers = &corners.front().x;
  const std::size_t count = 3 * corners.size(), lanes = hn::Lanes(d);
  NumberRange range{no_index, 0};
  std::size_t i = 0;
  if (count >= lanes) {
    VU low = hn::Set(d, no_index), high = hn::Zero(d);
    for (; i + lanes <= count; i += lanes) {
      const VU number = hn::LoadU(d, numbers + i);
      low = hn::Min(low, number);
      high = hn::Max(high, number);
    }
    range = {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
  }
  for (; i < count; ++i) range = {HWY_MIN(range.low, numbers[i]), HWY_MAX(range.high, numbers[i])};
  return range;
}

class BoxFinder {
 public:
  explicit BoxFinder(const WorldTriangles& triangles)
      : positions_(&triangles.positions.data()->x), first_(std::int32_t(triangles.first_position)) {}

  /// Finds the box of consecutive triangles, at least one. \returns false if a vertex may not be finite; the box is
  /// then undefined.
  bool Find(std::span<const glm::uvec3> corners, Box& box) {
    const DF d;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = hn::Set(d, std::numeric_limits<float>::infinity());
      high_[axis] = hn::Neg(low_[axis]);
    }
    rest_ = hn::Zero(d);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= corners.size(); i += lanes) Include(&corners[i].x);
    if (i < corners.size()) {
      // The last triangle is repeated: reading on would pass the end of the array.
      glm::uvec3 filled[kMaxLanes];
      for (std::size_t k = 0; k < lanes; ++k) filled[k] = corners[HWY_MIN(i + k, corners.size() - 1)];
      Include(&filled[0].x);
    }
    for (int axis = 0; axis < 3; ++axis) {
      // + 0: the sign of a zero must not depend on the number of lanes.
      box.low[axis] = hn::GetLane(hn::MinOfLanes(d, low_[axis])) + 0.0f;
      box.high[axis] = hn::GetLane(hn::MaxOfLanes(d, high_[axis])) + 0.0f;
    }
    return hn::AllTrue(d, hn::Eq(rest_, hn::Zero(d)));
  }

 private:
  HWY_INLINE void Include(const std::uint32_t* corners) {
    const DI d;
    VU numbers[3];
    hn::LoadInterleaved3(DU(), corners, numbers[0], numbers[1], numbers[2]);
    for (const VU& number : numbers) {
      const VI n = hn::Sub(hn::BitCast(d, number), hn::Set(d, first_)), at = hn::Add(n, hn::Add(n, n));
      for (int axis = 0; axis < 3; ++axis) {
        const VF p = hn::GatherIndex(DF(), positions_ + axis, at);
        low_[axis] = hn::Min(low_[axis], p);
        high_[axis] = hn::Max(high_[axis], p);
        rest_ = hn::Add(rest_, hn::Sub(p, p));  // becomes NaN if p is not finite, and stays NaN
      }
    }
  }

  const float* positions_;
  std::int32_t first_;
  VF low_[3], high_[3], rest_;
};

/// The box of the triangles with finite vertices.
Box BoxOfFinite(const WorldTriangles& triangles, std::size_t begin, std::size_t end) {
  Box box;
  for (std::size_t i = begin; i < end; ++i) {
    const std::array<glm::vec3, 3> corners = triangles[i];
    if (!is_finite(corners[0]) || !is_finite(corners[1]) || !is_finite(corners[2])) continue;
    for (const glm::vec3& corner : corners) box.include(corner + 0.0f);
  }
  return box;
}

void FindBoxes(const WorldTriangles& triangles, Box* boxes) {
  constexpr std::size_t kInBox = MeshRange::triangles_in_box;
  BoxFinder finder(triangles);
  for (std::size_t i = 0; i < triangles.corners.size(); i += kInBox, ++boxes) {
    const std::size_t count = HWY_MIN(kInBox, triangles.corners.size() - i);
    if (!finder.Find(triangles.corners.subspan(i, count), *boxes)) *boxes = BoxOfFinite(triangles, i, i + count);
  }
}

class CellFinder {
 public:
  CellFinder(const glm::vec3* positions, const CellMap& map) : positions_(&positions->x), map_(map) {}

  /// Finds the cells of a vector of triangles.
  HWY_INLINE hn::Vec<DU> Find(const std::uint32_t* corners) {
    hn::Vec<DU> a, b, c;
    hn::LoadInterleaved3(DU(), corners, a, b, c);
    const VI i = First(a), j = First(b), k = First(c);
    const VF x = Sum(0, i, j, k), y = Sum(1, i, j, k), z = Sum(2, i, j, k);
    // rest_ becomes NaN if a vertex is not finite, and stays NaN. A sum that overflows counts as not finite.
    rest_ = hn::Add(rest_, hn::Add(hn::Sub(x, x), hn::Add(hn::Sub(y, y), hn::Sub(z, z))));
    const VI cell_x = Place(0, x, y, z), cell_y = Place(1, x, y, z), cell_z = Place(2, x, y, z);
    const VI yz = hn::Or(hn::ShiftLeft<SpaceCell::y_shift>(cell_y), hn::ShiftLeft<SpaceCell::z_shift>(cell_z));
    return hn::BitCast(DU(), hn::Or(cell_x, yz));
  }
  [[nodiscard]] bool IsFinite() const {
    const DF d;
    return hn::AllTrue(d, hn::Eq(rest_, hn::Zero(d)));
  }

 private:
  static HWY_INLINE VI First(hn::Vec<DU> number) {
    const VI n = hn::BitCast(DI(), number);
    return hn::Add(n, hn::Add(n, n));
  }
  HWY_INLINE VF Sum(int axis, VI i, VI j, VI k) const {
    const DF d;
    const float* const from = positions_ + axis;
    return hn::Add(hn::Add(hn::GatherIndex(d, from, i), hn::GatherIndex(d, from, j)), hn::GatherIndex(d, from, k));
  }
  HWY_INLINE VI Place(std::size_t axis, VF x, VF y, VF z) const {
    const DF d;
    const auto& row = map_.rows[axis];
    const VF xy = hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y));
    const VF at = hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, row[2]), z)), hn::Set(d, row[3]));
    // NaN is not greater than 0, and so goes to cell 0; its conversion would differ from target to target.
    const VF not_before = hn::IfThenElseZero(hn::Gt(at, hn::Zero(d)), at);
    return hn::ConvertTo(DI(), hn::Min(not_before, hn::Set(d, map_.last)));
  }

  const float* positions_;
  const CellMap& map_;
  VF rest_ = hn::Zero(DF());
};

bool FindCells(const MeshPart& part, const CellMap& map, SpaceCell* cells) {
  const DU d;
  const std::size_t lanes = hn::Lanes(d);
  const glm::uvec3* triangles = part.mesh.triangles.data() + part.begin;
  const std::size_t count = part.end - part.begin;
  CellFinder finder(part.mesh.positions.data(), map);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) hn::StoreU(finder.Find(&triangles[i].x), d, &cells[i].packed);
  if (i < count) {
    // The last triangle is repeated: reading on would pass the end of the array.
    glm::uvec3 rest[kMaxLanes];
    for (std::size_t k = 0; k < lanes; ++k) rest[k] = triangles[std::min(i + k, count - 1)];
    HWY_ALIGN_MAX std::uint32_t found[kMaxLanes];
    hn::Store(finder.Find(&rest[0].x), d, found);
    for (std::size_t k = 0; i + k < count; ++k) cells[i + k].packed = found[k];
  }
  return finder.IsFinite();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost {

FRONTMOST_KERNELS(PlaceVertices);

void place_vertices(const glm::dmat4& world_from_mesh, std::span<const glm::vec3> from, glm::vec3* to, Isa isa) {
  kernel_for(PlaceVerticesKernels, isa)(world_from_mesh, from, to);
}

FRONTMOST_KERNELS(RangeOfNumbers);
FRONTMOST_KERNELS(FindBoxes);

NumberRange range_of_numbers(std::span<const glm::uvec3> corners, Isa isa) {
  return kernel_for(RangeOfNumbersKernels, isa)(corners);
}

void find_boxes(const WorldTriangles& triangles, Isa isa, Box* boxes) {
  kernel_for(FindBoxesKernels, isa)(triangles, boxes);
}

FRONTMOST_KERNELS(FindCells);

bool find_cells(const MeshPart& part, const CellMap& map, Isa isa, SpaceCell* cells) {
  // For more vertices, three times a vertex's number exceeds the 31 bits of a lane.
  constexpr std::size_t kMostVertices = (std::size_t(1) << 31) / 3;
  if (part.mesh.positions.size() > kMostVertices) {
    std::fill_n(cells, part.end - part.begin, SpaceCell());
    return false;
  }
  return kernel_for(FindCellsKernels, isa)(part, map, cells);
}

}  // namespace frontmost
#endif  // HWY_ONCE
