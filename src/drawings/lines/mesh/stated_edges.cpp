// SPDX-License-Identifier: Apache-2.0
// Meshes state edges by their own vertices, so an instance's edges are found by its vertices' numbers in the welded
// mesh. Lines that are no sides of triangles, as of wires beside a model, are no edges.
#include "lines/mesh/stated_edges.h"

#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "scene/edges.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kOffCircle = 0.01;  // share of the radius by which an end may leave its circle
constexpr std::size_t kStatedPerPart = 4096;

bool is_before(const glm::uvec2& a, const glm::uvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

/// Whether the edge has no length, or an end that is not finite.
bool is_none(const glm::uvec2& edge) { return edge.x == edge.y || edge.y == no_index; }

/// Whether the edges have their ends near the circle. Files may state anything. A section cuts an arc at two edges;
/// each of these keeps one end on the circle, and its other end lies on its chord, inside.
bool lies_on(const StatedCircle& circle, std::span<const glm::vec3> places) {
  constexpr int most_cut = 2;
  const double slack = kOffCircle * circle.radius;
  int cut = 0;
  return std::all_of(circle.edges.begin(), circle.edges.end(), [&](const glm::uvec2& edge) {
    int inside = 0;
    for (const std::uint32_t end : {edge.x, edge.y}) {
      const glm::dvec3 out = glm::dvec3(places[end]) - circle.centre;
      const double height = std::abs(glm::dot(out, circle.axis));
      const double away = glm::length(out - glm::dot(out, circle.axis) * circle.axis) - circle.radius;
      if (!(height + away <= slack)) return false;
      inside += height - away > slack;
    }
    cut += inside;
    return inside < 2 && cut <= most_cut;
  });
}

}  // namespace

StatedEdges::StatedEdges(const Scene& scene, const Buffer<std::uint32_t>& vertices, const Buffer<glm::uvec3>& triangles,
                         std::span<const glm::vec3> places, const Execution& execution) {
  const auto states_edges = [](const Mesh& mesh) { return !mesh.sharp_edges.empty() || !mesh.smooth_edges.empty(); };
  if (std::none_of(scene.meshes.begin(), scene.meshes.end(), states_edges)) return;
  std::vector<bool> is_covered(scene.instances.size(), false);
  std::vector<glm::uvec2> sharp;
  std::size_t vertex = 0, triangle = 0;
  bool is_any = false;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    check_cancelled(execution);
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto welded = [&](const glm::uvec2& edge) {
      const auto [low, high] = std::minmax(vertices[vertex + edge.x], vertices[vertex + edge.y]);
      return glm::uvec2(low, high);
    };
    const auto is_one_of = [&](const std::vector<glm::uvec2>& edges) {
      std::vector<glm::uvec2> own;
      for (const glm::uvec2& edge : edges) own.push_back(welded(edge));
      std::sort(own.begin(), own.end(), is_before);
      const auto is_side = [&](std::uint32_t a, std::uint32_t b) {
        return std::binary_search(own.begin(), own.end(), glm::uvec2(std::min(a, b), std::max(a, b)), is_before);
      };
      for (std::size_t t = 0; t < mesh.triangles.size() && !own.empty(); ++t) {
        const glm::uvec3& c = triangles[triangle + t];
        if (c.x != no_index && (is_side(c.x, c.y) || is_side(c.y, c.z) || is_side(c.z, c.x))) return true;
      }
      return false;
    };
    is_covered[i] = is_one_of(mesh.smooth_edges);
    if (is_covered[i] || is_one_of(mesh.sharp_edges)) {
      is_any = true;
      for (const glm::uvec2& edge : mesh.sharp_edges) sharp.push_back(welded(edge));
      for (const EdgeCircle& circle : mesh.edge_circles) {
        const std::optional<EdgeCircle> own = transformed(circle, instance.world_from_mesh);
        if (!own) break;  // nor is another circle of the instance one
        StatedCircle placed{own->centre, own->axis, own->radius, {}};
        for (std::uint32_t k = circle.first; k < circle.first + circle.count; ++k)
          placed.edges.push_back(welded(mesh.sharp_edges[k]));
        std::erase_if(placed.edges, is_none);
        if (lies_on(placed, places)) circles_.push_back(std::move(placed));
      }
    }
    vertex += mesh.positions.size();
    triangle += mesh.triangles.size();
  }
  if (!is_any) return;
  is_covered_ = std::move(is_covered);
  std::erase_if(sharp, is_none);
  const auto list = [&](std::size_t edge, const auto& add) { add(sharp[edge].x, sharp[edge].y); };
  set(places.size(), sharp.size(), list, execution);
}

void StatedEdges::add(std::span<const glm::uvec2> sharp, const Execution& execution) {
  if (sharp.empty()) return;
  const Buckets<std::uint32_t> before = std::move(higher_ends_);
  const auto list = [&](std::size_t source, const auto& add) {
    if (source < before.count()) {
      for (const std::uint32_t end : before[source]) add(source, end);
      return;
    }
    const glm::uvec2& edge = sharp[source - before.count()];
    add(std::min(edge.x, edge.y), std::max(edge.x, edge.y));
  };
  set(before.count(), before.count() + sharp.size(), list, execution);
}

template <class List>
void StatedEdges::set(std::size_t vertices, std::size_t sources, const List& list, const Execution& execution) {
  higher_ends_ = Buckets<std::uint32_t>(vertices, sources, list, execution);
  parallel_for(execution, vertices, kStatedPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) std::sort(higher_ends_[v].begin(), higher_ends_[v].end());
  });
}

}  // namespace frontmost::lines_detail
