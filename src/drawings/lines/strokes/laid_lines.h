// SPDX-License-Identifier: Apache-2.0
// An index of the lines that are drawn so far, and the rule by which lines count as lying on each other.
//
//     a --------------------------      Of two lines that run side by side, nearer to each other than `apart` and at
//            b -----------------------  nearly one angle, the later one is drawn only where the earlier one is not. The
//            |<-- overlap -->|          overlap is the stretch of a line on which another lies.
//
// Short lines are in the cells of a grid that they pass, long ones in an index of the infinite lines on which they lie.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "lines/square_grid.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {

struct Line : LineSegment {
  explicit Line(const LineSegment& segment)
      : LineSegment(segment), length(glm::distance(from, to)), along((to - from) / length) {}

  static constexpr double long_from = 16;  // pixels
  [[nodiscard]] bool is_long() const { return length > long_from; }

  double length;
  glm::dvec2 along;
};

/// A covered stretch of a line, in pixels from its beginning.
struct Stretch {
  double begin, end;
};

class Nearness {
 public:
  /// In pixels: shorter stretches are neither kept nor removed. Places of one point differ by the rounding of floats.
  static constexpr double shortest = 8e-3;
  /// Greatest slope between a long line and a line on it. Tiny pieces point anywhere, but would be too many.
  static constexpr double most_slope = 1.0 / 128;
  /// Greatest slope between short lines that lie on each other: at both ends of their overlap, their distance is at
  /// most a quarter of the overlap's length.
  static constexpr double most_short_slope = 0.5;

  explicit Nearness(double apart) : apart_(apart) {}

  [[nodiscard]] double apart() const { return apart_; }

  /// The allowed slope to a long line. It moves the end by several times `apart`: the part on that line may be short.
  [[nodiscard]] double slope_within(double length) const { return std::min(8 * apart_ / length, most_slope); }

  /// The greatest distance between a line of that length and a line that lies on it.
  [[nodiscard]] double reach_of(double length) const { return std::min(apart_, length / 4); }

  /// The stretch of `line` on which `other` lies, in pixels; empty if there is none.
  [[nodiscard]] Stretch overlap(const Line& line, const Line& other) const {
    constexpr Stretch nothing{0, 0};
    const bool has_long = line.is_long() || other.is_long();
    if (has_long && std::abs(cross(line.along, other.along)) > slope_within(std::min(line.length, other.length)))
      return nothing;
    const glm::dvec2 a = other.from - line.from, b = other.to - line.from;
    const double a_at = glm::dot(line.along, a), b_at = glm::dot(line.along, b);
    const double begin = std::max(0.0, std::min(a_at, b_at)), end = std::min(line.length, std::max(a_at, b_at));
    if (!(end - begin > shortest)) return nothing;
    const double a_off = cross(line.along, a), slope = (cross(line.along, b) - a_off) / (b_at - a_at);
    const auto off = [&](double at) { return std::abs(a_off + slope * (at - a_at)); };
    // Short lines must be closer to each other, because otherwise all lines from one point would lie on each other.
    const double most = reach_of(end - begin);
    return off(begin) <= most && off(end) <= most ? Stretch{begin, end} : nothing;
  }

 private:
  double apart_;
};

/// A line, with limits within which other lines may lie on it.
struct SoughtLine {
  SoughtLine(const Line& line, const Nearness& nearness)
      : middle((line.from + line.to) / 2.0),
        along(line.along),
        half(line.length / 2),
        reach(nearness.reach_of(line.length)),
        turn(line.is_long() ? Nearness::most_slope * (1 + 1e-4) : Nearness::most_short_slope) {}

  glm::dvec2 middle, along;
  double half;   ///< half of the length
  double reach;  ///< the greatest distance of a line that lies on this line
  double turn;   ///< the greatest slope between this line and a line that lies on it
};

