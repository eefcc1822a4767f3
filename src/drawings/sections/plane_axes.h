// SPDX-License-Identifier: Apache-2.0
// Coordinates in a cutting plane. The plane is perpendicular to a world axis, so coordinates are selected and never
// computed. Points in the plane stay there to the bit, and vertices of the cut face are vertices of the walls beside
// it.
#pragma once

#include "frontmost/lines.h"

namespace frontmost::lines_detail {

/// Orders points of a plane from left to right, and upwards for equal x.
[[nodiscard]] inline bool is_left_of(const glm::vec2& a, const glm::vec2& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// Two axes within the plane and one across it, right-handed in this order with CuttingPlane::towards.
class PlaneAxes {
 public:
  explicit PlaneAxes(const CuttingPlane& plane)
      : across_(int(plane.towards) % 3), is_minus_(int(plane.towards) >= 3), at_(float(plane.at)) {}

  /// Whether a point lies behind the plane.
  [[nodiscard]] bool is_behind(const glm::vec3& p) const { return is_minus_ ? p[across_] > at_ : p[across_] < at_; }
  [[nodiscard]] glm::vec2 in_plane(const glm::vec3& p) const { return {p[axis(0)], p[axis(1)]}; }
  [[nodiscard]] glm::vec3 in_space(const glm::vec2& p) const {
    glm::vec3 place;
    place[across_] = at_;
    place[axis(0)] = p.x;
    place[axis(1)] = p.y;
    return place;
  }
  [[nodiscard]] int across() const { return across_; }
  [[nodiscard]] float at() const { return at_; }

 private:
  [[nodiscard]] int axis(int i) const { return (across_ + (is_minus_ ? 2 - i : 1 + i)) % 3; }

  int across_;
  bool is_minus_;
  float at_;
};

}  // namespace frontmost::lines_detail
