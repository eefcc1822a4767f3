// SPDX-License-Identifier: Apache-2.0
// Cylinders through points.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace frontmost::lines_detail {

/// A cylinder without ends.
struct Tube {
  glm::dvec3 point, axis;  ///< on its axis; of unit length
  double radius;

  /// From the axis to the point, at a right angle.
  [[nodiscard]] glm::dvec3 outwards(const glm::dvec3& at) const {
    const glm::dvec3 u = at - point;
    return u - glm::dot(u, axis) * axis;
  }
  [[nodiscard]] double distance(const glm::dvec3& at) const { return std::abs(glm::length(outwards(at)) - radius); }
};

/// Two axes across a third, of unit length.
struct Across {
  glm::dvec3 u, v;
  explicit Across(const glm::dvec3& axis);
};

/// The tube of that axis whose distances to the points have the least squares (I. Kasa's fit of circles: of squared
/// radii). None where they lie on a line.
[[nodiscard]] std::optional<Tube> tube_through(std::span<const glm::dvec3> points, const glm::dvec3& axis);

/// The direction that is closest to a right angle with all vectors.
[[nodiscard]] glm::dvec3 common_perpendicular(std::span<const glm::dvec3> vectors);

}  // namespace frontmost::lines_detail
