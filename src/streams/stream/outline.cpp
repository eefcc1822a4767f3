// SPDX-License-Identifier: Apache-2.0
// Finds the outline of a piece without looking at every vertex. A run of 64 neighbouring triangles has a box. If that
// box adds nothing to what is known, the run has no point of the outline. A few triangles from all over the piece go
// first, so that much is known before the runs are tested.
#include "stream/outline.h"

#include <algorithm>

namespace frontmost::streaming {

OutlineFinder::OutlineFinder(const View& direction, double margin)
    : extremes_(FilledFrustum(direction.world_from_eye, direction.projection, margin)) {}

void OutlineFinder::include(const Mesh& mesh) {
  constexpr std::size_t run = 64;  // neighbours mostly, so few runs reach out and have their vertices examined
  const std::size_t count = mesh.triangles.size();
  // A few triangles from all over the piece go first. Otherwise, where a model grows from one end to the other, every
  // run would reach farther than the last, and all vertices would be examined.
  for (const std::size_t step : {64 * run, run})
    for (std::size_t begin = 0; begin < count; begin += step) include_corners(mesh, begin, begin + 1);
  for (std::size_t begin = 0; begin < count; begin += run) include_run(mesh, begin, std::min(begin + run, count));
}

/// Examines a run in quarters, because mostly a small part of it reaches out.
void OutlineFinder::include_run(const Mesh& mesh, std::size_t begin, std::size_t end) {
  if (!may_change_by(finite_bounds(mesh, begin, end))) return;
  const std::size_t part = (end - begin + 3) / 4;
  if (part == 1) return include_corners(mesh, begin, end);
  for (; begin < end; begin += part) include_run(mesh, begin, std::min(begin + part, end));
}

bool OutlineFinder::may_change_by(const Box& box) const {
  if (box.is_empty()) return false;
  Box larger = bounds_;
  larger.include(box);
  return larger.low != bounds_.low || larger.high != bounds_.high || extremes_.may_change_by(box);
}

void OutlineFinder::include_corners(const Mesh& mesh, std::size_t begin, std::size_t end) {
  for_finite_triangles(mesh, begin, end, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    for (const glm::vec3& point : {a, b, c}) include(point);
  });
}

void OutlineFinder::include(const glm::vec3& point) {
  extremes_.include(point);
  for (int k = 0; k < 3; ++k) {
    if (point[k] < bounds_.low[k]) ends_[k] = point;
    if (point[k] > bounds_.high[k]) ends_[3 + k] = point;
  }
  bounds_.include(point);
}

void OutlineFinder::include(std::span<const glm::vec3> points) {
  for (const glm::vec3& point : points) include(point);
}

std::vector<glm::vec3> OutlineFinder::points() const {
  if (bounds_.is_empty()) return {};
  std::vector<glm::vec3> points = extremes_.points();
  points.insert(points.end(), std::begin(ends_), std::end(ends_));
  return points;
}

Scene OutlineFinder::scene() const {
  Scene scene;
  if (bounds_.is_empty()) return scene;
  Mesh& mesh = scene.meshes.emplace_back();
  scene.instances.emplace_back();
  mesh.positions = points();
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.triangles.emplace_back(i, i, i);
  return scene;
}

}  // namespace frontmost::streaming
