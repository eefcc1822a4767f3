// SPDX-License-Identifier: Apache-2.0
// Whether a point of a drawn edge is hidden, by a test of every triangle of the scene.
#pragma once

#include <array>
#include <vector>

#include "frontmost/lines.h"

namespace frontmost::test {

/// Counts the triangles that hide a point, by intersecting the line of sight with each. The answer is uncertain if
/// rounding could change it.
class PointOracle {
 public:
  PointOracle(const Surfaces& surfaces, const View& view) : view_(view) {
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const auto c = surfaces.corners(id);
      triangles_.push_back({glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])});
    }
  }

  struct Answer {
    bool is_certain = true;
    std::uint32_t hidden_by = 0;
  };
  /// x lies on `edge`; triangles that contain the edge do not hide it.
  [[nodiscard]] Answer ask(const glm::dvec3& x, const DrawnEdge& edge) const {
    Answer answer;
    for (std::size_t id = 0; id < triangles_.size(); ++id) {
      const auto& t = triangles_[id];
      if (id == edge.left || id == edge.right || shared_corners(t, {edge.from, edge.to}) == 2) continue;
      const glm::dvec3 direction = view_.projection.orthographic ? -view_.forward() : view_.eye() - x;
      const glm::dvec3 u = t[1] - t[0], v = t[2] - t[0], n = glm::cross(u, v);
      const double slope = glm::dot(n, direction), size = glm::length(n) * glm::length(direction);
      if (std::abs(slope) <= 1e-9 * size) {
        // A triangle seen edge-on hides nothing, except by rounding.
        answer.is_certain &= slope == 0 || std::abs(glm::dot(n, x - t[0])) > 1e-6 * glm::length(n);
        continue;
      }
      const double s = glm::dot(n, t[0] - x) / slope;
      const glm::dvec3 hit = x + s * direction;
      const double planar = glm::dot(hit - view_.eye(), view_.forward());
      double inside = 1e300;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 side = t[(k + 1) % 3] - t[k];
        inside = std::min(inside, glm::dot(n, glm::cross(side, hit - t[k])) / (glm::length(n) * glm::length(side)));
      }
      const double before = s * glm::length(direction), near = planar - view_.projection.clip.near;
      const double scale = 1 + glm::length(x) + glm::length(hit);
      constexpr double kDoubt = 1e-7;
      if (inside < -kDoubt * scale || before < -kDoubt * scale || near < -kDoubt * scale) continue;
      if (inside > kDoubt * scale && before > kDoubt * scale && near > kDoubt * scale)
        ++answer.hidden_by;
      else
        answer.is_certain = false;
    }
    return answer;
  }

 private:
  static int shared_corners(const std::array<glm::dvec3, 3>& t, const std::array<glm::dvec3, 2>& own) {
    int shared = 0;
    for (const glm::dvec3& corner : t) shared += corner == own[0] || corner == own[1];
    return shared;
  }

  const View& view_;
  std::vector<std::array<glm::dvec3, 3>> triangles_;
};

}  // namespace frontmost::test
