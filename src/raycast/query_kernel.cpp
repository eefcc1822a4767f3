// SPDX-License-Identifier: Apache-2.0
// One ray through the tree: sixteen boxes or triangles at a time. Vectors only leave out what is certainly missed; what
// remains, one or two triangles a ray, is decided by meet().

#include "raycast/query_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raycast/index/placement.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/query_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using QF = hn::CappedTag<float, kRayLanes>;
using QV = hn::Vec<QF>;
using QM = hn::Mask<QF>;
constexpr std::size_t kQueryLanes = hn::MaxLanes(QF());

/// A child, and where the ray enters its box.
struct Entry {
  float t;
  std::uint32_t child;
};

HWY_INLINE std::uint32_t QueryBits(QM mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(QF(), mask, bytes);
  return (std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) & ((1u << kQueryLanes) - 1);
}

class QueryWalker {
 public:
  QueryWalker(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits)
      : tree_(tree), walk_(tree), q_(query), want_(want), hits_(hits) {
    if (query.is_segment) end_ = 1;
    for (int axis = 0; axis < 3; ++axis) slab_[axis] = SlabOf(axis);
    const glm::vec3 size = glm::abs(query.direction);
    along_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u_ = (along_ + 1) % 3, v_ = (along_ + 2) % 3;
    slope_u_ = query.direction[u_] / query.direction[along_];
    slope_v_ = query.direction[v_] / query.direction[along_];
  }

  void Walk() {
    std::vector<Entry>& stack = Stack();
    stack.clear();
    stack.push_back({0, tree_.root});
    while (!stack.empty()) {
      const Entry next = stack.back();
      stack.pop_back();
      walk_.Take(stack.size());
      if (!walk_.IsAround(stack.size())) walk_.Prefetch(stack.back().child);
      if (next.t > end_) continue;
      if (HWY_UNLIKELY(walk_.IsInstance(next.child))) {
        stack.push_back({next.t, walk_.Enter(next.child, stack.size())});
      } else if (next.child & kLeafBit) {
        if (MeetLeaf(walk_.Leaf(next.child)) && want_ == Want::any) return;
      } else {
        LookInto(walk_.Node(next.child), stack);
      }
    }
  }

 private:
  /// Kept from query to query, so that a million queries do not allocate a million times.
  static std::vector<Entry>& Stack() {
    thread_local std::vector<Entry> stack;
    return stack;
  }

  /// t = bound * inverse - start, widened by all rounding; the end of a segment is rounded too.
  struct Slab {
    float inverse, start_enter, start_leave;
    bool rests, is_flipped;
  };

  [[nodiscard]] Slab SlabOf(int axis) const {
    const double d = q_.direction[axis], o = q_.origin[axis];
    const double size = std::max({double(std::abs(tree_.bounds.low[axis])), double(std::abs(tree_.bounds.high[axis])),
                                  std::abs(o), q_.is_segment ? double(std::abs(q_.end[axis])) : 0.0});
    constexpr float all = std::numeric_limits<float>::infinity();
    // An axis along which the ray hardly moves says nothing, except where it does not move at all.
    const double reach = std::max(1.0, size) / std::abs(d);
    if (!(reach < 0x1p120) || std::isinf(d)) return {0, all, -all, d == 0, false};
    const double inverse = 1 / d, slack = 0x1p-20 * size * std::abs(inverse);
    return {float(inverse), float(o * inverse + slack), float(o * inverse - slack), false, inverse < 0};
  }

  /// Boxes that the ray cannot meet as it does not move along an axis.
  [[nodiscard]] HWY_NOINLINE QM Beside(const RayNode& node, std::size_t first) const {
    const QF d;
    QM beside = hn::MaskFromVec(hn::Zero(d));
    for (int axis = 0; axis < 3; ++axis) {
      if (!slab_[axis].rests) continue;
      const QV o = hn::Set(d, q_.origin[axis]);
      const QM below = hn::Gt(hn::Load(d, node.low[axis] + first), o);
      beside = hn::Or(beside, hn::Or(below, hn::Lt(hn::Load(d, node.high[axis] + first), o)));
    }
    return beside;
  }

