// SPDX-License-Identifier: Apache-2.0
// Builds a tree of eight-wide leaves and nodes. Triangles in the surfaces' spatial order are cut into leaves of eight.
// The binned surface area heuristic then halves ranges of leaves, and the binary tree is cut into nodes. Parts of a
// fixed length are built by whichever thread is free, so the tree is the same for any number of threads.
//
//    leaves       [ 8 ][ 8 ][ 8 ][ 8 ] ...            clusters already are in spatial order
//    copies       a a' a'' b c c' ...                 a' and a'' are removed: the vertices of a, higher ids
//    regrouped    256 leaves at a time                so that each leaf is small: a ray visits a fourth fewer leaves
//                                                     of a scanned model than with 32 at a time
//    halved       [ A  B | C  D ]                     split where the sum of surface * leaves is least
//    nodes        [ A  B | C | D ... ]                up to eight parts, so that the sum of all surfaces is least
#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "base/parallel.h"
#include "raycast/index/ray_tree.h"

namespace frontmost {

Box box_of(const RayLeaf& leaf) {
  std::size_t count = kRayLanes;
  while (count > 1 && leaf.id[count - 1] == no_primitive) --count;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    float low = leaf.corner[0][axis][0], high = low;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t lane = 0; lane < count; ++lane) {
        low = std::min(low, leaf.corner[k][axis][lane]);
        high = std::max(high, leaf.corner[k][axis][lane]);
      }
    box.low[axis] = low;
    box.high[axis] = high;
  }
  return box;
}

namespace {

constexpr std::size_t kClustersPerPart = 64;
constexpr std::size_t kLeavesPerPart = 1024;

/// Returns leaves to be filled. The lanes of the last leaf are set, because some of them may stay unused.
Buffer<RayLeaf> leaves_for(std::size_t triangle_count) {
  Buffer<RayLeaf> leaves((triangle_count + kRayLanes - 1) / kRayLanes);
  if (leaves.empty()) return leaves;
  leaves[leaves.size() - 1] = {};
  std::fill_n(leaves[leaves.size() - 1].id, kRayLanes, no_primitive);
  return leaves;
}

/// Redistributes the triangles of a group of whole leaves: halves them by the middle triangle along the longest side of
/// their centres' box, until eight are left. The spatial order alone makes leaves that bend around its turns.
class Regrouping {
 public:
  static constexpr std::size_t kLeaves = 256;  ///< divides kLeavesPerPart

  void regroup(RayLeaf* leaves, std::size_t leaf_count) {
    const std::size_t count = leaf_count * kRayLanes;
    for (std::size_t i = 0; i < count; ++i) {
      centres_[i].triangle = std::uint16_t(i);
      for (std::size_t axis = 0; axis < 3; ++axis)
        centres_[i].at[axis] = centre(leaves[i / kRayLanes], axis, i % kRayLanes);
    }
    halve(0, leaf_count);
    std::copy_n(leaves, leaf_count, before_.data());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t from = centres_[i].triangle;
      leaves[i / kRayLanes].copy(i % kRayLanes, before_[from / kRayLanes], from % kRayLanes);
    }
  }

 private:
  struct Centre {
    float at[3];
    std::uint16_t triangle;
  };

  /// Centre of the triangle's box. Halves are added, as the sum of two large floats overflows.
  static float centre(const RayLeaf& leaf, std::size_t axis, std::size_t lane) {
    const float a = leaf.corner[0][axis][lane], b = leaf.corner[1][axis][lane], c = leaf.corner[2][axis][lane];
    return 0.5f * std::min({a, b, c}) + 0.5f * std::max({a, b, c});
  }

  void halve(std::size_t first_leaf, std::size_t leaf_count) {
    if (leaf_count < 2) return;
    Centre* const begin = centres_.data() + first_leaf * kRayLanes;
    Centre* const end = begin + leaf_count * kRayLanes;
    std::size_t longest = 0;
    float most = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float low = begin->at[axis], high = low;
      for (const Centre* c = begin; c < end; ++c) low = std::min(low, c->at[axis]), high = std::max(high, c->at[axis]);
      if (high - low > most) longest = axis, most = high - low;
    }
    const std::size_t left = leaf_count / 2;
    std::nth_element(begin, begin + left * kRayLanes, end,
                     [longest](const Centre& a, const Centre& b) { return a.at[longest] < b.at[longest]; });
    halve(first_leaf, left);
    halve(first_leaf + left, leaf_count - left);
  }

  Buffer<Centre> centres_{kLeaves * kRayLanes};
  Buffer<RayLeaf> before_{kLeaves};
};

