// SPDX-License-Identifier: Apache-2.0
// Chains whose centre lines lie in the ink of others are left out. At most half a pen's width of ink is lost beside
// the ink that stays.
//
//      .-----------------------.
//     (  p ================= q  )     The ink of a segment p q reaches half the pen's width to all sides. A segment a b
//      '-----------------------'      lies in it on a stretch, because the shape is convex. A chain is covered if the
//       a .- - - - - - - - - . b      stretches of all chains that stay leave nothing of it.
//
//      -----o.....o-----              The round ends of two lines cover a short link between them. Without the link
//      there
//       end   link    end             would be a notch, and a lift of the pen. So the rims of a short chain must be
//                                     covered, too.
#include <cmath>
#include <numeric>
#include <utility>

#include "base/work_limit.h"
#include "lines/square_grid.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

/// A segment and the ink around it.
struct Capsule {
  glm::dvec2 from, to;
  double radius;
};

/// A stretch of a segment, from 0 at its beginning to 1 at its end; empty if `end` is less than `begin`.
struct InkedStretch {
  double begin = 1, end = 0;

  void unite(double low, double high) {
    low = std::max(low, 0.0);
    high = std::min(high, 1.0);
    if (!(low <= high)) return;
    const bool is_empty = end < begin;
    begin = is_empty ? low : std::min(begin, low);
    end = is_empty ? high : std::max(end, high);
  }
};

/// The stretch of the segment `from` `to` in a capsule: the hull of its stretches in two discs and in the rectangle
/// between.
InkedStretch stretch_in_ink(const glm::dvec2& from, const glm::dvec2& to, const Capsule& ink) {
  InkedStretch all;
  const double radius = ink.radius;
  const glm::dvec2 way = to - from;
  const double square = glm::dot(way, way);
  for (const glm::dvec2& centre : {ink.from, ink.to}) {
    const glm::dvec2 apart = from - centre;
    const double b = glm::dot(way, apart) / square, d = b * b - (glm::dot(apart, apart) - radius * radius) / square;
    if (d >= 0) all.unite(-b - std::sqrt(d), -b + std::sqrt(d));
  }
  const glm::dvec2 along = ink.to - ink.from;
  const double length = glm::length(along);
  if (!(length > 0)) return all;
  double low = 0, high = 1;
  /// Keeps the part of [low, high] where start + t * slope is within [least, most].
  const auto keep = [&](double start, double slope, double least, double most) {
    if (slope == 0) {
      if (!(start >= least && start <= most)) high = -1;
      return;
    }
    const double a = (least - start) / slope, b = (most - start) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  };
  const glm::dvec2 apart = from - ink.from;
  keep(cross(along, apart) / length, cross(along, way) / length, -radius, radius);
  keep(glm::dot(along, apart) / length, glm::dot(along, way) / length, 0, length);
  all.unite(low, high);
  return all;
}

class Ink {
 public:
  /// An empty page with room for all chains. No ink reaches farther than `most`. Precondition: there are chains.
  Ink(const std::vector<Chain>& chains, double most, const Execution& execution)
      : most_reach_(most),
        grid_(grid_over(chains, most)),
        by_cell_(grid_.count()),
        work_(execution, most_work, "strokes") {}

  /// Whether ink of pens that are at least as wide as the chain's, which reaches as far as `reach` says, covers the
  /// chain, and both rims of its own ink if `with_rims`.
  [[nodiscard]] bool covers(const Chain& chain, double reach, bool with_rims) {
    constexpr double rounding = 1e-6;
    return for_each_segment(chain, [&](const glm::dvec2& from, const glm::dvec2& to) {
      if (!covers(from, to, reach)) return false;
      if (!with_rims) return true;
      const glm::dvec2 way = to - from;
      const glm::dvec2 aside = glm::dvec2(-way.y, way.x) * (reach * (1 - rounding) / glm::length(way));
      return covers(from + aside, to + aside, reach) && covers(from - aside, to - aside, reach);
    });
  }

