// SPDX-License-Identifier: Apache-2.0
// The order in which a plotter's pen travels little: always on to the nearest end.
//
// Ends lie in the cells of a grid, a few to the cell. As they are used up the grid becomes too fine; it is made anew
// whenever three quarters are gone, which keeps every search short, and all of them together near-linear.
#include <algorithm>
#include <cmath>

#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::uint32_t none = no_index;

/// Number 2 i is the beginning of chain i, 2 i + 1 its end.
glm::dvec2 place(const std::vector<Chain>& chains, std::uint32_t number) {
  const Chain& chain = chains[number / 2];
  return number % 2 == 0 || chain.is_closed ? chain.points.front() : chain.points.back();
}

class EndGrid {
 public:
  EndGrid(const std::vector<Chain>& chains, const std::vector<bool>& is_used, std::size_t first, std::size_t last)
      : chains_(chains), is_used_(is_used) {
    glm::dvec2 high(-1e300);
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 2 * first; i < 2 * last; ++i) {
      if (is_used[i / 2]) continue;
      numbers.push_back(std::uint32_t(i));
      low_ = glm::min(low_, place(chains, numbers.back()));
      high = glm::max(high, place(chains, numbers.back()));
    }
    const double extent = std::max({high.x - low_.x, high.y - low_.y, 1e-6});
    cell_ = extent / std::max(1.0, std::sqrt(double(numbers.size()) / 2)) * 1.0001;
    side_ = int(extent / cell_) + 1;
    cells_.resize(std::size_t(side_) * std::size_t(side_));
    for (const std::uint32_t number : numbers) {
      const glm::ivec2 at = cell_of(place(chains, number));
      cells_[std::size_t(at.y) * std::size_t(side_) + std::size_t(at.x)].push_back(number);
    }
  }

  /// The unused end nearest to `from`, of equals the lowest number; none when all are used.
  [[nodiscard]] std::uint32_t nearest(const glm::dvec2& from) {
    std::uint32_t best = none;
    double best_distance = 1e300;
    const glm::ivec2 at = cell_of(from);
    const double outside = glm::distance(from, glm::clamp(from, low_, low_ + cell_ * side_));
    for (int ring = 0; ring <= side_; ++ring) {
      // Nothing in a ring is nearer than the rings within it are wide.
      if (best != none && std::sqrt(best_distance) <= std::max(0.0, (ring - 1) * cell_ - outside)) break;
      for_ring(at, ring, [&](std::vector<std::uint32_t>& cell) {
        cell.erase(std::remove_if(cell.begin(), cell.end(), [&](std::uint32_t n) { return bool(is_used_[n / 2]); }),
                   cell.end());
        for (const std::uint32_t number : cell) {
          const glm::dvec2 d = place(chains_, number) - from;
          const double distance = glm::dot(d, d);
          if (distance < best_distance || (distance == best_distance && number < best)) {
            best = number;
            best_distance = distance;
          }
        }
      });
    }
    return best;
  }

 private:
  [[nodiscard]] glm::ivec2 cell_of(const glm::dvec2& p) const {
    const glm::dvec2 at = (p - low_) / cell_;
    return {std::clamp(int(std::clamp(at.x, -1.0, 1e6)), 0, side_ - 1),
            std::clamp(int(std::clamp(at.y, -1.0, 1e6)), 0, side_ - 1)};
  }

  template <class Visit>
  void for_ring(const glm::ivec2& at, int ring, const Visit& visit) {
    for (int y = std::max(0, at.y - ring); y <= std::min(side_ - 1, at.y + ring); ++y) {
      const bool whole = std::abs(y - at.y) == ring;
      const int step = whole || ring == 0 ? 1 : 2 * ring;
      for (int x = at.x - ring; x <= at.x + ring; x += step)
        if (x >= 0 && x < side_) visit(cells_[std::size_t(y) * std::size_t(side_) + std::size_t(x)]);
    }
  }

  const std::vector<Chain>& chains_;
  const std::vector<bool>& is_used_;
  glm::dvec2 low_{1e300};
  double cell_ = 1;
  int side_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

void reverse(Chain& chain) {
  std::reverse(chain.points.begin(), chain.points.end());
  if (chain.bulges.empty()) return;
  // The join that begins at a point now ends there.
  chain.bulges.pop_back();
  std::reverse(chain.bulges.begin(), chain.bulges.end());
  chain.bulges.push_back(0);
  for (double& bulge : chain.bulges) bulge = -bulge;
}

/// Goes on with `chain` where it touches the last one and none of the two is closed.
void draw(Chain&& chain, double touching, std::size_t first, std::vector<Chain>& drawn) {
  if (drawn.size() > first && !drawn.back().is_closed && !chain.is_closed &&
      glm::distance(drawn.back().points.back(), chain.points.front()) <= touching) {
    Chain& last = drawn.back();
    const bool has_bulges = !last.bulges.empty() || !chain.bulges.empty();
    if (has_bulges) {
      last.bulges.resize(last.points.size(), 0);
      chain.bulges.resize(chain.points.size(), 0);
      last.bulges.pop_back();
      last.bulges.insert(last.bulges.end(), chain.bulges.begin(), chain.bulges.end());
    }
    last.points.pop_back();
    last.points.insert(last.points.end(), chain.points.begin(), chain.points.end());
    return;
  }
  drawn.push_back(std::move(chain));
}

void order_rank(std::vector<Chain>& chains, std::size_t first, std::size_t last, double touching,
                std::vector<Chain>& drawn) {
  std::vector<bool> is_used(chains.size());
  const std::size_t begin = drawn.size();
  glm::dvec2 pen(0);
  std::size_t left = last - first;
  while (left > 0) {
    EndGrid grid(chains, is_used, first, last);
    for (const std::size_t enough = left / 4; left > enough; --left) {
      const std::uint32_t number = grid.nearest(pen);
      Chain chain = chains[number / 2];  // the grid still looks at the places of used ones
      is_used[number / 2] = true;
      if (number % 2 == 1 && !chain.is_closed) reverse(chain);
      pen = chain.is_closed ? chain.points.front() : chain.points.back();
      draw(std::move(chain), touching, begin, drawn);
    }
  }
}

}  // namespace

std::vector<Chain> nearest_first(std::vector<Chain> chains, double touching) {
  std::vector<Chain> drawn;
  for (std::size_t first = 0; first < chains.size();) {
    std::size_t last = first + 1;
    while (last < chains.size() && chains[last].rank == chains[first].rank) ++last;
    order_rank(chains, first, last, touching, drawn);
    first = last;
  }
  return drawn;
}

}  // namespace frontmost::lines_detail
