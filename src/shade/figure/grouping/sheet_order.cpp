// SPDX-License-Identifier: Apache-2.0
// Of nodes that may all be painted next none is over another, whatever order they had: one would have to wait. So any
// of them make a sheet. Those of one surface are kept together, as patches of neighbours that grow until nothing beside
// them has to wait.
#include "shade/figure/grouping/sheet_order.h"

#include <functional>
#include <queue>
#include <set>
#include <span>

#include "shade/figure/grouping/sets.h"

namespace frontmost::shading {
namespace {

/// For each number, the second ones of its pairs.
class Lists {
 public:
  Lists(const std::vector<NodePair>& pairs, std::size_t count) : first_(count + 1, 0) {
    seconds_.reserve(pairs.size());
    for (const auto& [a, b] : pairs) {
      ++first_[a + 1];
      seconds_.push_back(b);
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t i) const {
    return {seconds_.data() + first_[i], first_[i + 1] - first_[i]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> seconds_;
};

class Sorter {
 public:
  explicit Sorter(const SheetNodes& nodes)
      : opacities_(nodes.opacities),
        over_(nodes.over, opacities_.size()),
        beside_(nodes.beside, opacities_.size()),
        below_(opacities_.size(), 0),
        states_(opacities_.size(), State::waiting),
        patches_(opacities_.size()),
        open_sides_(opacities_.size(), 0),
        next_in_patch_(opacities_.size()) {
    for (const NodePair& pair : nodes.over) ++below_[pair.second];
    std::iota(next_in_patch_.begin(), next_in_patch_.end(), 0u);
  }

  [[nodiscard]] SheetOrder sort() {
    for (std::uint32_t node = 0; node < below_.size(); ++node)
      if (below_[node] == 0) make_ready(node);
    while (!opaque_.empty() || !by_open_sides_.empty()) {
      ++sheet_;
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
    // The patch that it makes together with those beside it that are ready: they have waited for it.
    std::size_t open = 0;
    std::uint32_t patch = node;
    for (const std::uint32_t other : beside_[node]) {
      open += states_[other] == State::waiting;
      if (states_[other] != State::ready) continue;
      const std::uint32_t joined = patches_.find(other);
      if (joined != patch) {
        by_open_sides_.erase({open_sides_[joined], joined});
        open += open_sides_[joined];
        std::swap(next_in_patch_[node], next_in_patch_[joined]);
        patches_.unite(patch, joined);
        patch = patches_.find(node);
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

  /// All patches without open sides, or that with the fewest.
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
      sheet_ += i > 0 && opacities_[taken[i]] != opacities_[taken[i - 1]];
      paint(taken[i]);
    }
    for (const std::uint32_t node : taken) release(node);
  }

  void paint(std::uint32_t node) {
    states_[node] = State::painted;
    order_.nodes.push_back(node);
    order_.sheets.push_back(sheet_);
  }
  void release(std::uint32_t node) {
    for (const std::uint32_t other : over_[node])
      if (--below_[other] == 0) make_ready(other);
  }

  const std::vector<std::uint8_t>& opacities_;
  const Lists over_, beside_;
  std::vector<std::uint32_t> below_;  ///< how many that are not painted yet are below a node
  std::vector<State> states_;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> opaque_;
  Sets patches_;                              ///< of translucent nodes that are ready
  std::vector<std::size_t> open_sides_;       ///< of a patch: pairs of one of its own with one that waits
  std::vector<std::uint32_t> next_in_patch_;  ///< a ring
  std::set<std::pair<std::size_t, std::uint32_t>> by_open_sides_;
  SheetOrder order_;
  std::uint32_t sheet_ = 0;
};

}  // namespace

SheetOrder order_in_sheets(const SheetNodes& nodes) { return Sorter(nodes).sort(); }

}  // namespace frontmost::shading
