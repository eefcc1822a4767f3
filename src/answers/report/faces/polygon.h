// SPDX-License-Identifier: Apache-2.0
// Convex polygons on the screen: cutting them by lines, and their areas.
//
//        +-----.
//   left |    / .       A corner at most kNarrow away from the line lies on the line. A line along a side that was
//        |   /   .      cut before, and that rounding has moved slightly, therefore cuts nothing more off.
//        |  /     | right
//        '-/------'
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "report/faces/viewed_faces.h"

namespace frontmost::faces_detail {

/// A line of the screen; at() is the distance from it, in pixels, positive on one side.
struct CutLine {
  double a, b, c;

  [[nodiscard]] double at(const glm::dvec2& p) const { return a * p.x + b * p.y + c; }
};

/// The corners of a convex polygon in order. Corners that cuts leave on one line are kept.
class ConvexPiece {
 public:
  static constexpr int most_corners = 28;

  ConvexPiece() {}  // NOLINT: corners are set by add()
  ConvexPiece(const ConvexPiece& other) { *this = other; }
  ConvexPiece& operator=(const ConvexPiece& other) {
    count_ = other.count_;
    std::copy_n(other.corners_.begin(), count_, corners_.begin());  // other corners are not set
    return *this;
  }
  explicit ConvexPiece(const CellBox& box)
      : corners_{{{box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}}},
        count_(4) {}
  ConvexPiece(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) : corners_{{a, b, c}}, count_(3) {}

  [[nodiscard]] int size() const { return count_; }
  [[nodiscard]] const glm::dvec2* begin() const { return corners_.data(); }
  [[nodiscard]] const glm::dvec2* end() const { return corners_.data() + count_; }
  /// Whether the polygon may lack room for four cuts, which add one corner each.
  [[nodiscard]] bool is_full() const { return count_ + 4 > most_corners; }
  void add(const glm::dvec2& corner) {
    if (count_ < most_corners) corners_[std::size_t(count_++)] = corner;
  }
  void clear() { count_ = 0; }
  /// Moves the corners from the middle on into another polygon, which meets this one along a diagonal.
  [[nodiscard]] ConvexPiece halve() {
    ConvexPiece other;
    for (int i = count_ / 2; i < count_; ++i) other.add(corners_[std::size_t(i)]);
    other.add(corners_[0]);
    count_ = count_ / 2 + 1;
    return other;
  }

 private:
  std::array<glm::dvec2, most_corners> corners_;  // set by add()
  int count_ = 0;
};

/// Whether a polygon is nowhere wider than about kNarrow.
[[nodiscard]] inline bool is_narrow(const ConvexPiece& polygon) {
  if (polygon.size() < 3) return true;
  const glm::dvec2* const p = polygon.begin();
  double doubled = 0, reach = 0;
  for (int i = 1; i < polygon.size(); ++i) {
    const glm::dvec2 last = p[i - 1] - p[0], next = p[i] - p[0];
    doubled += last.x * next.y - last.y * next.x;
    reach = std::max({reach, std::abs(next.x), std::abs(next.y)});
  }
  return !(std::abs(doubled) > kNarrow * reach);
}

/// The sides of a line on which a polygon extends farther than kNarrow.
enum class LineSide { neither, left, right, both };

/// Distances of a polygon's corners from a line, positive on its left. A distance of less than `narrow` counts as 0.
struct LineDistances {
  std::array<double, ConvexPiece::most_corners> at;  ///< by corner
  int size;
  double narrow;
  LineSide side;

