// SPDX-License-Identifier: Apache-2.0
// The outlines of adjacent polygons, without the sides that two of them share.
//
// After shared sides are removed in pairs, the remaining sides form closed rings: every added outline was closed, so as
// many sides end at a point as begin there.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "painter/traps/trap.h"

namespace frontmost::shading {

/// Corners are rounded to 1/4096 pixel, and sides are split at corners of others. So adjacent outlines have the same
/// sides, in opposite directions. O(n log n) in the number of corners, for sides that are short beside the whole.
class SideNet {
 public:
  using Corner = painter_detail::TrappedCorner;

  /// Adds a closed outline, which the caller identifies as number `outline`.
  void add(std::span<const Corner> corners, std::uint32_t outline);
  void add(std::span<const glm::dvec2> corners, std::uint32_t outline);
  void clear() { raw_.clear(); }
  /// Splits sides. Call it after all outlines were added.
  void weave();

  /// Calls share(a, b) for outlines that share a side. Where several coincide there, outlines are paired in ascending
  /// order.
  template <class Share>
  void for_each_shared(const Share& share) const {
    for (std::size_t i = 0; i < sides_.size();) {
      const Pairs pairs = pairs_at(i);
      for (std::size_t k = 0; k < pairs.count(); ++k) share(sides_[i + k].outline, sides_[pairs.turn + k].outline);
      i = pairs.end;
    }
  }
  /// Calls keep(corners) for every closed ring of the sides that are not shared.
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

  /// All sides between two points: in the direction low to high they are [begin, turn), in the other [turn, end).
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
  std::vector<std::size_t> rows_;  ///< by row: index of its first point
  std::int64_t low_y_ = 0, row_height_ = 1;
  std::vector<std::pair<double, std::uint32_t>> between_;
  std::vector<Side> sides_;  ///< sides between the same points are consecutive
  std::vector<Side> left_;   ///< sorted by first point
  std::vector<std::uint8_t> is_used_;
  std::size_t next_ = 0;
  std::vector<Corner> ring_;
};

}  // namespace frontmost::shading
