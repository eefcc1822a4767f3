// SPDX-License-Identifier: Apache-2.0
// With o the origin of a ray along v: the ray meets a triangle abc if the determinants (a-o, b-o, v), (b-o, c-o, v) and
// (c-o, a-o, v) have the sign of (a-o, b-o, c-o), or, in parallel projection, of (b-a, c-a, v). The signs also imply
// that the ray's line is met in front of the eye and not behind.
#include "report/sample_square.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontmost {
namespace {

// 1/128 pixel, in units of 1/256 pixel.
constexpr int kMargin = 2;
// Sums of float roundings. Key: 16 of the interpolation (triangle_keys.h), 2 of the corners' keys, and 2 to spare.
// Distance of a corner from the eye: 6, since its depth is a sum of coordinates.
constexpr double kKeyRounding = 20 * 0x1p-24, kDistanceRounding = 6 * 0x1p-24;

}  // namespace

SampleSquare::SampleSquare(const SampleRays& rays, int x, int y, const glm::ivec2& offset)
    : corners{rays.at(x, y, offset + glm::ivec2(-kMargin, -kMargin)),
              rays.at(x, y, offset + glm::ivec2(kMargin, -kMargin)), rays.at(x, y, offset + glm::ivec2(kMargin)),
              rays.at(x, y, offset + glm::ivec2(-kMargin, kMargin))} {}

SampleSquare::SampleSquare(const SampleRays& rays, const glm::ivec2& low, const glm::ivec2& high)
    : corners{rays.at(low.x, low.y, glm::ivec2(-kMargin)), rays.at(high.x + 1, low.y, glm::ivec2(kMargin, -kMargin)),
              rays.at(high.x + 1, high.y + 1, glm::ivec2(kMargin)),
              rays.at(low.x, high.y + 1, glm::ivec2(-kMargin, kMargin))} {}

double ViewedTriangle::of_depth(double depth) const {
  const double cut = std::min(std::max(depth, rays_->near()), rays_->far());
  return rays_->is_orthographic() ? -cut : 1 / cut;
}

ViewedTriangle::ViewedTriangle(const std::array<glm::vec3, 3>& corners, const SampleRays& rays)
    : corners_{glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])},
      rays_(&rays),
      normal_(corners_[1] - corners_[0], corners_[2] - corners_[0]) {
  double low = std::numeric_limits<double>::infinity(), high = -low, error = 0, reach = 0, spread = 1;
  for (const glm::dvec3& corner : corners_) {
    const Bounded depth = bounded_dot(rays.forward(), glm::dvec3(0), corner - rays.eye());
    low = std::min(low, depth.value);
    high = std::max(high, depth.value);
    error = std::max(error, depth.error);
    const double from_eye = glm::distance(corner, rays.eye());
    reach = std::max(reach, from_eye);
    // Points that are nearer than near, or farther aside than the guard band, are clipped in doubles.
    if (depth.value >= rays.near()) spread = std::max(spread, std::min(from_eye / depth.value, rays.widest()));
  }
  depths_near_ = {low - error, low + error};
  depths_far_ = {high - error, high + error};
  const auto widened = [](double a, double b) {
    return DepthBounds{a - kRounding * std::abs(a), b + kRounding * std::abs(b)};
  };
  limits_least_ = widened(of_depth(depths_far_.high), of_depth(depths_far_.low));
  limits_greatest_ = widened(of_depth(depths_near_.high), of_depth(depths_near_.low));
  if (rays.is_orthographic())
    absolute_ = kKeyRounding * (rays.far() - rays.near()) + kDistanceRounding * reach;
  else
    relative_ = kKeyRounding + kDistanceRounding * spread;
  const Leg ab{corners_[1], corners_[0]}, ac{corners_[2], corners_[0]};
  facing_ = sign_of_determinant(ab, ac, rays.is_orthographic() ? Leg{rays.forward()} : Leg{corners_[0], rays.eye()});
}

