// SPDX-License-Identifier: Apache-2.0
// Circles and cylinders in space, and fits of these to points.
//
//          axis                  A tube is the set of all points at one distance from an axis. outwards(p) leads from
//           |     p              the axis to p at a right angle; its length less the radius is p's distance from the
//           |--->.               tube.
//           |  outwards
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace frontmost::lines_detail {

struct Circle3 {
  glm::dvec3 centre, axis;  ///< unit axis; seen from its tip, the circle runs anticlockwise
  double radius;

  /// The angle from one point to the next around the axis, in (-pi, pi].
  [[nodiscard]] double turn_between(const glm::dvec3& a, const glm::dvec3& b) const {
    const glm::dvec3 u = a - centre, v = b - centre;
    return std::atan2(glm::dot(axis, glm::cross(u, v)), glm::dot(u, v) - glm::dot(u, axis) * glm::dot(v, axis));
  }
  /// The approximate distance of a point: the greater of its distances from the plane and from the radius.
  [[nodiscard]] double distance(const glm::dvec3& point) const {
    const glm::dvec3 u = point - centre;
    const double height = glm::dot(u, axis);
    return std::max(std::abs(height), std::abs(glm::length(u - height * axis) - radius));
  }
};

[[nodiscard]] inline std::optional<Circle3> circle_through(const glm::dvec3& a, const glm::dvec3& b,
                                                           const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, normal = glm::cross(u, v);
  const double square = glm::dot(normal, normal);
  if (!(square > 0) || !std::isfinite(square)) return std::nullopt;
  const glm::dvec3 to_centre = glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) / (2 * square);
  const double radius = glm::length(to_centre);
  if (!std::isfinite(radius)) return std::nullopt;
  return Circle3{a + to_centre, normal / std::sqrt(square), radius};
}

/// The distance between the middle of a chord and its circle.
[[nodiscard]] inline double sagitta(double radius, double step) { return radius * (1 - std::cos(step / 2)); }

/// A cylinder without ends.
struct Tube {
  glm::dvec3 point, axis;  ///< `point` is on the axis; the axis has unit length
  double radius;

  /// The vector from the axis to the point, at a right angle.
  [[nodiscard]] glm::dvec3 outwards(const glm::dvec3& at) const {
    const glm::dvec3 u = at - point;
    return u - glm::dot(u, axis) * axis;
  }
  [[nodiscard]] double distance(const glm::dvec3& at) const { return std::abs(glm::length(outwards(at)) - radius); }
};

/// Two unit vectors across a third.
struct Across {
  glm::dvec3 u, v;
  explicit Across(const glm::dvec3& axis);
};

/// The tube about this axis that fits the points by least squares of squared radii (I. Kasa's fit of circles). None if
/// the points lie on a line.
[[nodiscard]] std::optional<Tube> tube_through(std::span<const glm::dvec3> points, const glm::dvec3& axis);

/// The direction that is closest to perpendicular to all vectors.
[[nodiscard]] glm::dvec3 common_perpendicular(std::span<const glm::dvec3> vectors);

}  // namespace frontmost::lines_detail
