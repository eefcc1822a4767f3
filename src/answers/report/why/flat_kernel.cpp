// SPDX-License-Identifier: Apache-2.0
// Counts triangles without area, a vector of them at a time. The products are those of PlaceFinder, in doubles and in
// the same order, so that both agree. A non-finite coordinate makes one of the products infinite or NaN.

#include <cmath>

#include "report/why/places.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "report/why/flat_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::why_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

std::uint64_t CountFlat(const WorldTriangles& triangles) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
    const std::array<glm::vec3, 3> p = triangles[i];
    const glm::dvec3 a(p[0]), normal = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
    const double size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    count += !(size > 0 && std::isfinite(size));
  }
  return count;
}

#else

using DD = hn::Repartition<double, DF>;
using VD = hn::Vec<DD>;

/// The lower or upper half of a vector, as doubles.
template <bool upper>
HWY_INLINE VD HalfOf(VF v) {
  const hn::Half<DF> half;
  if constexpr (upper)
    return hn::PromoteTo(DD(), hn::UpperHalf(half, v));
  else
    return hn::PromoteTo(DD(), hn::LowerHalf(half, v));
}

struct CornerVectors {
  VF x, y, z;
};

/// The triangles that have an area, one bit each.
template <bool upper>
HWY_INLINE std::uint64_t WithArea(const CornerVectors (&p)[3]) {
  const DD d;
  const VD ax = HalfOf<upper>(p[0].x), ay = HalfOf<upper>(p[0].y), az = HalfOf<upper>(p[0].z);
  const VD bx = hn::Sub(HalfOf<upper>(p[1].x), ax), by = hn::Sub(HalfOf<upper>(p[1].y), ay);
  const VD bz = hn::Sub(HalfOf<upper>(p[1].z), az), cx = hn::Sub(HalfOf<upper>(p[2].x), ax);
  const VD cy = hn::Sub(HalfOf<upper>(p[2].y), ay), cz = hn::Sub(HalfOf<upper>(p[2].z), az);
  const VD x = hn::Sub(hn::Mul(by, cz), hn::Mul(cy, bz)), y = hn::Sub(hn::Mul(bz, cx), hn::Mul(cz, bx));
  const VD z = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
  const VD size = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const VD infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  return BitsOf(d, hn::And(hn::Gt(size, hn::Zero(d)), hn::Lt(size, infinity)));
}

std::uint64_t CountFlat(const WorldTriangles& triangles) {
  const DI d;
  const DF df;
  const float* const positions = &triangles.positions.data()->x;
  const std::size_t lanes = hn::Lanes(d), count = triangles.corners.size();
  std::uint64_t with_area = 0;
  for (std::size_t i = 0; i < count; i += lanes) {
    glm::uvec3 filled[kMaxLanes];
    const glm::uvec3* corners = &triangles.corners[i];
    if (i + lanes > count) {
      // The last triangle is repeated, since reading on would pass the end of the array.
      for (std::size_t k = 0; k < lanes; ++k) filled[k] = triangles.corners[HWY_MIN(i + k, count - 1)];
      corners = filled;
    }
    VU numbers[3];
    hn::LoadInterleaved3(DU(), &corners->x, numbers[0], numbers[1], numbers[2]);
    CornerVectors places[3];
    for (int k = 0; k < 3; ++k) {
      const VI n = hn::Sub(hn::BitCast(d, numbers[k]), hn::Set(d, std::int32_t(triangles.first_position)));
      const VI at = hn::Add(n, hn::Add(n, n));
      places[k] = {hn::GatherIndex(df, positions, at), hn::GatherIndex(df, positions + 1, at),
                   hn::GatherIndex(df, positions + 2, at)};
    }
    const std::uint64_t found = WithArea<false>(places) | WithArea<true>(places) << hn::Lanes(DD());
    const std::uint64_t asked = HWY_MIN(count - i, lanes);
    with_area += std::uint64_t(hwy::PopCount(found & ((std::uint64_t(1) << asked) - 1)));
  }
  return count - with_area;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::why_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::why_detail {

FRONTMOST_KERNELS(CountFlat);

std::uint64_t count_flat(const WorldTriangles& triangles, Isa isa) {
  return kernel_for(CountFlatKernels, isa)(triangles);
}

}  // namespace frontmost::why_detail
#endif  // HWY_ONCE
