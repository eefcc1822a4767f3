// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles are excluded in floats, sixteen triangles (lanes) against sixteen probes:
//
//      boxes touch, and no spread vertex is shared                                 MayMeet
//      the lanes may have corners on both sides of the probe's plane               Straddles
//      the probe may have corners on both sides of the lanes' planes               IsStraddled
//      neighbours lie on one side of the shared vertex along the common line       LiesApart
//      both meet the planes' common line in overlapping stretches                  MeetsLineApart
//
// Each step answers "certainly not" or "perhaps", with a bound on all rounding errors. The rest is decided exactly.

#include "lines/crossings/space_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/crossings/space_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After base/highway-inl.h, for each target.
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

/// kShare bounds the rounding errors of normal, difference and product, as a share of the sum of the terms' absolute
/// values. kLeast bounds errors by underflow.
constexpr float kShare = 32.0f / 16777216.0f, kLeast = 1e-36f;
/// Used in place of kLeast for heights, because products of heights must not underflow either; most sizes are about 1.
constexpr float kLeastHeight = 1e-20f;

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

struct LanePlane {
  Vector3 corner, normal, size;
};

HWY_INLINE LanePlane PlaneThrough(const Vector3& corner, const Vector3& one, const Vector3& other) {
  const Vector3 a = Minus(one, corner), b = Minus(other, corner), c = Abs(a), d = Abs(b);
  const auto minor = [](V p, V q, V r, V s) HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  const auto bound = [](V p, V q, V r, V s)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Mul(p, q), hn::Mul(r, s)), hn::Set(D(), kLeastSize)); };
  return {corner,
          {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)},
          {bound(c.y, d.z, c.z, d.y), bound(c.z, d.x, c.x, d.z), bound(c.x, d.y, c.y, d.x)}};
}

/// Whether a point is certainly above a plane, and whether it is certainly below the plane; neither for NaN.
struct Height {
  M is_above, is_below;

  HWY_INLINE Height(const Vector3& point, const LanePlane& plane) {
    const D d;
    const Vector3 along = Minus(point, plane.corner);
    const V value = Dot(along, plane.normal);
    const V error = hn::Add(hn::Mul(Dot(Abs(along), plane.size), hn::Set(d, kShare)), hn::Set(d, kLeast));
    is_above = hn::Gt(value, error);
    is_below = hn::Lt(value, hn::Neg(error));
  }
};