  void LookInto(const RayNode& node, std::vector<Entry>& stack) const {
    const QF d;
    const std::size_t first_new = stack.size();
    for (std::size_t first = 0; first < node.count; first += kQueryLanes) {
      QV enter = hn::Zero(d), leave = hn::Set(d, end_);
      for (int axis = 0; axis < 3; ++axis) {
        const Slab& s = slab_[axis];
        const QV near = hn::Load(d, (s.is_flipped ? node.high : node.low)[axis] + first);
        const QV far = hn::Load(d, (s.is_flipped ? node.low : node.high)[axis] + first);
        const QV inverse = hn::Set(d, s.inverse);
        enter = hn::Max(enter, hn::Sub(hn::Mul(near, inverse), hn::Set(d, s.start_enter)));
        leave = hn::Min(leave, hn::Sub(hn::Mul(far, inverse), hn::Set(d, s.start_leave)));
      }
      QM outside = hn::Gt(enter, leave);
      if (HWY_UNLIKELY(slab_[0].rests || slab_[1].rests || slab_[2].rests))
        outside = hn::Or(outside, Beside(node, first));
      alignas(64) float at[kQueryLanes];
      hn::Store(enter, d, at);
      const std::uint32_t used = (1u << std::min<std::size_t>(kQueryLanes, node.count - first)) - 1;
      for (std::uint32_t inside = ~QueryBits(outside) & used; inside != 0; inside &= inside - 1) {
        const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(inside);
        stack.push_back({at[lane], node.child[first + lane]});
      }
    }
    // The nearest last. Few are entered, so insertion is quick.
    for (std::size_t i = first_new + 1; i < stack.size(); ++i) {
      const Entry entry = stack[i];
      std::size_t k = i;
      for (; k > first_new && stack[k - 1].t < entry.t; --k) stack[k] = stack[k - 1];
      stack[k] = entry;
    }
  }