int ViewedTriangle::edge_side(std::size_t edge, const SampleRay& ray) const {
  return sign_of_determinant({corners_[edge], ray.origin}, {corners_[(edge + 1) % 3], ray.origin}, {ray.direction});
}

bool ViewedTriangle::is_inside(const SampleRay& ray) const {
  if (facing_ == 0) return false;
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (edge_side(edge, ray) != facing_) return false;
  return true;
}

/// Whether a plane separates triangle and square. Planes through the eye and a side of either are tested; two convex
/// figures in front of the eye that do not meet always have such a plane. Some triangles that reach behind the eye and
/// miss the square are not separated, and count as touching.
bool ViewedTriangle::is_separated(const SampleSquare& square) const {
  for (std::size_t edge = 0; edge < 3; ++edge) {
    std::array<int, 4> sides;
    for (std::size_t i = 0; i < 4; ++i) sides[i] = edge_side(edge, square.corners[i]);
    const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
    // A triangle that is seen edge-on lies on neither side.
    if (facing_ >= 0 && *most < 0) return true;
    if (facing_ <= 0 && *least > 0) return true;
  }
  for (std::size_t side = 0; side < 4; ++side) {
    const SampleRay &a = square.corners[side], &b = square.corners[(side + 1) % 4], &c = square.corners[(side + 2) % 4];
    const bool parallel = rays_->is_orthographic();
    const Leg first = parallel ? Leg{b.origin, a.origin} : Leg{a.direction};
    const Leg second = parallel ? Leg{a.direction} : Leg{b.direction};
    const int inner = sign_of_determinant(first, second, parallel ? Leg{c.origin, a.origin} : Leg{c.direction});
    bool all_outside = true;
    for (const glm::dvec3& corner : corners_)
      all_outside = all_outside && sign_of_determinant(first, second, {corner, a.origin}) == -inner;
    if (all_outside) return true;
  }
  return false;
}

/// How the part of a triangle between near and far meets the square, for a triangle that contains the square. Methods
/// clip in floats, so either answer may be right within their rounding of a plane.
LineMeeting ViewedTriangle::between_planes(const SampleSquare& square) const {
  const double rim = kKeyRounding;
  if (depths_near_.low > rays_->near() * (1 + rim) && depths_far_.high < rays_->far() * (1 - rim))
    return LineMeeting::contains;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const SampleRay& ray : square.corners) {
    const double across = glm::dot(normal_.value, ray.direction),
                 along = glm::dot(normal_.value, corners_[0] - ray.origin);
    const double nearness = rays_->is_orthographic() ? -along / across : across / along;
    least = std::min(least, nearness);
    most = std::max(most, nearness);
  }
  const double nearest = of_depth(rays_->near()), farthest = of_depth(rays_->far());
  const double at_near = resolution(nearest), at_far = resolution(farthest);
  if (most < farthest - at_far || least > nearest + at_near) return LineMeeting::misses;
  return most < nearest - at_near && least > farthest + at_far ? LineMeeting::contains : LineMeeting::touches;
}

LineMeeting ViewedTriangle::meeting(const SampleSquare& square) const {
  if (is_separated(square)) return LineMeeting::misses;
  const LineMeeting by_planes = between_planes(square);
  if (by_planes != LineMeeting::contains) return by_planes;
  for (const SampleRay& ray : square.corners)
    if (!is_inside(ray)) return LineMeeting::touches;
  return LineMeeting::contains;
}

DepthBounds ViewedTriangle::nearness_at(const SampleRay& ray) const {
  const Bounded along = bounded_dot(normal_.value, normal_.error, corners_[0] - ray.origin);
  const Bounded across = bounded_dot(normal_.value, normal_.error, ray.direction);
  const Bounded& below = rays_->is_orthographic() ? across : along;
  const Bounded& above = rays_->is_orthographic() ? along : across;
  // Taken if the plane contains the eye, as far as doubles can tell. The test is written so that NaN passes it.
  if (!(std::abs(below.value) > 4 * below.error)) return {limits_least_.low, limits_greatest_.high};
  const double value = (rays_->is_orthographic() ? -above.value : above.value) / below.value;
  const double error = (above.error + std::abs(value) * below.error) / (std::abs(below.value) - below.error) +
                       kRounding * std::abs(value);
  return {std::min(std::max(value - error, limits_least_.low), limits_greatest_.low),
          std::min(std::max(value + error, limits_least_.high), limits_greatest_.high)};
}