HWY_INLINE Vector3 Choose(M mask, const Vector3& yes, const Vector3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

/// A triangle that a plane cuts: the corner that is alone on its side, and the other two. Valid where `is_known`.
struct Cut {
  Vector3 alone, one, other;
  M is_known;

  HWY_INLINE Cut(const Vector3 (&p)[3], const LanePlane& plane) {
    const Height a(p[0], plane), b(p[1], plane), c(p[2], plane);
    const auto known = [](const Height& h) HWY_ATTR { return hn::Or(h.is_above, h.is_below); };
    is_known = hn::And(hn::And(known(a), known(b)), known(c));
    const M is_first = hn::Not(hn::Xor(b.is_above, c.is_above)), is_second = hn::Not(hn::Xor(a.is_above, c.is_above));
    alone = Choose(is_first, p[0], Choose(is_second, p[1], p[2]));
    one = Choose(is_first, p[1], Choose(is_second, p[2], p[0]));
    other = Choose(is_first, p[2], Choose(is_second, p[0], p[1]));
  }
};

/// For a triangle with one corner in a plane: a vector of any length from that corner towards the point where the
/// opposite edge passes through the plane.
struct LaneReach {
  Vector3 to, error;

  /// `a` and `b` lead from that corner to the other two corners. Valid only if these two are not on one side of the
  /// plane.
  HWY_INLINE LaneReach(const Vector3& a, const Vector3& b, const LanePlane& plane) {
    const D d;
    const Vector3 far_a = Abs(a), far_b = Abs(b);
    const V high_a = hn::Abs(Dot(a, plane.normal)), high_b = hn::Abs(Dot(b, plane.normal));
    const auto mix = [](const Vector3& p, V t, const Vector3& q, V u) HWY_ATTR {
      return Vector3{hn::Add(hn::Mul(p.x, t), hn::Mul(q.x, u)), hn::Add(hn::Mul(p.y, t), hn::Mul(q.y, u)),
                     hn::Add(hn::Mul(p.z, t), hn::Mul(q.z, u))};
    };
    to = mix(a, high_b, b, high_a);
    // A height is at most the sum of its terms, so that sum also bounds later rounding errors.
    const V share = hn::Set(d, 2 * kShare), least = hn::Set(d, kLeastHeight);
    const V error_a = hn::Add(hn::Mul(Dot(far_a, plane.size), share), least);
    const V error_b = hn::Add(hn::Mul(Dot(far_b, plane.size), share), least);
    error = mix(far_a, error_b, far_b, error_a);
  }
};

/// One of sixteen probes, copied to all lanes.
struct Probe {
  const SpaceTriangles& triangles;
  const SpaceProbes& all;
  const std::size_t lane;

  HWY_INLINE Vector3 Splat3(const float (&arrays)[3][kSpaceLanes]) const {
    const D d;
    return {hn::Set(d, arrays[0][lane]), hn::Set(d, arrays[1][lane]), hn::Set(d, arrays[2][lane])};
  }
  HWY_INLINE Vector3 Corner(int k) const {
    const auto at = [&](int axis) HWY_ATTR { return hn::Set(D(), triangles.corners[3 * k + axis][all.first + lane]); };
    return {at(0), at(1), at(2)};
  }
  HWY_INLINE hn::Vec<DU> Vertex(int k) const { return hn::Set(DU(), triangles.vertices[k][all.first + lane]); }
};

/// Up to sixteen triangles in registers, one in each lane.
struct Lanes {
  Vector3 corner[3], from_middle[3];
  Vector3 low, high;
  hn::Vec<DU> vertex[3];
  LanePlane plane;

  HWY_INLINE Lanes(const SpaceTriangles& t, std::size_t first, const glm::vec3& middle) {
    const D d;
    const Vector3 origin = Splat(D(), middle);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto load = [&](std::size_t axis) HWY_ATTR { return hn::Load(d, t.corners[3 * k + axis].data() + first); };
      corner[k] = {load(0), load(1), load(2)};
      from_middle[k] = Minus(corner[k], origin);
      vertex[k] = hn::Load(DU(), t.vertices[k].data() + first);
    }
    const auto least = [](V a, V b, V c) HWY_ATTR { return hn::Min(hn::Min(a, b), c); };
    const auto most = [](V a, V b, V c) HWY_ATTR { return hn::Max(hn::Max(a, b), c); };
    low = {least(corner[0].x, corner[1].x, corner[2].x), least(corner[0].y, corner[1].y, corner[2].y),
           least(corner[0].z, corner[1].z, corner[2].z)};
    high = {most(corner[0].x, corner[1].x, corner[2].x), most(corner[0].y, corner[1].y, corner[2].y),
            most(corner[0].z, corner[1].z, corner[2].z)};
    plane = PlaneThrough(corner[0], corner[1], corner[2]);
  }
  HWY_INLINE M Has(hn::Vec<DU> wanted) const {
    return hn::RebindMask(
        D(), hn::Or(hn::Or(hn::Eq(vertex[0], wanted), hn::Eq(vertex[1], wanted)), hn::Eq(vertex[2], wanted)));
  }
  /// Lanes whose boxes touch the probe's box, and which share no spread vertex with the probe.
  HWY_INLINE M MayMeet(const Probe& probe) const {
    const DU d;
    const auto overlaps = [&](V from, V to, int axis) HWY_ATTR {
      return Overlaps(from, to, probe.all.low[axis][probe.lane], probe.all.high[axis][probe.lane]);
    };
    const M touches =
        hn::And(hn::And(overlaps(low.x, high.x, 0), overlaps(low.y, high.y, 1)), overlaps(low.z, high.z, 2));
    const auto has = [&](int k) HWY_ATTR {
      const auto wanted = hn::Set(d, probe.all.spread[k][probe.lane]);
      return hn::Or(hn::Or(hn::Eq(vertex[0], wanted), hn::Eq(vertex[1], wanted)), hn::Eq(vertex[2], wanted));
    };
    return hn::AndNot(hn::RebindMask(D(), hn::Or(hn::Or(has(0), has(1)), has(2))), touches);
  }
  /// Lanes that may have corners on both sides of the probe's plane.
  HWY_INLINE M Straddles(const Probe& probe, float least, float most) const {
    const D d;
    M above = hn::FirstN(d, 0), below = above;
    for (int k = 0; k < 3; ++k) {
      const auto is = [&](int v) HWY_ATTR { return hn::Eq(vertex[k], probe.Vertex(v)); };
      const M shared = hn::RebindMask(d, hn::Or(hn::Or(is(0), is(1)), is(2)));
      const V value = Dot(from_middle[k], probe.Splat3(probe.all.normal));
      // The comparisons are negated so that NaN counts as both above and below.
      above = hn::Or(above, hn::Not(hn::Or(shared, hn::Lt(value, hn::Set(d, least)))));
      below = hn::Or(below, hn::Not(hn::Or(shared, hn::Gt(value, hn::Set(d, most)))));
    }
    return hn::And(above, below);
  }
  /// Lanes whose planes the probe may straddle, without lanes that share two vertices with the probe.
  HWY_INLINE M IsStraddled(const Probe& probe, const M (&has)[3]) const {
    const D d;
    M above = hn::FirstN(d, 0), below = above;
    for (int k = 0; k < 3; ++k) {
      const Height height(probe.Corner(k), plane);  // shared vertices are on neither side
      above = hn::Or(above, hn::Not(hn::Or(has[k], height.is_below)));
      below = hn::Or(below, hn::Not(hn::Or(has[k], height.is_above)));
    }
    const M two = hn::Or(hn::Or(hn::And(has[0], has[1]), hn::And(has[1], has[2])), hn::And(has[2], has[0]));
    return hn::AndNot(two, hn::And(above, below));
  }
  /// Lanes in `asked` that certainly meet the line common to both planes wholly before the probe or wholly behind it:
  /// each edge of one triangle that crosses the other's plane has the same orientation to each of the other's.
  HWY_INLINE std::uint64_t MeetsLineApart(const Probe& probe, std::uint64_t asked) const {
    const Vector3 p[3] = {probe.Corner(0), probe.Corner(1), probe.Corner(2)};
    const Cut own(corner, {p[0], probe.Splat3(probe.all.normal), probe.Splat3(probe.all.size)}), other(p, plane);
    const std::uint64_t known = frontmost::HWY_NAMESPACE::BitsOf(D(), hn::And(own.is_known, other.is_known)) & asked;
    if (known == 0) return 0;  // for example, where triangles touch
    const LanePlane one = PlaneThrough(other.alone, own.alone, own.one),
                    two = PlaneThrough(other.alone, own.alone, own.other);
    const Height a(other.one, one), b(other.other, one), c(other.one, two), d(other.other, two);
    const M above = hn::And(hn::And(a.is_above, b.is_above), hn::And(c.is_above, d.is_above));
    const M below = hn::And(hn::And(a.is_below, b.is_below), hn::And(c.is_below, d.is_below));
    return frontmost::HWY_NAMESPACE::BitsOf(D(), hn::Or(above, below)) & known;
  }
  /// Lanes that share a vertex with the probe and certainly lie on the other side of it along the planes' common line.
  HWY_INLINE M LiesApart(const Probe& probe, const M (&has)[3]) const {
    const D d;
    const Vector3 p[3] = {probe.Corner(0), probe.Corner(1), probe.Corner(2)};
    const Vector3 shared = Choose(has[0], p[0], Choose(has[1], p[1], p[2]));
    const auto is_shared = [&](int k) HWY_ATTR {
      return hn::And(hn::And(hn::Eq(corner[k].x, shared.x), hn::Eq(corner[k].y, shared.y)),
                     hn::Eq(corner[k].z, shared.z));
    };
    const LaneReach own(Minus(Choose(is_shared(0), corner[1], corner[0]), shared),
                        Minus(Choose(is_shared(2), corner[1], corner[2]), shared),
                        {p[0], probe.Splat3(probe.all.normal), probe.Splat3(probe.all.size)});
    const LaneReach other(Minus(Choose(has[0], p[1], p[0]), shared), Minus(Choose(has[2], p[1], p[2]), shared), plane);
    const Vector3 size = Abs(own.to), other_size = Abs(other.to);
    const Vector3 most{hn::Add(size.x, own.error.x), hn::Add(size.y, own.error.y), hn::Add(size.z, own.error.z)};
    const V error = hn::Add(hn::Add(Dot(most, other.error), Dot(own.error, other_size)),
                            hn::Add(hn::Mul(Dot(size, other_size), hn::Set(d, kShare)), hn::Set(d, kLeast)));
    return hn::Lt(Dot(own.to, other.to), hn::Neg(error));
  }
};

