// SPDX-License-Identifier: Apache-2.0
// How a triangle meets the square of +-1/128 pixel around a sample, and how near the triangle is there. Doubles with
// bounds decide nearly everywhere; expansions decide the rest.
//
//       +-----------+            misses     no ray of the square meets the triangle
//       |        /  |            touches    some rays do: methods that place corners slightly differently may disagree
//       |   x   /   |            contains   all rays do: the sample is covered wherever a method places the corners
//       |      /    |
//       +-----/-----+
#pragma once

#include <cmath>

#include "report/exact_depth.h"

namespace frontmost {

/// The square as the rays through its corners, in order around the square.
struct SampleSquare {
  std::array<SampleRay, 4> corners;
  SampleSquare(const SampleRays& rays, int x, int y, const glm::ivec2& offset);
  /// A rectangle that holds the squares of all samples of pixels from `low` to `high`.
  SampleSquare(const SampleRays& rays, const glm::ivec2& low, const glm::ivec2& high);
};

enum class LineMeeting : std::uint8_t { misses, touches, contains };

/// Bounds of the least and of the greatest nearness over a square. Nearness grows as depth shrinks and is affine over
/// the screen: 1 / depth in perspective, -depth in parallel projection.
struct NearnessRange {
  DepthBounds least, greatest;
};

/// A triangle with finite corners in its view. Borrows the rays.
class ViewedTriangle {
 public:
  ViewedTriangle(const std::array<glm::vec3, 3>& corners, const SampleRays& rays);

  [[nodiscard]] LineMeeting meeting(const SampleSquare& square) const;
  /// The nearness of the triangle's plane over the square, limited to the nearness of the triangle's corners and of the
  /// near and far planes. Snapping moves the visible part by less than the width of the square, however thin the
  /// triangle is, so every key of the triangle lies in this range.
  [[nodiscard]] NearnessRange nearness(const SampleSquare& square) const;
  /// Greatest error of a key of this triangle, as a difference of nearness.
  [[nodiscard]] double resolution(double nearness) const { return relative_ * std::abs(nearness) + absolute_; }
  /// The side that is seen: -1 front (counter-clockwise), 1 back, 0 edge-on.
  [[nodiscard]] int facing() const { return facing_; }

  /// Whether the least nearness of `a` exceeds the greatest nearness of `b` by more than the resolution of either;
  /// exact.
  friend bool is_surely_nearer(const ViewedTriangle& a, const ViewedTriangle& b, const SampleSquare& square);

 private:
  [[nodiscard]] bool is_separated(const SampleSquare& square) const;
  [[nodiscard]] bool is_inside(const SampleRay& ray) const;
  [[nodiscard]] int edge_side(std::size_t edge, const SampleRay& ray) const;
  [[nodiscard]] LineMeeting between_planes(const SampleSquare& square) const;
  [[nodiscard]] Fraction exact_nearness(const SampleRay& ray, int extreme) const;
  [[nodiscard]] Fraction exact_limit(int extreme) const;
  [[nodiscard]] static Fraction exact_extreme(const ViewedTriangle& triangle, const SampleSquare& square, int extreme);
  [[nodiscard]] static bool exactly_nearer(const ViewedTriangle& a, const ViewedTriangle& b,
                                           const SampleSquare& square);
  [[nodiscard]] double of_depth(double depth) const;
  [[nodiscard]] DepthBounds nearness_at(const SampleRay& ray) const;

  std::array<glm::dvec3, 3> corners_;
  const SampleRays* rays_;
  BoundedNormal normal_;
  DepthBounds depths_near_, depths_far_;  // depths of the nearest and of the farthest corner, before the planes cut
  DepthBounds limits_least_, limits_greatest_;  // nearness of these corners, limited to that of the planes
  double relative_ = 0, absolute_ = 0;          // terms of resolution()
  int facing_;
};

}  // namespace frontmost
