// SPDX-License-Identifier: Apache-2.0
// Pieces of one colour: the sample places of a piece, the line that best separates its colours, and groups of colours.
//
//        +---------+      Samples (x dark, o light) are spread over a piece, which one straight line cuts in two.
//        | x x /o o|      Pieces keep their polygon's place in the painting order, so a cut never changes what hides
//        |x  /o o  |      what.
//        +---------+
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "shade/geometry/geometry.h"

namespace frontmost::shading {

/// A point of a piece with its colour.
struct ColorSample {
  glm::dvec2 at{0};    ///< pixels on the screen
  glm::vec4 color{0};  ///< 0 to 255 each: sRGB and alpha
};
/// The colour of holes: farther from every colour than any two colours are from each other.
inline constexpr glm::vec4 hole_color{0, 0, 0, -512};

/// The line of the points p with dot(normal, p) = offset; the normal is a unit vector.
struct ScreenLine {
  glm::dvec2 normal{1, 0};
  double offset = 0;
  [[nodiscard]] double distance(const glm::dvec2& p) const { return glm::dot(normal, p) - offset; }
};

/// The lines on the screen along which one texture coordinate is constant.
class TexcoordLines {
 public:
  /// `coordinate`: the value at each corner, in texels.
  TexcoordLines(const TriangleSetup& setup, const std::array<double, 3>& coordinate) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Affine& a = setup.weight[k];
      const double x = double(a.step_x), y = double(a.step_y);
      const double constant = double(a.at_reference) - x * double(setup.reference.x) - y * double(setup.reference.y);
      const auto add = [&](Plane& plane, double factor) {
        plane.constant += factor * constant;
        plane.x += factor * x;
        plane.y += factor * y;
      };
      add(weight_, 1);
      add(weighted_, coordinate[k]);
    }
  }

  [[nodiscard]] double at(const glm::dvec2& p) const {
    const double weight = weight_.constant + weight_.x * p.x + weight_.y * p.y;
    const double value = (weighted_.constant + weighted_.x * p.x + weighted_.y * p.y) / weight;
    return std::isfinite(value) ? value : 0;
  }

  /// The line on which the coordinate is `value`; none if the coordinate is the same in the whole triangle.
  [[nodiscard]] std::optional<ScreenLine> line(double value) const {
    const glm::dvec2 normal(weighted_.x - value * weight_.x, weighted_.y - value * weight_.y);
    const double length = glm::length(normal);
    if (!(length > 1e-300)) return std::nullopt;
    return ScreenLine{normal / length, (value * weight_.constant - weighted_.constant) / length};
  }

 private:
  /// A value that is affine over the screen.
  struct Plane {
    double constant = 0, x = 0, y = 0;
  };
  Plane weight_, weighted_;  ///< the sum of the weights, and of the coordinates times the weights
};

/// A piece to be cut: its convex outline, and its samples.
struct ColorPiece {
  std::span<const glm::dvec2> corners;
  /// best_cut() uses at most a few hundred of them.
  std::span<const ColorSample> samples;
  double least_width;  ///< pixels: least width of each side, across the cut
  double range;        ///< greatest difference in a channel that counts as one colour
};

/// The line that leaves the least sum of squared differences between samples and the mean colour of their side. It is
/// chosen among lines of equal `texture` coordinates, lines in some fixed directions, and lines across the direction of
/// change. None if no line separates the samples. If colours change evenly in one direction, the line is a border of
/// the fewest bands of one colour each.
[[nodiscard]] std::optional<ScreenLine> best_cut(const ColorPiece& piece, std::span<const TexcoordLines> texture);

/// A convex outline and its size.
struct PieceSize {
  explicit PieceSize(std::span<const glm::dvec2> corners);
  glm::dvec2 middle{0};
  double area = 0;    ///< square pixels
  double length = 0;  ///< pixels, at least half of the greatest distance between two corners
  /// Whether a sample at the middle suffices for the piece's colour.
  [[nodiscard]] bool is_small() const;
  /// The number of samples that the piece should have.
  [[nodiscard]] double sample_count() const;
};

/// The middle of the outline's chord through `at`, perpendicular to `along`.
[[nodiscard]] glm::dvec2 middle_across(std::span<const glm::dvec2> corners, const glm::dvec2& at,
                                       const glm::dvec2& along);

/// Calls add(place) for a place beside every corner of an outline, because colours are extreme there.
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

/// Calls add(place) for about `count` places that are evenly spread over an outline with this area. They form a rank-1
/// lattice over each triangle of the outline's fan, and their number there is in proportion to the triangle's area. (M.
/// Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018.)
template <class Add>
void for_each_place(std::span<const glm::dvec2> corners, double area, double count, const Add& add) {
  if (!(area > 0)) return;  // an outline without area has no triangles to fill
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

/// Appends the parts of an outline below and above a line.
void cut_outline(std::span<const glm::dvec2> corners, const ScreenLine& line, std::vector<glm::dvec2>& below,
                 std::vector<glm::dvec2>& above);

/// The greatest difference in any channel.
[[nodiscard]] float difference(const glm::vec4& a, const glm::vec4& b);

/// Groups of nearly equal colours, numbered in the order in which they are added. A photograph has as many colours as
/// pieces, so groups are found by the cells of a grid over all colours.
class ColorGroups {
 public:
  /// A colour may differ from the first colour of its group by `reach` in each channel; channels are 0 to 255.
  explicit ColorGroups(double reach) : reach_(reach), cell_size_(std::max(reach * 1.001, kLeastCell)) {}

  /// The number of the first group within reach of `color`; adds a new group if there is none.
  std::uint32_t find_or_add(const glm::vec4& color);
  [[nodiscard]] const std::vector<glm::vec4>& colors() const { return colors_; }

 private:
  [[nodiscard]] std::uint32_t find(const glm::ivec4& cell, const glm::vec4& color) const;

  static constexpr double kLeastCell = 1.0 / 64;  ///< steps of 8 bits
  const double reach_, cell_size_;
  std::vector<glm::vec4> colors_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace frontmost::shading
