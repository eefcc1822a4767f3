// SPDX-License-Identifier: Apache-2.0
// Shapes of one colour are merged, and translucent shapes are gathered in blend groups.
//
//    order    1  2  3  4  5        2 and 5 share a side and have one colour. If neither 3 nor 4 covers
//    colour   a  b  a  c  b        a part of 2, both can be painted together where 5 is.
//
// merge_neighbours() unites only polygons that no later one covers: these may be painted at the place of the last.
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "figures/colored_order.h"
#include "figures/side_net.h"
#include "geometry/buckets.h"
#include "geometry/disjoint_sets.h"
#include "painter/limits.h"
#include "painter/order/piece_grid.h"

namespace frontmost {
namespace {

using namespace shading;
using painter_detail::PolygonExtent;

/// The least overlap that counts, in pixels, because polygons that are cut at each other's sides overlap by rounding.
constexpr double kThin = 1.0 / 512;

using PolygonCorners = std::span<const glm::dvec2>;

/// Whether all of `b` lies outside of one side of `a`. Both are counter-clockwise as seen on the screen, whose y points
/// down.
bool has_side_between(PolygonCorners a, PolygonCorners b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 from = a[i], way = a[i + 1 == a.size() ? 0 : i + 1] - from;
    const double length = glm::length(way);
    if (!(length > kThin)) continue;
    const auto is_outside = [&](const glm::dvec2& corner) {
      const glm::dvec2 p = corner - from;
      return way.x * p.y - way.y * p.x > -kThin * length;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

std::vector<PolygonExtent> extents_of(const ColoredOrder& order) {
  std::vector<PolygonExtent> extents;
  extents.reserve(order.polygons.size());
  for (const PaintPolygon& polygon : order.polygons) {
    PolygonExtent extent{glm::vec2(std::numeric_limits<float>::infinity()),
                         glm::vec2(-std::numeric_limits<float>::infinity()), 0, 0};
    for (const glm::dvec2& corner : order.corners_of(polygon)) {
      extent.low = glm::min(extent.low, glm::vec2(corner));
      extent.high = glm::max(extent.high, glm::vec2(corner));
    }
    extents.push_back(extent);
  }
  return extents;
}

/// Finds the polygons of an order that overlap on the screen. Borrows the order.
class Overlaps {
 public:
  explicit Overlaps(const ColoredOrder& order) : order_(order), extents_(extents_of(order)), grid_(extents_) {}

  /// Whether two polygons overlap by more than rounding.
  [[nodiscard]] bool overlap(std::size_t i, std::size_t k) const {
    const PolygonExtent &a = extents_[i], &b = extents_[k];
    if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y) return false;
    const PolygonCorners own = order_.corners_of(order_.polygons[i]), other = order_.corners_of(order_.polygons[k]);
    return !has_side_between(own, other) && !has_side_between(other, own);
  }

  /// Calls meet(other) for polygons near polygon i that are later in the order (any_earlier(): earlier), until a call
  /// returns true. Some polygons occur more than once. \returns whether a call returned true.
  template <class Meet>
  bool any_later(std::size_t i, const Meet& meet) const {
    return any_cell(i, [&](std::span<const std::uint32_t> cell) {
      for (std::size_t k = cell.size(); k-- > 0 && cell[k] > i;)
        if (meet(cell[k])) return true;
      return false;
    });
  }
  template <class Meet>
  bool any_earlier(std::size_t i, const Meet& meet) const {
    return any_cell(i, [&](std::span<const std::uint32_t> cell) {
      for (std::size_t k = 0; k < cell.size() && cell[k] < i; ++k)
        if (meet(cell[k])) return true;
      return false;
    });
  }

 private:
  template <class Look>
  bool any_cell(std::size_t i, const Look& look) const {
    const painter_detail::PieceGrid::Range cells = grid_.range(extents_[i]);
    for (int y = cells.first.y; y <= cells.last.y; ++y)
      for (int x = cells.first.x; x <= cells.last.x; ++x)
        if (look(grid_.cell(grid_.number(x, y)))) return true;
    return false;
  }

  const ColoredOrder& order_;
  std::vector<PolygonExtent> extents_;
  painter_detail::PieceGrid grid_;
};

/// For each polygon, whether no later polygon covers a part of it.
std::vector<bool> find_uncovered(const ColoredOrder& order, const Execution& execution) {
  const Overlaps overlaps(order);
  painter_detail::PaintEffort effort(execution, order.polygons.size());
  painter_detail::Poll poll(effort);
  std::vector<bool> uncovered(order.polygons.size());
  for (std::size_t i = 0; i < uncovered.size(); ++i)
    uncovered[i] = !overlaps.any_later(i, [&](std::size_t other) {
      poll.count();
      return overlaps.overlap(i, other);
    });
  return uncovered;
}

/// Sets of polygons that are painted together. The leader of a set is its last polygon, in whose place the set is
/// painted.
using PolygonSets = DisjointSets<std::greater<>>;

/// Joins uncovered polygons of one colour that share a part of a side, and consecutive uncovered polygons of one shape.
PolygonSets joined(const ColoredOrder& colored, const std::vector<std::uint32_t>& shapes,
                   const std::vector<bool>& uncovered, const Execution& execution) {
  PolygonSets sets(uncovered.size());
  for (std::uint32_t i = 1; i < uncovered.size(); ++i)
    if (shapes[i] == shapes[i - 1] && uncovered[i] && uncovered[i - 1]) sets.join(i, i - 1);
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < uncovered.size(); ++i)
    if (uncovered[i]) members.push_back(i);
  const auto code = [&](std::uint32_t i) {
    const glm::u8vec4& c = colored.shapes[shapes[i]].color;
    return std::uint32_t(c.r) << 24 | std::uint32_t(c.g) << 16 | std::uint32_t(c.b) << 8 | c.a;
  };
  std::stable_sort(members.begin(), members.end(), [&](auto a, auto b) { return code(a) < code(b); });
  SideNet net;
  for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
    check_cancelled(execution);
    net.clear();
    for (end = begin; end < members.size() && code(members[end]) == code(members[begin]); ++end)
      net.add(colored.corners_of(colored.polygons[members[end]]), members[end]);
    if (end == begin + 1) continue;
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) { sets.join(a, b); });
  }
  return sets;
}

