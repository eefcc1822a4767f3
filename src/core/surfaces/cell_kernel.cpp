// SPDX-License-Identifier: Apache-2.0
// Finds the cells of triangles, a vector of triangles at a time.
//
// A triangle's place is that of the sum of its vertices. One matrix (CellMap) combines the factor of a third, the
// transform of the instance and the size of a cell, so that none of them takes a step of its own. The order of cells
// does not affect where a triangle is drawn, so floats suffice.

#include <algorithm>

#include "surfaces/cells.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfaces/cell_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class CellFinder {
 public:
  CellFinder(const glm::vec3* positions, const CellMap& map) : positions_(&positions->x), map_(map) {}

  /// Cells of a vector of triangles.
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
