// SPDX-License-Identifier: Apache-2.0
#include "report/why/frustum.h"

#include <algorithm>
#include <cmath>

namespace frontmost::why_detail {

bool FrustumPolygon::is_outside(Plane plane) const {
  return std::all_of(all().begin(), all().end(), [&](const FrustumPoint& p) { return p.inside[plane] < 0; });
}

void FrustumPolygon::cut(Plane plane) {
  FrustumPolygon kept;
  for (std::size_t i = 0; i < count; ++i) {
    const FrustumPoint &a = corners[i], &b = corners[i + 1 == count ? 0 : i + 1];
    const double from = a.inside[plane], to = b.inside[plane];
    if (from >= 0) kept.corners[kept.count++] = a;
    if ((from < 0) == (to < 0)) continue;
    const double t = from / (from - to);
    FrustumPoint& p = kept.corners[kept.count++];
    p.at = a.at + (b.at - a.at) * t;
    for (std::size_t k = 0; k < kPlaneCount; ++k) p.inside[k] = a.inside[k] + (b.inside[k] - a.inside[k]) * t;
    p.inside[plane] = 0;
  }
  *this = kept;
}

Frustum::Frustum(const View& view)
    : eye_(view.eye()),
      right_(view.right()),
      up_(view.up()),
      forward_(view.forward()),
      projection_(view.projection),
      pixels_across_(view.width / (projection_.right - projection_.left)),
      pixels_down_(view.height / (projection_.top - projection_.bottom)) {}

FrustumPoint Frustum::see(const glm::vec3& world) const {
  const glm::dvec3 p = glm::dvec3(world) - eye_;
  const PointAhead at(glm::dot(right_, p), glm::dot(up_, p), glm::dot(forward_, p));
  const Projection& f = projection_;
  const double unit = f.orthographic ? 1 : at.z;
  // Every point is inside an infinite far plane.
  const double before_far = std::isinf(f.clip.far) ? 1 : f.clip.far - at.z;
  return {at,
          {at.x - f.left * unit, f.right * unit - at.x, f.top * unit - at.y, at.y - f.bottom * unit, at.z - f.clip.near,
           before_far}};
}

bool Frustum::surely_holds(const Box& box) const {
  if (box.is_empty()) return true;
  // Distances are linear, so the corners decide. The rounding of see() is far less than this share of its summands.
  constexpr double kRounding = 1e-12;
  for (int k = 0; k < 8; ++k) {
    const glm::vec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                           k & 4 ? box.high.z : box.low.z);
    const FrustumPoint p = see(corner);
    const glm::dvec3 reach = glm::abs(glm::dvec3(corner)) + glm::abs(eye_);
    const Projection& f = projection_;
    const double across = std::max({std::abs(f.left), std::abs(f.right), std::abs(f.top), std::abs(f.bottom), 1.0});
    const double far = std::isinf(f.clip.far) ? 0 : f.clip.far;
    const double slack = kRounding * ((reach.x + reach.y + reach.z) * (1 + across) + across + f.clip.near + far);
    const bool is_inside = std::all_of(p.inside.begin(), p.inside.end(), [&](double d) { return d > slack; });
    if (!is_inside) return false;
  }
  return true;
}

glm::dvec2 Frustum::pixel_of(const PointAhead& p) const {
  const double unit = projection_.orthographic ? 1 : p.z;
  return {(p.x / unit - projection_.left) * pixels_across_, (projection_.top - p.y / unit) * pixels_down_};
}

double Frustum::facing(const PointAhead& a, const PointAhead& b, const PointAhead& c) const {
  if (projection_.orthographic) return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return glm::dot(a, glm::cross(b, c));
}

}  // namespace frontmost::why_detail
