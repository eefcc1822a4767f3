// SPDX-License-Identifier: Apache-2.0
// Takes one ray through the tree, eight boxes or triangles at a time. Vectors only leave out triangles that are
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

/// A child, and a lower bound of the t at which the ray enters its box.
struct Entry {
  float t;
  std::uint32_t child;
};

/// More steps than any walk has.
constexpr std::uint64_t kToTheEnd = ~std::uint64_t(0);

/// One ray on its way through the tree.
class QueryWalk {
 public:
  /// Precondition: is_valid(query); the tree has a root; `stack` has room for tree.stack_size() entries; `all` is where
  /// all hits go, if they are wanted.
  QueryWalk(const RayTree& tree, const Query& query, Want want, Entry* stack, std::vector<RayHit>* all = nullptr)
      : tree_(tree), query_(query), axis_(query), want_(want), next_(tree.root), stack_(stack), top_(stack), all_(all) {
    if (query.is_segment) end_ = 1;
    last_place_ = axis_.place_of(end_) * (1 - 0x1p-20f);
    const glm::vec3 &d = query.direction, &o = query.origin, end = query.is_segment ? query.end : query.origin;
    slab_[0] = SlabOf(0, d.x, o.x, end.x, tree.reach.x);
    slab_[1] = SlabOf(1, d.y, o.y, end.y, tree.reach.y);
    slab_[2] = SlabOf(2, d.z, o.z, end.z, tree.reach.z);
    is_resting_ = slab_[0].rests || slab_[1].rests || slab_[2].rests;
  }

  /// Visits up to `steps` nodes and leaves, and counts them. \returns false once the walk has ended.
  HWY_INLINE bool Walk(std::uint64_t steps, std::uint64_t& count) {
    std::uint32_t next = next_;
    Entry* top = top_;
    for (; steps != 0; --steps) {
      ++count;
      if ((next & kLeafBit) == 0) {
        if (HWY_LIKELY(LookInto(tree_.nodes[next], top, next))) continue;
      } else {
        if (MeetLeaf(tree_.leaf(next))) return false;
      }
      do {
        if (top == stack_) {
          Settle();
          return false;
        }
        --top;
      } while (top->t > end_);
      next = top->child;
    }
    tree_.prefetch(next);
    next_ = next;
    top_ = top;
    return true;
  }

  /// The closest hit, or any hit, after the walk has ended.
  [[nodiscard]] const RayHit& best() const { return best_; }

 private:
  /// Computes t = bound * inverse - start for a bound of a box along one axis. The two starts are widened by all
  /// rounding errors, also those of subnormal floats and of a segment's rounded end. `near` is the place of the bounds
  /// where the ray enters, in floats from the node's begin; `far`, of those where it leaves.
  struct Slab {
    float inverse, start_enter, start_leave;
    std::uint32_t near, far;
    bool rests;
  };

  /// A triangle that may be met, but not before the place `from`. Signs of floats already decide those that are
  /// certainly met.
  struct Noted {
    float from;
    std::uint32_t lane;
    const RayLeaf* leaf;
    bool is_certain, is_front;
  };
  static constexpr std::size_t kMostNoted = 16;
  static_assert(kMostNoted >= kRayLanes);  // a walk for any hit decides leaf by leaf, so Settle() always leaves room

