// SPDX-License-Identifier: Apache-2.0
// Builds a tree of sixteen-wide leaves and nodes. Triangles in the surfaces' spatial order are cut into leaves of
// sixteen. The binned surface area heuristic then halves ranges of leaves, the range with the largest surface first,
// until a node has sixteen children. Parts of a fixed length are built by whichever thread is free, so the tree is the
// same for any number of threads.
//
//    leaves       [ 16 ][ 16 ][ 16 ][ 16 ] ...        clusters already are in spatial order
//    copies       a a' a'' b c c' ...                 a' and a'' are removed: the vertices of a, higher ids
//    regrouped    sixteen leaves at a time            so that each leaf is small: makes single rays 20 to 40 % and
//                                                     views up to 10 % faster, and doubles the time of a build
//    nodes        [ A  B | C | D ... ]                split where the sum of surface * leaves is least
#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {

LeafBox box_of(const RayLeaf& leaf, std::uint32_t number) {
  std::size_t count = kRayLanes;
  while (count > 1 && leaf.id[count - 1] == no_primitive) --count;
  LeafBox box{};
  box.leaf = number;
  for (std::size_t axis = 0; axis < 3; ++axis) {
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

std::uint32_t count_triangles(const ClusterSet& set, std::size_t begin, std::size_t end) {
  std::uint32_t count = 0;
  for (std::size_t c = begin; c < end; ++c) {
    const Cluster& cluster = set.clusters[c];
    const std::size_t first = cluster.first_triangle;
    for (std::size_t t = first; t < first + cluster.triangle_count; ++t) count += !is_degenerate(set, t);
  }
  return count;
}

void fill(const ClusterSet& set, const Cluster& cluster, std::size_t& place, Buffer<RayLeaf>& leaves) {
  const float* const positions[3] = {set.x.data() + cluster.first_vertex, set.y.data() + cluster.first_vertex,
                                     set.z.data() + cluster.first_vertex};
  const std::size_t first = cluster.first_triangle;
  for (std::size_t t = first; t < first + cluster.triangle_count; ++t) {
    if (is_degenerate(set, t)) continue;
    RayLeaf& leaf = leaves[place / kRayLanes];
    const std::size_t lane = place % kRayLanes;
    set_corners(set, t, positions, leaf, lane);
    leaf.id[lane] = set.id[t];
    ++place;
  }
}

/// Redistributes the triangles of a group of whole leaves: halves the group at the middle triangle along the longest
/// side of the box of their centres, until sixteen triangles are left. The spatial order alone makes leaves that bend
/// around the turns of its curve.
class Regrouping {
 public:
  static constexpr std::size_t kLeaves = 16;

  void regroup(RayLeaf* leaves, std::size_t leaf_count) {
    const std::size_t count = leaf_count * kRayLanes;
    for (std::size_t i = 0; i < count; ++i) {
      centres_[i].triangle = std::uint16_t(i);
      for (std::size_t axis = 0; axis < 3; ++axis)
        centres_[i].at[axis] = centre(leaves[i / kRayLanes], axis, i % kRayLanes);
    }
    halve(0, leaf_count);
    std::copy_n(leaves, leaf_count, before_);
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
    Centre* const begin = centres_ + first_leaf * kRayLanes;
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

  Centre centres_[kLeaves * kRayLanes];
  RayLeaf before_[kLeaves];
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
  explicit LeafFiller(std::size_t triangle_count) : leaves_(leaves_for(triangle_count)) {}
  void add(const RayLeaf& from, std::size_t from_lane) {
    leaves_[next_ / kRayLanes].copy(next_ % kRayLanes, from, from_lane);
    ++next_;
  }
  [[nodiscard]] Buffer<RayLeaf> take() { return std::move(leaves_); }

 private:
  Buffer<RayLeaf> leaves_;
  std::size_t next_ = 0;
};

/// Fills tree.leaves in the surfaces' spatial order.
void fill_leaves(const Surfaces& surfaces, RayTree& tree, const Execution& execution) {
  const ClusterSet& set = cluster_set(surfaces, execution);
  const std::size_t parts = (set.clusters.size() + kClustersPerPart - 1) / kClustersPerPart;
  std::vector<std::size_t> first(parts + 1, 0);
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    first[begin / kClustersPerPart + 1] = count_triangles(set, begin, end);
  });
  for (std::size_t i = 0; i < parts; ++i) first[i + 1] += first[i];

  tree.triangle_count = static_cast<std::uint32_t>(first.back());
  tree.leaves = leaves_for(first.back());
  parallel_for(execution, set.clusters.size(), kClustersPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t place = first[begin / kClustersPerPart];
    for (std::size_t c = begin; c < end; ++c) fill(set, set.clusters[c], place, tree.leaves);
  });
}

/// Moves copies of triangles to a tree of their own if there are thousands, as when an object is placed a million times
/// in one place. Only the leaves of the new tree are filled. Leaves of `tree` are in the surfaces' spatial order, in
/// which copies follow each other. \returns the new tree; null, with nothing changed, if there are few copies.
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
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(tree.leaves[i], static_cast<std::uint32_t>(i));
  });
  return boxes;
}

constexpr int kBins = 16;
/// Number of leaves of a piece, which one thread builds. Compared with splitting all leaves by area, the speed of views
/// differs by less than the noise of 3 %, and two threads build in three quarters of the time.
constexpr std::size_t kPieceLeaves = 2048;
/// Fewer leaves than this are halved in place: their order already is a good one, and bins cost more than they save.
constexpr std::size_t kBinFrom = 4;

