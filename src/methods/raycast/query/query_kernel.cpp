// SPDX-License-Identifier: Apache-2.0
// Takes one ray through the tree, sixteen boxes or triangles at a time. Vectors only leave out triangles that are
// certainly missed, or lie behind a certain hit; meet() decides the others, one or two triangles a ray. In large trees
// the rays of a batch take turns: while one ray waits for memory, the others work.
//
//    ray 0   fetch ------> work   fetch ------> work       Nodes of large trees come from memory. While one ray's next
//    ray 1      fetch ------> work   fetch ------>         node is on its way, other rays visit theirs, so that the
//    ray 2         fetch ------> work   fetch ------>      waiting overlaps.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "raycast/query/queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/query/query_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lanes-inl.h"
#include "raycast/query/ray_axis-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A child, and the t at which the ray enters its box.
struct Entry {
  float t;
  std::uint32_t child;
};

class QueryWalker {
 public:
  /// Precondition: `stack` has room for tree.stack_size() entries.
  QueryWalker(const RayTree& tree, const Query& query, Want want, Entry* stack, std::vector<RayHit>& hits)
      : tree_(tree), q_(query), axis_(query), want_(want), stack_(stack), hits_(hits) {
    if (query.is_segment) end_ = 1;
    for (int axis = 0; axis < 3; ++axis) slab_[axis] = SlabOf(axis);
    stack_[waiting_++] = {0, tree.root};
  }

  /// Visits one node or leaf. \returns false once the walk has ended and `hits` is complete.
  bool Step() {
    const Entry next = stack_[--waiting_];
    if ((next.child & kLeafBit) == 0) {
      waiting_ += LookInto(tree_.nodes[next.child], stack_ + waiting_);
    } else if (want_ == Want::closest) {
      NoteLeaf(tree_.leaf(next.child));
    } else if (MeetLeaf(tree_.leaf(next.child)) && want_ == Want::any) {
      return false;
    }
    while (waiting_ != 0 && stack_[waiting_ - 1].t > end_) --waiting_;
    if (waiting_ == 0) {
      Settle();
      return false;
    }
    tree_.prefetch(stack_[waiting_ - 1].child);
    return true;
  }

 private:
  /// Computes t = bound * inverse - start for a bound of a box along one axis. The two starts are widened by all
  /// rounding errors, also those of subnormal floats and of a segment's rounded end.
  struct Slab {
    float inverse, start_enter, start_leave;
    bool rests, is_flipped;
  };

  /// A triangle that may be met, but not before the place `from`.
  struct Noted {
    float from;
    PrimitiveId id;
    std::array<glm::vec3, 3> corners;
  };
  static constexpr std::size_t kMostNoted = 16;

  [[nodiscard]] Slab SlabOf(int axis) const {
    const double d = q_.direction[axis], o = q_.origin[axis];
    const double size = std::max({double(std::abs(tree_.bounds.low[axis])), double(std::abs(tree_.bounds.high[axis])),
                                  std::abs(o), q_.is_segment ? double(std::abs(q_.end[axis])) : 0.0});
    constexpr float all = std::numeric_limits<float>::infinity();
    // An axis along which the ray hardly moves excludes no box. If the ray does not move along it at all, Beside()
    // tests it.
    const double reach = std::max(1.0, size) / std::abs(d);
    if (!(reach < 0x1p120) || std::isinf(d)) return {0, all, -all, d == 0, false};
    const double inverse = 1 / d, slack = 0x1p-20 * size * std::abs(inverse) + 0x1p-146;
    return {float(inverse), float(o * inverse + slack), float(o * inverse - slack), false, inverse < 0};
  }

  /// Returns the boxes that the ray cannot meet, because it does not move along an axis and is outside their range.
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

