// SPDX-License-Identifier: Apache-2.0
// A chain that is too short to be worth drawing is left out where it ends in the air. This may leave other short chains
// with an end in the air.
//
//        a ________________ b          c ends in the air and is left out. d holds a line that would end in the air
//              |    d/                 otherwise, so d stays. The lines that pass near the ends of short chains show,
//             c     /________ e        once for all, which ends touch something.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.h"
#include "geometry/buckets.h"
#include "lines/square_grid.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

double length_of(const Chain& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.points.size(); ++i) length += glm::distance(chain.points[i - 1], chain.points[i]);
  if (chain.is_closed) length += glm::distance(chain.points.back(), chain.points.front());
  return length;
}

double distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(p, a + t * along);
}

/// A grid of at most 2^20 cells over these places; cells are no smaller than `least`.
SquareGrid grid_over(const std::vector<glm::dvec2>& places, double least) {
  glm::dvec2 low(1e300), high(-1e300);
  for (const glm::dvec2& place : places) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  const double cell = std::max({(high.x - low.x) / 1023, (high.y - low.y) / 1023, least, 1e-6});
  return {low, cell, int((high.x - low.x) / cell) + 1, int((high.y - low.y) / cell) + 1};
}

/// A chain on which an end of a short chain lies. The first end of chain i is number 2 i, its last 2 i + 1.
struct Touch {
  std::size_t end, chain;
  bool is_at_end;  ///< it also is an end of that chain

  friend bool operator<(const Touch& a, const Touch& b) {
    return std::tie(a.end, a.chain, b.is_at_end) < std::tie(b.end, b.chain, a.is_at_end);
  }
};

class ShortChains {
 public:
  ShortChains(std::vector<Chain>& chains, const ShortChainRule& rule, const Execution& execution)
      : chains_(chains), rule_(rule), execution_(execution), is_short_(chains.size()), is_left_out_(chains.size()) {
    for (std::size_t i = 0; i < chains.size(); ++i) is_short_[i] = length_of(chains[i]) < rule.shortest;
  }

  void leave_out() {
    find_touches();
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (is_short_[i]) asked.push_back(i);
    while (!asked.empty()) {
      const std::size_t i = asked.back();
      asked.pop_back();
      if (is_left_out_[i] || !is_loose(i)) continue;
      is_left_out_[i] = true;
      // Short chains that ended on this one may be loose now.
      for (const std::size_t other : touched_by_[i]) asked.push_back(other);
    }
  }

  std::vector<Chain> take() {
    std::vector<Chain> kept;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (!is_left_out_[i]) kept.push_back(std::move(chains_[i]));
    return kept;
  }

 private:
  [[nodiscard]] const glm::dvec2& place(std::size_t end) const {
    const Chain& chain = chains_[end / 2];
    return end % 2 == 0 ? chain.points.front() : chain.points.back();
  }

  void find_touches() {
    std::vector<std::uint32_t> ends;
    std::vector<glm::dvec2> places;
    for (std::uint32_t i = 0; i < chains_.size(); ++i)
      if (is_short_[i] && !chains_[i].is_closed)
        for (const std::uint32_t end : {2 * i, 2 * i + 1}) {
          ends.push_back(end);
          places.push_back(place(end));
        }
    touched_by_.resize(chains_.size());
    if (ends.empty()) return;
    const SquareGrid grid = grid_over(places, rule_.shortest);
    const auto list = [&](std::size_t i, const auto& add) {
      grid.visit_along(places[i], places[i], 0, [&](const PassedCell& passed) {
        add(passed.cell, ends[i]);
        return true;
      });
    };
    const Buckets<std::uint32_t> by_cell(grid.count(), ends.size(), list, execution_);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      if (i % 1024 == 0) check_cancelled(execution_);
      const Chain& chain = chains_[i];
      const std::size_t joins = chain.points.size() - (chain.is_closed ? 0 : 1);
      for (std::size_t k = 0; k < joins; ++k) {
        const glm::dvec2 &a = chain.points[k], &b = chain.points[k + 1 == chain.points.size() ? 0 : k + 1];
        grid.visit_along(a, b, rule_.touching, [&](const PassedCell& passed) {
          for (const std::uint32_t end : by_cell[passed.cell])
            if (distance_to(place(end), a, b) <= rule_.touching) add_touch(end, i);
          return true;
        });
      }
    }
    std::sort(touches_.begin(), touches_.end());
    touches_.erase(std::unique(touches_.begin(), touches_.end(),
                               [](const Touch& a, const Touch& b) { return a.end == b.end && a.chain == b.chain; }),
                   touches_.end());
    for (const Touch& touch : touches_) touched_by_[touch.chain].push_back(touch.end / 2);
  }

  void add_touch(std::size_t end, std::size_t chain) {
    // Hidden chains hold no visible ones.
    if (end / 2 == chain || (rule_.is_hidden(chains_[chain].rank) && !rule_.is_hidden(chains_[end / 2].rank))) return;
    const auto is_near = [&](std::size_t other) { return glm::distance(place(end), place(other)) <= rule_.touching; };
    touches_.push_back({end, chain, !chains_[chain].is_closed && (is_near(2 * chain) || is_near(2 * chain + 1))});
  }

  /// Whether the short chain may be left out: one of its ends is in the air, or it is not of a contour and only
  /// connects lines that continue without it.
  [[nodiscard]] bool is_loose(std::size_t number) const {
    if (chains_[number].is_closed) return !chains_[number].is_contour;
    bool is_link = true;
    for (std::size_t end = 2 * number; end < 2 * number + 2; ++end) {
      bool is_held = false, meets_end = false;
      for (auto touch = std::lower_bound(touches_.begin(), touches_.end(), Touch{end, 0, true});
           touch != touches_.end() && touch->end == end; ++touch) {
        if (is_left_out_[touch->chain]) continue;
        is_held = true;
        meets_end |= touch->is_at_end;
      }
      if (!is_held) return true;
      is_link &= meets_end;
    }
    return !is_link && !chains_[number].is_contour;
  }

  std::vector<Chain>& chains_;
  const ShortChainRule& rule_;
  const Execution& execution_;
  std::vector<bool> is_short_, is_left_out_;
  std::vector<Touch> touches_;                        ///< ascending
  std::vector<std::vector<std::size_t>> touched_by_;  ///< by chain: the short chains that end on it
};

}  // namespace

std::vector<Chain> without_short_ones(std::vector<Chain> chains, const ShortChainRule& rule,
                                      const Execution& execution) {
  ShortChains all(chains, rule, execution);
  all.leave_out();
  return all.take();
}

}  // namespace frontmost::lines_detail