constexpr std::size_t kTrianglesPerPart = 16384;
/// So few copies cost views next to nothing and stay in the tree, because only an index without a second tree can be
/// refitted.
constexpr std::size_t kFew = 4096;

/// Returns whether the triangle at `place` has the vertices of the triangle before it and a higher id. Both are met
/// together at the same depth, and the lower id is seen. A double-sided triangle is no copy of a one-sided triangle.
bool is_copy(const RayTree& tree, std::size_t place) {
  const RayLeaf &one = tree.leaves[(place - 1) / kRayLanes], &again = tree.leaves[place / kRayLanes];
  const std::size_t a = (place - 1) % kRayLanes, b = place % kRayLanes;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (one.corner[k][axis][a] != again.corner[k][axis][b]) return false;
  return one.id[a] < again.id[b] && (tree.sides->is_double(one.id[a]) || !tree.sides->is_double(again.id[b]));
}

/// Fills tree.leaves in the surfaces' spatial order.
void fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution) {
  const ClusterSet& set = cluster_set(surfaces, execution);
  const std::size_t parts = (set.clusters.size() + kClustersPerPart - 1) / kClustersPerPart;
  std::vector<std::size_t> first(parts + 1, 0);
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t c = begin; c < end; ++c) visit_triangles(set, set.clusters[c], [&](std::size_t) { ++count; });
    first[begin / kClustersPerPart + 1] = count;
  });
  for (std::size_t i = 0; i < parts; ++i) first[i + 1] += first[i];

  tree.triangle_count = static_cast<std::uint32_t>(first.back());
  tree.leaves = leaves_for(first.back());
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t place = first[begin / kClustersPerPart];
    for (std::size_t c = begin; c < end; ++c)
      visit_triangles(set, set.clusters[c], [&](std::size_t t) {
        RayLeaf& leaf = tree.leaves[place / kRayLanes];
        set_corners(set, set.clusters[c], t, leaf, place % kRayLanes);
        leaf.id[place++ % kRayLanes] = set.id[t];
      });
  });
}

/// Moves copies of triangles to a tree of their own if there are thousands, as when an object is placed a million times
/// in one place. Only the leaves of the new tree are filled. Leaves of `tree` are in the surfaces' spatial order, in
/// which copies follow each other. \returns the new tree; null, with nothing changed, if there are few copies.
std::shared_ptr<RayTree> take_copies(RayTree& tree, const Execution& execution) {
  // Copies with holes may be open where the original is not.
  if (tree.cutouts || tree.triangle_count <= kFew) return nullptr;
  std::atomic<std::size_t> count{0};
  parallel_for(execution, tree.triangle_count, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) here += is_copy(tree, i);
    count += here;
  });
  if (count <= kFew) return nullptr;
  const auto copies = std::make_shared<RayTree>();
  copies->triangle_count = std::uint32_t(count);
  copies->leaves = leaves_for(count);
  Buffer<RayLeaf> kept = leaves_for(tree.triangle_count - count);
  std::size_t copied = 0;
  for (std::size_t i = 0; i < tree.triangle_count; ++i) {
    const bool is_again = i > 0 && is_copy(tree, i);
    const std::size_t place = is_again ? copied++ : i - copied;
    (is_again ? copies->leaves : kept)[place / kRayLanes].copy(place % kRayLanes, tree.leaves[i / kRayLanes],
                                                               i % kRayLanes);
  }
  tree.leaves = std::move(kept);
  tree.triangle_count -= copies->triangle_count;
  return copies;
}

/// A leaf and its bounds, for building nodes.
struct LeafBox {
  Box box;
  std::uint32_t leaf;
};

