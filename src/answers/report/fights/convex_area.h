// SPDX-License-Identifier: Apache-2.0
// Convex areas on the screen: cutting by straight lines, and the area of unions.
//
//     +-------+
//     |-------|-----        The union is measured along closely spaced lines. Parts of a line in several areas count
//     |   +---+---+         once. The ratio of that length to the sum over all areas is the ratio of the areas.
//     |---|---|---|-
//     +---+---+   |
//         +-------+
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "view/screen_transform.h"

namespace frontmost {

/// f(x, y) = constant + gradient . (x, y).
struct AffineOverScreen {
  double constant;
  glm::dvec2 gradient;

  [[nodiscard]] double at(const glm::dvec2& point) const { return constant + glm::dot(gradient, point); }
};

/// Corners are ordered as in a face on the screen: the inside is on the left of each side, with y upwards.
class ConvexArea {
 public:
  ConvexArea() = default;
  void assign(std::span<const glm::dvec2> corners) { corners_.assign(corners.begin(), corners.end()); }
  /// Keeps the part where `f` is not negative.
  void cut(const AffineOverScreen& f);
  [[nodiscard]] std::span<const glm::dvec2> corners() const { return corners_; }
  [[nodiscard]] bool is_empty() const { return corners_.size() < 3; }
  /// Area in square pixels.
  [[nodiscard]] double area() const;
  [[nodiscard]] glm::dvec2 centre() const;

 private:
  std::vector<glm::dvec2> corners_, before_;
};

/// A function that is not negative on the inner side of the line from one point to the next.
[[nodiscard]] AffineOverScreen inside_of_side(const glm::dvec2& from, const glm::dvec2& to);

/// Pixels [first, end) of a row.
struct RowSpan {
  int first, end;
};

/// The pixels of a row of samples at `sample.y` that lie in an area, sides included. Samples are `sample.x` to the
/// right of the left sides of their pixels.
[[nodiscard]] RowSpan span_of(std::span<const glm::dvec2> corners, const glm::dvec2& sample, int width);

/// Calls visit(number, x, y, offset) for the samples of a view in an area, in every `step`-th column and row. Numbers
/// are in the order of Visible; offsets are relative to the corners of pixels.
template <class Visit>
void visit_samples(std::span<const glm::dvec2> corners, const View& view, int step, const Visit& visit) {
  const auto from = [&](int first) { return (first + step - 1) / step * step; };
  const auto [top, bottom] =
      std::minmax_element(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  const std::span<const glm::ivec2> samples = sample_offsets(view.samples);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const glm::dvec2 offset = glm::dvec2(samples[s]) / double(kSubPixels);
    for (int y = from(std::max(int(std::floor(top->y - offset.y)), 0)); y < view.height; y += step) {
      if (y + offset.y > bottom->y + 1) break;
      const RowSpan row = span_of(corners, {offset.x, y + offset.y}, view.width);
      const std::size_t first = (s * std::size_t(view.height) + std::size_t(y)) * std::size_t(view.width);
      for (int x = from(row.first); x < row.end; x += step) visit(first + std::size_t(x), x, y, offset);
    }
  }
}

/// Measures the share of several areas that remains if every place counts once.
class UnionShare {
 public:
  void add(std::span<const glm::dvec2> corners) { areas_.push_back(corners); }
  /// The area of the union divided by the sum of the areas: 1 if none overlap, at least 1 over their number. Lines are
  /// 1/16 pixel apart, or farther apart if there would be too many.
  [[nodiscard]] double find() const;

 private:
  std::vector<std::span<const glm::dvec2>> areas_;
};

}  // namespace frontmost
