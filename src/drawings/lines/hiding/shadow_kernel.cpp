// SPDX-License-Identifier: Apache-2.0
// Boxes and sides are floats in cells, sixteen at a time; they only exclude occluders. The others are compared with the
// edge in doubles, eight triangles at a time. Each hides nothing, hides an interval for certain, or is left open. These
// operations are those of hidden_by() and of the bounds of exact_vector.h, so that every lane has the same bits.

#include "lines/hiding/occluder.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/hiding/shadow_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After base/highway-inl.h, for each target.
#include "base/lanes-inl.h"
#include "lines/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::lines_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, OccluderBatch::most>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using DF = hn::CappedTag<float, 16>;

using Vector3 = Lanes3<V>;
using LaneNormals = BoundedNormals<V>;

/// Values of functions, with masks that tell whose signs are certain.
struct Values {
  V value;
  M is_positive, is_negative, is_zero;

  /// Dot products of n and v, times `sign`; zero in the lanes of `is_on`. Each coordinate of v may be wrong by `slack`.
  HWY_INLINE Values(const LaneNormals& n, const Vector3& v, V sign, M is_on, double slack) {
    const D d;
    value = hn::Mul(Dot(n.value, v), sign);
    const Vector3 size = Abs(n.value);
    V error = n.ErrorOfDot(v);
    if (slack > 0) error = hn::Add(error, hn::Mul(hn::Set(d, slack), hn::Add(hn::Add(size.x, size.y), size.z)));
    is_positive = hn::AndNot(is_on, hn::Gt(value, error));
    is_negative = hn::AndNot(is_on, hn::Lt(value, hn::Neg(error)));
    is_zero = hn::Or(is_on, hn::Eq(error, hn::Zero(d)));
  }
};

/// The part of the edge that is left so far.
struct Rest {
  V begin, end;
  M is_gone, is_open;

  /// where_positive() for vectors. `along`: whether an edge that lies in the plane is removed, kept, or left undecided.
  enum class Along { gone, kept, open };
  template <Along along>
  HWY_INLINE void Keep(const Values& a, const Values& b) {
    const M above_a = hn::Or(a.is_positive, a.is_zero), above_b = hn::Or(b.is_positive, b.is_zero);
    const M below = hn::And(hn::Or(a.is_negative, a.is_zero), hn::Or(b.is_negative, b.is_zero));
    const M on = hn::And(a.is_zero, b.is_zero);
    is_gone = hn::Or(is_gone, along == Along::gone ? below : hn::AndNot(on, below));
    if (along == Along::open) is_open = hn::Or(is_open, on);
    const M known = hn::And(hn::Or(above_a, a.is_negative), hn::Or(above_b, b.is_negative));
    is_open = hn::Or(is_open, hn::Not(known));
    const M falls = hn::And(a.is_positive, b.is_negative), rises = hn::And(a.is_negative, b.is_positive);
    const V from_a = hn::Abs(a.value), root = hn::Div(from_a, hn::Add(from_a, hn::Abs(b.value)));
    begin = hn::IfThenElse(rises, hn::Max(begin, root), begin);
    end = hn::IfThenElse(falls, hn::Min(end, root), end);
  }
};

struct CornerLanes {
  Vector3 place;
  M is_from, is_to;  // whether the corner is an end of the edge
};

template <bool needs_depth>
HWY_INLINE void Ask(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden) {
  const D d;
  // A constructed end may also lie in a plane by the numbers of its edge's vertices; hidden_by() decides that.
  const bool has_vertices = edge.slack == 0;
  const V from_vertex = hn::Set(d, has_vertices ? double(edge.from_on[0]) : -1.0);
  const V to_vertex = hn::Set(d, has_vertices ? double(edge.to_on[0]) : -1.0);
  const Vector3 from = Splat(D(), edge.from), to = Splat(D(), edge.to);
  const Vector3 axis = Splat(D(), sight.is_parallel() ? sight.forward() : sight.eye());
  hidden.hides = hidden.open = 0;
  for (std::size_t i = 0; i < batch.count; i += hn::Lanes(d)) {
    CornerLanes corner[3];
    for (int k = 0; k < 3; ++k) {
      const auto load = [&](int c) HWY_ATTR { return hn::Load(d, batch.corners[3 * k + c] + i); };
      const V vertex = hn::Load(d, batch.vertices[k] + i);
      corner[k] = {{load(0), load(1), load(2)}, hn::Eq(vertex, from_vertex), hn::Eq(vertex, to_vertex)};
    }
    const V turn = hn::Load(d, batch.turn + i), against = hn::Neg(turn);
    const M none = hn::FirstN(d, 0);
    Rest rest{hn::Zero(d), hn::Set(d, 1.0), none, none};
    if (needs_depth) {
      const LaneNormals face(Minus(corner[1].place, corner[0].place), Minus(corner[2].place, corner[0].place));
      const Vector3 from_0 = Minus(from, corner[0].place), to_0 = Minus(to, corner[0].place);
      const auto any = [](M a, M b, M c) HWY_ATTR { return hn::Or(hn::Or(a, b), c); };
      rest.Keep<Rest::Along::gone>(
          Values(face, from_0, against, any(corner[0].is_from, corner[1].is_from, corner[2].is_from), edge.slack),
          Values(face, to_0, against, any(corner[0].is_to, corner[1].is_to, corner[2].is_to), edge.slack));
    }
    // A turn has the opposite sign of the product with the plane's normal.
    const auto keep_within = [&](const CornerLanes& p, const CornerLanes& q, V sign) HWY_ATTR {
      if (hn::AllTrue(D(), rest.is_gone)) return;
      const LaneNormals side(sight.is_parallel() ? axis : Minus(p.place, axis), Minus(q.place, p.place));
      rest.Keep<needs_depth ? Rest::Along::kept : Rest::Along::open>(
          Values(side, Minus(from, p.place), sign, hn::Or(p.is_from, q.is_from), edge.slack),
          Values(side, Minus(to, p.place), sign, hn::Or(p.is_to, q.is_to), edge.slack));
    };
    keep_within(corner[0], corner[1], against);
    keep_within(corner[1], corner[2], against);
    keep_within(corner[0], corner[2], turn);
    const M is_left = hn::AndNot(rest.is_gone, hn::Lt(rest.begin, rest.end));
    hn::Store(rest.begin, d, hidden.begin + i);
    hn::Store(rest.end, d, hidden.end + i);
    const std::uint64_t left = frontmost::HWY_NAMESPACE::BitsOf(d, is_left);
    const std::uint64_t open = frontmost::HWY_NAMESPACE::BitsOf(d, hn::And(is_left, rest.is_open));
    hidden.hides |= std::uint32_t((left & ~open) << i);
    hidden.open |= std::uint32_t(open << i);
  }
  const std::uint32_t used = (1u << batch.count) - 1;
  hidden.hides &= used;
  hidden.open &= used;
}

