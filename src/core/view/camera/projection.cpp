// SPDX-License-Identifier: Apache-2.0
// Projections and their matrices.
//
// S. Gortler. Foundations of 3D Computer Graphics. 2012, chapters 10 and 11 (projection, depth).
//
// One formula serves every depth convention: in perspective the normalised depth is (a z_eye + b) / -z_eye, in parallel
// projection -a z_eye + b, with a and b such that near and far map to the convention's two ends.

#include <cmath>
#include <string>

#include "frontmost/view.h"

namespace frontmost {
namespace {

void check_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw Error(ErrorCode::bad_argument, std::string(what), "must be a finite number");
}

void check_clip(const ClipDistances& clip, bool orthographic) {
  check_finite(clip.near, "near");
  if (std::isnan(clip.far)) throw Error(ErrorCode::bad_argument, "far", "must be a number");
  if (!orthographic && !(clip.near > 0))
    throw Error(ErrorCode::bad_argument, "near", "must be greater than 0 in perspective");
  if (orthographic) check_finite(clip.far, "far");
  if (!(clip.far > clip.near)) throw Error(ErrorCode::bad_argument, "far", "must be greater than near");
}

void check_sides(double left, double right, double bottom, double top) {
  check_finite(left, "left");
  check_finite(right, "right");
  check_finite(bottom, "bottom");
  check_finite(top, "top");
  if (!(left < right)) throw Error(ErrorCode::bad_argument, "right", "must be greater than left");
  if (!(bottom < top)) throw Error(ErrorCode::bad_argument, "top", "must be greater than bottom");
}

void check_size(int width, int height) {
  if (width < 1 || height < 1)
    throw Error(ErrorCode::bad_argument, "resolution", "width and height must be at least 1");
}

/// The offset that makes image coordinates count from the top left corner.
double pixel_shift(PixelRule rule) { return rule == PixelRule::centre_at_integer ? 0.5 : 0.0; }

/// Coefficients of the depth row (see the head of the file).
struct DepthRow {
  double a, b;
};

DepthRow depth_row(const Projection& projection, const DepthConvention& depth) {
  const double n = projection.clip.near, f = projection.clip.far;
  if (projection.orthographic) {
    const double a = (depth.at_far - depth.at_near) / (f - n);
    return {a, depth.at_near - a * n};
  }
  // The limit of the last line: n / (f - n) goes to 0, f / (f - n) to 1.
  if (std::isinf(f)) return {-depth.at_far, (depth.at_near - depth.at_far) * n};
  return {(depth.at_near * n - depth.at_far * f) / (f - n), (depth.at_near - depth.at_far) * n * f / (f - n)};
}

}  // namespace

Projection make_projection(double min_fov, double aspect, const ClipDistances& clip) {
  constexpr double kPi = 3.14159265358979323846;
  check_finite(min_fov, "field of view");
  check_finite(aspect, "aspect");
  if (!(min_fov > 0 && min_fov < kPi))
    throw Error(ErrorCode::bad_argument, "field of view", "must be between 0 and 180 degrees");
  if (!(aspect > 0)) throw Error(ErrorCode::bad_argument, "aspect", "must be greater than 0");
  check_clip(clip, false);
  const double side = std::tan(min_fov / 2);
  const double x = aspect > 1 ? side * aspect : side, y = aspect > 1 ? side : side / aspect;
  return {false, -x, x, -y, y, clip};
}

Projection make_frustum(double left, double right, double bottom, double top, const ClipDistances& clip) {
  check_sides(left, right, bottom, top);
  check_clip(clip, false);
  const double n = clip.near;
  return {false, left / n, right / n, bottom / n, top / n, clip};
}

Projection make_orthographic(double left, double right, double bottom, double top, const ClipDistances& clip) {
  check_sides(left, right, bottom, top);
  check_clip(clip, true);
  return {true, left, right, bottom, top, clip};
}

Projection make_projection(const Intrinsics& k, int width, int height, const ClipDistances& clip) {
  for (const double value : {k.fx, k.fy, k.cx, k.cy}) check_finite(value, "intrinsics");
  if (!(k.fx > 0 && k.fy > 0))
    throw Error(ErrorCode::bad_argument, "intrinsics", "focal lengths must be greater than 0");
  check_size(width, height);
  check_clip(clip, false);
  const double cx = k.cx + pixel_shift(k.rule), cy = k.cy + pixel_shift(k.rule);
  return {false, -cx / k.fx, (width - cx) / k.fx, (cy - height) / k.fy, cy / k.fy, clip};
}

Intrinsics intrinsics_of(const Projection& projection, int width, int height, PixelRule rule) {
  if (projection.orthographic) throw Error(ErrorCode::bad_argument, "intrinsics", "a parallel projection has none");
  const double fx = width / (projection.right - projection.left), fy = height / (projection.top - projection.bottom);
  return {fx, fy, -projection.left * fx - pixel_shift(rule), projection.top * fy - pixel_shift(rule), rule};
}

View make_view(const Intrinsics& intrinsics, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.projection = make_projection(intrinsics, width, height, {});
  return view;
}

View make_view(double min_fov, int width, int height) {
  check_size(width, height);
  View view;
  view.width = width;
  view.height = height;
  view.projection = make_projection(min_fov, double(width) / height, {});
  return view;
}

View View::between(double near, double far) const {
  View view = *this;
  view.projection.clip = {near, far};
  return view;
}

View View::enclosing(const Box& bounds) const {
  const ClipDistances clip = fit_clip(bounds, world_from_eye, projection.orthographic);
  return between(clip.near, clip.far);
}

glm::dmat4 clip_from_eye(const Projection& projection, const DepthConvention& depth) {
  const double w = projection.right - projection.left, h = projection.top - projection.bottom;
  const double x = (projection.right + projection.left) / w, y = (projection.top + projection.bottom) / h;
  const DepthRow row = depth_row(projection, depth);
  if (projection.orthographic) return {2 / w, 0, 0, 0, 0, 2 / h, 0, 0, 0, 0, -row.a, 0, -x, -y, row.b, 1};
  return {2 / w, 0, 0, 0, 0, 2 / h, 0, 0, x, y, row.a, -1, 0, 0, row.b, 0};
}

double distance_of_depth(const Projection& projection, const DepthConvention& depth, double ndc_depth) {
  const DepthRow row = depth_row(projection, depth);
  if (projection.orthographic) return (ndc_depth - row.b) / row.a;
  const double denominator = ndc_depth + row.a;
  // The depth is infinitely far: the far plane's own depth if the far plane is infinite, else a depth beyond it.
  if (denominator == 0) return std::numeric_limits<double>::infinity();
  return row.b / denominator;
}

}  // namespace frontmost