/// Redistributes triangles within a few leaves at a time, so that leaves get small. \returns the box of every leaf.
std::vector<LeafBox> group_leaves(RayTree& tree, const Execution& execution) {
  const std::size_t total = tree.triangle_count, leaf_count = tree.leaves.size();
  std::vector<LeafBox> boxes(leaf_count);
  parallel_for(execution, leaf_count, kLeavesPerPart, [&](std::size_t begin, std::size_t end) {
    // The last leaf, if not full, stays as it is, with its unused lanes at the end.
    const std::size_t whole_end = std::min(end, total / kRayLanes);
    Regrouping regrouping;
    for (std::size_t i = begin; i + 1 < whole_end; i += Regrouping::kLeaves)
      regrouping.regroup(tree.leaves.data() + i, std::min(Regrouping::kLeaves, whole_end - i));
    for (std::size_t i = begin; i < end; ++i) boxes[i] = {box_of(tree.leaves[i]), std::uint32_t(i)};
  });
  return boxes;
}

constexpr int kBins = 16;
/// Number of leaves of a piece, which one thread builds. Compared with splitting all leaves by area, the speed of views
/// differs by less than the noise of 3 %, and two threads build in three quarters of the time.
constexpr std::size_t kPieceLeaves = 4096;
/// Fewer leaves than this are halved in place: their order already is a good one, and bins cost more than they save.
constexpr std::size_t kBinFrom = 4;
/// Ranges below so many forks are halved in place, too. Building is recursive, and coordinates that shrink
/// geometrically would make a branch of thousands of forks.
constexpr std::uint32_t kBinDepth = 64;

struct BoxRange {
  std::size_t begin = 0, end = 0;
  Box box;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Halves are added, as the sum of two large floats can overflow.
glm::vec3 centre_of(const Box& b) { return 0.5f * b.low + 0.5f * b.high; }

float half_area(const Box& box) {
  const glm::vec3 d = box.high - box.low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Bin {
  Box box;
  std::uint32_t count = 0;
};

struct BoxSplit {
  int axis = -1;
  int bin = 0;  ///< the first bin on the right
  float cost = std::numeric_limits<float>::infinity();
};

/// The bin that a centre falls into, along each axis.
struct Binning {
  glm::vec3 origin, scale;

  explicit Binning(const Box& centres) : origin(centres.low) {
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centres.high[axis] - centres.low[axis];
      // If the extent is zero, not finite, or so small that the scale overflows, all centres fall into the first bin.
      const float wanted = kBins * 0.9999f / extent;
      scale[axis] = extent > 0 && wanted < std::numeric_limits<float>::max() ? wanted : 0.0f;
    }
  }
  [[nodiscard]] int operator()(const glm::vec3& centre, int axis) const {
    // This order of arguments makes NaN, the difference of infinities, count as 0.
    return std::min(int(std::max(0.0f, (centre[axis] - origin[axis]) * scale[axis])), kBins - 1);
  }
};

using Bins = std::array<std::array<Bin, kBins>, 3>;

void consider(const std::array<Bin, kBins>& bins, int axis, BoxSplit& best) {
  std::array<float, kBins> right_cost;
  Box box;
  std::uint32_t count = 0;
  for (int i = kBins - 1; i > 0; --i) {
    box.include(bins[std::size_t(i)].box);
    count += bins[std::size_t(i)].count;
    right_cost[std::size_t(i)] = count == 0 ? 0 : half_area(box) * float(count);
  }
  box = {};
  count = 0;
  std::uint32_t total = 0;
  for (const Bin& bin : bins) total += bin.count;
  for (int i = 1; i < kBins; ++i) {
    box.include(bins[std::size_t(i - 1)].box);
    count += bins[std::size_t(i - 1)].count;
    // A split must leave something on either side, or building would never end.
    if (count == 0 || count == total) continue;
    const float cost = half_area(box) * float(count) + right_cost[std::size_t(i)];
    if (cost < best.cost) best = {axis, i, cost};
  }
}

/// Nodes over one range; children are numbered within the piece.
struct NodePiece {
  BoxRange range;
  std::vector<RayNode> nodes;
  std::uint32_t root = 0, depth = 0;
};

/// A binary tree over the leaves is made first, and then cut into nodes of up to eight children, so that the sum of the
/// nodes' surfaces is least: rays then visit the fewest nodes.
///
/// H. Ylitie, T. Karras, S. Laine. Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs. 2017.
class PieceBuilder {
 public:
  PieceBuilder(std::vector<LeafBox>& boxes, NodePiece& piece) : boxes_(boxes), piece_(piece) {}

