// SPDX-License-Identifier: Apache-2.0
// Triangles are neighbours where exactly two share an edge and run along it in opposite directions. Every other edge,
// as of copies or of three triangles, is a border: nothing smooth goes on across it.
#include "rounds/smooth_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;
constexpr double kSixDigits = 2e-6;  // of the largest coordinate

Buffer<glm::dvec3> normals_of(const WeldedMesh& mesh, const Execution& execution) {
  Buffer<glm::dvec3> normals(mesh.triangles.size());
  parallel_for(execution, normals.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::dvec3 normal = normal_of(mesh, std::uint32_t(i));
      const double length = glm::length(normal);
      normals[i] = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0);
    }
  });
  return normals;
}

/// Fillers of T-junctions have no area and would split smooth surfaces.
void close_all_seams(WeldedMesh& mesh, const Execution& execution) {
  Buffer<std::int8_t> may_be_flat(mesh.triangles.size());
  for (std::size_t i = 0; i < may_be_flat.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    const glm::dvec3 at = mesh.positions[t.x], p = mesh.positions[t.y] - at, q = mesh.positions[t.z] - at;
    const glm::dvec3 normal = glm::cross(p, q);
    may_be_flat[i] = glm::dot(normal, normal) > 1e-20 * glm::dot(p, p) * glm::dot(q, q);
  }
  static_cast<void>(close_seams(mesh, may_be_flat, execution));
}

}  // namespace

SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution) {
  SmoothMesh result;
  result.mesh = weld(surfaces, execution);
  close_all_seams(result.mesh, execution);
  const WeldedMesh& mesh = result.mesh;
  result.normals = normals_of(mesh, execution);
  result.neighbours = EdgeNeighbours({mesh.triangles.data(), mesh.triangles.size()}, mesh.positions.size(), execution);
  const Box& box = surfaces.bounds();
  const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(box.low)), glm::abs(glm::dvec3(box.high)));
  if (!box.is_empty()) result.noise = kSixDigits * std::max({reach.x, reach.y, reach.z});
  return result;
}

}  // namespace frontmost::lines_detail
