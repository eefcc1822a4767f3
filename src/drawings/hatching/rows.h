// SPDX-License-Identifier: Apache-2.0
// The lines of a hatch set on the screen, their intersections with triangles, and the brightness along them.
//
//      line 2  - - -/- - -\- - -      Lines are parallel and evenly spaced, and are numbered across their direction.
//      line 1  - - / - - - \ - -      A line meets a triangle in a segment in space with both ends on the triangle's
//      line 0  - -/_________\- -      sides, so that visible parts and light are computed in space, too.
//
// Brightness is the cosine of the angle between the normal and the direction to the light, without shadows. Normals are
// smooth across edges that are no creases, so hatching follows a curved surface, not its triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "frontmost/lines.h"
#include "frontmost/scene.h"
#include "lines/hiding/occluder.h"
#include "lines/mesh/mesh.h"
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
  HatchRows(const HatchSet& set, const View& view)
      : size_(view.width, view.height),
        direction_(direction_of(set.angle)),
        across_(-direction_.y, direction_.x),
        spacing_(set.spacing),
        offset_(set.offset),
        near_(view.projection.clip.near),
        is_parallel_(view.projection.orthographic) {
    const Projection& p = view.projection;
    const glm::dvec2 scale(view.width / (p.right - p.left), -view.height / (p.top - p.bottom));
    plane_ = {across_ * scale, -glm::dot(across_, scale * glm::dvec2(p.left, p.top))};
    const double heights[] = {0, across_.x * view.width, across_.y * view.height,
                              across_.x * view.width + across_.y * view.height};
    const auto [low, high] = std::minmax_element(std::begin(heights), std::end(heights));
    picture_ = {std::int32_t(std::ceil((*low - offset_) / spacing_)),
                std::int32_t(std::floor((*high - offset_) / spacing_))};
  }

  struct Range {
    std::int32_t first = 0, last = -1;
  };

  /// The numbers of lines that may pass the triangle within the picture.
  [[nodiscard]] Range range_of(const HatchedTriangle& triangle) const {
    double low = 1e300, high = -1e300;
    for (const glm::dvec3& corner : triangle.in_eye) {
      if (!is_parallel_ && corner.z < near_) return picture_;
      const double height = weighted_height(corner) / weight(corner);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    // One more on each side, because the division rounds; the signs in segment() decide. Clamped before the conversion.
    const auto number = [&](double height) {
      return std::clamp((height - offset_) / spacing_, picture_.first - 2.0, picture_.last + 2.0);
    };
    return {std::max(picture_.first, std::int32_t(std::ceil(number(low))) - 1),
            std::min(picture_.last, std::int32_t(std::floor(number(high))) + 1)};
  }

  /// The segment of the line in the triangle. A vertex on the line counts as above, so that a line passes from triangle
  /// to triangle at one place, to the bit.
  [[nodiscard]] std::optional<HatchSegment> segment(const HatchedTriangle& triangle, std::int32_t line) const {
    double heights[3];
    for (int k = 0; k < 3; ++k)
      heights[k] = weighted_height(triangle.in_eye[k]) - height_of(line) * weight(triangle.in_eye[k]);
    HatchSegment segment;
    glm::dvec3 places[2];
    EndOn on[2];
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      int p = k, q = k == 2 ? 0 : k + 1;
      if ((heights[p] >= 0) == (heights[q] >= 0)) continue;
      // Computed from the lower vertex, for both triangles.
      if (triangle.vertices[p] > triangle.vertices[q]) std::swap(p, q);
      const double from_p = std::abs(heights[p]), t = from_p / (from_p + std::abs(heights[q]));
      const glm::dvec3 &from = triangle.places[p], &to = triangle.places[q];
      places[count] = place_between(from, to, t);
      on[count] = {triangle.vertices[p], triangle.vertices[q]};
      // A place at a vertex lies in all planes of that vertex.
      if (places[count] == from) on[count][1] = on[count][0];
      if (places[count] == to) on[count][0] = on[count][1];
      (count == 0 ? segment.from : segment.to) = {p, q, t};
      ++count;
    }
    if (count < 2 || places[0] == places[1]) return std::nullopt;
    segment.edge = {places[0], places[1], on[0], on[1], {triangle.number, no_index}, slack_of(places[0], places[1])};
    return segment;
  }

  /// The position along the line, in pixels, of a point on it.
  [[nodiscard]] double along(const glm::dvec2& screen) const { return glm::dot(screen, direction_); }

  /// The nearest position along the line within the picture.
  [[nodiscard]] double within_picture(std::int32_t line, double along) const {
    const glm::dvec2 start = point(line, 0);
    for (int axis = 0; axis < 2; ++axis) {
      if (direction_[axis] == 0) continue;
      const double a = -start[axis] / direction_[axis], b = (size_[axis] - start[axis]) / direction_[axis];
      along = std::clamp(along, std::min(a, b), std::max(a, b));
    }
    return along;
  }

  [[nodiscard]] glm::dvec2 point(std::int32_t line, double along) const {
    return across_ * height_of(line) + direction_ * along;
  }

 private:
  /// Sines differ between C libraries in their last bit, but not as floats.
  [[nodiscard]] static glm::dvec2 direction_of(double angle) {
    return glm::normalize(glm::dvec2(float(std::cos(angle)), -float(std::sin(angle))));
  }

  [[nodiscard]] double height_of(std::int32_t line) const { return offset_ + line * spacing_; }
  [[nodiscard]] double weight(const glm::dvec3& in_eye) const { return is_parallel_ ? 1 : in_eye.z; }
  /// The distance across the lines in pixels, times the weight.
  [[nodiscard]] double weighted_height(const glm::dvec3& in_eye) const {
    return glm::dot(plane_, {in_eye.x, in_eye.y, weight(in_eye)});
  }

  glm::dvec2 size_;
  glm::dvec2 direction_, across_;  ///< unit length
  double spacing_, offset_, near_;
  bool is_parallel_;
  glm::dvec3 plane_;
  Range picture_;
};

