// SPDX-License-Identifier: Apache-2.0
// Defines which triangle a ray through a sample meets, in plain scalar code. Kernels find the same bits faster.
//
// S. Woop, C. Benthin, I. Wald. Watertight Ray/Triangle Intersection. Journal of Computer Graphics Techniques 2(1),
// 2013. Unlike theirs, the signs of determinants are exact here.
//
// A corner is the rounded homogeneous screen position of a vertex (view/screen_transform.h), and is equal for all
// triangles with this vertex. Corners are sheared so that the ray through (sx, sy) becomes the axis: a corner then lies
// at (x - sx*w, y - sy*w). The ray meets the triangle if the origin is inside the three sheared corners, edges
// included. Whether a triangle is seen edge-on, and so covers nothing, is decided exactly, on world coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/exact_vector.h"
#include "view/facing_rule.h"
#include "view/screen_transform.h"

namespace frontmost::raycast_detail {

/// Keys are affine over the screen. They are evaluated from the centre of the tile that holds the sample, because
/// floats lose precision far from the image's centre. So the tile is part of the definition of a key.
inline constexpr int kTileSize = 32;

/// Corners between the planes, within the guard band and within these distances are transformed and sheared in floats,
/// because products of two sheared coordinates then stay in range. All other corners are computed in doubles.
inline constexpr float kSingleNear = 0x1p-40f, kSingleFar = 0x1p40f;
/// Steeper or higher key planes belong to triangles that are nearly edge-on, so the keys of these are made constant.
inline constexpr float kSteepest = 0x1p60f;

struct SampleCorner {
  double x = 0, y = 0, d = 0;
  bool is_single = false;  ///< the values are floats
};

/// Returns a homogeneous screen position in doubles.
inline glm::dvec3 wide_place(const ScreenTransform& t, const glm::vec3& world) {
  const double dx = double(world.x) - t.eye[0], dy = double(world.y) - t.eye[1], dz = double(world.z) - t.eye[2];
  return {t.x_row[0] * dx + t.x_row[1] * dy + t.x_row[2] * dz + t.x_offset,
          t.y_row[0] * dx + t.y_row[1] * dy + t.y_row[2] * dz + t.y_offset,
          t.d_row[0] * dx + t.d_row[1] * dy + t.d_row[2] * dz + t.d_offset};
}

inline SampleCorner make_corner(const ScreenTransform& t, const glm::vec3& world) {
  const HomogeneousVertex v = transform(t, world);
  if (is_plain(t, v) && v.d >= kSingleNear && v.d <= kSingleFar) return {v.x, v.y, v.d, true};
  const glm::dvec3 place = wide_place(t, world);
  return {place.x, place.y, place.z, false};
}

/// Returns whether a plane through the triangle contains the eye or, in parallel projection, the view direction.
inline bool is_edge_on(const View& view, const std::array<glm::vec3, 3>& world) {
  const glm::dvec3 a(world[0]), b(world[1]), c(world[2]);
  if (view.projection.orthographic) return sign_of_determinant({b, a}, {c, a}, {view.forward()}) == 0;
  const glm::dvec3 eye = view.eye();
  return sign_of_determinant({a, eye}, {b, eye}, {c, eye}) == 0;
}

/// A triangle with finite vertices, as the rays of a view see it.
struct SampleTriangle {
  std::array<glm::vec3, 3> world;
  std::array<SampleCorner, 3> corners;  ///< vertices on the screen, equal for all triangles that share them
};

inline SampleTriangle make_triangle(const ScreenTransform& t, const std::array<glm::vec3, 3>& world) {
  return {world, {make_corner(t, world[0]), make_corner(t, world[1]), make_corner(t, world[2])}};
}

struct Point {
  double x, y;
};

inline Point sheared(const ScreenTransform& t, const SampleCorner& c, float sx, float sy) {
  if (!c.is_single) {
    const double w = t.orthographic ? 1.0 : c.d;
    return {c.x - double(sx) * w, c.y - double(sy) * w};
  }
  const float w = t.orthographic ? 1.0f : float(c.d);
  return {float(c.x) - sx * w, float(c.y) - sy * w};
}

/// Returns the exact sign of a.x * b.y - a.y * b.x. Rounding is monotonic, so the rounded products decide if they
/// differ. If they are equal, their rounding errors decide.
inline int side(const Point& a, const Point& b) {
  const double p = a.x * b.y, q = a.y * b.x;
  if (p != q) return p > q ? 1 : -1;
  const double p_error = std::fma(a.x, b.y, -p), q_error = std::fma(a.y, b.x, -q);
  return int(p_error > q_error) - int(p_error < q_error);
}

/// Returns -1 if the triangle is met from the front (counter-clockwise on the screen; y is down), 1 if it is met from
/// behind, and 0 if it is missed or edge-on.
inline int facing(const ScreenTransform& t, const std::array<SampleCorner, 3>& corners, float sx, float sy) {
  const Point a = sheared(t, corners[0], sx, sy), b = sheared(t, corners[1], sx, sy),
              c = sheared(t, corners[2], sx, sy);
  const int u = side(b, c), v = side(c, a), w = side(a, b);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  return least >= 0 ? most : most <= 0 ? least : 0;
}

/// Returns whether the ray meets the triangle and culling keeps it. `facing` is the result of facing().
inline bool keeps(const FacingRule& rule, PrimitiveId id, int facing) {
  return facing != 0 && rule.keeps(id, facing < 0);
}

inline float key_of_distance(const ScreenTransform& t, double d) {
  if (t.orthographic) return std::fmin(std::fmax((t.far - float(d)) * t.inverse_range, 0.0f), 1.0f);
  return std::fmin(t.near * (1.0f / float(d)), 1.0f);
}

/// The key of a triangle over one tile: k0 + u*gx + v*gy, where (u, v) is relative to the tile's centre in 1/256 pixel.
struct TileKeyPlane {
  float gx = 0, gy = 0, k0 = 0;
  float low = 0, high = 0;  ///< range of the vertices' keys, which no key leaves
  bool is_clipped = false;  ///< not wholly between near and far: only keys in [cut, 1] are seen
  bool is_outside = false;  ///< wholly nearer than near, wholly beyond far, or seen edge-on: covers nothing
  float cut = 0;

