// SPDX-License-Identifier: Apache-2.0
// Finds the line that best separates the colours of a piece.
//
//        +---------+         Samples (x dark, o light) are spread over a piece, which one straight line
//        | x x /o o|         cuts in two. Both sides are sampled again, and cut again if necessary.
//        | x  / o o|         The line is only a place in the picture: pieces keep their polygon's place
//        |x  /o o  |         in the painting order, so a cut never changes what hides what.
//        +---------+
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shade/geometry/triangle_setup.h"

namespace frontmost::shading {

/// A point of a piece with its colour.
struct ColorSample {
  glm::dvec2 at{0};    ///< screen
  glm::vec4 color{0};  ///< 0 to 255 each: sRGB and alpha
};
/// The colour of holes: farther from every colour than any two colours are from each other.
inline constexpr glm::vec4 hole_color{0, 0, 0, -512};

/// Points with dot(normal, p) = offset; the normal is a unit vector.
struct ScreenLine {
  glm::dvec2 normal{1, 0};
  double offset = 0;
  [[nodiscard]] double distance(const glm::dvec2& p) const { return glm::dot(normal, p) - offset; }
};

/// The lines on the screen along which one texture coordinate is constant.
class TexcoordLines {
 public:
  /// `coordinate`: the value at each corner, in texels.
  TexcoordLines(const TriangleSetup& setup, const std::array<double, 3>& coordinate);
  [[nodiscard]] double at(const glm::dvec2& p) const;
  /// None if the whole triangle has one value.
  [[nodiscard]] std::optional<ScreenLine> line(double value) const;

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
  /// Thinned out to a few hundred.
  std::span<const ColorSample> samples;
  double least_width;  ///< pixels: least width of each side, across the cut
  double range;        ///< greatest difference in a channel that counts as one colour
};

/// The line with the least sum of squared differences from the mean colours of both sides, among lines along `texture`
/// coordinates, in some fixed directions, and across the direction of change. None if no line separates the samples. If
/// colours change evenly in one direction, the line is a border of the fewest bands of one colour each.
[[nodiscard]] std::optional<ScreenLine> best_cut(const ColorPiece& piece, std::span<const TexcoordLines> texture);

}  // namespace frontmost::shading
