// SPDX-License-Identifier: Apache-2.0
// Number of uses of each edge of a mesh, by brute force.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "frontmost/scene.h"

namespace frontmost::test {

struct EdgeUse {
  int forward = 0, backward = 0;  // from the lower to the higher vertex number, and back
};
using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, EdgeUse>;

inline Edges edges_of(const Mesh& mesh) {
  Edges edges;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      ++(a < b ? edges[{a, b}].forward : edges[{b, a}].backward);
    }
  return edges;
}

inline int boundary_count(const Mesh& mesh) {
  const Edges edges = edges_of(mesh);
  return int(std::count_if(edges.begin(), edges.end(),
                           [](const auto& e) { return e.second.forward + e.second.backward == 1; }));
}

// True if every edge is used at most once in each direction: a surface with consistent winding.
inline bool is_oriented_manifold(const Mesh& mesh) {
  const Edges edges = edges_of(mesh);
  return std::all_of(edges.begin(), edges.end(),
                     [](const auto& e) { return e.second.forward <= 1 && e.second.backward <= 1; });
}

// V - E + F over the vertices that triangles use.
inline int euler_characteristic(const Mesh& mesh) {
  std::set<std::uint32_t> used;
  for (const glm::uvec3& t : mesh.triangles) used.insert({t.x, t.y, t.z});
  return int(used.size()) - int(edges_of(mesh).size()) + int(mesh.triangles.size());
}

// Six times the enclosed volume; positive if faces look outwards.
inline double signed_volume(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum;
}

// The smallest cosine between a corner's normal and its triangle's own; below 0 a normal looks inwards.
inline double worst_normal(const Mesh& mesh) {
  double worst = 1;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3 corners = mesh.triangles[t];
    const glm::dvec3 a(mesh.positions[corners.x]), b(mesh.positions[corners.y]), c(mesh.positions[corners.z]);
    const glm::dvec3 flat = glm::normalize(glm::cross(b - a, c - a));
    for (int k = 0; k < 3; ++k)
      worst = std::min(worst, glm::dot(flat, glm::dvec3(mesh.normals.values[mesh.corners(mesh.normals, t)[k]])));
  }
  return worst;
}

}  // namespace frontmost::test