/// A short form of a line, 20 bytes long. It suffices to exclude that the line lies on another line.
struct BriefLine {
  BriefLine(const Line& line, std::uint32_t its_number)
      : middle((line.from + line.to) / 2.0), half((line.to - line.from) / 2.0), number(its_number) {}

  glm::vec2 middle, half;
  std::uint32_t number;

  /// False only where Nearness::overlap() is empty.
  [[nodiscard]] bool may_lie_on(const SoughtLine& line) const {
    const glm::dvec2 other(half), apart = glm::dvec2(middle) - line.middle;
    const double across = std::abs(cross(line.along, other)), along = std::abs(glm::dot(line.along, other));
    // The slack is more than the rounding error of floats.
    const double slack = 1e-6 * (1 + std::abs(double(middle.x)) + std::abs(double(middle.y)) + along + across);
    const bool is_beside = std::abs(cross(line.along, apart)) > line.reach + across + slack;
    const bool is_beyond = std::abs(glm::dot(line.along, apart)) > line.half + along + slack;
    const bool is_turned = across > line.turn * along * (1 + 1e-6) + slack;
    return (int(is_beside) | int(is_beyond) | int(is_turned)) == 0;  // without branches
  }
};

/// Calls visit(numbers) for those `lines` that may lie on `sought`, a few hundred at a time.
template <class Visit>
void visit_likely(std::span<const BriefLine> lines, const SoughtLine& sought, const Visit& visit) {
  std::array<std::uint32_t, 256> found;
  while (!lines.empty()) {
    std::size_t count = 0;
    const auto some = lines.first(std::min(lines.size(), found.size()));
    for (const BriefLine& one : some) {
      found[count] = one.number;
      count += one.may_lie_on(sought);
    }
    visit(std::span<const std::uint32_t>(found.data(), count));
    lines = lines.subspan(some.size());
  }
}

/// Long segments, indexed by the infinite line on which they lie.
///
/// A line on top of another meets two opposite sides of the drawing, prolonged, at nearly the same heights. These two
/// heights are a point in a dual plane, in which lines that cross or run in parallel lie apart.
///
///     drawing          dual plane     The plane is a table of buckets. Lines that may lie on a line are near its
///    |            _b    |   . b       point. A line that turns about its middle moves there along a straight way.
///   a|  ___-----  |     |
///    |--          |     +------ a
class LongLines {
 public:
  /// `low` and `high` are the corners of a box around all segments. Precondition: they differ.
  LongLines(const glm::dvec2& low, const glm::dvec2& high, const Nearness& near)
      : low_(low), extent_(std::max(high.x - low.x, high.y - low.y)), bucket_(extent_ / 512), near_(near) {}

  void add(std::uint32_t number, const Line& segment) {
    const BriefLine brief(segment, number);
    const glm::dvec2 d = glm::abs(segment.to - segment.from);
    // Near the diagonal, a line on top of the segment may be in the other table.
    if (d.y <= 1.05 * d.x) flat_[key(heights(segment, 0))].push_back(brief);
    if (d.x <= 1.05 * d.y) steep_[key(heights(segment, 1))].push_back(brief);
  }

  /// Calls visit(numbers) for segments whose lines turn from this one's by at most the angle that Nearness allows at
  /// its length, and pass near its middle. \returns how many were tested.
  template <class Visit>
  std::size_t for_each(const Line& segment, const SoughtLine& sought, const Visit& visit) const {
    const glm::dvec2 d = glm::abs(segment.to - segment.from);
    const int axis = d.y <= d.x ? 0 : 1;
    const Table& table = axis == 0 ? flat_ : steep_;
    if (table.empty()) return 0;
    std::size_t looked_at = 0;
    const double slope = near_.slope_within(segment.length), off = near_.apart();
    // A line that turns about the middle moves by up to `spread` at the farther side, by a share of it at the nearer.
    const glm::dvec2 at = heights(segment, axis);
    const double middle = ((segment.from[axis] + segment.to[axis]) / 2 - low_[axis]) / extent_;
    const int far = middle < 0.5 ? 1 : 0;
    const double way = far == 1 ? 1 - middle : middle, share = (1 - way) / way;
    const double play = 2 * off, spread = 2 * slope * way * extent_ + play;  // slopes are at most 1: twice the angle
    for (int i = index(at[far] - spread); i <= index(at[far] + spread); ++i) {
      const double low = i * bucket_ - at[far] - play, high = low + bucket_ + 2 * play;
      const int last = index(at[1 - far] - low * share + play);
      for (int j = index(at[1 - far] - high * share - play); j <= last; ++j) {
        const auto found = table.find(far == 1 ? key(j, i) : key(i, j));
        if (found == table.end()) continue;
        looked_at += found->second.size();
        visit_likely(found->second, sought, visit);
      }
    }
    return looked_at;
  }

