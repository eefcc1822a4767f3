// SPDX-License-Identifier: Apache-2.0
// Depth keys within a triangle on the screen: the one definition, in plain scalar code, for every method that snaps
// vertices. Kernels evaluate the same operations, and so get the same bits.
//
// Keys are affine over the screen. Over most triangles they change little, and floats can follow their plane: (k0 +
// dx*gx) + dy*gy from the topmost vertex, with a gradient that is exact before it is rounded. Over a steep triangle,
// such as a floor from the eye's feet to the horizon, these products are far greater than their sum, the key, and would
// leave few of its bits. There the key is k0 + (e1*a + e2*b) from the farthest vertex, in doubles. e1 and e2 are edge
// functions: exact integers, and no term is negative within the triangle, so nothing cancels.
//
// Neither formula depends on which vertex comes first, nor on the winding, as areas are made positive before.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace frontmost {

/// Twice the signed area of a triangle with vertices x[3], y[3], exact within the guard band.
template <class Triangle>
[[nodiscard]] std::int64_t doubled_area(const Triangle& t) {
  return std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - std::int64_t(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
}

/// The key of a triangle that is not steep, as a plane: the key at (x, y) is (k0 + (x - x0) * gx) + (y - y0) * gy,
/// limited to [k_min, k_max].
struct KeyPlane {
  /// Triangles with smaller keys count as steep, because float products with such keys might not be normal numbers.
  static constexpr float least_key = 1e-30f;

  std::int32_t x0, y0;
  float k0, gx, gy, k_min, k_max;
  bool is_steep;  ///< the plane is only a rough one, see SteepKeys

  /// The plane of vertices x[3], y[3] with key[3]. Precondition: the area is positive.
  template <class Triangle>
  explicit KeyPlane(const Triangle& t) {
    const auto is_above = [&](int a, int b) { return t.y[a] < t.y[b] || (t.y[a] == t.y[b] && t.x[a] < t.x[b]); };
    const int lower = is_above(1, 0) ? 1 : 0, a = is_above(2, lower) ? 2 : lower;
    x0 = t.x[a], y0 = t.y[a], k0 = t.key[a];
    const double x1 = t.x[1] - t.x[0], y1 = t.y[1] - t.y[0], x2 = t.x[2] - t.x[0], y2 = t.y[2] - t.y[0];
    const double k1 = double(t.key[1]) - double(t.key[0]), k2 = double(t.key[2]) - double(t.key[0]);
    // Keys of a triangle that is not steep are within a factor of 3, so differences of keys have 26 bits; differences
    // of vertices have 23. The sums of products are therefore exact, and the same from any vertex.
    const double scale = 1 / double(doubled_area(t));
    gx = float((k1 * y2 - k2 * y1) * scale);
    gy = float((x1 * k2 - x2 * k1) * scale);
    k_min = std::min({t.key[0], t.key[1], t.key[2]});
    k_max = std::max({t.key[0], t.key[1], t.key[2]});
    // Within these limits the sum is accurate to 16 roundings of a float.
    const auto width = float(std::max({t.x[0], t.x[1], t.x[2]}) - std::min({t.x[0], t.x[1], t.x[2]}));
    const auto height = float(std::max({t.y[0], t.y[1], t.y[2]}) - y0);
    const float limit = k_min - least_key;
    is_steep = std::abs(gx) * width + std::abs(gy) * height > 4 * limit || k_max - k_min > 2 * limit;
  }

  [[nodiscard]] float at(std::int32_t x, std::int32_t y) const {
    return std::min(std::max((k0 + float(x - x0) * gx) + float(y - y0) * gy, k_min), k_max);
  }
};

/// The keys of a steep triangle: rounded once, from doubles.
struct SteepKeys {
  double x0, y0, k0;  ///< the farthest vertex
  double px, py;      ///< the side from this vertex to the next one
  double qx, qy;      ///< the side from the last vertex to this one
  double a, b;        ///< keys of the two other vertices, less k0, divided by the area
  float k_min, k_max;

  SteepKeys() = default;
  /// The keys of vertices x[3], y[3] with key[3]. Precondition: the area is positive.
  template <class Triangle>
  explicit SteepKeys(const Triangle& t) {
    const int lesser = t.key[1] < t.key[0] ? 1 : 0, m = t.key[2] < t.key[lesser] ? 2 : lesser;
    const int p = m == 2 ? 0 : m + 1, q = p == 2 ? 0 : p + 1;
    const auto area = double(doubled_area(t));
    x0 = t.x[m], y0 = t.y[m], k0 = double(t.key[m]);
    px = t.x[p] - t.x[m], py = t.y[p] - t.y[m];
    qx = t.x[m] - t.x[q], qy = t.y[m] - t.y[q];
    a = (double(t.key[p]) - k0) / area;
    b = (double(t.key[q]) - k0) / area;
    k_min = t.key[m];
    k_max = std::max(t.key[p], t.key[q]);
  }

  /// \returns the key, limited to the range of the vertices' keys; the limits matter only outside of the triangle.
  [[nodiscard]] float at(std::int32_t x, std::int32_t y) const {
    return std::min(std::max(float(exactly_at(x, y)), k_min), k_max);
  }
  /// The key before it is rounded and limited.
  [[nodiscard]] double exactly_at(double x, double y) const {
    const double dx = x - x0, dy = y - y0;
    return k0 + ((qx * dy - qy * dx) * a + (px * dy - py * dx) * b);
  }
  [[nodiscard]] double gx() const { return -(qy * a + py * b); }
  [[nodiscard]] double gy() const { return qx * a + px * b; }
};

/// KeyPlane or SteepKeys, for code that evaluates fragments one by one.
class TriangleKeys {
 public:
  /// The keys of vertices x[3], y[3] with key[3]. Precondition: the area is positive.
  template <class Triangle>
  explicit TriangleKeys(const Triangle& t) : plane_(t) {
    if (plane_.is_steep) steep_ = SteepKeys(t);
  }
  [[nodiscard]] float at(std::int32_t x, std::int32_t y) const {
    return plane_.is_steep ? steep_.at(x, y) : plane_.at(x, y);
  }

 private:
  KeyPlane plane_;
  SteepKeys steep_;
};

}  // namespace frontmost