  [[nodiscard]] float raw(float u, float v) const { return (k0 + u * gx) + v * gy; }
  [[nodiscard]] bool sees(float raw_key) const { return !is_clipped || (raw_key >= cut && raw_key <= 1.0f); }
  [[nodiscard]] float clamped(float raw_key) const { return std::min(std::max(raw_key, low), high); }
};

inline void set_range(const ScreenTransform& t, const std::array<SampleCorner, 3>& c, TileKeyPlane& plane) {
  const double nearest = std::min({c[0].d, c[1].d, c[2].d}), farthest = std::max({c[0].d, c[1].d, c[2].d});
  plane.is_outside = !(farthest >= t.near && nearest <= t.far);
  plane.is_clipped = !(nearest >= t.near && farthest <= t.far);
  plane.cut = t.orthographic ? 0.0f : t.near / t.far;
  plane.high = nearest >= t.near ? key_of_distance(t, nearest) : 1.0f;
  plane.low = farthest <= t.far ? key_of_distance(t, farthest) : plane.cut;
}

/// Returns the vertices that keys are computed from. If one vertex is in doubles, all are, because the triangle may
/// pass so near to the eye that floats would turn its plane to the other side.
inline std::array<glm::dvec3, 3> places_of(const ScreenTransform& t, const SampleTriangle& triangle, bool is_single) {
  std::array<glm::dvec3, 3> places;
  for (std::size_t k = 0; k < 3; ++k) {
    const SampleCorner& c = triangle.corners[k];
    places[k] = is_single || !c.is_single ? glm::dvec3(c.x, c.y, c.d) : wide_place(t, triangle.world[k]);
  }
  return places;
}

/// Returns the key plane of a triangle. `tile` is the tile's centre relative to the image's centre, in 1/256 pixel.
inline TileKeyPlane key_plane(const View& view, const ScreenTransform& t, const SampleTriangle& triangle,
                              const glm::dvec2& tile) {
  TileKeyPlane plane;
  set_range(t, triangle.corners, plane);
  // Triangles of single corners are not tested. These corners are in front of the eye, so an edge-on triangle of them
  // is no wider than their rounding.
  const bool is_single =
      triangle.corners[0].is_single && triangle.corners[1].is_single && triangle.corners[2].is_single;
  plane.is_outside = plane.is_outside || (!is_single && is_edge_on(view, triangle.world));
  if (plane.is_outside) return plane;
  const std::array<glm::dvec3, 3> c = places_of(t, triangle, is_single);
  const glm::dvec3 p = c[1] - c[0], q = c[2] - c[0];
  const double nx = p.y * q.z - p.z * q.y, ny = p.z * q.x - p.x * q.z, nd = p.x * q.y - p.y * q.x;
  const double det = (nx * c[0].x + ny * c[0].y) + nd * c[0].z;
  const double across = nx * tile.x + ny * tile.y;
  const double scale = t.orthographic ? double(t.inverse_range) / nd : double(t.near) / det;
  plane.gx = float(nx * scale);
  plane.gy = float(ny * scale);
  plane.k0 = t.orthographic ? float(double(t.far) * double(t.inverse_range) - (det - across) * scale)
                            : float((across + nd) * scale);
  // NaN counts as too steep. If the triangle reaches beyond near or far, no sample sees its sliver between the planes.
  if (!(std::abs(plane.gx) <= kSteepest && std::abs(plane.gy) <= kSteepest && std::abs(plane.k0) <= kSteepest)) {
    plane.is_outside = plane.is_clipped;
    plane.gx = plane.gy = 0;
    plane.k0 = plane.low;
  }
  return plane;
}

}  // namespace frontmost::raycast_detail