void HideBatch(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden) {
  Ask<true>(batch, edge, sight, hidden);
}
void CoverBatch(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden) {
  Ask<false>(batch, edge, sight, hidden);
}

std::uint64_t Overlapping(const ScreenBoxes& boxes, std::size_t count, const ScreenPart& part) {
  const DF d;
  const auto low_x = hn::Set(d, part.low.x), low_y = hn::Set(d, part.low.y);
  const auto high_x = hn::Set(d, part.high.x), high_y = hn::Set(d, part.high.y), farthest = hn::Set(d, part.farthest);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto in_x =
        hn::And(hn::Le(hn::LoadU(d, boxes.low_x + i), high_x), hn::Ge(hn::LoadU(d, boxes.high_x + i), low_x));
    const auto in_y =
        hn::And(hn::Le(hn::LoadU(d, boxes.low_y + i), high_y), hn::Ge(hn::LoadU(d, boxes.high_y + i), low_y));
    const auto is_before = hn::Le(hn::LoadU(d, boxes.nearest + i), farthest);
    bits |= frontmost::HWY_NAMESPACE::BitsOf(d, hn::And(hn::And(in_x, in_y), is_before)) << i;
  }
  return count < 64 ? bits & ((std::uint64_t(1) << count) - 1) : bits;
}

std::uint64_t WithinSides(const ScreenSides& sides, std::size_t count, const ScreenSegment& segment) {
  const DF d;
  const auto from_x = hn::Set(d, segment.from.x), from_y = hn::Set(d, segment.from.y);
  const auto to_x = hn::Set(d, segment.to.x), to_y = hn::Set(d, segment.to.y);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    auto is_outside = hn::FirstN(d, 0);
    for (int k = 0; k < ScreenSides::count; ++k) {
      const auto a = hn::LoadU(d, sides.a[k] + i), b = hn::LoadU(d, sides.b[k] + i), c = hn::LoadU(d, sides.c[k] + i);
      const auto at_from = hn::Add(hn::Add(hn::Mul(a, from_x), hn::Mul(b, from_y)), c);
      const auto at_to = hn::Add(hn::Add(hn::Mul(a, to_x), hn::Mul(b, to_y)), c);
      const bool is_plane = k + 1 == ScreenSides::count;
      const auto from_least = hn::Set(d, is_plane ? segment.from_nearness : 0.0f);
      const auto to_least = hn::Set(d, is_plane ? segment.to_nearness : 0.0f);
      is_outside = hn::Or(is_outside, hn::And(hn::Lt(at_from, from_least), hn::Lt(at_to, to_least)));
    }
    bits |= frontmost::HWY_NAMESPACE::BitsOf(d, hn::Not(is_outside)) << i;
  }
  return count < 64 ? bits & ((std::uint64_t(1) << count) - 1) : bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::lines_detail {

FRONTMOST_KERNELS(Overlapping);
FRONTMOST_KERNELS(WithinSides);
FRONTMOST_KERNELS(HideBatch);
FRONTMOST_KERNELS(CoverBatch);

ShadowKernels shadow_kernels(Isa isa) {
  return {kernel_for(OverlappingKernels, isa), kernel_for(WithinSidesKernels, isa), kernel_for(HideBatchKernels, isa),
          kernel_for(CoverBatchKernels, isa)};
}

}  // namespace frontmost::lines_detail
#endif  // HWY_ONCE
