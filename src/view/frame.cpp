// SPDX-License-Identifier: Apache-2.0
// Views that show a whole model.

#include <algorithm>
#include <array>
#include <cmath>

#include "frontmost/view.h"

namespace frontmost {
namespace {

/// The model's own axes: up as its format has it; front is what a `front` view looks at.
struct ModelAxes {
  glm::dvec3 right, up, front;  ///< right-handed; front points from the model to the viewer
};

ModelAxes model_axes(Axis up_axis) {
  const glm::dvec3 up = direction(up_axis);
  // Front of a y-up model is +z (glTF), of a z-up model -y (CAD), of an x-up model +z.
  const bool along_z = up_axis == Axis::z || up_axis == Axis::minus_z;
  const glm::dvec3 front = along_z ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  return {glm::cross(up, front), up, front};
}

struct Gaze {
  glm::dvec3 towards_viewer, up;
};

Gaze gaze(NamedView view, const ModelAxes& axes) {
  switch (view) {
    case NamedView::front: return {axes.front, axes.up};
    case NamedView::back: return {-axes.front, axes.up};
    case NamedView::left: return {-axes.right, axes.up};
    case NamedView::right: return {axes.right, axes.up};
    case NamedView::top: return {axes.up, -axes.front};
    case NamedView::bottom: return {-axes.up, axes.front};
    case NamedView::iso: return {axes.right + axes.up + axes.front, axes.up};
    case NamedView::three_quarter: return {0.55 * axes.right + 0.42 * axes.up + axes.front, axes.up};
  }
  return {axes.front, axes.up};
}

std::array<glm::dvec3, 8> corners_of(const Box& box) {
  std::array<glm::dvec3, 8> corners;
  for (int k = 0; k < 8; ++k)
    corners[std::size_t(k)] = {k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                               k & 4 ? box.high.z : box.low.z};
  return corners;
}

Box unit_box() { return {glm::vec3(-0.5f), glm::vec3(0.5f)}; }

/// How far a box reaches from its centre across the picture, and how far back a perspective eye must stand.
struct Extent {
  double half_x = 0, half_y = 0, distance = 0;
};

Extent measure(const Box& box, const glm::dmat4& pose, double spread_x, double spread_y) {
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.low) + glm::dvec3(box.high));
  Extent extent;
  for (const glm::dvec3& corner : corners_of(box)) {
    const glm::dvec3 p = corner - centre;
    const double x = std::abs(glm::dot(p, glm::dvec3(pose[0]))), y = std::abs(glm::dot(p, glm::dvec3(pose[1])));
    const double nearer = glm::dot(p, glm::dvec3(pose[2]));
    extent.half_x = std::max(extent.half_x, x);
    extent.half_y = std::max(extent.half_y, y);
    extent.distance = std::max({extent.distance, x / spread_x + nearer, y / spread_y + nearer});
  }
  return extent;
}

}  // namespace

ClipDistances fit_clip(const Box& bounds, const glm::dmat4& world_from_eye, bool orthographic) {
  const Box box = bounds.is_empty() ? unit_box() : bounds;
  const glm::dvec3 eye(world_from_eye[3]), forward(-glm::dvec3(world_from_eye[2]));
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest, size = 0;
  for (const glm::dvec3& corner : corners_of(box)) {
    const double distance = glm::dot(corner - eye, forward);
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
    size = std::max(size, glm::length(corner - eye));
  }
  // A flat box seen face on has no extent in depth: what is spared is then a part of its distance.
  const double spare = std::max({0.01 * (farthest - nearest), 1e-6 * size, 1e-30});
  ClipDistances clip{nearest - spare, farthest + spare};
  if (orthographic) return clip;
  if (!(clip.far > 0)) clip.far = std::max(size, 1e-30);  // all behind the eye: any valid planes will do
  clip.near = std::max(clip.near, 1e-4 * clip.far);
  if (!(clip.near < clip.far)) clip.near = 0.5 * clip.far;
  return clip;
}

View frame(const Surfaces& surfaces, int width, int height, const FrameOptions& options) {
  if (width < 1 || height < 1) throw Error(ErrorCode::bad_argument, "resolution: width and height must be at least 1");
  if (!(options.margin >= 0 && options.margin < 0.5)) throw Error(ErrorCode::bad_argument, "margin: must be 0 to 0.5");
  const Box box = surfaces.bounds().is_empty() ? unit_box() : surfaces.bounds();
  const Gaze look = gaze(options.direction, model_axes(surfaces.scene().up));
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.low) + glm::dvec3(box.high));
  const glm::dvec3 towards = glm::normalize(look.towards_viewer);
  glm::dmat4 pose = look_at(towards, glm::dvec3(0), look.up);

  const double aspect = double(width) / height, filled = 1 - 2 * options.margin;
  Projection projection = make_projection(options.min_fov, aspect, {});
  const Extent extent = measure(box, pose, projection.right * filled, projection.top * filled);
  const double diagonal = std::max(glm::length(glm::dvec3(box.high) - glm::dvec3(box.low)), 1e-30);
  const double distance = options.orthographic ? diagonal : std::max(extent.distance, 1e-3 * diagonal);
  pose[3] = glm::dvec4(centre + towards * distance, 1.0);

  const ClipDistances clip = fit_clip(box, pose, options.orthographic);
  if (options.orthographic) {
    const double half = std::max({extent.half_y, extent.half_x / aspect, 1e-3 * diagonal}) / filled;
    projection = make_orthographic(-half * aspect, half * aspect, -half, half, clip);
  } else {
    projection.clip = clip;
  }
  View view{width, height, options.samples, pose, projection, options.culling};
  validate(view);
  return view;
}

}  // namespace frontmost