  bool MeetLeaf(const RayLeaf& leaf) {
    bool met = false;
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes) {
      const Candidates candidates = CandidatesOf(leaf, first);
      if (want_ == Want::any && candidates.certain != 0 && !tree_.cutouts) {
        const std::size_t lane = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(candidates.certain);
        hits_.push_back({leaf.id[lane], 0, false});
        return true;
      }
      for (std::uint32_t bits = candidates.possible; bits != 0; bits &= bits - 1) {
        const std::size_t lane = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        if (leaf.id[lane] == no_primitive) continue;
        std::array<glm::vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = {leaf.corner[k][0][lane], leaf.corner[k][1][lane], leaf.corner[k][2][lane]};
        const RayHit hit = meet(q_, corners, leaf.id[lane]);
        if (hit.primitive == no_primitive || LooksThrough(hit)) continue;
        met = true;
        Keep(hit);
      }
    }
    return met;
  }

  [[nodiscard]] HWY_INLINE bool LooksThrough(const RayHit& hit) const {
    const Cutouts* const cutouts = tree_.cutouts.get();
    if (!cutouts || !cutouts->has(hit.primitive)) return false;
    const glm::dvec3 along = q_.is_segment ? glm::dvec3(q_.end) - glm::dvec3(q_.origin) : glm::dvec3(q_.direction);
    return (*cutouts)[hit.primitive].is_hole_at(glm::dvec3(q_.origin) + hit.t * along);
  }

  void Keep(const RayHit& hit) {
    if (want_ == Want::all || hits_.empty()) {
      hits_.push_back(hit);
    } else if (hit.t < hits_[0].t || (hit.t == hits_[0].t && hit.primitive < hits_[0].primitive)) {
      hits_[0] = hit;
    }
    // Boxes at the same t may hold an equal hit of a lower id: the end is rounded up.
    if (want_ == Want::closest) end_ = std::min(end_, float(hits_[0].t) * (1 + 0x1p-22f) + 0x1p-148f);
  }

  struct Candidates {
    std::uint32_t possible, certain;
  };

  /// Sheared so that the ray is an axis, a triangle is met where its edges all turn about the origin in one way. What
  /// two edges certainly turn different ways about, or lies before the start or beyond the end, is missed.
  [[nodiscard]] Candidates CandidatesOf(const RayLeaf& leaf, std::size_t first) const {
    const QF d;
    QV u[3], v[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const auto from_origin = [&](int axis) HWY_ATTR {
        return hn::Sub(hn::Load(d, leaf.corner[k][axis] + first), hn::Set(d, q_.origin[axis]));
      };
      z[k] = from_origin(along_);
      u[k] = hn::Sub(from_origin(u_), hn::Mul(z[k], hn::Set(d, slope_u_)));
      v[k] = hn::Sub(from_origin(v_), hn::Mul(z[k], hn::Set(d, slope_v_)));
    }
    const auto turn = [&](int a, int b) HWY_ATTR { return hn::Sub(hn::Mul(u[a], v[b]), hn::Mul(v[a], u[b])); };
    const QV e[3] = {turn(1, 2), turn(2, 0), turn(0, 1)};
    const QV least = Least(e), most = Most(e);
    const QV wide = hn::Max(Size(u), Size(v)), error = hn::Mul(hn::Add(wide, Size(z)), hn::Set(d, 0x1p-20f));
    const QV bound = hn::Add(hn::Mul(hn::Mul(hn::Add(wide, error), error), hn::Set(d, 8.0f)), hn::Set(d, 0x1p-140f));
    const QV below = hn::Neg(bound);
    const QM beside = hn::And(hn::Gt(most, bound), hn::Lt(least, below));
    // Products of sizes below this overflow in no sum: no turn is NaN, which least and most may pass over.
    const QM serves = hn::Lt(wide, hn::Set(d, 0x1p60f));
    const QM inside = hn::And(serves, hn::Or(hn::Gt(least, bound), hn::Lt(most, below)));
    // Along the ray, in units of its direction's largest coordinate.
    const float length = q_.direction[along_];
    const QV sign = hn::Set(d, length < 0 ? -1.0f : 1.0f), end = hn::Set(d, end_ * std::abs(length));
    const QV towards[3] = {hn::Mul(z[0], sign), hn::Mul(z[1], sign), hn::Mul(z[2], sign)};
    const QV nearest = Least(towards), farthest = Most(towards);
    const QM before = hn::Lt(hn::Add(farthest, error), hn::Zero(d));
    const QM beyond = hn::Gt(hn::Sub(nearest, error), hn::Mul(end, hn::Set(d, 1 + 0x1p-20f)));
    const QM between =
        hn::And(hn::Gt(nearest, error), hn::Lt(hn::Add(farthest, error), hn::Mul(end, hn::Set(d, 1 - 0x1p-20f))));
    const std::uint32_t missed = QueryBits(hn::Or(beside, hn::Or(before, beyond)));
    constexpr std::uint32_t all = (1u << kQueryLanes) - 1;
    return {~missed & all, QueryBits(hn::And(inside, between))};
  }

  static HWY_INLINE QV Least(const QV (&x)[3]) { return hn::Min(hn::Min(x[0], x[1]), x[2]); }
  static HWY_INLINE QV Most(const QV (&x)[3]) { return hn::Max(hn::Max(x[0], x[1]), x[2]); }
  static HWY_INLINE QV Size(const QV (&x)[3]) { return hn::Max(hn::Max(hn::Abs(x[0]), hn::Abs(x[1])), hn::Abs(x[2])); }

  const RayTree& tree_;
  PlacedWalk walk_;
  const Query& q_;
  Want want_;
  std::vector<RayHit>& hits_;
  float end_ = std::numeric_limits<float>::infinity();
  Slab slab_[3];
  int along_ = 2, u_ = 0, v_ = 1;  ///< the axis that the ray moves most along, and the others
  float slope_u_ = 0, slope_v_ = 0;
};

void WalkQuery(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits) {
  if (tree.root != no_index) QueryWalker(tree, query, want, hits).Walk();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(WalkQuery);

void walk(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits, Isa isa) {
  kernel_for(WalkQueryKernels, isa)(tree, query, want, hits);
}

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