  /// Measures the corners of a polygon by distance(corner).
  template <class Distance>
  void measure(const ConvexPiece& polygon, const Distance& distance, double narrow_distance) {
    size = polygon.size();
    narrow = narrow_distance;
    double least = 0, greatest = 0;
    for (int i = 0; i < size; ++i) {
      const double d = distance(polygon.begin()[i]);
      at[std::size_t(i)] = d;
      least = d < least ? d : least;
      greatest = d > greatest ? d : greatest;
    }
    const bool is_left = greatest > narrow, is_right = least < -narrow;
    side = is_left ? (is_right ? LineSide::both : LineSide::left) : is_right ? LineSide::right : LineSide::neither;
  }
  void measure(const ConvexPiece& polygon, const CutLine& line) {
    measure(
        polygon, [&](const glm::dvec2& p) { return line.at(p); }, kNarrow);
  }
};

/// Cuts a polygon that extends to both sides of a line.
inline void cut_polygon(const ConvexPiece& polygon, const LineDistances& line, ConvexPiece& left, ConvexPiece& right) {
  left.clear();
  right.clear();
  const glm::dvec2* const p = polygon.begin();
  for (int i = 0; i < polygon.size(); ++i) {
    const int j = i + 1 == polygon.size() ? 0 : i + 1;
    const double from = line.at[std::size_t(i)], to = line.at[std::size_t(j)];
    if (from >= -line.narrow) left.add(p[i]);
    if (from <= line.narrow) right.add(p[i]);
    if ((from > line.narrow && to < -line.narrow) || (from < -line.narrow && to > line.narrow)) {
      const glm::dvec2 cut = p[i] + (p[j] - p[i]) * (from / (from - to));
      left.add(cut);
      right.add(cut);
    }
  }
}

/// Three areas of a polygon: in the picture, in the scene, and as a solid angle from the eye.
struct Areas {
  double pixels = 0, units = 0, solid_angle = 0;

  Areas& operator+=(const Areas& other) {
    pixels += other.pixels;
    units += other.units;
    solid_angle += other.solid_angle;
    return *this;
  }
};

/// The angle of the point (x, y) from the x axis, for y >= 0. Uses only square roots and a series, so it is the same on
/// every machine, up to a few units in the last place.
inline double angle_of(double x, double y) {
  // The angle is halved, by its tangent, until the series of the arctangent is short.
  double t = y, times = 1;
  if (x > 0 && y < 0.05 * x) {
    t = y / x;
  } else {
    t = y / (x + std::sqrt(x * x + y * y));
    for (times = 2; t >= 0.05; times *= 2) t /= 1 + std::sqrt(1 + t * t);
  }
  const double s = t * t;
  double sum = 0;
  for (int n = 13; n > 0; n -= 2) sum = 1.0 / n - s * sum;
  return times * t * sum;
}

/// Computes areas for a view. A place (x, y) of the picture has the direction (u, v, 1) in eye space; u and v are
/// affine in x and y. A surface point with key 1 / distance lies at (u, v, 1) / key; in parallel projection at (u, v,
/// -key), with key -distance.
class AreaRule {
 public:
  explicit AreaRule(const View& view)
      : orthographic_(view.projection.orthographic),
        left_(view.projection.left),
        top_(view.projection.top),
        step_x_((view.projection.right - view.projection.left) / view.width),
        step_y_((view.projection.top - view.projection.bottom) / view.height) {}

  /// The areas of a convex polygon in one plane, wound either way. Precondition: at least three corners; keys above 0
  /// in perspective.
  [[nodiscard]] Areas areas_of(std::span<const ScreenPoint> polygon) const {
    // The polygon is a fan about its first corner. The determinant of three directions equals that of two differences
    // in the image plane, so small triangles lose nothing to rounding. (A. van Oosterom, J. Strackee. The Solid Angle
    // of a Plane Triangle. 1983.)
    const glm::dvec3 a = direction_to(polygon[0]), at = place_of(a, polygon[0].key);
    const double a_length = glm::length(a);
    glm::dvec3 b = direction_to(polygon[1]), to_b = place_of(b, polygon[1].key) - at, normal(0);
    double b_length = glm::length(b), doubled = 0, solid_angle = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const glm::dvec3 c = direction_to(polygon[i]), to_c = place_of(c, polygon[i].key) - at;
      const double c_length = glm::length(c);
      const double part = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      doubled += part;
      normal += glm::cross(to_b, to_c);
      if (!orthographic_)
        solid_angle += 2 * angle_of(a_length * b_length * c_length + glm::dot(a, b) * c_length +
                                        glm::dot(b, c) * a_length + glm::dot(c, a) * b_length,
                                    std::abs(part));
      b = c;
      to_b = to_c;
      b_length = c_length;
    }
    return {0.5 * std::abs(doubled) / (step_x_ * step_y_), 0.5 * glm::length(normal), solid_angle};
  }

 private:
  [[nodiscard]] glm::dvec3 direction_to(const ScreenPoint& p) const {
    return {left_ + p.x * step_x_, top_ - p.y * step_y_, 1};
  }
  [[nodiscard]] glm::dvec3 place_of(const glm::dvec3& direction, double key) const {
    return orthographic_ ? glm::dvec3(direction.x, direction.y, -key) : direction / key;
  }

  bool orthographic_;
  double left_, top_, step_x_, step_y_;
};

}  // namespace frontmost::faces_detail