/// Two nodes. A node is a shape that is painted as a whole; nodes are numbered in the original order.
using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// The most pairs of nodes, which take 128 MB. With more pairs, the order stays unchanged.
constexpr std::size_t kMostPairs = std::size_t(1) << 24;
/// Limits on overlap tests; with more, the order stays unchanged.
constexpr std::size_t kMostAsked = std::size_t(1) << 28, kMostAskedOfPolygon = 1 << 10, kAskedPerPoll = 1 << 12;

void sort_out(std::vector<NodePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// The pairs in which one shape is over another, except opaque shapes that are over no translucent one, directly or
/// indirectly: these go first. None if there are too many pairs.
std::optional<std::vector<NodePair>> find_over(const ColoredOrder& colored, const Execution& execution) {
  const std::vector<std::uint32_t> shape_of = colored.shapes_of_polygons();
  const Overlaps overlaps(colored);
  const std::size_t most_asked = kMostAsked + kMostAskedOfPolygon * shape_of.size();
  std::size_t asked = 0;
  std::vector<NodePair> over;
  std::vector<std::uint8_t> is_bound;
  for (const ColoredShape& shape : colored.shapes) is_bound.push_back(shape.color.a < 255);
  for (std::size_t i = 0; i < shape_of.size(); ++i) {
    const std::uint32_t node = shape_of[i];
    const bool is_full = overlaps.any_earlier(i, [&](std::size_t other) {
      if (++asked % kAskedPerPoll == 0) check_cancelled(execution);
      if (asked > most_asked) return true;
      const std::uint32_t below = shape_of[other];
      if (below == node || !is_bound[below]) return false;
      if (!over.empty() && over.back() == NodePair(below, node)) return false;
      if (!overlaps.overlap(i, other)) return false;
      is_bound[node] = 1;
      over.emplace_back(below, node);
      return over.size() > kMostPairs;
    });
    if (is_full) return std::nullopt;
  }
  sort_out(over);
  return over;
}

/// The pairs of translucent neighbours of one opacity, in both directions.
std::vector<NodePair> find_beside(const ColoredOrder& colored, const Execution& execution) {
  std::vector<NodePair> beside;
  std::array<std::vector<std::uint32_t>, 255> by_opacity;
  for (std::uint32_t i = 0; i < colored.shapes.size(); ++i)
    if (colored.shapes[i].color.a < 255) by_opacity[colored.shapes[i].color.a].push_back(i);
  SideNet net;
  for (const std::vector<std::uint32_t>& members : by_opacity) {
    check_cancelled(execution);
    if (members.size() < 2) continue;
    net.clear();
    for (const std::uint32_t i : members)
      for (const PaintPolygon& polygon : colored.polygons_of(colored.shapes[i]))
        net.add(colored.corners_of(polygon), i);
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) {
      if (a != b) beside.insert(beside.end(), {{a, b}, {b, a}});
    });
  }
  sort_out(beside);
  return beside;
}

