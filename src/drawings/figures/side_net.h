// SPDX-License-Identifier: Apache-2.0
// The outlines of adjacent polygons, without the sides that two of them share.
//
//    A ------------------ B     Corners are rounded to a grid. A neighbour has a corner C on
//    |         C          |     the side A-B, which becomes A-C and C-B. So each of the three
//    |         |          |     polygons has the same sides as its neighbours, in opposite
//    +---------+----------+     directions. Shared sides are found by their numbers.
//
// Points are sorted by rows of the picture, and by x within a row. The sides that are not shared form closed rings: as
// many sides end at a point as begin there.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "painter/traps/traps.h"

namespace frontmost::shading {

/// O(n log n) in the number of corners, if sides are short in comparison with the whole.
class SideNet {
 public:
  using Corner = painter_detail::TrappedCorner;

  /// Adds a closed outline, which the caller identifies as number `outline`.
  void add(std::span<const Corner> corners, std::uint32_t outline) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      add_side(corners[i].at, corners[i + 1 == corners.size() ? 0 : i + 1].at, outline, corners[i].trap);
  }

  void add(std::span<const glm::dvec2> corners, std::uint32_t outline) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      add_side(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1], outline, painter_detail::no_trap);
  }

  void clear() { raw_.clear(); }

  /// Splits sides at the corners that lie on them. Call this after all outlines are added.
  void weave() {
    sides_.clear();
    if (raw_.empty()) return;
    sort_points();
    for (const Raw& side : raw_) {
      find_between(side.from, side.to);
      std::uint32_t from = number(side.from);
      for (const auto& [along, point] : between_) {
        sides_.push_back({from, point, side.outline, side.trap});
        from = point;
      }
      sides_.push_back({from, number(side.to), side.outline, side.trap});
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      const auto [a_low, a_high] = std::minmax(a.from, a.to);
      const auto [b_low, b_high] = std::minmax(b.from, b.to);
      return std::tie(a_low, a_high, a.from, a.outline) < std::tie(b_low, b_high, b.from, b.outline);
    });
  }

  /// Calls share(a, b) for outlines that share a side. Where several coincide, they are paired in ascending order.
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
    leave_unshared();
    for (std::size_t first = 0; first < left_.size(); ++first) {
      if (is_used_[first]) continue;
      walk_around(first);
      keep(std::span<const Corner>(ring_));
    }
  }

 private:
  static constexpr double kUnits = 4096;  ///< per pixel
  /// The greatest distance, in units, between a corner and the side on which it lies. Both were rounded.
  static constexpr double kBesideSide = 1.5;

  using Point = glm::i64vec2;
  struct Side {
    std::uint32_t from, to, outline, trap;
  };
  struct Raw {
    Point from, to;
    std::uint32_t outline, trap;
  };

  /// All sides between two points. Sides [begin, turn) lead from the low point to the high point, sides [turn, end)
  /// back.
  struct Pairs {
    std::size_t begin, turn, end;
    [[nodiscard]] std::size_t count() const { return std::min(turn - begin, end - turn); }
  };

  void add_side(const glm::dvec2& from, const glm::dvec2& to, std::uint32_t outline, std::uint32_t trap) {
    const auto rounded = [](const glm::dvec2& p) {
      return Point(std::llround(p.x * kUnits), std::llround(p.y * kUnits));
    };
    if (rounded(from) != rounded(to)) raw_.push_back({rounded(from), rounded(to), outline, trap});
  }

  [[nodiscard]] Pairs pairs_at(std::size_t begin) const {
    const auto ends = [](const Side& side) { return std::minmax(side.from, side.to); };
    Pairs pairs{begin, begin, begin};
    while (pairs.end < sides_.size() && ends(sides_[pairs.end]) == ends(sides_[begin]))
      pairs.turn += sides_[pairs.end++].from == sides_[begin].from;
    return pairs;
  }

  [[nodiscard]] std::uint32_t number(const Point& p) const {
    const auto row = std::size_t((p.y - low_y_) / row_height_);
    const auto less = [](const Point& a, const Point& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); };
    const auto begin = points_.begin();
    return std::uint32_t(
        std::lower_bound(begin + std::ptrdiff_t(rows_[row]), begin + std::ptrdiff_t(rows_[row + 1]), p, less) - begin);
  }

  void sort_points() {
    points_.clear();
    for (const Raw& side : raw_) points_.push_back(side.from);
    std::int64_t high_y = raw_.front().from.y;
    low_y_ = high_y;
    for (const Point& p : points_) {
      low_y_ = std::min(low_y_, p.y);
      high_y = std::max(high_y, p.y);
    }
    const auto rows = std::int64_t(std::sqrt(double(points_.size()))) + 1;
    row_height_ = (high_y - low_y_) / rows + 1;
    const auto key = [&](const Point& p) { return std::tuple((p.y - low_y_) / row_height_, p.x, p.y); };
    std::sort(points_.begin(), points_.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    rows_.assign(std::size_t(rows) + 2, points_.size());
    for (std::size_t i = points_.size(); i-- > 0;) rows_[std::size_t((points_[i].y - low_y_) / row_height_)] = i;
    for (std::size_t r = rows_.size() - 1; r-- > 0;) rows_[r] = std::min(rows_[r], rows_[r + 1]);
  }

  /// Sets between_ to the points on a side, in the order of the side's direction.
  void find_between(const Point& from, const Point& to) {
    between_.clear();
    const glm::dvec2 way(to - from);
    const double length = glm::length(way);
    const auto [low, high] = std::minmax(from.y, to.y);
    const auto row_of = [&](std::int64_t y) {
      return std::clamp<std::int64_t>((y - low_y_) / row_height_, 0, std::int64_t(rows_.size()) - 2);
    };
    for (std::int64_t row = row_of(low - 2); row <= row_of(high + 2); ++row) {
      // The range of x of the side within the row.
      double least = double(std::min(from.x, to.x)), greatest = double(std::max(from.x, to.x));
      if (low != high) {
        const auto x_at = [&](std::int64_t y) {
          return double(from.x) + way.x * std::clamp(double(y - from.y) / way.y, 0.0, 1.0);
        };
        const double a = x_at(low_y_ + row * row_height_ - 2), b = x_at(low_y_ + (row + 1) * row_height_ + 2);
        least = std::min(a, b);
        greatest = std::max(a, b);
      }
      const auto first = points_.begin() + std::ptrdiff_t(rows_[std::size_t(row)]);
      const auto last = points_.begin() + std::ptrdiff_t(rows_[std::size_t(row) + 1]);
      auto at = std::lower_bound(first, last, least - 2, [](const Point& p, double x) { return double(p.x) < x; });
      for (; at != last && double(at->x) <= greatest + 2; ++at) {
        const glm::dvec2 p(*at - from);
        const double along = glm::dot(p, way) / length;
        if (along > kBesideSide && along < length - kBesideSide &&
            std::abs(way.x * p.y - way.y * p.x) <= kBesideSide * length)
          between_.push_back({along, std::uint32_t(at - points_.begin())});
      }
    }
    std::sort(between_.begin(), between_.end());
  }

  /// Sides in opposite directions cancel out, so equal numbers of both are dropped.
  void leave_unshared() {
    left_.clear();
    for (std::size_t i = 0; i < sides_.size();) {
      const Pairs pairs = pairs_at(i);
      for (std::size_t k = i + pairs.count(); k < pairs.turn; ++k) left_.push_back(sides_[k]);
      for (std::size_t k = pairs.turn + pairs.count(); k < pairs.end; ++k) left_.push_back(sides_[k]);
      i = pairs.end;
    }
    std::sort(left_.begin(), left_.end(), [](const Side& a, const Side& b) {
      return std::tie(a.from, a.to, a.outline) < std::tie(b.from, b.to, b.outline);
    });
    is_used_.assign(left_.size(), 0);
  }

  /// Sets ring_ to the ring that begins with side `first`, which is unused. As many sides end at each point as begin
  /// there, so every walk returns to its first point.
  void walk_around(std::size_t first) {
    ring_.clear();
    std::size_t side = first;
    while (true) {
      is_used_[side] = 1;
      ring_.push_back({glm::dvec2(points_[left_[side].from]) / kUnits, left_[side].trap});
      if (left_[side].to == left_[first].from) break;
      side = std::size_t(std::lower_bound(left_.begin(), left_.end(), left_[side].to,
                                          [](const Side& s, std::uint32_t point) { return s.from < point; }) -
                         left_.begin());
      while (is_used_[side]) ++side;
    }
    straighten();
  }

  /// Removes corners at which the ring does not turn.
  void straighten() {
    std::vector<Corner> kept;
    const std::size_t count = ring_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Corner& before = kept.empty() ? ring_[count - 1] : kept.back();
      const glm::dvec2 in = ring_[i].at - before.at, out = ring_[i + 1 == count ? 0 : i + 1].at - ring_[i].at;
      const double turn = std::abs(in.x * out.y - in.y * out.x);
      const bool is_straight =
          turn <= 4 / kUnits * std::min(glm::length(in), glm::length(out)) && glm::dot(in, out) > 0;
      if (!is_straight || before.trap != ring_[i].trap) kept.push_back(ring_[i]);
    }
    if (kept.size() >= 3) ring_ = std::move(kept);
  }

  std::vector<Raw> raw_;
  std::vector<Point> points_;      ///< sorted by row, then by x
  std::vector<std::size_t> rows_;  ///< by row: index of its first point
  std::int64_t low_y_ = 0, row_height_ = 1;
  std::vector<std::pair<double, std::uint32_t>> between_;
  std::vector<Side> sides_;  ///< sides between the same points are consecutive
  std::vector<Side> left_;   ///< sides that are not shared, sorted by first point
  std::vector<std::uint8_t> is_used_;
  std::vector<Corner> ring_;
};

}  // namespace frontmost::shading
