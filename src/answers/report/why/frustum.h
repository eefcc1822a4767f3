// SPDX-License-Identifier: Apache-2.0
// Where triangles are beside the viewing volume, in doubles: distances from its six planes, and what is left between
// them.
#pragma once

#include <array>
#include <span>

#include "frontmost/view.h"

namespace frontmost::why_detail {

/// Right, up and ahead of the eye.
using PointAhead = glm::dvec3;

/// Bits of what a point lies outside of. The sides come before near and far.
enum Plane : std::uint8_t { kLeft, kRight, kAbove, kBelow, kNear, kFar, kPlaneCount };

/// Distances from the planes, positive inside; linear over space.
using PlaneDistances = std::array<double, kPlaneCount>;

struct FrustumPoint {
  PointAhead at;
  PlaneDistances inside;
};

/// Corners of a convex polygon; of a triangle cut by six planes at most.
struct FrustumPolygon {
  std::array<FrustumPoint, 3 + kPlaneCount> corners;
  std::size_t count = 0;

  [[nodiscard]] std::span<const FrustumPoint> all() const { return std::span(corners).first(count); }
  [[nodiscard]] bool is_outside(Plane plane) const;
  /// Takes away what lies outside of a plane.
  void cut(Plane plane);
};

class Frustum {
 public:
  explicit Frustum(const View& view);

  [[nodiscard]] bool is_orthographic() const { return projection_.orthographic; }
  /// Whether everything within a box is inside of all planes, beyond doubt.
  [[nodiscard]] bool surely_holds(const Box& box) const;
  [[nodiscard]] FrustumPoint see(const glm::vec3& world) const;
  /// In pixels from the picture's top left corner. Precondition: before the eye.
  [[nodiscard]] glm::dvec2 pixel_of(const PointAhead& p) const;
  /// Which way a triangle is wound on the screen, whichever part of it is before the eye: positive for its front, 0
  /// where it is seen edge on.
  [[nodiscard]] double facing(const PointAhead& a, const PointAhead& b, const PointAhead& c) const;

 private:
  glm::dvec3 eye_, right_, up_, forward_;
  Projection projection_;
  double pixels_across_, pixels_down_;  ///< for a unit of the projection's rectangle
};

}  // namespace frontmost::why_detail