  /// Makes the nearest child that the ray enters the next one, and pushes the others, the nearest last. \returns false
  /// if the ray enters none.
  HWY_INLINE bool LookInto(const RayNode& node, Entry*& top, std::uint32_t& next) const {
    const QF d;
    // Bits of floats from 0 on are ordered as the floats are, even if they overflow to NaN.
    alignas(64) std::int32_t at[kRayLanes];
    std::uint32_t entered = 0;
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes) {
      QV enter[3], leave[3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Slab& s = slab_[axis];
        const QV near = hn::Load(d, node.bounds() + s.near + first), far = hn::Load(d, node.bounds() + s.far + first);
        const QV inverse = hn::Set(d, s.inverse);
        enter[axis] = hn::Sub(hn::Mul(near, inverse), hn::Set(d, s.start_enter));
        leave[axis] = hn::Sub(hn::Mul(far, inverse), hn::Set(d, s.start_leave));
      }
      const QV from = hn::Max(hn::Max(enter[0], enter[1]), hn::Max(enter[2], hn::Zero(d)));
      const QV to = hn::Min(hn::Min(leave[0], leave[1]), hn::Min(leave[2], hn::Set(d, end_)));
      QM outside = hn::Gt(from, to);
      if (HWY_UNLIKELY(is_resting_)) outside = hn::Or(outside, Beside(node, first));
      hn::Store(hn::BitCast(QI(), from), QI(), at + first);
      entered |= (~QueryBits(outside) & kAllLanes) << first;
    }
    entered &= (1u << node.count) - 1;
    if (entered == 0) return false;
    // One child or two are the usual cases, and take no branch.
    const std::uint32_t others = entered & (entered - 1);
    const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(entered);
    const std::size_t j = hwy::Num0BitsBelowLS1Bit_Nonzero32(others != 0 ? others : entered);
    const std::size_t swaps = (i ^ j) & (std::size_t(0) - std::size_t(at[j] < at[i])), near = i ^ swaps,
                      far = j ^ swaps;
    *top = {bits_as<float>(at[far]), node.child[far]};
    const Entry* const bottom = top;
    top += others != 0;
    next = node.child[near];
    std::uint32_t more = others & (others - 1);
    if (HWY_LIKELY(more == 0)) return true;
    *top++ = {bits_as<float>(at[near]), next};
    for (; more != 0; more &= more - 1) {
      const std::size_t k = hwy::Num0BitsBelowLS1Bit_Nonzero32(more);
      Entry* to = top++;
      for (; to != bottom && bits_as<std::int32_t>(to[-1].t) < at[k]; --to) *to = to[-1];
      *to = {bits_as<float>(at[k]), node.child[k]};
    }
    next = (--top)->child;
    return true;
  }

  /// Visits a leaf. If any hit is wanted, the leaf's triangles are decided at once, because the walk may end with them.
  /// \returns true if the walk has ended.
  HWY_INLINE bool MeetLeaf(const RayLeaf& leaf) {
    for (std::size_t first = 0; first < kRayLanes; first += kQueryLanes) {
      const RayAxis::Edges edges = axis_.EdgesOf(leaf, first);
      const std::uint32_t possible = RayAxis::MayPass(edges);
      if (possible != 0 && Note(leaf, first, possible, edges)) return true;
    }
    if (want_ != Want::any || noted_ == 0) return false;
    Settle();
    return bool(best_);
  }

  /// Decides the noted triangles; if any hit is wanted, up to the first one that is met.
  void Settle() {
    for (; noted_ != 0 && !(want_ == Want::any && best_); --noted_) {
      const Noted& note = notes_[noted_ - 1];
      if (want_ == Want::closest && note.from > axis_.place_of(end_)) continue;
      const std::array<glm::vec3, 3> corners = note.leaf->corners_of(note.lane);
      const PrimitiveId id = note.leaf->id[note.lane];
      const RayHit hit = note.is_certain ? certain_hit(query_, corners, id, note.is_front) : meet(query_, corners, id);
      if (hit.primitive != no_primitive && !passes(tree_, query_, hit)) Keep(hit);
    }
  }

  [[nodiscard]] HWY_INLINE Slab SlabOf(std::size_t axis, float d, float o, float end, float bound) const {
    const float size = std::max(bound, std::max(std::abs(o), std::abs(end)));
    const bool is_flipped = d < 0;
    const auto low = std::uint32_t(axis * kRayLanes), flip = is_flipped * std::uint32_t(3 * kRayLanes);
    const std::uint32_t near = low + flip, far = low + std::uint32_t(3 * kRayLanes) - flip;
    // An axis along which the ray hardly moves excludes no box. If the ray does not move along it at all, Beside()
    // tests it.
    const float inverse = 1 / d, reach = std::max(1.0f, size) * std::abs(inverse);
    if (HWY_UNLIKELY(!(reach < 0x1p120f) || inverse == 0)) {
      constexpr float all = std::numeric_limits<float>::infinity();
      return {0, all, -all, near, far, d == 0};
    }
    // Roundings of the inverse, of a segment's direction, of two products and of two sums are at most 9 half units in
    // the last place of size * inverse, and 15 if the inverse is subnormal. The slack is 16.
    const float slack = size * std::abs(inverse) * 0x1p-20f + 0x1p-140f;
    return {inverse, o * inverse + slack, o * inverse - slack, near, far, false};
  }

  /// Returns the boxes that the ray cannot meet, because it does not move along an axis and is outside their range.
  [[nodiscard]] HWY_NOINLINE QM Beside(const RayNode& node, std::size_t first) const {
    const QF d;
    QM beside = hn::MaskFromVec(hn::Zero(d));
    for (int axis = 0; axis < 3; ++axis) {
      if (!slab_[axis].rests) continue;
      const QV o = hn::Set(d, query_.origin[axis]);
      const QM below = hn::Gt(hn::Load(d, node.low[axis] + first), o);
      beside = hn::Or(beside, hn::Or(below, hn::Lt(hn::Load(d, node.high[axis] + first), o)));
    }
    return beside;
  }

  /// Notes the triangles that may be met. They are decided later, because most of them turn out to lie behind nearer
  /// certain hits.
  HWY_NOINLINE bool Note(const RayLeaf& leaf, std::size_t first, std::uint32_t possible, const RayAxis::Edges& edges) {
    const QF d;
    const Passes p = axis_.Pass(edges);
    // Triangles before the start or beyond the end are missed.
    const QM outside = hn::Or(hn::Lt(p.to, hn::Zero(d)), hn::Gt(p.from, hn::Set(d, LastPlace())));
    possible &= ~QueryBits(outside);
    if (possible == 0) return false;
    const QM between = hn::And(hn::Gt(p.from, hn::Zero(d)), hn::Lt(p.to, hn::Set(d, last_place_)));
    const std::uint32_t certain = QueryBits(hn::And(p.inside, between)) & possible;
    const bool is_whole = !tree_.cutouts && !query_.is_one_way;
    if (want_ == Want::any && is_whole && certain != 0) {
      // Any hit suffices, so only its id is given.
      best_ = {leaf.id[first + hwy::Num0BitsBelowLS1Bit_Nonzero32(certain)], 0, false};
      return true;
    }
    alignas(64) float from[kQueryLanes], to[kQueryLanes];
    hn::Store(p.from, d, from);
    hn::Store(p.to, d, to);
    for (; possible != 0; possible &= possible - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(possible);
      // The end may have come nearer since. Vectors of every length then note the same triangles.
      if (leaf.id[first + lane] == no_primitive || from[lane] > LastPlace()) continue;
      const bool is_certain = certain >> lane & 1;
      // The ray ends where it certainly meets a triangle: triangles that begin beyond are not the closest.
      if (want_ == Want::closest && is_certain && is_whole)
        end_ = std::min(end_, axis_.t_of(to[lane]) * (1 + 0x1p-20f) + 0x1p-148f);
      // If there is no room, the noted triangles are decided now, which only costs time.
      if (noted_ == kMostNoted) Settle();
      notes_[noted_++] = {from[lane], std::uint32_t(first + lane), &leaf, is_certain, (p.front >> lane & 1) != 0};
    }
    return false;
  }

  /// Triangles that begin beyond this place are not met before the end.
  [[nodiscard]] HWY_INLINE float LastPlace() const { return axis_.place_of(end_) * (1 + 0x1p-20f); }

  void Keep(const RayHit& hit) {
    if (want_ == Want::all) all_->push_back(hit);
    if (hit.t < best_.t || (hit.t == best_.t && hit.primitive < best_.primitive)) best_ = hit;
    // The end is rounded up, because boxes at the same t may hold an equal hit with a lower id.
    if (want_ == Want::closest) end_ = std::min(end_, float(best_.t) * (1 + 0x1p-22f) + 0x1p-148f);
  }

  const RayTree& tree_;
  const Query& query_;
  RayAxis axis_;
  Want want_;
  bool is_resting_ = false;
  float end_ = std::numeric_limits<float>::infinity();
  float last_place_;  ///< a triangle that is passed before this place is not beyond the segment's end
  Slab slab_[3];
  std::uint32_t next_;  ///< the child to visit next
  Entry *stack_, *top_;
  std::vector<RayHit>* all_;
  RayHit best_;
  std::size_t noted_ = 0;
  Noted notes_[kMostNoted];
};