 private:
  using Table = std::unordered_map<std::uint64_t, std::vector<BriefLine>>;

  /// The heights at which the segment's line meets the two sides of the drawing across `axis`.
  [[nodiscard]] glm::dvec2 heights(const LineSegment& s, int axis) const {
    const double slope = (s.to[1 - axis] - s.from[1 - axis]) / (s.to[axis] - s.from[axis]);
    const double first = s.from[1 - axis] + slope * (low_[axis] - s.from[axis]);
    return glm::dvec2(first, first + slope * extent_) - low_[1 - axis];
  }
  [[nodiscard]] int index(double height) const { return int(std::floor(height / bucket_)); }
  [[nodiscard]] static std::uint64_t key(int first, int second) {
    return std::uint64_t(std::uint32_t(first)) << 32 | std::uint32_t(second);
  }
  [[nodiscard]] std::uint64_t key(const glm::dvec2& at) const { return key(index(at[0]), index(at[1])); }

  const glm::dvec2 low_;
  const double extent_, bucket_;
  const Nearness near_;
  Table flat_, steep_;
};

class LaidLines {
 public:
  /// Makes an empty index for pieces of `lines`. Precondition: there are lines.
  LaidLines(const std::vector<Line>& lines, const Nearness& nearness);

  void add(std::uint32_t number, const Line& line) {
    if (line.is_long()) return long_.add(number, line);
    cells_.visit_along(line.from, line.to, reach_of(line), [&](const PassedCell& passed) {
      lines_[passed.cell].emplace_back(line, number);
      return true;
    });
  }

  /// Calls visit(numbers) for candidates, possibly repeatedly: all short lines with a stretch by Nearness::overlap(),
  /// and the long ones that LongLines::for_each() finds. \returns how many were tested.
  ///
  /// Cost: a few tests per line in drawings. Thousands of lines in one cell, as of a model that is seen very small, are
  /// tested each against each: 20 thousand take up to 1.4 s.
  template <class Visit>
  std::size_t for_each(const Line& line, const Visit& visit) const {
    const SoughtLine sought(line, near_);
    std::size_t looked_at = 0;
    cells_.visit_along(line.from, line.to, reach_of(line), [&](const PassedCell& passed) {
      looked_at += lines_[passed.cell].size();
      visit_likely(lines_[passed.cell], sought, visit);
      return true;
    });
    return looked_at + long_.for_each(line, sought, visit);
  }

 private:
  /// The bounding box of the lines, and the number and total length of the short ones.
  struct Extent {
    explicit Extent(const std::vector<Line>& lines);
    [[nodiscard]] SquareGrid grid(double near) const;
    glm::dvec2 low{1e300}, high{-1e300};
    double short_length = 0, short_count = 0;
  };

  /// All lines that count as lying on `line` are within this distance, which includes a margin.
  [[nodiscard]] double reach_of(const Line& line) const { return near_.reach_of(line.length + Nearness::shortest); }

  const Nearness near_;
  const Extent extent_;
  const SquareGrid cells_;
  std::vector<std::vector<BriefLine>> lines_;  ///< the short lines by cell
  LongLines long_;
};

}  // namespace frontmost::lines_detail
