// SPDX-License-Identifier: Apache-2.0
// Counts of a scene, mesh by mesh and object by object; and likely units of files that state none.
#include "frontmost/report.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "report/mesh_topology.h"

namespace frontmost {
namespace {

void add(Oddities& sum, const Oddities& odd) {
  sum.non_finite_triangles += odd.non_finite_triangles;
  sum.degenerate_triangles += odd.degenerate_triangles;
  sum.duplicate_triangles += odd.duplicate_triangles;
  sum.boundary_edges += odd.boundary_edges;
  sum.non_manifold_edges += odd.non_manifold_edges;
  sum.inconsistent_edges += odd.inconsistent_edges;
}

// Number of triangles of each material, in the order of material numbers.
std::vector<MaterialUse> materials_of(const Mesh& mesh, std::size_t material_count) {
  if (mesh.triangles.empty()) return {};
  if (mesh.material_ids.size() <= 1) return {{mesh.material_of(0), mesh.triangles.size()}};
  // Scenes usually have few materials, so counting beats sorting, unless the scene has more materials than the mesh
  // triangles.
  std::vector<MaterialUse> uses;
  if (material_count <= mesh.material_ids.size()) {
    std::vector<std::uint64_t> counts(material_count + 1, 0);
    for (const std::uint32_t id : mesh.material_ids) ++counts[id == no_index ? material_count : id];
    for (std::size_t i = 0; i <= material_count; ++i)
      if (counts[i] > 0) uses.push_back({i == material_count ? no_index : std::uint32_t(i), counts[i]});
    return uses;
  }
  std::vector<std::uint32_t> sorted = mesh.material_ids;
  std::sort(sorted.begin(), sorted.end());
  for (const std::uint32_t id : sorted) {
    if (uses.empty() || uses.back().material != id) uses.push_back({id, 0});
    ++uses.back().triangles;
  }
  return uses;
}

std::uint64_t face_count(const Mesh& mesh) {
  if (mesh.face_ids.empty()) return mesh.triangles.size();
  // The triangles of a polygon are consecutive.
  std::uint64_t faces = 1;
  for (std::size_t i = 1; i < mesh.face_ids.size(); ++i) faces += mesh.face_ids[i] != mesh.face_ids[i - 1];
  return faces;
}

MeshReport report_mesh(const Mesh& mesh, const Topology& topology, std::size_t material_count) {
  MeshReport report;
  report.name = mesh.name;
  report.triangles = mesh.triangles.size();
  report.vertices = mesh.positions.size();
  report.positions = topology.points.size();
  report.faces = face_count(mesh);
  report.has_normals = !mesh.normals.empty();
  report.has_texcoords = !mesh.texcoords.empty();
  report.has_colors = !mesh.colors.empty();
  report.materials = materials_of(mesh, material_count);
  report.odd = topology.odd;
  report.pieces = topology.pieces;
  report.shells = topology.shells;
  report.closed = topology.closed;
  report.genus = topology.genus;
  return report;
}

// The bounds of the points that stay finite in world space.
Box bounds_of(const std::vector<glm::vec3>& points, const glm::dmat4& world_from_mesh, const Execution& execution) {
  Box bounds;
  std::mutex mutex;
  parallel_for(execution, points.size(), std::size_t(1) << 16, [&](std::size_t begin, std::size_t end) {
    Box part;
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 p(world_from_mesh * glm::dvec4(glm::dvec3(points[i]), 1));
      if (is_finite(p)) part.include(p);
    }
    const std::lock_guard lock(mutex);
    bounds.include(part);
  });
  return bounds;
}

struct Measures {
  double area = 0, volume = 0;
};

/// Area and volume. Triangles are summed in blocks, so that the number of threads does not change the result. The
/// volume is that of tetrahedra with their tip in the middle of the bounds; other tips, far from the object, would
/// cause cancellation.
Measures measures_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const Box& bounds,
                     const Execution& execution) {
  constexpr std::size_t block = std::size_t(1) << 14;
  std::vector<Measures> sums((mesh.triangles.size() + block - 1) / block);
  const glm::dvec3 tip = (glm::dvec3(bounds.low) + glm::dvec3(bounds.high)) * 0.5;
  const auto world = [&](std::uint32_t vertex) {
    return glm::dvec3(world_from_mesh * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1));
  };
  parallel_for(execution, sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t t = b * block; t < std::min((b + 1) * block, mesh.triangles.size()); ++t) {
        const glm::uvec3& c = mesh.triangles[t];
        const glm::dvec3 p = world(c.x) - tip, q = world(c.y) - tip, r = world(c.z) - tip;
        const glm::dvec3 across = glm::cross(q - p, r - p);
        const double area = 0.5 * glm::length(across), volume = glm::dot(p, across) / 6;
        if (!std::isfinite(area) || !std::isfinite(volume)) continue;
        sums[b].area += area;
        sums[b].volume += volume;
      }
  });
  Measures all;
  for (const Measures& sum : sums) all = {all.area + sum.area, all.volume + sum.volume};
  return all;
}

