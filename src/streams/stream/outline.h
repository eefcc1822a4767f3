// SPDX-License-Identifier: Apache-2.0
// Finds the points of a stream that decide bounds and framing. Only triangles with three finite vertices count.
//
// Framing needs the points of the whole model, which a stream does not keep. But only points at the rim can touch a
// side of the picture, and there are few of them. The finder keeps only these, and its scene() stands for the model:
//
//        . * .                * kept: the farthest point towards a side of the frustum or of the bounds
//      *  . .  *              . dropped: other points lie farther out on every side
//        . * .
#pragma once

#include <algorithm>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "surfaces/cluster_set.h"
#include "view/camera/extremes.h"

namespace frontmost::streaming {

/// Calls visit(a, b, c) with the vertices of each finite triangle from `begin` to `end`.
template <class Visit>
void for_finite_triangles(const Mesh& mesh, std::size_t begin, std::size_t end, const Visit& visit) {
  for (std::size_t t = begin; t < end; ++t) {
    const glm::uvec3& corners = mesh.triangles[t];
    const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y], &c = mesh.positions[corners.z];
    if (is_finite(a) && is_finite(b) && is_finite(c)) visit(a, b, c);
  }
}

[[nodiscard]] inline Box finite_bounds(const Mesh& mesh, std::size_t begin, std::size_t end) {
  Box box;
  for_finite_triangles(mesh, begin, end, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    box.include(Box{glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  });
  return box;
}

class OutlineFinder {
 public:
  OutlineFinder(const View& direction, double margin)
      : extremes_(FilledFrustum(direction.world_from_eye, direction.projection, margin)) {}

  /// Includes the points of a mesh, but does not look at every vertex: a run of neighbouring triangles whose box would
  /// change nothing has no point of the outline.
  void include(const Mesh& mesh) {
    constexpr std::size_t run = 64;  // mostly neighbours in space, so few runs extend the outline
    const std::size_t count = mesh.triangles.size();
    // A few triangles from all over the piece go first. Otherwise, where a model grows from one end to the other, every
    // run would reach farther than the last, and all vertices would be examined.
    for (const std::size_t step : {64 * run, run})
      for (std::size_t begin = 0; begin < count; begin += step) include_corners(mesh, begin, begin + 1);
    for (std::size_t begin = 0; begin < count; begin += run) include_run(mesh, begin, std::min(begin + run, count));
  }
  void include(std::span<const glm::vec3> points) {
    for (const glm::vec3& point : points) include(point);
  }

  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// The points kept: no more than a few hundred.
  [[nodiscard]] std::vector<glm::vec3> points() const {
    if (bounds_.is_empty()) return {};
    std::vector<glm::vec3> points = extremes_.points();
    points.insert(points.end(), std::begin(ends_), std::end(ends_));
    return points;
  }
  /// The kept points as triangles without area. Surfaces of this scene have the model's bounds, and frame() returns the
  /// same view for them.
  [[nodiscard]] Scene scene() const {
    Scene scene;
    if (bounds_.is_empty()) return scene;
    Mesh& mesh = scene.meshes.emplace_back();
    scene.instances.emplace_back();
    mesh.positions = points();
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.triangles.emplace_back(i, i, i);
    return scene;
  }

 private:
  /// Examines a run in quarters, because mostly only a small part of the run extends the outline.
  void include_run(const Mesh& mesh, std::size_t begin, std::size_t end) {
    if (!may_change_by(finite_bounds(mesh, begin, end))) return;
    const std::size_t part = (end - begin + 3) / 4;
    if (part == 1) return include_corners(mesh, begin, end);
    for (; begin < end; begin += part) include_run(mesh, begin, std::min(begin + part, end));
  }

  /// False if no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const {
    if (box.is_empty()) return false;
    Box larger = bounds_;
    larger.include(box);
    return larger.low != bounds_.low || larger.high != bounds_.high || extremes_.may_change_by(box);
  }

  void include_corners(const Mesh& mesh, std::size_t begin, std::size_t end) {
    for_finite_triangles(mesh, begin, end, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
      for (const glm::vec3& point : {a, b, c}) include(point);
    });
  }

  void include(const glm::vec3& point) {
    extremes_.include(point);
    for (int k = 0; k < 3; ++k) {
      if (point[k] < bounds_.low[k]) ends_[k] = point;
      if (point[k] > bounds_.high[k]) ends_[3 + k] = point;
    }
    bounds_.include(point);
  }

  Extremes extremes_;
  Box bounds_;
  glm::vec3 ends_[6] = {};  ///< a point on each side of the bounds
};

}  // namespace frontmost::streaming
