// SPDX-License-Identifier: Apache-2.0
// Positions of triangles relative to the viewing volume, in doubles: distances from its six planes, and clipping.
#pragma once

#include <array>
#include <span>

#include "frontmost/view.h"

namespace frontmost::why_detail {

/// Coordinates right, up and ahead of the eye.
using PointAhead = glm::dvec3;

/// The planes of the viewing volume, used as bits. The sides come before near and far.
enum Plane : std::uint8_t { kLeft, kRight, kAbove, kBelow, kNear, kFar, kPlaneCount };

/// Distances from the planes, positive inside, linear over space.
using PlaneDistances = std::array<double, kPlaneCount>;

struct FrustumPoint {
  PointAhead at;
  PlaneDistances inside;
};

/// A convex polygon, at most a triangle cut by six planes.
struct FrustumPolygon {
  std::array<FrustumPoint, 3 + kPlaneCount> corners;
  std::size_t count = 0;

  [[nodiscard]] std::span<const FrustumPoint> all() const { return std::span(corners).first(count); }
  [[nodiscard]] bool is_outside(Plane plane) const;
  /// Cuts off the part outside a plane.
  void cut(Plane plane);
};

class Frustum {
 public:
  explicit Frustum(const View& view);

  [[nodiscard]] bool is_orthographic() const { return projection_.orthographic; }
  /// Whether a box surely lies inside all planes.
  [[nodiscard]] bool surely_holds(const Box& box) const;
  [[nodiscard]] FrustumPoint see(const glm::vec3& world) const;
  /// The position in pixels from the picture's top left corner. Precondition: the point is in front of the eye.
  [[nodiscard]] glm::dvec2 pixel_of(const PointAhead& p) const;
  /// Winding of a triangle on the screen, even if parts lie behind the eye: positive if its front is seen, 0 if it is
  /// edge-on.
  [[nodiscard]] double facing(const PointAhead& a, const PointAhead& b, const PointAhead& c) const;

 private:
  glm::dvec3 eye_, right_, up_, forward_;
  Projection projection_;
  double pixels_across_, pixels_down_;  ///< pixels per unit of the projection's rectangle
};

}  // namespace frontmost::why_detail