/// For each node, the second nodes of its pairs.
using NodeLists = Buckets<std::uint32_t>;

NodeLists lists_of(const std::vector<NodePair>& pairs, std::size_t count) {
  const auto list = [&](std::size_t i, const auto& add) { add(pairs[i].first, pairs[i].second); };
  return {count, pairs.size(), list, {.threads = 1}};
}

/// Sorts nodes in painting order. Opaque nodes that may be painted next go first, in their order. Then all patches go
/// that have no waiting node beside them; if there are none, the patch with the fewest goes. A patch is a set of
/// translucent neighbours that may be painted next. O(n log n) in the number of nodes and pairs.
class BlendSorter {
 public:
  /// `over`: the second is painted after the first. `beside`: translucent pairs of one opacity, in both directions.
  BlendSorter(std::vector<std::uint8_t> opacities, const std::vector<NodePair>& over,
              const std::vector<NodePair>& beside)
      : opacities_(std::move(opacities)),
        over_(lists_of(over, opacities_.size())),
        beside_(lists_of(beside, opacities_.size())),
        below_(opacities_.size(), 0),
        states_(opacities_.size(), State::waiting),
        patches_(opacities_.size()),
        open_sides_(opacities_.size(), 0),
        next_in_patch_(opacities_.size()) {
    for (const NodePair& pair : over) ++below_[pair.second];
    std::iota(next_in_patch_.begin(), next_in_patch_.end(), 0u);
  }

  /// Nodes in painting order, each with its blend group; groups ascend. Translucent nodes of a group have the same
  /// opacity, and none is over another. A group with opaque nodes has no translucent ones.
  [[nodiscard]] std::vector<NodePair> sort() {
    for (std::uint32_t node = 0; node < below_.size(); ++node)
      if (below_[node] == 0) make_ready(node);
    while (!opaque_.empty() || !by_open_sides_.empty()) {
      ++group_;
      if (opaque_.empty()) {
        paint_patches();
        continue;
      }
      while (!opaque_.empty()) {
        const std::uint32_t node = opaque_.top();
        opaque_.pop();
        paint(node);
        release(node);
      }
    }
    return std::move(order_);
  }

 private:
  enum class State : std::uint8_t { waiting, ready, painted };

  void make_ready(std::uint32_t node) {
    states_[node] = State::ready;
    if (opacities_[node] == 255) return opaque_.push(node);
    // Joins the node and the ready patches beside it, which have waited for it, into one patch.
    std::size_t open = 0;
    std::uint32_t patch = node;
    for (const std::uint32_t other : beside_[node]) {
      open += states_[other] == State::waiting;
      if (states_[other] != State::ready) continue;
      const std::uint32_t joined = patches_.leader_of(other);
      if (joined != patch) {
        by_open_sides_.erase({open_sides_[joined], joined});
        open += open_sides_[joined];
        std::swap(next_in_patch_[node], next_in_patch_[joined]);
        patches_.join(patch, joined);
        patch = patches_.leader_of(node);
      }
      --open;
    }
    open_sides_[patch] = open;
    by_open_sides_.insert({open, patch});
  }