/// The stack of a walk: children that are not visited yet. Allocates memory for uncommonly deep trees only.
class WalkStack {
 public:
  explicit WalkStack(const RayTree& tree) : deep_(tree.stack_size() > kUsual ? tree.stack_size() : 0) {}
  [[nodiscard]] Entry* data() { return deep_.empty() ? usual_ : deep_.data(); }

 private:
  static constexpr std::size_t kUsual = 128;
  Entry usual_[kUsual];
  std::vector<Entry> deep_;
};

void WalkQuery(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits) {
  if (tree.root == no_index) return;
  WalkStack stack(tree);
  QueryWalk walk(tree, query, want, stack.data(), &hits);
  std::uint64_t count = 0;
  walk.Walk(kToTheEnd, count);
  if (want != Want::all && walk.best()) hits.push_back(walk.best());
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
      walk_.emplace(batch_.tree, batch_.queries[number_], batch_.want, stack_.data());
      return true;
    }
    return false;
  }

  /// Does some steps of the current query, and begins the next one after its last step. \returns false if no query is
  /// left.
  HWY_INLINE bool Walk(std::uint64_t steps) {
    if (walk_->Walk(steps, batch_.steps)) return true;
    batch_.answers[number_] = walk_->best();
    return Begin();
  }

 private:
  QueryBatch& batch_;
  WalkStack stack_;
  std::size_t number_ = 0;
  std::optional<QueryWalk> walk_;
};

/// Rays that take turns wait for memory at the same time. This gives 1.7 times as many rays a second for a million
/// triangles, 1.1 to 1.4 times for 70 to 120 thousand, and up to a fourth fewer if the tree fits into the second-level
/// cache. More than eight rays gain nothing.
constexpr std::size_t kTurns = 8;
constexpr std::size_t kTurnsFromBytes = std::size_t(1) << 20;

std::uint64_t WalkBatch(const RayTree& tree, std::span<const Query> queries, Want want, std::span<RayHit> answers) {
  QueryBatch batch{tree, queries, want, answers};
  const std::size_t bytes = tree.nodes.size() * sizeof(RayNode) + tree.leaves.size() * sizeof(RayLeaf);
  const std::size_t count = bytes < kTurnsFromBytes ? 1 : HWY_MIN(kTurns, queries.size());
  if (count == 1) {
    BatchWalk only(batch);
    if (only.Begin())
      while (only.Walk(kToTheEnd)) continue;
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
      if (active[k]->Walk(1))
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
