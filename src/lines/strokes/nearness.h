// SPDX-License-Identifier: Apache-2.0
// Which lines count as lying on each other.
#pragma once

#include <algorithm>
#include <cmath>

#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {

struct Line : Segment {
  explicit Line(const Segment& segment)
      : Segment(segment), length(glm::distance(from, to)), along((to - from) / length) {}

  static constexpr double long_from = 16;  // pixels
  [[nodiscard]] bool is_long() const { return length > long_from; }

  double length;
  glm::dvec2 along;
};

/// Where a line is covered, in pixels from its beginning.
struct Stretch {
  double begin, end;
};

class Nearness {
 public:
  /// Pixels: what is left over or taken away is longer. Places of one point differ by the rounding of floats, 1e-7 of
  /// some thousand pixels.
  static constexpr double shortest = 8e-3;
  /// Between a long line and what counts as lying on it. Tiny pieces point anywhere, but such lists would be too many.
  static constexpr double most_slope = 1.0 / 128;
  /// Between short ones: they part by at most a quarter of what they share, to either side.
  static constexpr double most_short_slope = 0.5;

  explicit Nearness(double apart) : apart_(apart) {}

  [[nodiscard]] double apart() const { return apart_; }

  /// How much a direction may differ from that of a long line: over its length by some times what counts as near, for
  /// the part that lies on the long line may be short.
  [[nodiscard]] double slope_within(double length) const { return std::min(8 * apart_ / length, most_slope); }

  /// How far from a line of that length lies at most what lies on it.
  [[nodiscard]] double reach_of(double length) const { return std::min(apart_, length / 4); }

  /// Where, along `line`, `other` lies on it; empty where it does not. Lengths in pixels.
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
    // Short ones are closer together, or all would lie on each other that start from a point.
    const double most = reach_of(end - begin);
    return off(begin) <= most && off(end) <= most ? Stretch{begin, end} : nothing;
  }

 private:
  double apart_;
};

}  // namespace frontmost::lines_detail
