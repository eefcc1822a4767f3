// SPDX-License-Identifier: Apache-2.0
// Chains that lie in the ink of others are left out: a pen that draws them again makes no new line.
//
//      .-----------------------.
//     (  p ================= q  )     The ink of a segment p q reaches half the pen's width to all sides. A segment a b
//      '-----------------------'      lies in it on a stretch, because the shape is convex. A chain is covered if the
//       a .- - - - - - - - - . b      stretches of all chains that stay leave nothing of it.
#include <cmath>
#include <numeric>
#include <utility>

#include "base/work_limit.h"
#include "lines/square_grid.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

struct InkedLine {
  glm::dvec2 from, to;
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

/// The stretch of `line` within `radius` of `other`: the hull of its stretches in two discs and in the rectangle
/// between.
InkedStretch stretch_in_ink(const InkedLine& line, const InkedLine& other, double radius) {
  InkedStretch all;
  const glm::dvec2 way = line.to - line.from;
  const double square = glm::dot(way, way);
  for (const glm::dvec2& centre : {other.from, other.to}) {
    const glm::dvec2 apart = line.from - centre;
    const double b = glm::dot(way, apart) / square, d = b * b - (glm::dot(apart, apart) - radius * radius) / square;
    if (d >= 0) all.unite(-b - std::sqrt(d), -b + std::sqrt(d));
  }
  const glm::dvec2 along = other.to - other.from;
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
  const glm::dvec2 apart = line.from - other.from;
  keep(cross(along, apart) / length, cross(along, way) / length, -radius, radius);
  keep(glm::dot(along, apart) / length, glm::dot(along, way) / length, 0, length);
  all.unite(low, high);
  return all;
}

class Ink {
 public:
  /// An empty page with room for all chains. Precondition: there are chains.
  Ink(const std::vector<Chain>& chains, double radius, const Execution& execution)
      : radius_(radius),
        grid_(grid_over(chains, radius)),
        by_cell_(grid_.count()),
        work_(execution, most_work, "strokes") {}

  /// Whether the ink that is there covers the chain.
  [[nodiscard]] bool covers(const Chain& chain) {
    return for_each_line(chain, [&](const InkedLine& line) { return covers(line); });
  }

  void add(const Chain& chain) {
    for_each_line(chain, [&](const InkedLine& line) {
      grid_.visit_along(line.from, line.to, 0, [&](const PassedCell& passed) {
        by_cell_[passed.cell].push_back(std::uint32_t(lines_.size()));
        return true;
      });
      lines_.push_back(line);
      return true;
    });
  }

 private:
  static constexpr int most_cells = 255;  ///< to each side; long lines are in every cell that they pass
  static constexpr std::uint64_t most_work = std::uint64_t(1) << 33;

  static SquareGrid grid_over(const std::vector<Chain>& chains, double radius) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const Chain& chain : chains)
      for (const glm::dvec2& p : chain.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    const glm::dvec2 size = high - low;
    const double cell = std::max({size.x / most_cells, size.y / most_cells, radius, 1e-6});
    return {low, cell, int(size.x / cell) + 1, int(size.y / cell) + 1};
  }

  /// Calls visit(line) for the lines of a chain until it returns false. \returns whether all returned true.
  template <class Visit>
  static bool for_each_line(const Chain& chain, const Visit& visit) {
    const std::size_t count = chain.points.size() - (chain.is_closed ? 0 : 1);
    for (std::size_t i = 0; i < count; ++i) {
      const InkedLine line{chain.points[i], chain.points[i + 1 == chain.points.size() ? 0 : i + 1]};
      if (line.from != line.to && !visit(line)) return false;
    }
    return true;
  }

  [[nodiscard]] bool covers(const InkedLine& line) {
    stretches_.clear();
    std::uint64_t compared = 0;
    grid_.visit_along(line.from, line.to, radius_, [&](const PassedCell& passed) {
      compared += by_cell_[passed.cell].size();
      for (const std::uint32_t number : by_cell_[passed.cell]) {
        const InkedStretch stretch = stretch_in_ink(line, lines_[number], radius_);
        if (stretch.begin <= stretch.end) stretches_.push_back(stretch);
      }
      return true;
    });
    work_.add(compared, [] {
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

  const double radius_;
  const SquareGrid grid_;
  std::vector<std::vector<std::uint32_t>> by_cell_;
  std::vector<InkedLine> lines_;
  std::vector<InkedStretch> stretches_;  ///< of the current line
  WorkLimit work_;
};

}  // namespace

std::vector<Chain> uncovered(std::vector<Chain> chains, double within, const Execution& execution) {
  if (chains.empty()) return chains;
  std::vector<double> lengths;
  lengths.reserve(chains.size());
  for (const Chain& chain : chains) lengths.push_back(length_of(chain));
  std::vector<std::size_t> order(chains.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(chains[a].rank, -lengths[a]) < std::pair(chains[b].rank, -lengths[b]);
  });
  Ink ink(chains, within, execution);
  std::vector<bool> is_covered(chains.size());
  for (const std::size_t i : order) {
    is_covered[i] = ink.covers(chains[i]);
    if (!is_covered[i]) ink.add(chains[i]);
  }
  std::vector<Chain> kept;
  for (std::size_t i = 0; i < chains.size(); ++i)
    if (!is_covered[i]) kept.push_back(std::move(chains[i]));
  return kept;
}

}  // namespace frontmost::lines_detail