  /// Adds the chain's ink, which reaches as far as `reach` says, above 0.
  void add(const Chain& chain, double reach) {
    for_each_segment(chain, [&](const glm::dvec2& from, const glm::dvec2& to) {
      grid_.visit_along(from, to, 0, [&](const PassedCell& passed) {
        by_cell_[passed.cell].push_back(std::uint32_t(capsules_.size()));
        return true;
      });
      capsules_.push_back({from, to, reach});
      return true;
    });
  }

 private:
  static constexpr int most_cells = 255;  ///< to each side; long lines are in every cell that they pass
  static constexpr std::uint64_t most_work = std::uint64_t(1) << 33;

  static constexpr std::uint64_t steps_at_once = 10000;

  static SquareGrid grid_over(const std::vector<Chain>& chains, double most) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const Chain& chain : chains)
      for (const glm::dvec2& p : chain.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    const glm::dvec2 size = high - low;
    const double cell = std::max({size.x / most_cells, size.y / most_cells, most, 1e-6});
    return {low, cell, int(size.x / cell) + 1, int(size.y / cell) + 1};
  }

  /// Calls visit(from, to) for the segments of a chain until it returns false. \returns whether all returned true.
  template <class Visit>
  static bool for_each_segment(const Chain& chain, const Visit& visit) {
    const std::size_t count = chain.points.size() - (chain.is_closed ? 0 : 1);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec2 &from = chain.points[i], &to = chain.points[i + 1 == chain.points.size() ? 0 : i + 1];
      if (from != to && !visit(from, to)) return false;
    }
    return true;
  }

  [[nodiscard]] bool covers(const glm::dvec2& from, const glm::dvec2& to, double least_radius) {
    stretches_.clear();
    grid_.visit_along(from, to, most_reach_, [&](const PassedCell& passed) {
      steps_ += 1 + by_cell_[passed.cell].size();
      for (const std::uint32_t number : by_cell_[passed.cell]) {
        if (capsules_[number].radius < least_radius) continue;
        const InkedStretch stretch = stretch_in_ink(from, to, capsules_[number]);
        if (stretch.begin <= stretch.end) stretches_.push_back(stretch);
      }
      return true;
    });
    if (steps_ >= steps_at_once)
      work_.add(std::exchange(steps_, 0), [] {
        return std::string(
            "too many lines lie within a pen's width of each other; draw the model larger, or with a "
            "thinner pen");
      });
    std::sort(stretches_.begin(), stretches_.end(),
              [](const InkedStretch& a, const InkedStretch& b) { return a.begin < b.begin; });
    constexpr double rounding = 1e-9;
    double at = 0;
    for (const InkedStretch& stretch : stretches_) {
      if (stretch.begin > at + rounding) return false;
      at = std::max(at, stretch.end);
    }
    return at >= 1 - rounding;
  }

  const double most_reach_;
  const SquareGrid grid_;
  std::vector<std::vector<std::uint32_t>> by_cell_;
  std::vector<Capsule> capsules_;
  std::vector<InkedStretch> stretches_;  ///< covered stretches of the segment that covers() examines
  std::uint64_t steps_ = 0;              ///< not yet added to work_
  WorkLimit work_;
};

}  // namespace

std::vector<Chain> uncovered(std::vector<Chain> chains, std::span<const double> reaches, const Execution& execution) {
  if (chains.empty()) return chains;
  std::vector<double> lengths;
  lengths.reserve(chains.size());
  for (const Chain& chain : chains) lengths.push_back(length_of(chain));
  std::vector<std::size_t> order(chains.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(chains[a].rank, -lengths[a]) < std::pair(chains[b].rank, -lengths[b]);
  });
  Ink ink(chains, *std::max_element(reaches.begin(), reaches.end()), execution);
  std::vector<bool> is_covered(chains.size());
  for (const std::size_t i : order) {
    const double reach = reaches[chains[i].rank];
    is_covered[i] = ink.covers(chains[i], reach, lengths[i] <= 2 * reach);
    if (!is_covered[i] && reach > 0) ink.add(chains[i], reach);
  }
  std::vector<Chain> kept;
  for (std::size_t i = 0; i < chains.size(); ++i)
    if (!is_covered[i]) kept.push_back(std::move(chains[i]));
  return kept;
}

}  // namespace frontmost::lines_detail
