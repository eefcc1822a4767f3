// SPDX-License-Identifier: Apache-2.0
// The transform from world space to the screen, and homogeneous clipping by one plane after another.
//
// I. Sutherland, G. Hodgman. Reentrant Polygon Clipping. 1974.
//
// Vertices that can be snapped keep the float position that every other triangle sees. Only other vertices, and cuts,
// are computed in double.
//
// There are no cracks: the result for an edge depends on its two ends alone. Both triangles of an edge cut it from its
// inner to its outer end, in the same order of planes, and so get the same bits.

#include "view/screen_transform.h"

#include <algorithm>
#include <tuple>

#include "view/clip.h"

namespace frontmost {
namespace {

std::array<float, 3> as_row(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

float dot(const std::array<float, 3>& row, const glm::dvec3& v) {
  return float(double(row[0]) * v.x + double(row[1]) * v.y + double(row[2]) * v.z);
}

}  // namespace

ScreenTransform::ScreenTransform(const View& view) {
  const Projection& p = view.projection;
  // Scales, in 1/256 pixel per unit of the image plane, and the point where the axis meets the plane, from the image's
  // centre.
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
  // Floats subtract the rounded eye from a position. The rest of the eye, at most half a unit in the last place, is
  // multiplied by the rows once, in doubles.
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

namespace {

struct ClipVertex {
  double x, y, d;  // homogeneous, see screen_transform.h
  ScreenVertex plain;
  bool is_plain;  // whether `plain` is valid
};

enum class ClipPlane { near, far, left, right, top, bottom };
/// Near comes first: in perspective the sides are planes only where w, the distance, is positive.
constexpr ClipPlane kPlanes[] = {ClipPlane::near,  ClipPlane::far, ClipPlane::left,
                                 ClipPlane::right, ClipPlane::top, ClipPlane::bottom};

double w_of(const ScreenTransform& t, const ClipVertex& v) { return t.orthographic ? 1.0 : v.d; }

/// Distance from a plane, not negative inside. A vertex that can be snapped is inside every plane, whatever doubles
/// say.
double distance(const ScreenTransform& t, ClipPlane plane, const ClipVertex& v) {
  const double reach = kGuardBand * w_of(t, v);
  double distance = 0;
  switch (plane) {
    case ClipPlane::near: distance = v.d - t.near; break;
    case ClipPlane::far: distance = double(t.far) - v.d; break;
    case ClipPlane::left: distance = reach + v.x; break;
    case ClipPlane::right: distance = reach - v.x; break;
    case ClipPlane::top: distance = reach + v.y; break;
    case ClipPlane::bottom: distance = reach - v.y; break;
  }
  return v.is_plain ? std::max(distance, 0.0) : distance;
}

ClipVertex cut(const ScreenTransform& t, ClipPlane plane, const ClipVertex& inside, const ClipVertex& outside) {
  const double a = distance(t, plane, inside), b = distance(t, plane, outside);
  // a >= 0 > b: never 0 / 0, and s is within [0, 1].
  const double s = a / (a - b);
  // Rounding must not move the distance past an end: behind the near plane the divide is not possible.
  const auto [nearest, farthest] = std::minmax(inside.d, outside.d);
  ClipVertex v{inside.x + s * (outside.x - inside.x),
               inside.y + s * (outside.y - inside.y),
               std::clamp(inside.d + s * (outside.d - inside.d), nearest, farthest),
               {},
               false};
  // The cut is exactly on its plane: rounding must not put it outside of the plane that made it.
  switch (plane) {
    case ClipPlane::near: v.d = t.near; break;
    case ClipPlane::far: v.d = t.far; break;
    case ClipPlane::left: v.x = -kGuardBand * w_of(t, v); break;
    case ClipPlane::right: v.x = kGuardBand * w_of(t, v); break;
    case ClipPlane::top: v.y = -kGuardBand * w_of(t, v); break;
    case ClipPlane::bottom: v.y = kGuardBand * w_of(t, v); break;
  }
  return v;
}

/// Each of six planes adds at most one corner to a convex polygon, and one more corner is written before the count is
/// tested.
using ClipCorners = std::array<ClipVertex, ClippedPolygon::max_corners + 1>;

/// Whether all vertices are outside of one plane, so that nothing between them is inside. Cutting at earlier planes
/// would be rounded, by much if some vertices are 1e20 times as far away as others, and cuts could land in the picture.
bool is_outside(const ScreenTransform& t, const ClipCorners& triangle) {
  const auto all_outside = [&](ClipPlane plane) {
    return std::all_of(triangle.begin(), triangle.begin() + 3,
                       [&](const ClipVertex& v) { return distance(t, plane, v) < 0; });
  };
  return std::any_of(std::begin(kPlanes), std::end(kPlanes), all_outside);
}

int clip_by(const ScreenTransform& t, ClipPlane plane, const ClipCorners& in, int count, ClipCorners& out) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const ClipVertex& a = in[std::size_t(i)];
    const ClipVertex& b = in[std::size_t(i + 1 == count ? 0 : i + 1)];
    const bool a_inside = distance(t, plane, a) >= 0, b_inside = distance(t, plane, b) >= 0;
    if (a_inside) out[std::size_t(kept++)] = a;
    if (a_inside != b_inside) out[std::size_t(kept++)] = a_inside ? cut(t, plane, a, b) : cut(t, plane, b, a);
    // Rounding can make a sliver polygon look non-convex; it has no area to lose.
    if (kept >= ClippedPolygon::max_corners) break;
  }
  return std::min(kept, ClippedPolygon::max_corners);
}

/// A coordinate in 1/256 pixel. Ties go to the even number, as in every kernel; a cut on the guard band must not round
/// beyond it.
std::int32_t snap_coordinate(double homogeneous, double w) {
  const double limit = kGuardBand;
  return static_cast<std::int32_t>(std::nearbyint(std::clamp(homogeneous / w, -limit, limit)));
}

ScreenVertex finish(const ScreenTransform& t, const ClipVertex& v) {
  if (v.is_plain) return v.plain;
  const double w = w_of(t, v);
  const double key = t.orthographic ? (double(t.far) - v.d) * double(t.inverse_range) : double(t.near) / v.d;
  return {snap_coordinate(v.x, w), snap_coordinate(v.y, w), std::clamp(float(key), 0.0f, 1.0f)};
}

/// Rotates a polygon so that its topmost corner comes first. Fans begin at the first corner, which must not depend on
/// the order of vertices: another order would otherwise give other pieces.
void begin_at_top(ClippedPolygon& polygon) {
  const auto end = polygon.corners.begin() + polygon.count;
  const auto top = std::min_element(polygon.corners.begin(), end, [](const ScreenVertex& a, const ScreenVertex& b) {
    return std::tie(a.y, a.x, a.key) < std::tie(b.y, b.x, b.key);
  });
  std::rotate(polygon.corners.begin(), top, end);
}

double row_dot(const std::array<float, 3>& row, const glm::dvec3& d, float offset) {
  return row[0] * d.x + row[1] * d.y + row[2] * d.z + offset;
}

ClipVertex prepare(const ScreenTransform& t, const glm::vec3& world) {
  const glm::dvec3 d = glm::dvec3(world) - glm::dvec3(t.eye[0], t.eye[1], t.eye[2]);
  ClipVertex v{
      row_dot(t.x_row, d, t.x_offset), row_dot(t.y_row, d, t.y_offset), row_dot(t.d_row, d, t.d_offset), {}, false};
  const HomogeneousVertex single = transform(t, world);
  v.is_plain = is_plain(t, single);
  if (v.is_plain) v.plain = snap(t, single);
  return v;
}

}  // namespace

ClippedPolygon clip_triangle(const ScreenTransform& t, const std::array<glm::vec3, 3>& world) {
  ClipCorners polygon, next;
  int count = 3;
  for (std::size_t i = 0; i < 3; ++i) polygon[i] = prepare(t, world[i]);
  if (is_outside(t, polygon)) return {};
  for (const ClipPlane plane : kPlanes) {
    count = clip_by(t, plane, polygon, count, next);
    if (count < 3) return {};
    std::swap(polygon, next);
  }
  ClippedPolygon result;
  result.count = count;
  for (int i = 0; i < count; ++i) result.corners[std::size_t(i)] = finish(t, polygon[std::size_t(i)]);
  if (count > 3) begin_at_top(result);
  return result;
}

}  // namespace frontmost
