// SPDX-License-Identifier: Apache-2.0
// The rule by which lines count as lying on each other.
//
//     a --------------------------      Of two lines that run side by side, nearer to each other than `apart` and at
//            b -----------------------  nearly one angle, the later one is drawn only where the earlier one is not. The
//            |<-- overlap -->|          overlap is the stretch of a line on which another lies.
//
// The allowed difference in angle is smaller for long lines than for short ones. Otherwise long lines that cross at a
// small angle would lose what lies between them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

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
  /// In pixels: shorter stretches are neither kept nor removed. Places of one point differ by the rounding of floats,
  /// 1e-7 of some thousand pixels.
  static constexpr double shortest = 8e-3;
  /// Greatest slope between a long line and a line on it. Tiny pieces point anywhere, but their lists would be too
  /// long.
  static constexpr double most_slope = 1.0 / 128;
  /// Greatest slope between short lines: they part by at most a quarter of their overlap, to either side.
  static constexpr double most_short_slope = 0.5;

  explicit Nearness(double apart) : apart_(apart) {}

  [[nodiscard]] double apart() const { return apart_; }

  /// The allowed difference in direction from a long line. It moves the end by several times `apart`, because the part
  /// on the long line may be short.
  [[nodiscard]] double slope_within(double length) const { return std::min(8 * apart_ / length, most_slope); }

  /// The greatest distance from a line of that length of lines that lie on it.
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
    // Short lines must be closer together, or all lines from one point would lie on each other.
    const double most = reach_of(end - begin);
    return off(begin) <= most && off(end) <= most ? Stretch{begin, end} : nothing;
  }

 private:
  double apart_;
};

/// A line, with the limits for other lines that may lie on it.
struct SoughtLine {
  SoughtLine(const Line& line, const Nearness& nearness)
      : middle((line.from + line.to) / 2.0),
        along(line.along),
        half(line.length / 2),
        reach(nearness.reach_of(line.length)),
        turn(line.is_long() ? Nearness::most_slope * (1 + 1e-4) : Nearness::most_short_slope) {}

  glm::dvec2 middle, along;
  double half;   ///< half of the length
  double reach;  ///< the greatest distance of such lines
  double turn;   ///< the greatest tangent of the angle to such lines
};

/// A short form of a line in 20 bytes, which suffices to exclude that it lies on another.
struct BriefLine {
  BriefLine(const Line& line, std::uint32_t its_number)
      : middle((line.from + line.to) / 2.0), half((line.to - line.from) / 2.0), number(its_number) {}

  glm::vec2 middle, half;
  std::uint32_t number;

  /// False only where Nearness::overlap() is empty.
  [[nodiscard]] bool may_lie_on(const SoughtLine& line) const {
    const glm::dvec2 other(half), apart = glm::dvec2(middle) - line.middle;
    const double across = std::abs(cross(line.along, other)), along = std::abs(glm::dot(line.along, other));
    // More than the rounding error of floats.
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

}  // namespace frontmost::lines_detail