  /// Builds the piece over boxes [begin, end).
  void build(std::size_t begin, std::size_t end) {
    piece_.range = range_of(begin, end);
    forks_.reserve(2 * piece_.range.size());
    piece_.root = make_node(make_fork(piece_.range, 0), 0);
  }

 private:
  /// A node of the binary tree. cost[i] is the least cost of its subtree as at most i + 1 children of one node;
  /// left_count[i] of them are then on the left, or 0 if it is best as a single child.
  struct Fork {
    Box box;
    std::uint32_t left, right;  ///< forks; or a leaf, and no_index
    std::array<float, kRayLanes> cost;
    std::array<std::uint8_t, kRayLanes> left_count;

    [[nodiscard]] bool is_leaf() const { return right == no_index; }
  };

  std::uint32_t make_fork(const BoxRange& range, std::uint32_t depth) {
    Fork fork{range.box, boxes_[range.begin].leaf, no_index, {}, {}};
    if (range.size() > 1) {
      const auto [left, right] = split(range, depth);
      fork.left = make_fork(left, depth + 1);
      fork.right = make_fork(right, depth + 1);
      set_costs(fork);
    }
    forks_.push_back(fork);
    return std::uint32_t(forks_.size() - 1);
  }

  void set_costs(Fork& fork) const {
    const Fork &left = forks_[fork.left], &right = forks_[fork.right];
    for (std::size_t i = 1; i < kRayLanes; ++i) {
      float least = std::numeric_limits<float>::infinity();
      // The first division is taken even if areas that overflow make all costs infinite, or NaN.
      for (std::size_t k = 0; k < i; ++k) {
        const float cost = left.cost[k] + right.cost[i - 1 - k];
        if (k == 0 || cost < least) least = cost, fork.left_count[i] = std::uint8_t(k + 1);
      }
      fork.cost[i] = least;
    }
    fork.cost[0] = half_area(fork.box) + fork.cost[kRayLanes - 1];
    for (std::size_t i = 1; i + 1 < kRayLanes; ++i)
      if (fork.cost[0] <= fork.cost[i]) fork.cost[i] = fork.cost[0], fork.left_count[i] = 0;
  }

  /// Makes the node of a fork, before those of its children.
  std::uint32_t make_node(std::uint32_t fork, std::uint32_t depth) {
    piece_.depth = std::max(piece_.depth, depth);
    if (forks_[fork].is_leaf()) return forks_[fork].left | kLeafBit;
    std::vector<std::uint32_t> children;
    children.reserve(kRayLanes);
    divide(fork, kRayLanes, children);
    const std::size_t number = piece_.nodes.size();
    piece_.nodes.push_back({});
    for (std::size_t lane = 0; lane < children.size(); ++lane) {
      const std::uint32_t child = make_node(children[lane], depth + 1);
      piece_.nodes[number].set_box(lane, forks_[children[lane]].box);
      piece_.nodes[number].child[lane] = child;
    }
    piece_.nodes[number].count = std::uint32_t(children.size());
    return std::uint32_t(number);
  }

  /// Divides a fork into at most `count` children.
  void divide(std::uint32_t fork, std::size_t count, std::vector<std::uint32_t>& children) const {
    const Fork& f = forks_[fork];
    const std::size_t left = f.left_count[count - 1];
    if (left == 0) return children.push_back(fork);
    divide(f.left, left, children);
    divide(f.right, count - left, children);
  }

  [[nodiscard]] BoxRange range_of(std::size_t begin, std::size_t end) const {
    BoxRange range{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) range.box.include(boxes_[i].box);
    return range;
  }

  std::pair<BoxRange, BoxRange> split(const BoxRange& range, std::uint32_t depth) {
    if (range.size() >= kBinFrom && depth < kBinDepth) {
      const std::pair<BoxRange, BoxRange> halves = split_by_area(range);
      if (halves.first.size() > 0) return halves;
    }
    const std::size_t middle = range.begin + range.size() / 2;
    return {range_of(range.begin, middle), range_of(middle, range.end)};
  }