/// For each probe: the range of heights over its plane, relative to the middle of a box, in which rounding leaves the
/// side of a point in the box open. The error of the farthest point is used for all points.
struct Thresholds {
  HWY_ALIGN float least[kSpaceLanes], most[kSpaceLanes];

  HWY_INLINE Thresholds(const SpaceTriangles& triangles, const SpaceProbes& probes, const Box& box,
                        const glm::vec3& middle) {
    const D d;
    const Vector3 half = Splat(D(), glm::max(box.high - middle, middle - box.low));
    for (std::size_t i = 0; i < kSpaceLanes; i += hn::Lanes(d)) {
      const auto load = [&](const float(&arrays)[3][kSpaceLanes]) HWY_ATTR {
        return Vector3{hn::Load(d, arrays[0] + i), hn::Load(d, arrays[1] + i), hn::Load(d, arrays[2] + i)};
      };
      const auto corner = [&](int axis)
                              HWY_ATTR { return hn::Load(d, triangles.corners[axis].data() + probes.first + i); };
      const Vector3 at = Minus({corner(0), corner(1), corner(2)}, Splat(D(), middle));
      const Vector3 far = Abs(at), size = load(probes.size);
      const V height = Dot(at, load(probes.normal));
      const V error =
          hn::Add(hn::Mul(hn::Add(Dot(far, size), Dot(half, size)), hn::Set(d, kShare)), hn::Set(d, kLeast));
      hn::Store(hn::Sub(height, error), d, least + i);
      hn::Store(hn::Add(height, error), d, most + i);
    }
  }
};

