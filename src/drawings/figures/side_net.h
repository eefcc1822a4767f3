// SPDX-License-Identifier: Apache-2.0
// Outlines that lie beside each other, without the sides that two of them share.
//
// What is left after shared sides have gone in pairs closes to rings by itself: every outline that was added was
// closed, so as many sides end at a point as begin there.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "painter/traps/trap.h"

namespace frontmost::shading {

/// Corners are rounded to 1/4096 pixel, and sides are parted where corners of others lie on them; so what lies beside
/// each other has the same sides there, once to and once fro. O(n log n) in the number of corners, for sides that are
/// short beside the whole.
class SideNet {
 public:
  using Corner = painter_detail::TrappedCorner;

  /// Adds a closed outline, as number `outline` of the caller's.
  void add(std::span<const Corner> corners, std::uint32_t outline);
  void add(std::span<const glm::dvec2> corners, std::uint32_t outline);
  void clear() { raw_.clear(); }
  /// Parts sides. All is to be added before.
  void weave();

  /// Calls share(a, b) for outlines that share a side. Where several lie over each other there, those with the lowest
  /// numbers share it, and so on.
  template <class Share>
  void for_each_shared(const Share& share) const {
    for (std::size_t i = 0; i < sides_.size();) {
      const Pairs pairs = pairs_at(i);
      for (std::size_t k = 0; k < pairs.count(); ++k) share(sides_[i + k].outline, sides_[pairs.turn + k].outline);
      i = pairs.end;
    }
  }
  /// Calls keep(corners) for every closed ring of what is left without shared sides.
  template <class Keep>
  void for_each_ring(const Keep& keep) {
    begin_rings();
    while (next_ring()) keep(std::span<const Corner>(ring_));
  }

 private:
  using Point = glm::i64vec2;
  struct Side {
    std::uint32_t from, to, outline, trap;
  };
  struct Raw {
    Point from, to;
    std::uint32_t outline, trap;
  };

  /// Sides between two points: those to begin at some place, those fro at the turn.
  struct Pairs {
    std::size_t begin, turn, end;
    [[nodiscard]] std::size_t count() const { return std::min(turn - begin, end - turn); }
  };
  void add_side(const glm::dvec2& from, const glm::dvec2& to, std::uint32_t outline, std::uint32_t trap);
  [[nodiscard]] Pairs pairs_at(std::size_t begin) const;
  [[nodiscard]] std::uint32_t number(const Point& p) const;
  void sort_points();
  void find_between(const Point& from, const Point& to);
  void begin_rings();
  bool next_ring();
  void straighten();

  std::vector<Raw> raw_;
  std::vector<Point> points_;      ///< by rows, and by x in a row
  std::vector<std::size_t> rows_;  ///< where each begins
  std::int64_t low_y_ = 0, row_height_ = 1;
  std::vector<std::pair<double, std::uint32_t>> between_;
  std::vector<Side> sides_;  ///< those between the same points together
  std::vector<Side> left_;   ///< by where they begin
  std::vector<std::uint8_t> is_used_;
  std::size_t next_ = 0;
  std::vector<Corner> ring_;
};

/// Numbers that are put together into sets, as those of polygons that share sides. Each set is known by its greatest
/// number.
class Sets {
 public:
  explicit Sets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    above_[std::min(a, b)] = std::max(a, b);
  }

 private:
  std::vector<std::uint32_t> above_;
};

}  // namespace frontmost::shading