double rounding_within(const Box& bounds) {
  if (bounds.is_empty()) return 0;
  float farthest = 0;
  for (int axis = 0; axis < 3; ++axis)
    farthest = std::max({farthest, std::abs(bounds.low[axis]), std::abs(bounds.high[axis])});
  return 0.5 * (double(farthest) - double(std::nextafter(farthest, 0.0f)));
}

MaterialReport report_material(const Material& material) {
  MaterialReport report;
  report.name = material.name;
  for (const TextureUse* use : texture_uses_of(material)) report.textures += use->is_set();
  report.alpha = material.alpha;
  report.double_sided = material.double_sided;
  return report;
}

glm::dvec3 unit(const glm::dvec4& v) {
  const glm::dvec3 direction(v);
  const double length = std::sqrt(glm::dot(direction, direction));
  return length > 0 ? direction / length : direction;
}

CameraReport report_camera(const Camera& camera) {
  CameraReport report;
  report.name = camera.name;
  report.position = glm::dvec3(camera.world_from_eye[3]);
  report.direction = unit(-camera.world_from_eye[2]);
  report.up = unit(camera.world_from_eye[1]);
  report.orthographic = camera.orthographic;
  report.vertical = camera.vertical;
  return report;
}

LightReport report_light(const Light& light) {
  LightReport report;
  report.name = light.name;
  report.kind = light.kind;
  report.position = glm::dvec3(light.world_from_light[3]);
  report.direction = unit(-light.world_from_light[2]);
  report.color = light.color;
  report.intensity = light.intensity;
  report.range = light.range;
  report.inner_cone = light.inner_cone;
  report.outer_cone = light.outer_cone;
  return report;
}

// Objects of one mesh need its points. Meshes are examined one after the other, so only one mesh's points are in
// memory.
void report_objects(const Scene& scene, const std::vector<std::uint32_t>& instances, const Topology& topology,
                    const Execution& execution, SceneReport& report) {
  for (const std::uint32_t i : instances) {
    const Instance& instance = scene.instances[i];
    const MeshReport& mesh = report.meshes[instance.mesh];
    report.objects[i] = {instance.name,
                         instance.mesh,
                         mesh.triangles,
                         bounds_of(topology.points, instance.world_from_mesh, execution),
                         0,
                         std::nullopt};
    const Measures measures =
        measures_of(scene.meshes[instance.mesh], instance.world_from_mesh, report.objects[i].bounds, execution);
    report.area += report.objects[i].area = measures.area;
    if (mesh.genus) {
      report.objects[i].volume = std::abs(measures.volume);
      report.volume = report.volume.value_or(0) + std::abs(measures.volume);
    }
    report.bounds.include(report.objects[i].bounds);
    report.triangles += mesh.triangles;
    for (const MaterialUse& use : mesh.materials)
      if (use.material != no_index) report.materials[use.material].triangles += use.triangles;
  }
}

constexpr double millimetre = 0.001, centimetre = 0.01, inch = 0.0254, metre = 1;

}  // namespace

SceneReport inspect(const Scene& scene, const Execution& execution) {
  validate(scene);
  SceneReport report;
  report.name = scene.name;
  report.up = scene.up;
  report.origin = scene.origin;
  report.texture_count = scene.textures.size();
  report.warnings = scene.warnings;
  for (const Material& material : scene.materials) report.materials.push_back(report_material(material));
  for (const Camera& camera : scene.cameras) report.cameras.push_back(report_camera(camera));
  for (const Light& light : scene.lights) report.lights.push_back(report_light(light));
  std::vector<std::vector<std::uint32_t>> instances(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) instances[scene.instances[i].mesh].push_back(i);
  report.objects.resize(scene.instances.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    report_progress(execution, "inspect", double(m) / double(scene.meshes.size()));
    const Topology topology = examine(scene.meshes[m], execution);
    report.meshes.push_back(report_mesh(scene.meshes[m], topology, scene.materials.size()));
    report.stored_triangles += report.meshes[m].triangles;
    report.vertices += report.meshes[m].vertices;
    add(report.odd, topology.odd);
    report_objects(scene, instances[m], topology, execution, report);
  }
  report.rounding = rounding_within(report.bounds);
  return report;
}

std::vector<double> likely_units(const Box& bounds) {
  if (bounds.is_empty()) return {};
  const glm::dvec3 size = glm::dvec3(bounds.high) - glm::dvec3(bounds.low);
  const double greatest = std::max({size.x, size.y, size.z});
  constexpr double least_part = 5, greatest_part = 2000, grain = 1, least_in_metres = 0.001;
  if (!(greatest >= least_in_metres && greatest <= greatest_part)) return {};
  if (greatest >= least_part) return {millimetre};
  if (greatest < grain) return {metre};
  return {centimetre, inch, metre};
}

}  // namespace frontmost