struct BoxRange {
  std::size_t begin = 0, end = 0;
  Box box;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

LeafBox as_leaf_box(const Box& box, std::uint32_t leaf) {
  return {{box.low.x, box.low.y, box.low.z}, leaf, {box.high.x, box.high.y, box.high.z}, 0};
}
/// Halves are added, as the sum of two large floats can overflow.
glm::vec3 centre_of(const LeafBox& b) {
  return {0.5f * b.low[0] + 0.5f * b.high[0], 0.5f * b.low[1] + 0.5f * b.high[1], 0.5f * b.low[2] + 0.5f * b.high[2]};
}

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

class NodeBuilder {
 public:
  explicit NodeBuilder(std::vector<LeafBox>& boxes) : boxes_(boxes) {}

  /// \returns up to sixteen ranges. Splits the range with the largest surface until there are sixteen, or none can be
  /// split.
  std::vector<BoxRange> children_of(const BoxRange& range) {
    std::vector<BoxRange> ranges{range};
    ranges.reserve(kRayLanes);
    while (ranges.size() < kRayLanes) {
      std::size_t largest = ranges.size();
      float most = -1;
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        // Areas that overflow count as equal. The first range that can be split is taken even if its area is NaN.
        const float area = half_area(ranges[i].box);
        if (ranges[i].size() > 1 && (largest == ranges.size() || area > most)) largest = i, most = area;
      }
      if (largest == ranges.size()) break;
      const auto [left, right] = split(ranges[largest]);
      ranges[largest] = left;
      ranges.push_back(right);
    }
    return ranges;
  }

  [[nodiscard]] BoxRange range_of(std::size_t begin, std::size_t end) const {
    BoxRange range{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) range.box.include(as_box(boxes_[i]));
    return range;
  }

 private:
  std::pair<BoxRange, BoxRange> split(const BoxRange& range) {
    if (range.size() >= kBinFrom) {
      const std::pair<BoxRange, BoxRange> halves = split_by_area(range);
      if (halves.first.size() > 0) return halves;
    }
    const std::size_t middle = range.begin + range.size() / 2;
    return {range_of(range.begin, middle), range_of(middle, range.end)};
  }

  /// \returns empty ranges if all centres are in one place, or areas exceed the range of floats.
  std::pair<BoxRange, BoxRange> split_by_area(const BoxRange& range) {
    Box centres;
    for (std::size_t i = range.begin; i < range.end; ++i) centres.include(centre_of(boxes_[i]));
    const Binning binning(centres);
    Bins bins;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const glm::vec3 centre = centre_of(boxes_[i]);
      const Box box = as_box(boxes_[i]);
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
    const auto middle =
        std::partition(first, last, [&](const LeafBox& box) { return binning(centre_of(box), best.axis) < best.bin; });
    const auto cut = std::size_t(middle - boxes_.begin());
    BoxRange left{range.begin, cut, {}}, right{cut, range.end, {}};
    for (int i = 0; i < kBins; ++i)
      (i < best.bin ? left : right).box.include(bins[std::size_t(best.axis)][std::size_t(i)].box);
    return {left, right};
  }

  std::vector<LeafBox>& boxes_;
};

/// Nodes over one range; children are numbered within the piece.
struct NodePiece {
  BoxRange range;
  std::vector<RayNode> nodes;
  std::uint32_t root = 0, depth = 0;
};

class PieceBuilder {
 public:
  PieceBuilder(std::vector<LeafBox>& boxes, NodePiece& piece) : boxes_(boxes), builder_(boxes), piece_(piece) {}

  void build() { piece_.root = build(piece_.range, 0); }

 private:
  std::uint32_t build(const BoxRange& range, std::uint32_t depth) {
    piece_.depth = std::max(piece_.depth, depth);
    if (range.size() == 1) return boxes_[range.begin].leaf | kLeafBit;
    const std::vector<BoxRange> ranges = builder_.children_of(range);
    const std::size_t number = piece_.nodes.size();
    piece_.nodes.push_back({});
    for (std::size_t lane = 0; lane < ranges.size(); ++lane) {
      const std::uint32_t child = build(ranges[lane], depth + 1);
      piece_.nodes[number].set_box(lane, ranges[lane].box);
      piece_.nodes[number].child[lane] = child;
    }
    piece_.nodes[number].count = std::uint32_t(ranges.size());
    return std::uint32_t(number);
  }

  std::vector<LeafBox>& boxes_;
  NodeBuilder builder_;
  NodePiece& piece_;
};

/// Fills tree.nodes over the boxes, and reorders the boxes.
void build_nodes(std::vector<LeafBox>& boxes, RayTree& tree, const Execution& execution) {
  if (boxes.empty()) return;
  std::vector<NodePiece> pieces((boxes.size() + kPieceLeaves - 1) / kPieceLeaves);
  parallel_for(execution, boxes.size(), kPieceLeaves, [&](std::size_t begin, std::size_t end) {
    NodePiece& piece = pieces[begin / kPieceLeaves];
    piece.range = NodeBuilder(boxes).range_of(begin, end);
    PieceBuilder(boxes, piece).build();
  });

  // The piece above all others, whose leaves are the pieces.
  std::vector<LeafBox> roots;
  for (std::uint32_t p = 0; p < pieces.size(); ++p) roots.push_back(as_leaf_box(pieces[p].range.box, p));
  NodePiece top;
  top.range = NodeBuilder(roots).range_of(0, roots.size());
  PieceBuilder(roots, top).build();
  tree.bounds = top.range.box;

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
