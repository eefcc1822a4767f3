// SPDX-License-Identifier: Apache-2.0
// The viewing rays of a picture, and where each meets the plane of a triangle.
//
// The start and the direction of a ray are affine in the screen position. The barycentric weights of the point that the
// ray meets are, up to a common factor, volumes that the ray spans with two vertices each: triple products, and so
// affine as well. They are valid for triangles that cross the eye plane, and their ratios are perspective-correct
// without a division by a depth of 0.
#pragma once

#include <array>

#include "frontmost/view.h"

namespace frontmost {

/// The start and the direction of the ray through a point on the screen, in world axes.
class ScreenRays {
 public:
  explicit ScreenRays(const View& view);

  [[nodiscard]] bool is_parallel() const { return parallel_; }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
  /// Perspective: the direction of the ray through (x, y), not normalised; its component along the viewing axis is 1.
  /// Parallel projection: the start of the ray, relative to the eye.
  [[nodiscard]] glm::dvec3 at(double x, double y) const { return corner_ + x * step_x_ + y * step_y_; }
  [[nodiscard]] const glm::dvec3& step_x() const { return step_x_; }
  [[nodiscard]] const glm::dvec3& step_y() const { return step_y_; }

  /// The point seen at (x, y) at a planar depth, relative to the eye.
  [[nodiscard]] glm::dvec3 point(double x, double y, double depth) const {
    return parallel_ ? at(x, y) + depth * forward_ : depth * at(x, y);
  }

 private:
  bool parallel_;
  glm::dvec3 eye_, forward_;
  glm::dvec3 corner_;  ///< at() at the screen's origin
  glm::dvec3 step_x_, step_y_;
};

inline ScreenRays::ScreenRays(const View& view)
    : parallel_(view.projection.orthographic), eye_(view.eye()), forward_(view.forward()) {
  const Projection& p = view.projection;
  corner_ = p.left * view.right() + p.top * view.up() + (parallel_ ? glm::dvec3(0) : forward_);
  step_x_ = (p.right - p.left) / view.width * view.right();
  step_y_ = (p.bottom - p.top) / view.height * view.up();
}

/// For each vertex, the volume spanned by the ray and the other two vertices at some screen position, and its change
/// per pixel.
struct RayVolumes {
  glm::dvec3 value, step_x, step_y;
};

/// The volumes at screen position (x, y), in pixels, of a triangle with vertices in world axes relative to the eye: six
/// times the volumes that the ray spans with the sides. In perspective the ray's direction changes from pixel to pixel;
/// in parallel projection its start does.
///
///           a
///          /.\           The ray d from the eye meets the triangle a b c at weights in the ratio of
///         / d \          d . (b x c)  :  d . (c x a)  :  d . (a x b)
///        b-----c
[[nodiscard]] inline RayVolumes ray_volumes(const ScreenRays& rays, const std::array<glm::dvec3, 3>& corners, double x,
                                            double y) {
  const glm::dvec3 ray = rays.at(x, y);
  RayVolumes v{};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = corners[std::size_t((k + 1) % 3)], &q = corners[std::size_t((k + 2) % 3)];
    // In parallel projection the ray's start moves, which changes the product by the area that the start sweeps along
    // the side from p to q.
    const glm::dvec3 side = rays.is_parallel() ? glm::cross(rays.forward(), q - p) : glm::cross(p, q);
    v.value[k] = rays.is_parallel() ? glm::dot(glm::cross(p - ray, q - ray), rays.forward()) : glm::dot(side, ray);
    v.step_x[k] = glm::dot(side, rays.step_x());
    v.step_y[k] = glm::dot(side, rays.step_y());
  }
  return v;
}

}  // namespace frontmost
