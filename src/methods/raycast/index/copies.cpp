// SPDX-License-Identifier: Apache-2.0
// Copies follow each other in the spatial order of the surfaces, so one pass over neighbouring lanes finds them:
//
//    lanes    a  a' a'' b  c  c' ...        a' has the vertices of a and a higher id: a ray that meets a' meets a as
//    stay     a         b  c                well, at the same place, and a is seen
//    go          a' a''       c'
//
// Copies go only if there are thousands: a second tree costs every build a little, and an index with a second tree is
// rebuilt instead of refitted. Triangles with holes stay, because a copy may be seen through the other's hole.
#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {
namespace {

constexpr std::size_t kTrianglesPerPart = 16384;
/// Fewer copies cost views next to nothing, and an index without a second tree can be refitted.
constexpr std::size_t kFew = 4096;

/// Whether the triangle at `place` repeats the one before it with a higher id: both are met together at the same depth,
/// and the lower id is seen. A double-sided triangle is no copy of a one-sided triangle.
bool is_copy(const RayTree& tree, std::size_t place) {
  const RayLeaf &one = tree.leaves[(place - 1) / kRayLanes], &again = tree.leaves[place / kRayLanes];
  const std::size_t a = (place - 1) % kRayLanes, b = place % kRayLanes;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (one.corner[k][axis][a] != again.corner[k][axis][b]) return false;
  return one.id[a] < again.id[b] && (tree.sides->is_double(one.id[a]) || !tree.sides->is_double(again.id[b]));
}

std::size_t count_copies(const RayTree& tree, const Execution& execution) {
  std::atomic<std::size_t> count{0};
  parallel_for(execution, tree.triangle_count, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) here += is_copy(tree, i);
    count += here;
  });
  return count;
}

/// Fills leaves, starting with the first lane.
class LeafFiller {
 public:
  explicit LeafFiller(std::size_t triangle_count) : leaves_((triangle_count + kRayLanes - 1) / kRayLanes) {
    if (leaves_.empty()) return;
    RayLeaf& last = leaves_[leaves_.size() - 1] = {};
    std::fill_n(last.id, kRayLanes, no_primitive);
  }
  void add(const RayLeaf& from, std::size_t from_lane) {
    RayLeaf& to = leaves_[next_ / kRayLanes];
    const std::size_t lane = next_++ % kRayLanes;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) to.corner[k][axis][lane] = from.corner[k][axis][from_lane];
    to.id[lane] = from.id[from_lane];
  }
  [[nodiscard]] Buffer<RayLeaf> take() { return std::move(leaves_); }

 private:
  Buffer<RayLeaf> leaves_;
  std::size_t next_ = 0;
};

}  // namespace

std::shared_ptr<RayTree> take_copies(RayTree& tree, const Execution& execution) {
  // Copies with holes may be open where the original is not.
  if (tree.cutouts || tree.triangle_count <= kFew) return nullptr;
  const std::size_t count = count_copies(tree, execution);
  if (count <= kFew) return nullptr;
  const auto copies = std::make_shared<RayTree>();
  copies->triangle_count = std::uint32_t(count);
  LeafFiller again(count), kept(tree.triangle_count - count);
  for (std::size_t i = 0; i < tree.triangle_count; ++i)
    (i > 0 && is_copy(tree, i) ? again : kept).add(tree.leaves[i / kRayLanes], i % kRayLanes);
  copies->leaves = again.take();
  tree.leaves = kept.take();
  tree.triangle_count -= copies->triangle_count;
  return copies;
}

}  // namespace frontmost