  /// Pushes the children that the ray enters, the nearest last. \returns their number.
  std::size_t LookInto(const RayNode& node, Entry* top) const {
    const QF d;
    const QU du;
    const QI di;
    alignas(64) std::int32_t at[kRayLanes + kQueryLanes];
    alignas(64) std::uint32_t child[kRayLanes + kQueryLanes];
    std::size_t count = 0;
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
      const QM inside = hn::AndNot(outside, hn::FirstN(d, node.count - first));
      const Compactor<QF> entered(inside);
      entered.Store(hn::BitCast(di, enter), at + count);
      entered.Store(hn::Load(du, node.child + first), child + count);
      count += entered.count();
    }
    for (std::size_t i = 0; i < count; ++i) top[RankOf(at, count, i)] = {bits_as<float>(at[i]), child[i]};
    return count;
  }

  /// Visits a leaf for the closest hit. Triangles that may be met are noted and decided later, because most of them
  /// turn out to lie behind nearer certain hits.
  void NoteLeaf(const RayLeaf& leaf) {
    const QF d;
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes) {
      const Passes passes = axis_.Pass(leaf, first);
      const Candidates candidates = CandidatesOf(passes);
      if (candidates.possible == 0) continue;
      alignas(64) float from[kQueryLanes], to[kQueryLanes];
      hn::Store(passes.from, d, from);
      hn::Store(passes.to, d, to);
      if (!tree_.cutouts && !q_.is_one_way)
        for (std::uint32_t bits = candidates.certain; bits != 0; bits &= bits - 1)
          EndAt(to[hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)]);
      for (std::uint32_t bits = candidates.possible; bits != 0; bits &= bits - 1) {
        const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        if (!(from[lane] > axis_.place_of(end_))) Note(leaf, first + lane, from[lane]);
      }
    }
  }

  /// Moves the end of the ray to a place where it certainly meets a triangle. Triangles that begin beyond it are not
  /// the closest.
  void EndAt(float place) { end_ = std::min(end_, axis_.t_of(place) * (1 + 0x1p-20f) + 0x1p-148f); }

  void Note(const RayLeaf& leaf, std::size_t lane, float from) {
    if (leaf.id[lane] == no_primitive) return;
    // If there is no room, the noted triangles are decided now, which only costs time.
    if (noted_ == kMostNoted) Settle();
    notes_[noted_++] = {from, leaf.id[lane], leaf.corners_of(lane)};
  }

  /// Decides the noted triangles.
  void Settle() {
    for (std::size_t i = 0; i < noted_; ++i) {
      const Noted& note = notes_[i];
      if (note.from > axis_.place_of(end_)) continue;
      const RayHit hit = meet(q_, note.corners, note.id);
      if (hit.primitive != no_primitive && !passes(tree_, q_, hit)) Keep(hit);
    }
    noted_ = 0;
  }

  bool MeetLeaf(const RayLeaf& leaf) {
    bool met = false;
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes) {
      const Candidates candidates = CandidatesOf(axis_.Pass(leaf, first));
      // Any hit suffices, so only its id is given.
      if (want_ == Want::any && candidates.certain != 0 && !tree_.cutouts && !q_.is_one_way) {
        const std::size_t lane = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(candidates.certain);
        hits_.push_back({leaf.id[lane], 0, false});
        return true;
      }
      for (std::uint32_t bits = candidates.possible; bits != 0; bits &= bits - 1) {
        const std::size_t lane = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        if (leaf.id[lane] == no_primitive) continue;
        const RayHit hit = meet(q_, leaf.corners_of(lane), leaf.id[lane]);
        if (hit.primitive == no_primitive || passes(tree_, q_, hit)) continue;
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
    // The end is rounded up, because boxes at the same t may hold an equal hit with a lower id.
    if (want_ == Want::closest) end_ = std::min(end_, float(hits_[0].t) * (1 + 0x1p-22f) + 0x1p-148f);
  }

  struct Candidates {
    std::uint32_t possible, certain;
  };

  /// Returns which triangles are possible and which are certain hits. Triangles before the start or beyond the end are
  /// missed.
  [[nodiscard]] HWY_INLINE Candidates CandidatesOf(const Passes& p) const {
    const QF d;
    const float end = axis_.place_of(end_);
    const QM outside = hn::Or(hn::Lt(p.to, hn::Zero(d)), hn::Gt(p.from, hn::Set(d, end * (1 + 0x1p-20f))));
    const QM between = hn::And(hn::Gt(p.from, hn::Zero(d)), hn::Lt(p.to, hn::Set(d, end * (1 - 0x1p-20f))));
    constexpr std::uint32_t all = (1u << kQueryLanes) - 1;
    return {~QueryBits(hn::Or(p.beside, outside)) & all, QueryBits(hn::And(p.inside, between))};
  }

  const RayTree& tree_;
  const Query& q_;
  RayAxis axis_;
  Want want_;
  Entry* stack_;
  std::size_t waiting_ = 0;
  std::vector<RayHit>& hits_;
  float end_ = std::numeric_limits<float>::infinity();
  Slab slab_[3];
  std::size_t noted_ = 0;
  Noted notes_[kMostNoted];
};