  /// Paints all patches without open sides or, if there are none, the patch with the fewest open sides.
  void paint_patches() {
    std::vector<std::uint32_t> taken;
    do {
      const std::uint32_t patch = by_open_sides_.begin()->second;
      by_open_sides_.erase(by_open_sides_.begin());
      std::uint32_t node = patch;
      do {
        taken.push_back(node);
        node = next_in_patch_[node];
      } while (node != patch);
    } while (!by_open_sides_.empty() && by_open_sides_.begin()->first == 0);
    std::sort(taken.begin(), taken.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(opacities_[a], a) < std::pair(opacities_[b], b);
    });
    for (std::size_t i = 0; i < taken.size(); ++i) {
      group_ += i > 0 && opacities_[taken[i]] != opacities_[taken[i - 1]];
      paint(taken[i]);
    }
    for (const std::uint32_t node : taken) release(node);
  }

  void paint(std::uint32_t node) {
    states_[node] = State::painted;
    order_.emplace_back(node, group_);
  }
  void release(std::uint32_t node) {
    for (const std::uint32_t other : over_[node])
      if (--below_[other] == 0) make_ready(other);
  }

  const std::vector<std::uint8_t> opacities_;  ///< by node
  const NodeLists over_, beside_;
  std::vector<std::uint32_t> below_;  ///< number of unpainted nodes below a node
  std::vector<State> states_;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> opaque_;
  DisjointSets<std::greater<>> patches_;      ///< patches of translucent nodes that are ready
  std::vector<std::size_t> open_sides_;       ///< by patch: number of pairs of a node in the patch and a waiting node
  std::vector<std::uint32_t> next_in_patch_;  ///< the nodes of each patch form a ring
  std::set<std::pair<std::size_t, std::uint32_t>> by_open_sides_;
  std::vector<NodePair> order_;
  std::uint32_t group_ = 0;
};

}  // namespace

ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution) {
  const std::size_t count = colored.polygons.size();
  const IeeeScope ieee;
  const std::vector<std::uint32_t> shapes = colored.shapes_of_polygons();
  const std::vector<bool> uncovered = find_uncovered(colored, execution);
  PolygonSets sets = joined(colored, shapes, uncovered, execution);
  std::vector<std::uint32_t> places(count), order(count);
  for (std::uint32_t i = 0; i < count; ++i) places[i] = sets.leader_of(i);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::tie(places[a], a) < std::tie(places[b], b); });
  const auto are_one = [&](std::uint32_t a, std::uint32_t b) {
    return places[a] == places[b] || (shapes[a] == shapes[b] && !uncovered[a] && !uncovered[b]);
  };
  ColoredOrder merged;
  merged.view = colored.view;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t i = order[k];
    if (k == 0 || !are_one(order[k - 1], i)) merged.begin_shape(colored.shapes[shapes[i]].color);
    merged.add_polygon(colored.polygons[i].id, colored.corners_of(colored.polygons[i]));
  }
  return merged;
}

ColoredOrder gather_blend_groups(ColoredOrder colored, const Execution& execution) {
  const auto is_translucent = [](const ColoredShape& shape) { return shape.color.a < 255; };
  if (std::none_of(colored.shapes.begin(), colored.shapes.end(), is_translucent)) return colored;
  const IeeeScope ieee;
  std::vector<std::uint8_t> opacities;
  for (const ColoredShape& shape : colored.shapes) opacities.push_back(shape.color.a);
  const std::optional<std::vector<NodePair>> over = find_over(colored, execution);
  if (!over) return colored;
  ColoredOrder made;
  made.view = colored.view;
  for (const auto& [node, group] : BlendSorter(std::move(opacities), *over, find_beside(colored, execution)).sort()) {
    const ColoredShape& shape = colored.shapes[node];
    made.begin_shape(shape.color);
    made.shapes.back().blend_group = group;
    for (const PaintPolygon& polygon : colored.polygons_of(shape))
      made.add_polygon(polygon.id, colored.corners_of(polygon));
  }
  return made;
}

}  // namespace frontmost
