// SPDX-License-Identifier: Apache-2.0
// Neighbours are paired from the table of corners, vertex by vertex: all sides to higher vertices are sorted by their
// other end, and exactly two that run against each other are neighbours. Anything else, as copies or sides of three
// triangles, counts as a border, because nothing smooth goes on there.
#include "rounds/smooth_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "lines/mesh/corner_table.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kCornersPerPart = 4096;
constexpr double kSixDigits = 2e-6;  // of the largest coordinate

Buffer<glm::dvec3> normals_of(const WeldedMesh& mesh, const Execution& execution) {
  Buffer<glm::dvec3> normals(mesh.triangles.size());
  parallel_for(execution, normals.size(), kCornersPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::dvec3 normal = normal_of(mesh, std::uint32_t(i));
      const double length = glm::length(normal);
      normals[i] = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0);
    }
  });
  return normals;
}

/// Fillers of T-junctions have no area, and would part what is whole.
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

/// A triangle's side at an edge, which is known by its lower vertex.
struct EdgeSide {
  std::uint32_t upper, triangle;
  std::uint8_t side;
  bool is_forward;  ///< the triangle runs from the lower vertex to the upper
};

void list_sides(const WeldedMesh& mesh, const CornerTable& table, std::uint32_t vertex, std::vector<EdgeSide>& sides) {
  sides.clear();
  for (const Corner& corner : table.at(vertex)) {
    const std::uint32_t next = corner.next(mesh), last = corner.last(mesh), k = corner.k();
    if (next > vertex) sides.push_back({next, corner.triangle(), std::uint8_t(k), true});
    if (last > vertex) sides.push_back({last, corner.triangle(), std::uint8_t((k + 2) % 3), false});
  }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.triangle < b.triangle;
  });
}

void pair_sides(const std::vector<EdgeSide>& sides, Buffer<glm::uvec3>& across) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].upper == sides[begin].upper) ++end;
    const EdgeSide &a = sides[begin], &b = sides[end - 1];
    const bool is_pair = end - begin == 2 && a.is_forward != b.is_forward;
    for (std::size_t i = begin; i < end; ++i) across[sides[i].triangle][sides[i].side] = no_index;
    if (!is_pair) continue;
    across[a.triangle][a.side] = b.triangle;
    across[b.triangle][b.side] = a.triangle;
  }
}

}  // namespace

SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution) {
  SmoothMesh result;
  result.mesh = weld(surfaces, execution);
  close_all_seams(result.mesh, execution);
  const WeldedMesh& mesh = result.mesh;
  result.normals = normals_of(mesh, execution);
  result.across = Buffer<glm::uvec3>(mesh.triangles.size());
  const CornerTable table(mesh, execution);
  parallel_for(execution, mesh.positions.size(), kCornersPerPart, [&](std::size_t begin, std::size_t end) {
    std::vector<EdgeSide> sides;
    for (std::size_t v = begin; v < end; ++v) {
      list_sides(mesh, table, std::uint32_t(v), sides);
      pair_sides(sides, result.across);
    }
  });
  const Box& box = surfaces.bounds();
  const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(box.low)), glm::abs(glm::dvec3(box.high)));
  if (!box.is_empty()) result.noise = kSixDigits * std::max({reach.x, reach.y, reach.z});
  return result;
}

}  // namespace frontmost::lines_detail