/// The stack of a walk: children that are not visited yet. Allocates memory for uncommonly deep trees only.
class WalkStack {
 public:
  explicit WalkStack(const RayTree& tree) : deep_(tree.stack_size() > kUsual ? tree.stack_size() : 0) {}
  [[nodiscard]] Entry* data() { return deep_.empty() ? usual_ : deep_.data(); }

 private:
  static constexpr std::size_t kUsual = 256;
  Entry usual_[kUsual];
  std::vector<Entry> deep_;
};

void WalkQuery(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits) {
  if (tree.root == no_index) return;
  WalkStack stack(tree);
  QueryWalker walker(tree, query, want, stack.data(), hits);
  while (walker.Step()) continue;
}

struct QueryBatch {
  const RayTree& tree;
  std::span<const Query> queries;
  Want want;
  std::span<RayHit> answers;
  std::size_t next = 0;     ///< the first query that has not begun
  std::uint64_t steps = 0;  ///< visited nodes and leaves
};

/// Answers queries of a batch, one after the other.
class BatchWalk {
 public:
  explicit BatchWalk(QueryBatch& batch) : batch_(batch), stack_(batch.tree) {}

  /// Begins the next valid query. \returns false if no query is left.
  bool Begin() {
    while (batch_.next < batch_.queries.size()) {
      number_ = batch_.next++;
      batch_.answers[number_] = {};
      if (batch_.tree.root == no_index || !is_valid(batch_.queries[number_])) continue;
      hits_.clear();
      walker_.emplace(batch_.tree, batch_.queries[number_], batch_.want, stack_.data(), hits_);
      return true;
    }
    return false;
  }

  /// Does a step of the current query, and begins the next one after its last step. \returns false if no query is left.
  bool Step() {
    ++batch_.steps;
    if (walker_->Step()) return true;
    if (!hits_.empty()) batch_.answers[number_] = hits_[0];
    return Begin();
  }

 private:
  QueryBatch& batch_;
  WalkStack stack_;
  std::size_t number_ = 0;
  std::vector<RayHit> hits_;
  std::optional<QueryWalker> walker_;
};

/// Rays that take turns wait for memory at the same time. This gives 1.4 times as many rays a second if a million
/// triangles do not fit into caches, but a tenth fewer if all triangles fit. More than eight rays gain nothing.
constexpr std::size_t kTurns = 8;
constexpr std::size_t kTurnsFromBytes = std::size_t(8) << 20;

std::uint64_t WalkBatch(const RayTree& tree, std::span<const Query> queries, Want want, std::span<RayHit> answers) {
  QueryBatch batch{tree, queries, want, answers};
  const std::size_t bytes = tree.nodes.size() * sizeof(RayNode) + tree.leaves.size() * sizeof(RayLeaf);
  const std::size_t count = bytes < kTurnsFromBytes ? 1 : HWY_MIN(kTurns, queries.size());
  if (count == 1) {
    BatchWalk only(batch);
    if (only.Begin())
      while (only.Step()) continue;
    return batch.steps;
  }
  std::vector<BatchWalk> turns;
  turns.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    turns.emplace_back(batch);
    if (!turns.back().Begin()) turns.pop_back();
  }
  std::array<BatchWalk*, kTurns> active;
  std::size_t active_count = 0;
  for (BatchWalk& turn : turns) active[active_count++] = &turn;
  while (active_count != 0)
    for (std::size_t k = 0; k < active_count;)
      if (active[k]->Step())
        ++k;
      else
        active[k] = active[--active_count];
  return batch.steps;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(WalkQuery);
FRONTMOST_KERNELS(WalkBatch);

void walk(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits, Isa isa) {
  kernel_for(WalkQueryKernels, isa)(tree, query, want, hits);
}

std::uint64_t walk_batch(const RayTree& tree, std::span<const Query> queries, Want want, std::span<RayHit> answers,
                         Isa isa) {
  return kernel_for(WalkBatchKernels, isa)(tree, queries, want, answers);
}

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
