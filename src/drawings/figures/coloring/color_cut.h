// SPDX-License-Identifier: Apache-2.0
// Which line parts the colours of a piece best.
//
//        +---------+         Samples (x dark, o light) are spread over a piece. One straight line is
//        | x x /o o|         chosen; both sides are looked at again, and cut again where they must be.
//        | x  / o o|         The line is a place in the picture and nothing else: pieces lie in their
//        |x  /o o  |         polygon's place of the order, so a cut never changes what hides what.
//        +---------+
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shade/geometry/triangle_setup.h"

namespace frontmost::shading {

/// What a point of a piece looks like.
struct ColorSample {
  glm::dvec2 at{0};    ///< screen
  glm::vec4 color{0};  ///< 0 to 255 each: sRGB and alpha
};
/// Stands for a hole: further from every colour than any two are from each other.
inline constexpr glm::vec4 hole_color{0, 0, 0, -512};

/// Points with dot(normal, p) = offset; the normal is a unit vector.
struct ScreenLine {
  glm::dvec2 normal{1, 0};
  double offset = 0;
  [[nodiscard]] double distance(const glm::dvec2& p) const { return glm::dot(normal, p) - offset; }
};

/// The lines on the screen along which one coordinate of a texture is the same.
class TexcoordLines {
 public:
  /// `coordinate` of each corner, in texels.
  TexcoordLines(const TriangleSetup& setup, const std::array<double, 3>& coordinate);
  [[nodiscard]] double at(const glm::dvec2& p) const;
  /// None where all of the triangle has the same.
  [[nodiscard]] std::optional<ScreenLine> line(double value) const;

 private:
  /// Of a value that is affine over the screen.
  struct Plane {
    double constant = 0, x = 0, y = 0;
  };
  Plane weight_, weighted_;  ///< the sum of the weights, and of the coordinates times these
};

/// A piece that is to be cut: its convex outline, and what it looks like.
struct ColorPiece {
  std::span<const glm::dvec2> corners;
  /// Many are thinned out to a few hundred.
  std::span<const ColorSample> samples;
  double least_width;  ///< pixels that each side of a cut is to have across it
  double range;        ///< steps of a channel that are one colour
};

/// Chooses among lines along `texture` coordinates, in some fixed directions, and across the way in which the colour
/// changes, the one with the least sum of squared differences from the mean colours of both sides. None where there is
/// none that parts the samples. Where colours change evenly, in one direction, it is a border of the fewest bands that
/// are of one colour each.
[[nodiscard]] std::optional<ScreenLine> best_cut(const ColorPiece& piece, std::span<const TexcoordLines> texture);

}  // namespace frontmost::shading
