// SPDX-License-Identifier: Apache-2.0
// With n the normal and a a corner, a ray o + d v meets the plane at d = n.(a - o) / n.v.
#include "report/exact_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "view/screen_transform.h"

namespace frontmost {

SampleRays::SampleRays(const View& view)
    : orthographic_(view.projection.orthographic),
      eye_(view.eye()),
      forward_(view.forward()),
      right_(view.right()),
      up_(view.up()),
      left_(view.projection.left),
      top_(view.projection.top),
      step_x_((view.projection.right - view.projection.left) / view.width),
      step_y_((view.projection.top - view.projection.bottom) / view.height) {
  const ScreenTransform t(view);
  near_ = double(t.near);
  far_ = double(t.far);
  const double guard = double(kGuardBand) / kSubPixels;
  widest_ =
      glm::length(glm::dvec3((guard + 0.5 * view.width) * step_x_ + std::abs(left_ + 0.5 * view.width * step_x_),
                             (guard + 0.5 * view.height) * step_y_ + std::abs(top_ - 0.5 * view.height * step_y_), 1));
}

SampleRay SampleRays::at(int x, int y, const glm::ivec2& offset) const {
  const double along = left_ + (x + offset.x / 256.0) * step_x_, upwards = top_ - (y + offset.y / 256.0) * step_y_;
  const glm::dvec3 aside = along * right_ + upwards * up_;
  if (orthographic_) return {eye_ + aside, forward_};
  return {eye_, forward_ + aside};
}

BoundedPlane::BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays) : corner_(corners[0]) {
  const glm::dvec3 ab = glm::dvec3(corners[1]) - corner_, ac = glm::dvec3(corners[2]) - corner_;
  normal_ = BoundedNormal(ab, ac);
  double low = std::numeric_limits<double>::infinity(), high = -low, error = 0;
  for (const glm::vec3& corner : corners) {
    const Bounded depth = bounded_dot(rays.forward(), glm::dvec3(0), glm::dvec3(corner) - rays.eye());
    low = std::min(low, depth.value);
    high = std::max(high, depth.value);
    error = std::max(error, depth.error);
  }
  const auto within = [&](double depth) { return std::min(std::max(depth, rays.near()), rays.far()); };
  limits_low_ = {within(low - error), within(low + error)};
  limits_high_ = {within(high - error), within(high + error)};
}

bool BoundedPlane::find_depth(const SampleRay& ray, DepthBounds& bounds) const {
  const Bounded above = bounded_dot(normal_.value, normal_.error, corner_ - ray.origin);
  const Bounded below = bounded_dot(normal_.value, normal_.error, ray.direction);
  // If the plane is seen nearly edge-on, or contains the eye, only the corners' range is known. The test is written so
  // that NaN fails it.
  if (!(std::abs(below.value) > 4 * below.error)) return false;
  const double depth = above.value / below.value;
  const double error = (above.error + std::abs(depth) * below.error) / (std::abs(below.value) - below.error) +
                       kRounding * std::abs(depth);
  bounds = {depth - error, depth + error};
  return true;
}

DepthBounds BoundedPlane::at(const SampleRay& ray) const {
  DepthBounds bounds{limits_low_.low, limits_high_.high};
  if (!find_depth(ray, bounds)) return bounds;
  bounds.low = std::min(std::max(bounds.low, limits_low_.low), limits_high_.low);
  bounds.high = std::min(std::max(bounds.high, limits_low_.high), limits_high_.high);
  return bounds;
}

bool share_a_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  const auto has_area = [](const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 from(corners[0]);
    const BoundedNormal normal(glm::dvec3(corners[1]) - from, glm::dvec3(corners[2]) - from);
    const glm::dvec3 sure = glm::abs(normal.value) - normal.error;
    return sure.x > 0 || sure.y > 0 || sure.z > 0;
  };
  const glm::dvec3 origin(a[0]);
  return has_area(a) && has_area(b) && std::all_of(b.begin(), b.end(), [&](const glm::vec3& corner) {
           return sign_of_determinant({glm::dvec3(a[1]), origin}, {glm::dvec3(a[2]), origin},
                                      {glm::dvec3(corner), origin}) == 0;
         });
}

bool has_one_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays) {
  const auto is_level = [&](const glm::vec3& corner) {
    const Bounded step = bounded_dot(rays.forward(), glm::dvec3(0), glm::dvec3(corner) - glm::dvec3(corners[0]));
    if (std::abs(step.value) > 2 * step.error) return false;
    return dot(exact(rays.forward()), difference(glm::dvec3(corner), glm::dvec3(corners[0]))).sign() == 0;
  };
  return is_level(corners[1]) && is_level(corners[2]);
}

ExactDepth::ExactDepth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays, const SampleRay& ray) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const ExactVector normal = cross(difference(b, a), difference(c, a));
  numerator_ = dot(normal, difference(a, ray.origin));
  denominator_ = dot(normal, exact(ray.direction));
  // The denominator is made positive, since fractions are compared by multiplying both sides.
  if (denominator_.sign() < 0) {
    numerator_ = -numerator_;
    denominator_ = -denominator_;
  }
  if (denominator_.sign() == 0) {
    // Edge-on: the ray lies in the plane or misses it. The depth of the nearest corner is used.
    numerator_ = Expansion(-std::numeric_limits<float>::max());
    denominator_ = Expansion(1);
  }
  // Limits the depth to the corners' range, by the same rule as the bounds above; otherwise both would disagree about
  // slivers.
  Expansion nearest, farthest;
  for (int i = 0; i < 3; ++i) {
    const Expansion depth = dot(exact(rays.forward()), difference(glm::dvec3(corners[std::size_t(i)]), rays.eye()));
    if (i == 0 || (depth - nearest).sign() < 0) nearest = depth;
    if (i == 0 || (depth - farthest).sign() > 0) farthest = depth;
  }
  limit(nearest, 1);
  limit(farthest, -1);
  limit(Expansion(rays.near()), 1);
  limit(Expansion(rays.far()), -1);
}

/// Limits the depth from below (side 1) or from above (side -1).
void ExactDepth::limit(const Expansion& bound, int side) {
  if ((bound * denominator_ - numerator_).sign() != side) return;
  numerator_ = bound;
  denominator_ = Expansion(1);
}

}  // namespace frontmost
