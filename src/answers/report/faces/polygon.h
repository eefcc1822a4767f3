// SPDX-License-Identifier: Apache-2.0
// Convex polygons on the screen, and cutting them by lines.
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

#include "report/faces/viewed_faces.h"

namespace frontmost::faces_detail {

/// A line of the screen; at() is the distance from it, in pixels, positive on one side.
struct CutLine {
  double a, b, c;

  [[nodiscard]] double at(const glm::dvec2& p) const { return a * p.x + b * p.y + c; }
};

/// The corners of a polygon in order. Corners that cuts leave on one line are kept.
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

/// Whether a polygon is nowhere wider than kNarrow, or hardly.
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

}  // namespace frontmost::faces_detail