void SetProbes(const SpaceTriangles& triangles, std::size_t first, SpaceProbes& probes) {
  const D d;
  probes.first = first;
  for (std::size_t i = 0; i < kSpaceLanes; i += hn::Lanes(d)) {
    const Lanes lanes(triangles, first + i, glm::vec3(0));
    const auto store = [&](const Vector3& v, float(&arrays)[3][kSpaceLanes]) HWY_ATTR {
      hn::Store(v.x, d, arrays[0] + i);
      hn::Store(v.y, d, arrays[1] + i);
      hn::Store(v.z, d, arrays[2] + i);
    };
    store(lanes.low, probes.low);
    store(lanes.high, probes.high);
    store(lanes.plane.normal, probes.normal);
    store(lanes.plane.size, probes.size);
    for (int k = 0; k < 3; ++k) {
      const auto is_spread = hn::Eq(hn::And(lanes.vertex[k], hn::Set(DU(), kNotSpread)), hn::Zero(DU()));
      hn::Store(hn::IfThenElse(is_spread, lanes.vertex[k], hn::Set(DU(), no_index)), DU(), probes.spread[k] + i);
    }
  }
}

std::uint32_t CrossingGroups(const SpaceTriangles& triangles, std::size_t first, const Box& box,
                             const SpaceProbes& probes, SpaceMasks& masks) {
  const D d;
  const std::uint32_t touching = TouchingLanes({probes.low[0], probes.low[1], probes.low[2]},
                                               {probes.high[0], probes.high[1], probes.high[2]}, box);
  if (touching == 0) return 0;
  const glm::vec3 middle = (box.low + box.high) * 0.5f;
  const Thresholds thresholds(triangles, probes, box, middle);
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < kSpaceLanes; i += hn::Lanes(d)) {
    const Lanes lanes(triangles, first + i, middle);
    // There is no branch per probe, because it cannot be predicted whether any lane is left.
    std::uint16_t left[kSpaceLanes];
    std::uint32_t near = 0, some_left = 0;
    frontmost::HWY_NAMESPACE::ForEachBit(touching, [&](std::size_t p) HWY_ATTR {
      left[p] = std::uint16_t(frontmost::HWY_NAMESPACE::BitsOf(d, lanes.MayMeet({triangles, probes, p})));
      near |= std::uint32_t(left[p] != 0) << p;
    });
    if (near == 0) continue;
    frontmost::HWY_NAMESPACE::ForEachBit(near, [&](std::size_t p) HWY_ATTR {
      const M straddles = lanes.Straddles({triangles, probes, p}, thresholds.least[p], thresholds.most[p]);
      left[p] &= std::uint16_t(frontmost::HWY_NAMESPACE::BitsOf(d, straddles));
      some_left |= std::uint32_t(left[p] != 0) << p;
    });
    frontmost::HWY_NAMESPACE::ForEachBit(some_left, [&](std::size_t p) HWY_ATTR {
      const Probe probe{triangles, probes, p};
      const M has[3] = {lanes.Has(probe.Vertex(0)), lanes.Has(probe.Vertex(1)), lanes.Has(probe.Vertex(2))};
      const M is_straddled = lanes.IsStraddled(probe, has);
      std::uint64_t bits = left[p] & frontmost::HWY_NAMESPACE::BitsOf(d, is_straddled);
      if (bits == 0) return;
      const M shares = hn::Or(hn::Or(has[0], has[1]), has[2]);
      if ((bits & frontmost::HWY_NAMESPACE::BitsOf(d, shares)) != 0)
        bits &= ~frontmost::HWY_NAMESPACE::BitsOf(d, hn::And(shares, lanes.LiesApart(probe, has)));
      if (bits != 0) bits &= ~lanes.MeetsLineApart(probe, bits);
      if (bits == 0) return;
      const auto mask = std::uint16_t(bits << i);
      masks[p] = found >> p & 1 ? std::uint16_t(masks[p] | mask) : mask;
      found |= 1u << p;
    });
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::lines_detail {

FRONTMOST_KERNELS(Touching);
FRONTMOST_KERNELS(SetProbes);
FRONTMOST_KERNELS(CrossingGroups);

SpaceKernels space_kernels(Isa isa) {
  return {kernel_for(TouchingKernels, isa), kernel_for(SetProbesKernels, isa), kernel_for(CrossingGroupsKernels, isa)};
}

}  // namespace frontmost::lines_detail
#endif  // HWY_ONCE
