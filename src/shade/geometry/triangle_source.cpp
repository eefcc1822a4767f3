// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/prefetch.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {
namespace {

float dot3(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Whatever its length: scaled first, so that squares of large and small ones stay finite. Zero when it has none.
glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float size = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  if (!(size > 0 && size < std::numeric_limits<float>::infinity())) return glm::vec3(0);
  const glm::vec3 scaled = v / size;
  const float length = std::sqrt(dot3(scaled, scaled));
  return length > 0 ? scaled / length : glm::vec3(0);  // false for NaN
}

bool lacks_normals(const Mesh& mesh) { return mesh.normals.empty(); }

}  // namespace

TriangleSource::TriangleSource(const Surfaces& surfaces, const View& view, const BitSet* large,
                               const Execution& execution)
    : rays_(view), large_(large), smooth_(surfaces.scene().meshes.size()) {
  const Scene& scene = surfaces.scene();
  std::vector<std::vector<PrimitiveId>> first_of_mesh(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    placements_.push_back(placement_of(surfaces, i));
    first_of_mesh[scene.instances[i].mesh].push_back(surfaces.first_primitive(i));
  }
  if (!large) return;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (!lacks_normals(scene.meshes[m]) || first_of_mesh[m].empty()) continue;
    const auto is_large = [&](std::uint32_t triangle) {
      for (const PrimitiveId first : first_of_mesh[m])
        if (large->contains(first + triangle)) return true;
      return false;
    };
    smooth_[m] = smooth_normals(scene.meshes[m], is_large, execution);
  }
}

TriangleSource::Placement TriangleSource::placement_of(const Surfaces& surfaces, std::uint32_t number) {
  const Instance& instance = surfaces.scene().instances[number];
  const Mesh& mesh = surfaces.scene().meshes[instance.mesh];
  // The cofactors are the inverse transpose times the determinant, and exist for singular matrices too.
  const glm::dmat3 m(instance.world_from_mesh);
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const bool is_mirrored = glm::dot(m[0], cofactors[0]) < 0;
  double size = 0;
  for (int k = 0; k < 9; ++k) size = std::max(size, std::abs(cofactors[k / 3][k % 3]));
  const double scale = (is_mirrored ? -1 : 1) / (size > 0 ? size : 1);
  return {number,        surfaces.first_primitive(number),  std::uint32_t(mesh.triangles.size()), &mesh,
          instance.mesh, ToWorld(instance.world_from_mesh), glm::mat3(cofactors * scale),         is_mirrored};
}

const TriangleSource::Placement& TriangleSource::placement_with(PrimitiveId id, const Placement& guess) const {
  if (guess.holds(id)) return guess;
  const auto starts_after = [](PrimitiveId wanted, const Placement& p) { return wanted < p.first; };
  return *(std::upper_bound(placements_.begin(), placements_.end(), id, starts_after) - 1);
}

void TriangleSource::set_up(std::span<const NewTriangle> triangles, std::vector<TriangleSetup>& setups) const {
  if (triangles.empty()) return;
  // What neighbours on the screen need is often far apart in memory, so that all of it is asked for first: corner
  // numbers, then the positions that they lead to.
  const Placement* placement = &placements_.front();
  for (const NewTriangle& t : triangles) {
    placement = &placement_with(t.id, *placement);
    prefetch_line(&placement->mesh->triangles[t.id - placement->first]);
    const PackedCornerNormals& smooth = smooth_[placement->mesh_number];
    if (!smooth.empty()) prefetch_line(&smooth[t.id - placement->first]);
  }
  for (const NewTriangle& t : triangles) {
    placement = &placement_with(t.id, *placement);
    const glm::uvec3& corners = placement->mesh->triangles[t.id - placement->first];
    for (int k = 0; k < 3; ++k) prefetch_line(&placement->mesh->positions[corners[k]]);
  }
  for (const NewTriangle& t : triangles) {
    placement = &placement_with(t.id, *placement);
    set_up(t, *placement, setups[t.number]);
  }
}

void TriangleSource::set_up(const NewTriangle& triangle, const Placement& placement, TriangleSetup& setup) const {
  const Mesh& mesh = *placement.mesh;
  setup.id = triangle.id;
  setup.instance = placement.instance;
  setup.mesh = placement.mesh_number;
  setup.triangle = triangle.id - placement.first;
  setup.material = mesh.material_of(setup.triangle);
  const glm::uvec3& c = mesh.triangles[setup.triangle];
  const std::array<glm::vec3, 3> corners{placement.world(mesh.positions[c.x]), placement.world(mesh.positions[c.y]),
                                         placement.world(mesh.positions[c.z])};
  set_up_plane(setup, rays_, corners, triangle.reference);
  if (placement.is_mirrored) setup.is_backside = !setup.is_backside;
  set_normals(triangle.id, placement, setup);
  set_attributes(mesh, setup);
}

void TriangleSource::set_normals(PrimitiveId id, const Placement& placement, TriangleSetup& setup) const {
  const Mesh& mesh = *placement.mesh;
  if (lacks_normals(mesh) && !(large_ && large_->contains(id))) {
    setup.normal.fill(setup.plane_normal);
    setup.is_smooth = false;
    return;
  }
  const glm::mat3& normal_matrix = placement.normal_matrix;
  glm::vec3 sum(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 own = lacks_normals(mesh) ? unpack(smooth_[setup.mesh][setup.triangle][k])
                                              : mesh.normals.values[mesh.corners(mesh.normals, setup.triangle)[int(k)]];
    setup.normal[k] = unit_or_zero(normal_matrix * own);
    sum += setup.normal[k];
  }
  // All three are turned together to the side that is seen, whatever the winding says; a single one may lean away.
  const bool turned = dot3(sum, setup.plane_normal) < 0;
  setup.is_smooth = false;
  for (glm::vec3& n : setup.normal) {
    if (turned) n = -n;
    if (n == glm::vec3(0)) n = setup.plane_normal;
    setup.is_smooth = setup.is_smooth || dot3(n, setup.plane_normal) < 0.99999f;
  }
}

void TriangleSource::set_attributes(const Mesh& mesh, TriangleSetup& setup) const {
  setup.has_texcoord = has_texcoords_ && !mesh.texcoords.empty();
  setup.has_color = !mesh.colors.empty();
  for (int k = 0; k < 3; ++k) {
    const auto corner = std::size_t(k);
    setup.texcoord[corner] =
        setup.has_texcoord ? mesh.texcoords.values[mesh.corners(mesh.texcoords, setup.triangle)[k]] : glm::vec2(0);
    setup.color[corner] =
        setup.has_color ? mesh.colors.values[mesh.corners(mesh.colors, setup.triangle)[k]] : glm::vec4(1);
  }
}

}  // namespace frontmost::shading