/// A normal that is linear along a segment, from t = 0 to 1; not of unit length in between.
struct NormalAlong {
  glm::dvec3 from, to;

  /// The cosine of the angle to a unit vector.
  [[nodiscard]] double cosine_at(double t, const glm::dvec3& to_light) const {
    const glm::dvec3 n = from + (to - from) * t;
    const double length = glm::length(n);
    return length > 0 ? glm::dot(n, to_light) / length : 0;
  }
};

/// Vertex normals of triangles, smooth across edges that are no creases.
class CornerNormals {
 public:
  CornerNormals(const SeenMesh& seen, const Surfaces& surfaces, double crease_angle, const Execution& execution)
      : mesh_(seen.mesh),
        normals_(mesh_.triangles.size()),
        surfaces_(surfaces),
        cosine_(float(std::cos(crease_angle))),
        corners_(corner_table(mesh_, execution)) {
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) normals_[i] = normal_of(mesh_, i);
  }

  /// The unit normals at the vertices of a triangle, on the side from which it is counter-clockwise. Vertices with very
  /// many triangles have the triangle's own normal. O(triangles at its vertices).
  [[nodiscard]] std::array<glm::dvec3, 3> of(std::uint32_t triangle) const {
    const glm::dvec3 own = unit_of(normals_[triangle]);
    return {at(triangle, 0, own), at(triangle, 1, own), at(triangle, 2, own)};
  }

 private:
  /// The tip of a cone with more sides is flat: its normal means nothing.
  static constexpr std::size_t most_at_vertex = 256;

  /// The mean with weights by N. Max (Weights for Computing Vertex Normals from Facet Normals, 1999), exact on spheres
  /// for any tessellation.
  [[nodiscard]] glm::dvec3 at(std::uint32_t triangle, int corner, const glm::dvec3& own) const {
    const std::uint32_t vertex = mesh_.triangles[triangle][corner];
    const std::span<const Corner> around = corners_[vertex];
    if (around.size() > most_at_vertex) return own;
    const std::uint32_t instance = surfaces_.source(mesh_.ids[triangle]).instance;
    glm::dvec3 sum(0);
    for (const Corner& one : around) {
      const std::uint32_t other = one.triangle();
      const glm::dvec3& normal = normals_[other];
      const double cosine = glm::dot(unit_of(normal), own);
      // Neighbours with the opposite winding are reversed.
      if (other != triangle && (std::abs(cosine) < cosine_ || surfaces_.source(mesh_.ids[other]).instance != instance))
        continue;
      const glm::dvec3 &place = mesh_.positions[vertex], &next = mesh_.positions[one.next(mesh_)],
                       &last = mesh_.positions[one.last(mesh_)];
      const double weight = glm::dot(next - place, next - place) * glm::dot(last - place, last - place);
      if (weight > 0) sum += normal * (std::copysign(1.0, cosine) / weight);
    }
    return unit_of(sum, own);
  }

  const WeldedMesh& mesh_;
  Buffer<glm::dvec3> normals_;
  const Surfaces& surfaces_;
  const double cosine_;
  const CornerTable corners_;
};

/// The intervals in which that cosine is less than `limit`, in order: at most three.
inline void find_dark(const NormalAlong& normal, const glm::dvec3& to_light, double limit,
                      std::vector<Interval>& dark) {
  dark.clear();
  // (N.L)^2 = limit^2 N.N is a quadratic equation; its roots are where N.L = +-limit |N|.
  const glm::dvec3 step = normal.to - normal.from;
  const double p = glm::dot(normal.from, to_light), q = glm::dot(step, to_light), square = limit * limit;
  const double a = q * q - square * glm::dot(step, step), b = p * q - square * glm::dot(normal.from, step),
               c = p * p - square * glm::dot(normal.from, normal.from);
  double cuts[4] = {0, 1, 1, 1};
  int count = 1;
  const auto cut_at = [&](double t) {
    if (t > 0 && t < 1) cuts[count++] = t;
  };
  if (const double discriminant = b * b - a * c; discriminant > 0) {
    // Each root has two forms; the one without cancellation is used.
    const double sum = -b - std::copysign(std::sqrt(discriminant), b);
    if (a != 0) cut_at(sum / a);
    if (sum != 0) cut_at(c / sum);
  }
  std::sort(cuts + 1, cuts + count);
  cuts[count] = 1;
  for (int i = 0; i < count; ++i) {
    if (!(normal.cosine_at(0.5 * (cuts[i] + cuts[i + 1]), to_light) < limit)) continue;
    if (!dark.empty() && dark.back().end == cuts[i])
      dark.back().end = cuts[i + 1];
    else
      dark.push_back({cuts[i], cuts[i + 1]});
  }
}

}  // namespace frontmost::lines_detail
