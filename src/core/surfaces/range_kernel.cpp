// SPDX-License-Identifier: Apache-2.0
// Finds boxes of triangles and the extremes of their vertex numbers, a vector of triangles at a time.
//
// Surfaces needs both for every triangle of a scene. A vertex that is not finite must not get into a box. It is found
// by adding x - x to a sum, which adds 0 for finite numbers and NaN for others, once for 64 triangles.

#include <algorithm>

#include "surfaces/placed_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfaces/range_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

  /// The box of consecutive triangles, at least one. \returns false if a vertex may not be finite; the box then means
  /// nothing.
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

}  // namespace HWY_NAMESPACE
}  // namespace frontmost
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost {

FRONTMOST_KERNELS(RangeOfNumbers);
FRONTMOST_KERNELS(FindBoxes);

NumberRange range_of_numbers(std::span<const glm::uvec3> corners, Isa isa) {
  return kernel_for(RangeOfNumbersKernels, isa)(corners);
}

void find_boxes(const WorldTriangles& triangles, Isa isa, Box* boxes) {
  kernel_for(FindBoxesKernels, isa)(triangles, boxes);
}

}  // namespace frontmost
#endif  // HWY_ONCE
