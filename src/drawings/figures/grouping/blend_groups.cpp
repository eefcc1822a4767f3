// SPDX-License-Identifier: Apache-2.0
// Gathers translucent shapes in blend groups: a painting order in which translucent neighbours are
// consecutive.
//
// Nodes that may all be painted next do not overlap, because one would have to wait for the other. So any of them can
// form a blend group. Those of one surface are kept together, as patches of neighbours that grow until no node beside
// them has to wait.
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "figures/colored_order.h"
#include "figures/grouping/overlaps.h"
#include "figures/side_net.h"
#include "geometry/buckets.h"
#include "geometry/disjoint_sets.h"
#include "painter/limits.h"

namespace frontmost {
namespace {

using namespace shading;

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// Nodes are painted as a whole and numbered in the original order.
struct BlendNodes {
  std::vector<std::uint8_t> opacities;  ///< by node
  std::vector<NodePair> over;           ///< the second is painted after the first; sorted, unique
  std::vector<NodePair> beside;         ///< translucent pairs of one opacity, in both directions; sorted, unique
};

/// Nodes in painting order, and the blend group of each, ascending. Translucent nodes of a group have the same opacity,
/// and none is over another; opaque nodes have groups without translucent ones.
struct BlendOrder {
  std::vector<std::uint32_t> nodes, groups;
};

/// Memory of 128 MB. With more pairs, the order stays unchanged.
constexpr std::size_t kMostPairs = std::size_t(1) << 24;
/// Limits on overlap tests; with more, the order stays unchanged.
constexpr std::size_t kMostAsked = std::size_t(1) << 28, kMostAskedOfPolygon = 1 << 10, kAskedPerPoll = 1 << 12;

void sort_out(std::vector<NodePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// The pairs in which one shape is over another, except opaque shapes that are over no translucent one, directly or
/// indirectly. These go first, in their order. None if there are too many pairs.
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

/// Pairs of translucent neighbours of one opacity.
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

/// Opaque nodes that may be painted next go first, in their order; then patches that have no waiting node
/// beside them; if there are none, the patch with the fewest. O(n log n) in the number of nodes and pairs.
class BlendSorter {
 public:
  explicit BlendSorter(const BlendNodes& nodes)
      : opacities_(nodes.opacities),
        over_(lists_of(nodes.over, opacities_.size())),
        beside_(lists_of(nodes.beside, opacities_.size())),
        below_(opacities_.size(), 0),
        states_(opacities_.size(), State::waiting),
        patches_(opacities_.size()),
        open_sides_(opacities_.size(), 0),
        next_in_patch_(opacities_.size()) {
    for (const NodePair& pair : nodes.over) ++below_[pair.second];
    std::iota(next_in_patch_.begin(), next_in_patch_.end(), 0u);
  }

  [[nodiscard]] BlendOrder sort() {
    for (std::uint32_t node = 0; node < below_.size(); ++node)
      if (below_[node] == 0) make_ready(node);
    while (!opaque_.empty() || !by_open_sides_.empty()) {
      ++group_;
      if (opaque_.empty())
        paint_patches();
      else
        paint_opaque();
    }
    return std::move(order_);
  }

 private:
  enum class State : std::uint8_t { waiting, ready, painted };

  void make_ready(std::uint32_t node) {
    states_[node] = State::ready;
    if (opacities_[node] == 255) return opaque_.push(node);
    // The patch of the node and the ready nodes beside it, which have waited for it.
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

  void paint_opaque() {
    while (!opaque_.empty()) {
      const std::uint32_t node = opaque_.top();
      opaque_.pop();
      paint(node);
      release(node);
    }
  }

  /// Paints all patches without open sides or, if there are none, the one with the fewest.
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
    order_.nodes.push_back(node);
    order_.groups.push_back(group_);
  }
  void release(std::uint32_t node) {
    for (const std::uint32_t other : over_[node])
      if (--below_[other] == 0) make_ready(other);
  }

  const std::vector<std::uint8_t>& opacities_;
  const NodeLists over_, beside_;
  std::vector<std::uint32_t> below_;  ///< number of unpainted nodes below a node
  std::vector<State> states_;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> opaque_;
  DisjointSets<std::greater<>> patches_;      ///< of translucent nodes that are ready
  std::vector<std::size_t> open_sides_;       ///< by patch: pairs of one of its nodes with a waiting one
  std::vector<std::uint32_t> next_in_patch_;  ///< rings of nodes
  std::set<std::pair<std::size_t, std::uint32_t>> by_open_sides_;
  BlendOrder order_;
  std::uint32_t group_ = 0;
};

ColoredOrder in_order(const ColoredOrder& colored, const BlendOrder& order) {
  ColoredOrder made;
  made.view = colored.view;
  for (std::size_t k = 0; k < order.nodes.size(); ++k) {
    const ColoredShape& shape = colored.shapes[order.nodes[k]];
    made.begin_shape(shape.color);
    made.shapes.back().blend_group = order.groups[k];
    for (const PaintPolygon& polygon : colored.polygons_of(shape))
      made.add_polygon(polygon.id, colored.corners_of(polygon));
  }
  return made;
}

}  // namespace

ColoredOrder gather_blend_groups(ColoredOrder colored, const Execution& execution) {
  const auto is_translucent = [](const ColoredShape& shape) { return shape.color.a < 255; };
  if (std::none_of(colored.shapes.begin(), colored.shapes.end(), is_translucent)) return colored;
  const IeeeScope ieee;
  BlendNodes nodes;
  for (const ColoredShape& shape : colored.shapes) nodes.opacities.push_back(shape.color.a);
  std::optional<std::vector<NodePair>> over = find_over(colored, execution);
  if (!over) return colored;
  nodes.over = std::move(*over);
  nodes.beside = find_beside(colored, execution);
  return in_order(colored, BlendSorter(nodes).sort());
}

}  // namespace frontmost
