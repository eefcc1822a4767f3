// SPDX-License-Identifier: Apache-2.0
// Ranks the cells of a torus so that, for any rank, the cells of lower rank are spread evenly (R. Ulichney. The
// Void-and-Cluster Method for Dither Array Generation. 1993). A dot is repeatedly put into the largest gap; the order
// of dots is their rank. So one table, made once for all threads, serves for every darkness.
#include "hatching/dot_grid.h"

#include <array>

namespace frontmost::lines_detail {
namespace {

constexpr int cells_along = DotGrid::side, cell_count = cells_along * cells_along;

/// For each cell, how much the taken cells around it crowd it. Compilers vectorize the loops; else they take most time
/// of small pictures.
class Torus {
 public:
  Torus() {
    barred_[1].fill(never);
    for (int y = 0; y < cells_along; ++y)
      for (int x = 0; x < 2 * cells_along; ++x) {
        const int from_x = std::min(x % cells_along, cells_along - x % cells_along),
                  from_y = std::min(y, cells_along - y);
        // Rounded to a float, the exponential is the same with every C library.
        near_[std::size_t(2 * cells_along * y + x)] =
            float(std::exp(-(from_x * from_x + from_y * from_y) / (2 * 1.9 * 1.9)));
      }
  }

  [[nodiscard]] bool is_taken(int cell) const { return barred_[1][std::size_t(cell)] == 0; }
  void set(int cell, bool taken) {
    barred_[taken][std::size_t(cell)] = 0;
    barred_[!taken][std::size_t(cell)] = never;
    const int x = cell % cells_along, y = cell / cells_along;
    const double sign = taken ? 1 : -1;
    for (int j = 0; j < cells_along; ++j) {
      const float* near = near_.data() + 2 * cells_along * ((j - y) & (cells_along - 1)) + cells_along - x;
      double* crowd = crowd_.data() + cells_along * j;
      for (int i = 0; i < cells_along; ++i) crowd[i] += sign * double(near[i]);
    }
  }
  /// With `taken`, the most crowded of the taken cells; otherwise the least crowded of the free cells. Among equals,
  /// the first.
  [[nodiscard]] int extreme(bool taken) const {
    const double sign = taken ? 1 : -1;
    const auto value = [&](int cell) { return sign * crowd_[std::size_t(cell)] + barred_[taken][std::size_t(cell)]; };
    std::array<double, cells_along> most;
    most.fill(never);
    for (int j = 0; j < cell_count; j += cells_along)
      for (int i = 0; i < cells_along; ++i) {
        const double here = value(j + i), there = most[std::size_t(i)];
        most[std::size_t(i)] = here > there ? here : there;
      }
    const double best = *std::max_element(most.begin(), most.end());
    int first = cell_count;
    for (int i = 0; i < cells_along; ++i)
      if (most[std::size_t(i)] == best)
        for (int cell = i; cell < first; cell += cells_along)
          if (value(cell) == best) first = cell;
    return first;
  }

 private:
  static constexpr double never = -1e300;

  std::array<float, 2 * cell_count> near_{};  ///< weight by distance; x goes from minus to plus the size of a row
  std::array<double, cell_count> crowd_{};
  std::array<std::array<double, cell_count>, 2>
      barred_{};  ///< [0]: 0 for free cells; [1]: 0 for taken cells; `never` for others
};

/// A random generator with the same numbers on every machine.
struct Shuffle {
  std::uint64_t state = 1;
  std::uint32_t next() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return std::uint32_t(state >> 33);
  }
};

std::vector<int> ranks() {
  constexpr int first = cell_count / 10;
  Torus torus;
  Shuffle shuffle;
  for (int taken = 0; taken < first;) {
    const int cell = int(shuffle.next() % cell_count);
    if (torus.is_taken(cell)) continue;
    torus.set(cell, true);
    ++taken;
  }
  // Moves a dot from the most crowded cell to the widest gap, until this gap is the cell that it left.
  for (int i = 0; i < cell_count; ++i) {
    const int from = torus.extreme(true);
    torus.set(from, false);
    const int to = torus.extreme(false);
    torus.set(to, true);
    if (from == to) break;
  }
  std::vector<int> rank(cell_count);
  Torus rest = torus;
  for (int left = first; left > 0;) {
    const int cell = torus.extreme(true);
    torus.set(cell, false);
    rank[std::size_t(cell)] = --left;
  }
  for (int taken = first; taken < cell_count; ++taken) {
    const int cell = rest.extreme(false);
    rest.set(cell, true);
    rank[std::size_t(cell)] = taken;
  }
  return rank;
}

}  // namespace

DotGrid::DotGrid(double spacing, double width)
    : cell_(cell_of(spacing)), width_(width), columns_(std::int32_t(width / cell_) + 1) {
  // At most a quarter of the cells are taken; with more, their rows would show.
  constexpr double most = cell_count / 4.0;
  static const std::vector<int> rank_of = ranks();
  Shuffle shuffle;
  for (const int rank : rank_of) {
    // Darkness grows with the square root of the share of dots, because few dots far apart look darker than they are.
    const auto darkness = float(std::sqrt((rank + 0.5) / most));
    const float shift = 0.3f + 0.4f * float(shuffle.next() & 0xFFFF) / 65536.0f;
    places_.push_back({shift, 0.95f - darkness});
  }
}

}  // namespace frontmost::lines_detail
