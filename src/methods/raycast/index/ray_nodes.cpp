// SPDX-License-Identifier: Apache-2.0
// The nodes of a RayIndex: the binned surface area heuristic halves ranges of leaves, the range of the largest surface
// first, until a node has sixteen children.
//
// Sequences of a fixed length in the spatial order are pieces, each built by whichever thread is free. The nodes above
// are built over the pieces' boxes in the same way. So the tree is the same for any number of threads.
//
//    leaves of a piece         [ A ][ B ][ C ][ D ] ...
//    a range is halved         [ A  B | C  D  ... ]     at the least sum of the halves' surfaces, each times its leaves
//    the larger half as well   [ A  B | C | D ... ]     and so on, until a node has sixteen children

#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.h"
#include "raycast/index/build.h"

namespace frontmost {
namespace {

constexpr int kBins = 16;
/// Leaves of a piece. Compared with splitting everything by area, views differ by less than the noise of 3 %, and two
/// threads build in three quarters of the time.
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
      // The extent is zero, not finite, or so small that the scale overflows: all centres are in the first bin.
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

  /// \returns up to sixteen ranges: splits the range of the largest surface until none can be split.
  std::vector<BoxRange> children_of(const BoxRange& range) {
    std::vector<BoxRange> ranges{range};
    ranges.reserve(kRayLanes);
    while (ranges.size() < kRayLanes) {
      std::size_t largest = ranges.size();
      float most = -1;
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        // Areas that overflow count as equal. A NaN area loses to any other, but the first splittable range is taken
        // anyway.
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

  /// \returns an empty range if all centres are in one place, or areas exceed the range of floats.
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

void set_child(RayNode& node, std::size_t lane, const Box& box, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = box.low[axis];
    node.high[axis][lane] = box.high[axis];
  }
  node.child[lane] = child;
}

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
      set_child(piece_.nodes[number], lane, ranges[lane].box, child);
    }
    piece_.nodes[number].count = std::uint32_t(ranges.size());
    return std::uint32_t(number);
  }

  std::vector<LeafBox>& boxes_;
  NodeBuilder builder_;
  NodePiece& piece_;
};

}  // namespace

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

}  // namespace frontmost