  /// \returns empty ranges if all centres are in one place, or areas exceed the range of floats.
  std::pair<BoxRange, BoxRange> split_by_area(const BoxRange& range) {
    Box centres;
    for (std::size_t i = range.begin; i < range.end; ++i) centres.include(centre_of(boxes_[i].box));
    const Binning binning(centres);
    Bins bins;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Box& box = boxes_[i].box;
      const glm::vec3 centre = centre_of(box);
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[std::size_t(axis)][std::size_t(binning(centre, axis))];
        bin.box.include(box);
        ++bin.count;
      }
    }
    BoxSplit best;
    for (int axis = 0; axis < 3; ++axis) consider(bins[std::size_t(axis)], axis, best);
    if (best.axis < 0) return {};
    const auto first = boxes_.begin() + std::ptrdiff_t(range.begin), last = boxes_.begin() + std::ptrdiff_t(range.end);
    const auto middle = std::partition(
        first, last, [&](const LeafBox& box) { return binning(centre_of(box.box), best.axis) < best.bin; });
    const auto cut = std::size_t(middle - boxes_.begin());
    BoxRange left{range.begin, cut, {}}, right{cut, range.end, {}};
    for (int i = 0; i < kBins; ++i)
      (i < best.bin ? left : right).box.include(bins[std::size_t(best.axis)][std::size_t(i)].box);
    return {left, right};
  }

  std::vector<LeafBox>& boxes_;
  NodePiece& piece_;
  std::vector<Fork> forks_;
};

/// Fills tree.nodes over the boxes, and reorders the boxes.
void build_nodes(std::vector<LeafBox>& boxes, RayTree& tree, const Execution& execution) {
  if (boxes.empty()) return;
  std::vector<NodePiece> pieces((boxes.size() + kPieceLeaves - 1) / kPieceLeaves);
  parallel_for(execution, boxes.size(), kPieceLeaves, [&](std::size_t begin, std::size_t end) {
    PieceBuilder(boxes, pieces[begin / kPieceLeaves]).build(begin, end);
  });

  // The piece above all others, whose leaves are the pieces.
  std::vector<LeafBox> roots;
  for (std::uint32_t p = 0; p < pieces.size(); ++p) roots.push_back({pieces[p].range.box, p});
  NodePiece top;
  PieceBuilder(roots, top).build(0, roots.size());
  tree.set_bounds(top.range.box);

  std::vector<std::uint32_t> first(pieces.size() + 1, std::uint32_t(top.nodes.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i) first[i + 1] = first[i] + std::uint32_t(pieces[i].nodes.size());
  tree.nodes = Buffer<RayNode>(first.back());
  const auto in_piece = [&](std::uint32_t p, std::uint32_t child) {
    return child & kLeafBit ? child : child + first[p];
  };
  const auto in_top = [&](std::uint32_t child) {
    return child & kLeafBit ? in_piece(child & ~kLeafBit, pieces[child & ~kLeafBit].root) : child;
  };
  for (std::size_t n = 0; n < top.nodes.size(); ++n) {
    RayNode& node = tree.nodes[n] = top.nodes[n];
    for (std::size_t lane = 0; lane < node.count; ++lane) node.child[lane] = in_top(node.child[lane]);
  }
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    tree.depth = std::max(tree.depth, top.depth + pieces[p].depth);
    for (std::size_t n = 0; n < pieces[p].nodes.size(); ++n) {
      RayNode& node = tree.nodes[first[p] + n] = pieces[p].nodes[n];
      for (std::size_t lane = 0; lane < node.count; ++lane) node.child[lane] = in_piece(p, node.child[lane]);
    }
  }
  tree.root = in_top(top.root);
}

void build(RayTree& tree, const Execution& execution) {
  std::vector<LeafBox> boxes = group_leaves(tree, execution);
  report_progress(execution, "index", 0.5);
  build_nodes(boxes, tree, execution);
}

}  // namespace

RayTree make_tree(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  RayTree tree;
  tree.cutouts = placed_scene(surfaces).cutouts;
  tree.sides = placed_scene(surfaces).sides;
  report_progress(execution, "index", 0);
  fill_leaves(surfaces, tree, execution);
  tree.copies = take_copies(tree, execution);
  build(tree, execution);
  if (tree.copies) build(*tree.copies, execution);
  report_progress(execution, "index", 1);
  return tree;
}

}  // namespace frontmost
