// SPDX-License-Identifier: Apache-2.0
// R. Ulichney. The Void-and-Cluster Method for Dither Array Generation. 1993: ranks for the cells of a torus, so that
// those below any rank are spread evenly.
#include "lines/hatching/dot_grid.h"

#include <array>

namespace frontmost::lines_detail {
namespace {

constexpr int side = DotGrid::side, count = side * side;

/// How crowded each cell is by those that are taken.
class Torus {
 public:
  Torus() {
    for (int i = 0; i < count; ++i) {
      const int x = std::min(i % side, side - i % side), y = std::min(i / side, side - i / side);
      // As a float it is the same with every C library.
      near_[std::size_t(i)] = float(std::exp(-(x * x + y * y) / (2 * 1.9 * 1.9)));
    }
  }

  [[nodiscard]] bool is_taken(int cell) const { return taken_[std::size_t(cell)]; }
  void set(int cell, bool taken) {
    taken_[std::size_t(cell)] = taken;
    const int x = cell % side, y = cell / side;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double near = near_[std::size_t(((j - y) & (side - 1)) * side + ((i - x) & (side - 1)))];
        crowd_[std::size_t(j * side + i)] += taken ? near : -near;
      }
  }
  /// Of the taken cells the most crowded, or of the free ones the least; of equals the first.
  [[nodiscard]] int extreme(bool taken) const {
    int best = -1;
    for (int i = 0; i < count; ++i) {
      if (is_taken(i) != taken) continue;
      const double here = crowd_[std::size_t(i)], there = best < 0 ? 0 : crowd_[std::size_t(best)];
      if (best < 0 || (taken ? here > there : here < there)) best = i;
    }
    return best;
  }

 private:
  std::array<float, count> near_{};
  std::array<double, count> crowd_{};
  std::array<bool, count> taken_{};
};

/// The same numbers everywhere.
class Shuffle {
 public:
  std::uint32_t next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return std::uint32_t(state_ >> 33);
  }

 private:
  std::uint64_t state_ = 1;
};

std::vector<int> ranks() {
  constexpr int first = count / 10;
  Torus torus;
  Shuffle shuffle;
  for (int taken = 0; taken < first;) {
    const int cell = int(shuffle.next() % count);
    if (torus.is_taken(cell)) continue;
    torus.set(cell, true);
    ++taken;
  }
  // From the thickest crowd to the widest void, until that is where it came from.
  for (int i = 0; i < count; ++i) {
    const int from = torus.extreme(true);
    torus.set(from, false);
    const int to = torus.extreme(false);
    torus.set(to, true);
    if (from == to) break;
  }
  std::vector<int> rank(count);
  Torus rest = torus;
  for (int left = first; left > 0;) {
    const int cell = torus.extreme(true);
    torus.set(cell, false);
    rank[std::size_t(cell)] = --left;
  }
  for (int taken = first; taken < count; ++taken) {
    const int cell = rest.extreme(false);
    rest.set(cell, true);
    rank[std::size_t(cell)] = taken;
  }
  return rank;
}

}  // namespace

DotGrid::DotGrid(double spacing, double width) : cell_(cell_of(spacing)), columns_(std::int32_t(width / cell_) + 1) {
  // A quarter of the cells at most: where more were taken their rows would show.
  constexpr double most = count / 4.0;
  Shuffle shuffle;
  for (const int rank : ranks()) {
    // Darkness grows with the square root of the share of dots: few that are far apart look darker than they are.
    const auto darkness = float(std::sqrt((rank + 0.5) / most));
    const float shift = 0.3f + 0.4f * float(shuffle.next() & 0xFFFF) / 65536.0f;
    places_.push_back({shift, 0.95f - darkness});
  }
}

}  // namespace frontmost::lines_detail