NearnessRange ViewedTriangle::nearness(const SampleSquare& square) const {
  NearnessRange range{nearness_at(square.corners[0]), {}};
  range.greatest = range.least;
  for (std::size_t i = 1; i < 4; ++i) {
    const DepthBounds here = nearness_at(square.corners[i]);
    range.least = {std::min(range.least.low, here.low), std::min(range.least.high, here.high)};
    range.greatest = {std::max(range.greatest.low, here.low), std::max(range.greatest.high, here.high)};
  }
  return range;
}

/// The nearness of the nearest (extreme 1) or farthest (-1) corner, limited to that of the near and far planes.
Fraction ViewedTriangle::exact_limit(int extreme) const {
  Expansion depth;
  for (std::size_t i = 0; i < 3; ++i) {
    const Expansion here = dot(exact(rays_->forward()), difference(corners_[i], rays_->eye()));
    if (i == 0 || (depth - here).sign() == extreme) depth = here;
  }
  const Expansion near(rays_->near()), far(rays_->far());
  if ((depth - near).sign() < 0) depth = near;
  if ((depth - far).sign() > 0) depth = far;
  return rays_->is_orthographic() ? Fraction{-depth, Expansion(1)} : Fraction{Expansion(1), depth};
}

Fraction ViewedTriangle::exact_nearness(const SampleRay& ray, int extreme) const {
  const ExactVector normal = cross(difference(corners_[1], corners_[0]), difference(corners_[2], corners_[0]));
  const Expansion along = dot(normal, difference(corners_[0], ray.origin)), across = dot(normal, exact(ray.direction));
  Fraction value = rays_->is_orthographic() ? Fraction{-along, across} : Fraction{across, along};
  if (value.denominator.sign() == 0) return exact_limit(extreme);
  if (value.denominator.sign() < 0) value = {-value.numerator, -value.denominator};
  return value;
}

Fraction ViewedTriangle::exact_extreme(const ViewedTriangle& triangle, const SampleSquare& square, int extreme) {
  Fraction best = triangle.exact_nearness(square.corners[0], extreme);
  for (std::size_t i = 1; i < 4; ++i) {
    const Fraction here = triangle.exact_nearness(square.corners[i], extreme);
    if (here.compare(best) == extreme) best = here;
  }
  const Fraction least = triangle.exact_limit(-1), greatest = triangle.exact_limit(1);
  if (best.compare(least) < 0) return least;
  return best.compare(greatest) > 0 ? greatest : best;
}

bool ViewedTriangle::exactly_nearer(const ViewedTriangle& a, const ViewedTriangle& b, const SampleSquare& square) {
  const Fraction least = exact_extreme(a, square, -1), greatest = exact_extreme(b, square, 1);
  // Equals greatest + resolution; both terms of the resolution are doubles by definition.
  const double relative = std::max(a.relative_, b.relative_), absolute = std::max(a.absolute_, b.absolute_);
  const Fraction reach{greatest.numerator * Expansion(1 + relative) + Expansion(absolute) * greatest.denominator,
                       greatest.denominator};
  return least.compare(reach) > 0;
}

bool is_surely_nearer(const ViewedTriangle& a, const ViewedTriangle& b, const SampleSquare& square) {
  const DepthBounds least = a.nearness(square).least, greatest = b.nearness(square).greatest;
  const double resolution = std::max(a.resolution(greatest.high), b.resolution(greatest.high));
  const double rounding = kRounding * (std::abs(greatest.high) + resolution);
  if (least.low > greatest.high + resolution + rounding) return true;
  if (least.high < greatest.low + resolution - rounding) return false;
  return ViewedTriangle::exactly_nearer(a, b, square);
}

}  // namespace frontmost
