// SPDX-License-Identifier: Apache-2.0
// In floats: what they leave open is decided exactly afterwards.

#include "lines/space_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/space_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After foreach_target.h, for each target.
#include "base/lanes-inl.h"
#include "lines/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::lines_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kSpaceLanes>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// What the roundings of the normal, the difference and the product may amount to, as a share of the sum of the terms'
/// absolute values; and where floats underflow.
constexpr float kShare = 32.0f / 16777216.0f, kLeast = 1e-36f;

HWY_INLINE M Overlaps(V low, V high, float box_low, float box_high) {
  const D d;
  return hn::And(hn::Le(low, hn::Set(d, box_high)), hn::Ge(high, hn::Set(d, box_low)));
}

HWY_INLINE std::uint32_t TouchingLanes(const float* const (&lows)[3], const float* const (&highs)[3], const Box& box) {
  const D d;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kSpaceLanes; i += hn::Lanes(d)) {
    M meets = hn::FirstN(d, hn::Lanes(d));
    for (int axis = 0; axis < 3; ++axis)
      meets = hn::And(
          meets, Overlaps(hn::Load(d, lows[axis] + i), hn::Load(d, highs[axis] + i), box.low[axis], box.high[axis]));
    bits |= frontmost::HWY_NAMESPACE::BitsOf(d, meets) << i;
  }
  return std::uint32_t(bits);
}

std::uint32_t Touching(const SpaceBoxes& boxes, std::size_t first, const Box& box) {
  return TouchingLanes({boxes.low[0].data() + first, boxes.low[1].data() + first, boxes.low[2].data() + first},
                       {boxes.high[0].data() + first, boxes.high[1].data() + first, boxes.high[2].data() + first}, box);
}

using Vector3 = Lanes3<V>;

struct Plane {
  Vector3 corner, normal, size;
};

/// Which corners rounding does not rule out to be above a plane, and below; its own vertices are neither.
struct Sides {
  M above, below;

  HWY_INLINE void Add(const Vector3& corner, const Plane& plane, M is_shared) {
    const D d;
    const Vector3 along = Minus(corner, plane.corner);
    const V value = Dot(along, plane.normal);
    const V error = hn::Add(hn::Mul(Dot(Abs(along), plane.size), hn::Set(d, kShare)), hn::Set(d, kLeast));
    above = hn::Or(above, hn::Not(hn::Or(is_shared, hn::Lt(value, hn::Neg(error)))));
    below = hn::Or(below, hn::Not(hn::Or(is_shared, hn::Gt(value, error))));
  }
  HWY_INLINE M Both() const { return hn::And(above, below); }
};

/// Up to sixteen triangles in registers.
struct Lanes {
  Vector3 corner[3];
  Vector3 low, high;
  hn::Vec<DU> vertex[3];
  Plane plane;

