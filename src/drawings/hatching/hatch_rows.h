// SPDX-License-Identifier: Apache-2.0
// The lines of a hatch set on the screen, and their intersections with triangles.
//
//      line 2  - - -/- - -\- - -      Lines are parallel and evenly spaced, and are numbered across their direction.
//      line 1  - - / - - - \ - -      A line meets a triangle in a segment in space with both ends on the triangle's
//      line 0  - -/_________\- -      sides, so that visible parts and light are computed in space, too.
#pragma once

#include <optional>

#include "frontmost/lines.h"
#include "hatching/tone.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A triangle that is hatched.
struct HatchedTriangle {
  std::uint32_t number;
  glm::uvec3 vertices;
  glm::dvec3 places[3];
  glm::dvec3 in_eye[3];  ///< as Sight::in_eye()
};

/// The segment of a line in a triangle. Each end lies between two vertices, at a share of the way.
struct HatchSegment {
  SightedEdge edge;
  struct Share {
    int p = 0, q = 0;  ///< corners
    double t = 0;
  } from, to;

  /// A value at an end, interpolated from values at the vertices.
  [[nodiscard]] static glm::dvec3 at(const Share& share, const std::array<glm::dvec3, 3>& corners) {
    return corners[std::size_t(share.p)] * (1 - share.t) + corners[std::size_t(share.q)] * share.t;
  }
};

/// Lines are numbered; number 0 is `HatchSet::offset` from the picture's corner.
class HatchRows {
 public:
  HatchRows(const HatchSet& set, const View& view);

  struct Range {
    std::int32_t first = 0, last = -1;
  };
  /// The numbers of lines that may pass the triangle within the picture.
  [[nodiscard]] Range range_of(const HatchedTriangle& triangle) const;
  /// The segment of the line in the triangle. A vertex on the line counts as above, so that a line passes from triangle
  /// to triangle at one place, to the bit.
  [[nodiscard]] std::optional<HatchSegment> segment(const HatchedTriangle& triangle, std::int32_t line) const;

  /// The position along the line, in pixels, of a point on it.
  [[nodiscard]] double along(const glm::dvec2& screen) const { return glm::dot(screen, direction_); }
  /// The nearest position along the line within the picture.
  [[nodiscard]] double within_picture(std::int32_t line, double along) const;
  [[nodiscard]] glm::dvec2 point(std::int32_t line, double along) const {
    return across_ * height_of(line) + direction_ * along;
  }

 private:
  [[nodiscard]] double height_of(std::int32_t line) const { return offset_ + line * spacing_; }
  [[nodiscard]] double weight(const glm::dvec3& in_eye) const { return is_parallel_ ? 1 : in_eye.z; }
  /// The distance across the lines in pixels, times the weight.
  [[nodiscard]] double weighted_height(const glm::dvec3& in_eye) const {
    return glm::dot(plane_, {in_eye.x, in_eye.y, weight(in_eye)});
  }

  glm::dvec2 size_;
  glm::dvec2 direction_, across_;  ///< of unit length
  double spacing_, offset_, near_;
  bool is_parallel_;
  glm::dvec3 plane_;
  Range picture_;
};

}  // namespace frontmost::lines_detail
