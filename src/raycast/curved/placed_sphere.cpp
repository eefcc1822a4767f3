// SPDX-License-Identifier: Apache-2.0
// Rays against ellipsoids: in the space where they are the unit sphere, which keeps t as it is.
//
// E. Haines, J. Guenther, T. Akenine-Moeller. Precision Improvements for Ray/Sphere Intersection. Ray Tracing Gems,
// chapter 7, 2019.
#include <cmath>

#include "raycast/curved/placed_curves.h"

namespace frontmost::raycast_detail {
namespace {

constexpr double kTurn = 6.283185307179586477;

/// What squares of products stay finite of. Not NaN.
bool is_moderate(const glm::dvec3& v) {
  constexpr double kModerate = 0x1p250;
  return std::abs(v.x) <= kModerate && std::abs(v.y) <= kModerate && std::abs(v.z) <= kModerate;
}

/// Of a point of the unit sphere, as Sphere says.
glm::dvec2 parameters_of(const glm::dvec3& p) {
  const double around = std::atan2(-p.z, p.x) / kTurn;
  const double down = std::atan2(std::sqrt(p.x * p.x + p.z * p.z), p.y) / (kTurn / 2);
  return {around < 0 ? around + 1 : around, down};
}

/// Both roots of t^2 - 2 b t + c, less first. The discriminant comes from the line's distance to the centre: b^2 - c
/// would lose it to rounding when the sphere is small and far away.
std::optional<glm::dvec2> roots(const glm::dvec3& origin, const glm::dvec3& direction) {
  const double dd = glm::dot(direction, direction), b = -glm::dot(origin, direction) / dd;
  const glm::dvec3 nearest = origin + b * direction;
  const double discriminant = 1 - glm::dot(nearest, nearest);
  if (!(discriminant >= 0)) return std::nullopt;  // NaN too
  const double half = std::sqrt(discriminant / dd);
  // The root of greater size is a sum without cancellation, and the product of both is c.
  const double large = b < 0 ? b - half : b + half;
  const double small = large == 0 ? 0 : (glm::dot(origin, origin) - 1) / dd / large;
  return glm::dvec2(std::min(small, large), std::max(small, large));
}

}  // namespace

std::optional<PlacedSphere> place(const Sphere& sphere, const glm::dmat4& world_from_mesh, PrimitiveId id) {
  if (!is_finite(sphere.centre) || !(sphere.radius > 0) || !std::isfinite(sphere.radius)) return std::nullopt;
  const glm::dmat3 axes = glm::dmat3(world_from_mesh) * sphere.radius, rows = glm::transpose(axes);
  PlacedSphere placed;
  placed.unit_from_world = glm::inverse(axes);
  placed.centre = glm::dvec3(world_from_mesh * glm::dvec4(sphere.centre, 1));
  placed.reach = {glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])};
  placed.id = id;
  bool usable = is_moderate(placed.centre) && is_moderate(placed.reach);
  for (int k = 0; k < 3; ++k) usable = usable && is_moderate(placed.unit_from_world[k]);
  return usable ? std::optional(placed) : std::nullopt;
}

/// Wider by what a ray may pass the sphere and still count as meeting it.
DoubleBox PlacedSphere::bounds() const {
  const glm::dvec3 pad = (glm::abs(centre) + reach) * 0x1p-44 + reach * 0x1p-30;
  return {centre - reach - pad, centre + reach + pad};
}

std::optional<RayMeeting> meet(const PlacedSphere& sphere, const DoubleRay& ray) {
  const glm::dvec3 origin = sphere.unit_from_world * (ray.origin - sphere.centre);
  const glm::dvec3 direction = sphere.unit_from_world * ray.direction;
  const std::optional<glm::dvec2> both = roots(origin, direction);
  if (!both) return std::nullopt;
  for (const double t : {both->x, both->y}) {
    if (!(t >= ray.from && t <= ray.to)) continue;
    const glm::dvec3 point = origin + t * direction, through_centre = t == both->x ? -direction : direction;
    // From so far away that rounding leaves nothing of the radius, the ray passes through the centre.
    const glm::dvec3 unit = glm::normalize(point == glm::dvec3(0) ? through_centre : point);
    const glm::dvec3 normal = glm::normalize(unit * sphere.unit_from_world);  // by the inverse's transpose
    if (ray.keeps(normal, sphere.is_double_sided)) return RayMeeting{t, parameters_of(unit), normal};
  }
  return std::nullopt;
}

}  // namespace frontmost::raycast_detail
