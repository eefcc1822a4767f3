// SPDX-License-Identifier: Apache-2.0
#include "report/faces/measures.h"

#include <cmath>

namespace frontmost::faces_detail {

AreaRule::AreaRule(const View& view)
    : orthographic_(view.projection.orthographic),
      left_(view.projection.left),
      top_(view.projection.top),
      step_x_((view.projection.right - view.projection.left) / view.width),
      step_y_((view.projection.top - view.projection.bottom) / view.height) {}

Areas AreaRule::areas_of(std::span<const ScreenPoint> polygon) const {
  // The polygon is a fan about its first corner. The determinant of three directions equals that of two differences in
  // the image plane, so small triangles lose nothing to rounding. (A. van Oosterom, J. Strackee. The Solid Angle of a
  // Plane Triangle. 1983.)
  const glm::dvec3 a = direction_to(polygon[0]), at = place_of(a, polygon[0].key);
  const double a_length = glm::length(a);
  glm::dvec3 b = direction_to(polygon[1]), to_b = place_of(b, polygon[1].key) - at, normal(0);
  double b_length = glm::length(b), doubled = 0, solid_angle = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const glm::dvec3 c = direction_to(polygon[i]), to_c = place_of(c, polygon[i].key) - at;
    const double c_length = glm::length(c);
    const double part = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    doubled += part;
    normal += glm::cross(to_b, to_c);
    if (!orthographic_)
      solid_angle += 2 * angle_of(a_length * b_length * c_length + glm::dot(a, b) * c_length +
                                      glm::dot(b, c) * a_length + glm::dot(c, a) * b_length,
                                  std::abs(part));
    b = c;
    to_b = to_c;
    b_length = c_length;
  }
  return {0.5 * std::abs(doubled) / (step_x_ * step_y_), 0.5 * glm::length(normal), solid_angle};
}

double angle_of(double x, double y) {
  // The angle is halved, by its tangent, until the series of the arctangent is short.
  double t = y, times = 1;
  if (x > 0 && y < 0.05 * x) {
    t = y / x;
  } else {
    t = y / (x + std::sqrt(x * x + y * y));
    for (times = 2; t >= 0.05; times *= 2) t /= 1 + std::sqrt(1 + t * t);
  }
  const double s = t * t;
  double sum = 0;
  for (int n = 13; n > 0; n -= 2) sum = 1.0 / n - s * sum;
  return times * t * sum;
}

}  // namespace frontmost::faces_detail
