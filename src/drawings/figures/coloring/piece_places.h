// SPDX-License-Identifier: Apache-2.0
// The sample places of a piece of a polygon, and cuts of pieces.
//
// Places form a rank-1 lattice over each triangle of the piece's fan. They are evenly spread for any number, so more
// can be added later without moving earlier ones. A piece from a cut keeps the samples of the whole that lie in it, and
// adds only missing ones.
#pragma once

#include <span>
#include <vector>

#include "figures/coloring/color_cut.h"

namespace frontmost::shading {

/// A convex outline and its size.
struct PieceSize {
  explicit PieceSize(std::span<const glm::dvec2> corners);
  glm::dvec2 middle{0};
  double area = 0;    ///< square pixels
  double length = 0;  ///< pixels, at least half of the greatest distance between two corners
  /// Whether its middle gives its colour.
  [[nodiscard]] bool is_small() const;
  /// The number of samples that it should have.
  [[nodiscard]] double sample_count() const;
};

/// The middle of the outline's chord through `at`, perpendicular to `along`.
[[nodiscard]] glm::dvec2 middle_across(std::span<const glm::dvec2> corners, const glm::dvec2& at,
                                       const glm::dvec2& along);

/// Calls add(place) beside every corner of an outline, where colours are extreme.
template <class Add>
void for_each_corner_place(std::span<const glm::dvec2> corners, const glm::dvec2& middle, const Add& add) {
  constexpr double kInset = 0.25;  // pixels from the corner inwards
  for (const glm::dvec2& corner : corners) {
    const glm::dvec2 way = middle - corner;
    add(corner + way * std::min(0.25, kInset / std::max(glm::length(way), 1e-9)));
  }
}

/// Calls add(place) for places along the middle of a long and narrow outline.
template <class Add>
void for_each_place_along(std::span<const glm::dvec2> corners, const PieceSize& size, const Add& add) {
  const auto count = std::size_t(std::ceil(size.length / 1.5));
  const glm::dvec2 from = corners[0];
  glm::dvec2 to = from;
  for (const glm::dvec2& corner : corners)
    if (glm::length(corner - from) > glm::length(to - from)) to = corner;
  const glm::dvec2 step = (to - from) / double(count);
  for (std::size_t k = 0; k < count; ++k) add(middle_across(corners, from + step * (double(k) + 0.5), step));
}

/// Calls add(place) for places from number `first` on until `count`, evenly spread over an outline of some area: a
/// rank-1 lattice over each triangle of its fan, with a number of places in proportion to its area. (M. Roberts. The
/// Unreasonable Effectiveness of Quasirandom Sequences. 2018.)
template <class Add>
void for_each_place(std::span<const glm::dvec2> corners, double area, double count, const Add& add) {
  if (!(area > 0)) return;  // no area has no direction, though it may be long
  double before = 0;
  std::size_t number = 0;
  const glm::dvec2 from = corners[0];
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec2 a = corners[i - 1] - from, b = corners[i] - from;
    before += std::abs(a.x * b.y - a.y * b.x) * 0.5;
    const auto until = std::size_t(std::ceil(std::min(before / area, 1.0) * count));
    for (; number < until; ++number) {
      double u = 0.5 + 0.7548776662466927 * double(number), v = 0.5 + 0.5698402909980532 * double(number);
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      add(from + a * u + b * v);
    }
  }
}

/// The parts of an outline below and above a line.
struct CutOutline {
  std::vector<glm::dvec2> below, above;
};
[[nodiscard]] CutOutline cut_outline(std::span<const glm::dvec2> corners, const ScreenLine& line);

}  // namespace frontmost::shading
