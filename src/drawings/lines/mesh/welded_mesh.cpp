// SPDX-License-Identifier: Apache-2.0
//    vertices of all instances --places--> first at each place --counted in parts--> numbers of places
//    triangles of all instances --------------- by these numbers --------------> triangles, without those that collapse
//
// All lists are counted in parts before they are written, so no list grows and no thread waits.
#include "lines/mesh/welded_mesh.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "geometry/places.h"
#include "lines/mesh/corner_table.h"
#include "surfaces/cluster_set.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kPerPart = 8192;

/// Calls visit(instance, first, last) for the pieces of the range from `begin` to `end` within each instance. The range
/// counts over all instances; `firsts` are the instances' first numbers, followed by the count of all.
template <class Visitor>
void visit_instances(const std::vector<std::size_t>& firsts, std::size_t begin, std::size_t end, const Visitor& visit) {
  auto i = std::size_t(std::upper_bound(firsts.begin(), firsts.end(), begin) - firsts.begin()) - 1;
  for (; begin < end; ++i) {
    const std::size_t last = std::min(end, firsts[i + 1]);
    if (begin < last) visit(i, begin - firsts[i], last - firsts[i]);
    begin = last;
  }
}

template <class Size>
std::vector<std::size_t> firsts_of(const Scene& scene, const Size& size) {
  std::vector<std::size_t> firsts{0};
  firsts.reserve(scene.instances.size() + 1);
  for (const Instance& instance : scene.instances) firsts.push_back(firsts.back() + size(scene.meshes[instance.mesh]));
  return firsts;
}

/// The number of kept items before each part, and at the end the number of all.
template <class IsKept>
std::vector<std::size_t> counted(std::size_t count, const IsKept& is_kept, const Execution& execution) {
  std::vector<std::size_t> before((count + kPerPart - 1) / kPerPart + 1, 0);
  parallel_for(execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t kept = 0;
    for (std::size_t i = begin; i < end; ++i) kept += is_kept(i);
    before[begin / kPerPart + 1] = kept;
  });
  for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
  return before;
}

Buffer<glm::vec3> places_of(const Scene& scene, const Execution& execution) {
  const std::vector<std::size_t> firsts = firsts_of(scene, [](const Mesh& mesh) { return mesh.positions.size(); });
  if (firsts.back() >= std::size_t(1) << 31)
    throw Error(ErrorCode::limit_exceeded, "lines", "more than 2147483647 vertices over all instances");
  Buffer<glm::vec3> places(firsts.back());
  parallel_for(execution, places.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    visit_instances(firsts, begin, end, [&](std::size_t i, std::size_t first, std::size_t last) {
      const std::vector<glm::vec3>& positions = scene.meshes[scene.instances[i].mesh].positions;
      const ToWorld to_world(scene.instances[i].world_from_mesh);
      for (std::size_t v = first; v < last; ++v) places[firsts[i] + v] = to_world(positions[v]) + 0.0f;  // -0 is 0
    });
  });
  return places;
}

/// By vertex of all instances, the number of its place; fills `positions`.
Buffer<std::uint32_t> number_places(const Scene& scene, Positions& positions, const Execution& execution) {
  const Buffer<glm::vec3> places = places_of(scene, execution);
  const Buffer<std::uint32_t> first = first_at_place({places.data(), places.size()}, execution);
  Buffer<std::uint32_t> numbers(places.size());
  const auto is_first = [&](std::size_t v) { return first[v] == v && is_finite(places[v]); };
  const std::vector<std::size_t> before = counted(places.size(), is_first, execution);
  Buffer<glm::vec3> kept(before.back());
  parallel_for(execution, places.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t next = before[begin / kPerPart];
    for (std::size_t v = begin; v < end; ++v) {
      if (!is_first(v)) continue;
      kept[next] = places[v];
      numbers[v] = std::uint32_t(next++);
    }
  });
  parallel_for(execution, places.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (!is_first(v)) numbers[v] = first[v] == v ? no_index : numbers[first[v]];
  });
  positions = Positions(std::move(kept));
  return numbers;
}

/// By primitive, its three place numbers; the first is no_index if the primitive is left out.
Buffer<glm::uvec3> corners_of(const Surfaces& surfaces, const Buffer<std::uint32_t>& numbers,
                              const Execution& execution) {
  const Scene& scene = surfaces.scene();
  const std::vector<std::size_t> vertices = firsts_of(scene, [](const Mesh& mesh) { return mesh.positions.size(); });
  const std::vector<std::size_t> firsts = firsts_of(scene, [](const Mesh& mesh) { return mesh.triangles.size(); });
  if (firsts.back() > Corner::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "lines",
                "more than " + std::to_string(Corner::most_triangles) + " triangles over all instances");
  Buffer<glm::uvec3> all(firsts.back());
  parallel_for(execution, all.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    visit_instances(firsts, begin, end, [&](std::size_t i, std::size_t first, std::size_t last) {
      const std::vector<glm::uvec3>& triangles = scene.meshes[scene.instances[i].mesh].triangles;
      const bool is_mirrored = surfaces.is_mirrored(std::uint32_t(i));
      for (std::size_t t = first; t < last; ++t) {
        glm::uvec3 c;
        for (int k = 0; k < 3; ++k) c[k] = numbers[vertices[i] + triangles[t][is_mirrored && k > 0 ? 3 - k : k]];
        if (c.y == no_index || c.z == no_index || c.x == c.y || c.y == c.z || c.z == c.x) c.x = no_index;
        all[firsts[i] + t] = c;
      }
    });
  });
  return all;
}

}  // namespace

WeldedMesh weld(const Surfaces& surfaces, const Execution& execution) {
  WeldedMesh welded;
  const Buffer<std::uint32_t> numbers = number_places(surfaces.scene(), welded.positions, execution);
  Buffer<glm::uvec3> all = corners_of(surfaces, numbers, execution);
  const auto is_kept = [&](std::size_t id) { return all[id].x != no_index; };
  const std::vector<std::size_t> before = counted(all.size(), is_kept, execution);
  welded.ids = Buffer<PrimitiveId>(before.back());
  const bool keeps_all = before.back() == all.size();
  if (!keeps_all) welded.triangles = Buffer<glm::uvec3>(before.back());
  parallel_for(execution, all.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t next = before[begin / kPerPart];
    for (std::size_t id = begin; id < end; ++id) {
      if (!is_kept(id)) continue;
      if (!keeps_all) welded.triangles[next] = all[id];
      welded.ids[next++] = PrimitiveId(id);
    }
  });
  if (keeps_all) welded.triangles = std::move(all);
  return welded;
}

}  // namespace frontmost::lines_detail
