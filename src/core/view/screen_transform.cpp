// SPDX-License-Identifier: Apache-2.0
#include "view/screen_transform.h"

#include <algorithm>

namespace frontmost {
namespace {

std::array<float, 3> as_row(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

float dot(const std::array<float, 3>& row, const glm::dvec3& v) {
  return float(double(row[0]) * v.x + double(row[1]) * v.y + double(row[2]) * v.z);
}

}  // namespace

ScreenTransform::ScreenTransform(const View& view) {
  const Projection& p = view.projection;
  // 1/256 pixels per unit of the image plane, and where the axis meets the plane, from the image's centre.
  const double scale_x = view.width / (p.right - p.left) * kSubPixels;
  const double scale_y = view.height / (p.top - p.bottom) * kSubPixels;
  const double axis_x = -p.left * scale_x - 0.5 * view.width * kSubPixels;
  const double axis_y = p.top * scale_y - 0.5 * view.height * kSubPixels;
  const double per_distance = p.orthographic ? 0 : 1;

  // A pinhole's image is scale * right / distance + axis. With W = distance the second term must be multiplied by W, so
  // it goes into the row; in parallel projection, with W = 1, it is an offset.
  eye = as_row(view.eye());
  x_row = as_row(scale_x * view.right() + per_distance * axis_x * view.forward());
  y_row = as_row(-scale_y * view.up() + per_distance * axis_y * view.forward());
  d_row = as_row(view.forward());
  // Floats subtract the rounded eye. The rest, at most half a unit in the last place, goes through the rows once, in
  // doubles.
  const glm::dvec3 rest = view.eye() - glm::dvec3(eye[0], eye[1], eye[2]);
  x_offset = float((1 - per_distance) * axis_x) - dot(x_row, rest);
  y_offset = float((1 - per_distance) * axis_y) - dot(y_row, rest);
  d_offset = -dot(d_row, rest);

  orthographic = p.orthographic;
  near = float(p.clip.near);
  // Beyond `farthest` a reciprocal would be a subnormal number, which some machines flush to 0.
  far = p.orthographic ? float(p.clip.far) : float(std::min(p.clip.far, double(farthest)));
  inverse_range = orthographic ? float(1 / (p.clip.far - p.clip.near)) : 0;
  centre_x = view.width * (kSubPixels / 2);
  centre_y = view.height * (kSubPixels / 2);
}

}  // namespace frontmost