  HWY_INLINE Lanes(const SpaceTriangles& t, std::size_t first) {
    const D d;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto load = [&](std::size_t axis) HWY_ATTR { return hn::Load(d, t.corners[3 * k + axis].data() + first); };
      corner[k] = {load(0), load(1), load(2)};
      vertex[k] = hn::Load(DU(), t.vertices[k].data() + first);
    }
    const auto least = [](V a, V b, V c) HWY_ATTR { return hn::Min(hn::Min(a, b), c); };
    const auto most = [](V a, V b, V c) HWY_ATTR { return hn::Max(hn::Max(a, b), c); };
    low = {least(corner[0].x, corner[1].x, corner[2].x), least(corner[0].y, corner[1].y, corner[2].y),
           least(corner[0].z, corner[1].z, corner[2].z)};
    high = {most(corner[0].x, corner[1].x, corner[2].x), most(corner[0].y, corner[1].y, corner[2].y),
            most(corner[0].z, corner[1].z, corner[2].z)};
    SetPlane();
  }
  HWY_INLINE void SetPlane() {
    const Vector3 a = Minus(corner[1], corner[0]), b = Minus(corner[2], corner[0]);
    const auto minor = [](V p, V q, V r, V s) HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
    const auto bound = [](V p, V q, V r, V s) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(p, q), hn::Mul(r, s)), hn::Set(D(), kLeastSize));
    };
    const Vector3 p = Abs(a), q = Abs(b);
    plane = {corner[0],
             {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)},
             {bound(p.y, q.z, p.z, q.y), bound(p.z, q.x, p.x, q.z), bound(p.x, q.y, p.y, q.x)}};
  }
  HWY_INLINE M Touches(const Box& box) const {
    return hn::And(
        hn::And(Overlaps(low.x, high.x, box.low.x, box.high.x), Overlaps(low.y, high.y, box.low.y, box.high.y)),
        Overlaps(low.z, high.z, box.low.z, box.high.z));
  }
  HWY_INLINE M Has(std::uint32_t v) const {
    const auto wanted = hn::Set(DU(), v);
    return hn::RebindMask(
        D(), hn::Or(hn::Or(hn::Eq(vertex[0], wanted), hn::Eq(vertex[1], wanted)), hn::Eq(vertex[2], wanted)));
  }
  /// Which may have corners on both sides of the probe's plane.
  HWY_INLINE M Straddles(const SpaceProbe& probe) const {
    const D d;
    const Plane probe_plane{Splat(D(), probe.corners[0]), Splat(D(), probe.normal), Splat(D(), probe.size)};
    Sides sides{hn::FirstN(d, 0), hn::FirstN(d, 0)};
    for (int k = 0; k < 3; ++k) {
      const auto is = [&](std::uint32_t v) HWY_ATTR { return hn::Eq(vertex[k], hn::Set(DU(), v)); };
      const auto shared = hn::Or(hn::Or(is(probe.vertices.x), is(probe.vertices.y)), is(probe.vertices.z));
      sides.Add(corner[k], probe_plane, hn::RebindMask(d, shared));
    }
    return sides.Both();
  }
  /// Of whose planes the probe may have corners on both sides; none that share two vertices with it.
  HWY_INLINE M IsStraddled(const SpaceProbe& probe) const {
    const D d;
    const M has[3] = {Has(probe.vertices.x), Has(probe.vertices.y), Has(probe.vertices.z)};
    Sides sides{hn::FirstN(d, 0), hn::FirstN(d, 0)};
    for (int k = 0; k < 3; ++k) sides.Add(Splat(D(), probe.corners[k]), plane, has[k]);
    const M two = hn::Or(hn::Or(hn::And(has[0], has[1]), hn::And(has[1], has[2])), hn::And(has[2], has[0]));
    return hn::AndNot(two, sides.Both());
  }
};

void CrossingGroups(const SpaceTriangles& triangles, std::size_t first, const Box& box, const SpaceProbes& probes,
                    SpaceMasks& masks) {
  const D d;
  masks.fill(0);
  const std::uint32_t touching = TouchingLanes({probes.low[0], probes.low[1], probes.low[2]},
                                               {probes.high[0], probes.high[1], probes.high[2]}, box);
  if (touching == 0) return;
  for (std::size_t i = 0; i < kSpaceLanes; i += hn::Lanes(d)) {
    const Lanes lanes(triangles, first + i);
    frontmost::HWY_NAMESPACE::ForEachBit(touching, [&](std::size_t p) HWY_ATTR {
      const SpaceProbe& probe = probes.probes[p];
      const M touches = lanes.Touches(probe.box);
      if (hn::AllFalse(d, touches)) return;
      const M straddles = hn::And(touches, lanes.Straddles(probe));
      if (hn::AllFalse(d, straddles)) return;
      const M crosses = hn::And(straddles, lanes.IsStraddled(probe));
      masks[p] |= std::uint16_t(frontmost::HWY_NAMESPACE::BitsOf(d, crosses) << i);
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::lines_detail {

FRONTMOST_KERNELS(Touching);
FRONTMOST_KERNELS(CrossingGroups);

SpaceKernels space_kernels(Isa isa) {
  return {kernel_for(TouchingKernels, isa), kernel_for(CrossingGroupsKernels, isa)};
}

SpaceProbes::SpaceProbes(const SpaceTriangles& triangles, std::size_t first) {
  for (std::size_t i = 0; i < kSpaceLanes; ++i) {
    SpaceProbe& probe = probes[i];
    for (std::size_t k = 0; k < 3; ++k) {
      probe.corners[k] = triangles.corner(first + i, k);
      probe.vertices[int(k)] = triangles.vertices[k][first + i];
    }
    probe.box = triangles.box(first + i);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis][i] = probe.box.low[axis];
      high[axis][i] = probe.box.high[axis];
    }
    const glm::dvec3 u = glm::dvec3(probe.corners[1]) - glm::dvec3(probe.corners[0]);
    const glm::dvec3 v = glm::dvec3(probe.corners[2]) - glm::dvec3(probe.corners[0]);
    probe.normal = glm::vec3(glm::cross(u, v));
    const glm::dvec3 p = glm::abs(u), q = glm::abs(v);
    probe.size = glm::vec3(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x) + kLeastSize;
  }
}

}  // namespace frontmost::lines_detail
#endif  // HWY_ONCE
