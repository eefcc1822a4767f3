// SPDX-License-Identifier: Apache-2.0
// Convex areas on the screen: cut by straight lines, and how much of several is one and the same.
//
//     +-------+
//     |-------|-----        The union is measured along lines close to each other: what several areas have of a line
//     |   +---+---+         counts once. The ratio to what they have of it one by one is that of the areas.
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

/// Corners in the order of a face on the screen: its inside lies to the left of its sides, were y to run up.
class ConvexArea {
 public:
  ConvexArea() = default;
  void assign(std::span<const glm::dvec2> corners) { corners_.assign(corners.begin(), corners.end()); }
  /// Keeps where `f` is not negative.
  void cut(const AffineOverScreen& f);
  [[nodiscard]] std::span<const glm::dvec2> corners() const { return corners_; }
  [[nodiscard]] bool is_empty() const { return corners_.size() < 3; }
  /// In pixels squared.
  [[nodiscard]] double area() const;
  [[nodiscard]] glm::dvec2 centre() const;

 private:
  std::vector<glm::dvec2> corners_, before_;
};

/// Not negative to the inner side of the line from one point to the next.
[[nodiscard]] AffineOverScreen inside_of_side(const glm::dvec2& from, const glm::dvec2& to);

/// The pixels [first, end) of a row.
struct RowSpan {
  int first, end;
};

/// The pixels of a row of samples at `sample.y` that lie in an area, those on its sides with them; samples are
/// `sample.x` from the left sides of their pixels.
[[nodiscard]] RowSpan span_of(std::span<const glm::dvec2> corners, const glm::dvec2& sample, int width);

/// Calls visit(number, x, y, offset) for the samples of a view in an area: numbers in the order of Visible, offsets
/// from the corners of pixels. Only those of every `step`-th column and row.
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

/// Measures how much of several areas is left when every place counts once.
class UnionShare {
 public:
  void add(std::span<const glm::dvec2> corners) { areas_.push_back(corners); }
  /// The area of the union over the sum of the areas: 1 where none overlap, at least 1 over their number. Lines are
  /// 1/16 pixel apart, or farther where there would be too many.
  [[nodiscard]] double find() const;

 private:
  std::vector<std::span<const glm::dvec2>> areas_;
};

}  // namespace frontmost
