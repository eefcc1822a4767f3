// SPDX-License-Identifier: Apache-2.0
// One ray through the tree: sixteen boxes or triangles at a time. Vectors only leave out what is certainly missed; what
// remains, one or two triangles a ray, is decided by meet().

#include "raycast/query_kernel.h"

#include <algorithm>
#include <array>

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

class QueryWalker {
 public:
  QueryWalker(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits)
      : tree_(tree), q_(query), want_(want), hits_(hits) {
    if (query.is_segment) end_ = 1;
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = 0.5f * query.origin[axis];
      const float d = query.direction[axis];
      // An axis along which the ray hardly moves says nothing, except where it does not move at all.
      constexpr float least = 0x1p-100f;
      moves_[axis] = std::abs(d) >= least && std::abs(d) <= std::numeric_limits<float>::max();
      rests_[axis] = d == 0 && !query.is_segment;
      inverse_[axis] = moves_[axis] ? 2.0f / d : 0;
      // The rounded direction of a segment is off by as much as its ends' last places.
      pad_[axis] = query.is_segment ? 0x1p-22f * std::max(std::abs(query.origin[axis]), std::abs(query.end[axis])) : 0;
    }
  }

  void Walk() {
    std::vector<Entry>& stack = Stack();
    stack.clear();
    stack.push_back({0, tree_.root});
    while (!stack.empty()) {
      const Entry next = stack.back();
      stack.pop_back();
      if (next.t > end_) continue;
      if (next.child & kLeafBit) {
        if (MeetLeaf(tree_.leaves[next.child & ~kLeafBit]) && want_ == Want::any) return;
      } else {
        LookInto(tree_.nodes[next.child], stack);
      }
    }
  }

 private:
  /// Kept from query to query, so that a million queries do not allocate a million times.
  static std::vector<Entry>& Stack() {
    thread_local std::vector<Entry> stack;
    return stack;
  }

  void LookInto(const RayNode& node, std::vector<Entry>& stack) const {
    const QF d;
    const std::size_t first_new = stack.size();
    for (std::size_t first = 0; first < node.count; first += kQueryLanes) {
      QV enter = hn::Zero(d), leave = hn::Set(d, end_);
      QM outside = hn::MaskFromVec(hn::Zero(d));
      for (int axis = 0; axis < 3; ++axis) {
        const QV pad = hn::Set(d, pad_[axis]), half = hn::Set(d, 0.5f), o = hn::Set(d, origin_[axis]);
        // Halves, because differences of large floats overflow.
        const QV low = hn::Sub(hn::Mul(hn::Sub(hn::Load(d, node.low[axis] + first), pad), half), o);
        const QV high = hn::Sub(hn::Mul(hn::Add(hn::Load(d, node.high[axis] + first), pad), half), o);
        if (rests_[axis]) outside = hn::Or(outside, hn::Or(hn::Gt(low, hn::Zero(d)), hn::Lt(high, hn::Zero(d))));
        if (!moves_[axis]) continue;
        const QV inverse = hn::Set(d, inverse_[axis]);
        const QV a = hn::Mul(inverse_[axis] > 0 ? low : high, inverse),
                 b = hn::Mul(inverse_[axis] > 0 ? high : low, inverse);
        // Three roundings, and as much again.
        const QV slack = hn::Set(d, 0x1p-21f);
        enter = hn::Max(enter, hn::Sub(a, hn::Mul(hn::Abs(a), slack)));
        leave = hn::Min(leave, hn::Add(b, hn::Mul(hn::Abs(b), slack)));
      }
      outside = hn::Or(outside, hn::Gt(enter, leave));
      alignas(64) float at[kQueryLanes];
      hn::Store(enter, d, at);
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, outside, bytes);
      const std::uint32_t used = (1u << std::min<std::size_t>(kQueryLanes, node.count - first)) - 1;
      std::uint32_t inside = ~(std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) & used;
      for (; inside != 0; inside &= inside - 1) {
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
      std::uint32_t candidates = Candidates(leaf, first);
      for (; candidates != 0; candidates &= candidates - 1) {
        const std::size_t lane = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(candidates);
        if (leaf.id[lane] == no_primitive) continue;
        std::array<glm::vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = {leaf.corner[k][0][lane], leaf.corner[k][1][lane], leaf.corner[k][2][lane]};
        const RayHit hit = meet(q_, corners, leaf.id[lane]);
        if (hit.primitive == no_primitive) continue;
        met = true;
        Keep(hit);
      }
    }
    return met;
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

  /// The lanes that the line may meet: no two edges certainly turn it different ways.
  [[nodiscard]] std::uint32_t Candidates(const RayLeaf& leaf, std::size_t first) const {
    const QF d;
    QV p[3][3], size[3];
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        p[k][axis] = hn::Sub(hn::Load(d, leaf.corner[k][axis] + first), hn::Set(d, q_.origin[axis]));
      size[k] = hn::Max(hn::Max(hn::Abs(p[k][0]), hn::Abs(p[k][1])), hn::Abs(p[k][2]));
    }
    const glm::vec3 along = q_.direction;
    // Of a determinant: its six products are at most this times the sizes of two corners.
    const float length = std::abs(along.x) + std::abs(along.y) + std::abs(along.z);
    const QV scale = hn::Set(d, 0x1p-19f * length);
    const QV underflow = hn::Set(d, 0x1p-145f * length + 0x1p-145f);
    const QV zero = hn::Zero(d);
    QM some_left = hn::MaskFromVec(zero), some_right = some_left;
    for (int k = 0; k < 3; ++k) {
      const auto &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
      const auto minor = [&](int i, int j) HWY_ATTR { return hn::Sub(hn::Mul(a[i], b[j]), hn::Mul(a[j], b[i])); };
      const QV det =
          hn::Add(hn::Add(hn::Mul(hn::Set(d, along.x), minor(1, 2)), hn::Mul(hn::Set(d, along.y), minor(2, 0))),
                  hn::Mul(hn::Set(d, along.z), minor(0, 1)));
      const QV bound = hn::Add(hn::Mul(scale, hn::Mul(size[(k + 1) % 3], size[(k + 2) % 3])), underflow);
      // NaN and infinite bounds compare false: not certain.
      some_left = hn::Or(some_left, hn::Gt(det, bound));
      some_right = hn::Or(some_right, hn::Lt(det, hn::Neg(bound)));
    }
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::And(some_left, some_right), bytes);
    constexpr std::uint32_t all = (1u << kQueryLanes) - 1;
    return ~(std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) & all;
  }

  const RayTree& tree_;
  const Query& q_;
  Want want_;
  std::vector<RayHit>& hits_;
  float end_ = std::numeric_limits<float>::infinity();
  float origin_[3], inverse_[3], pad_[3];
  bool moves_[3], rests_[3];
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
