// SPDX-License-Identifier: Apache-2.0
#include "frontmost/tessellate.h"

#include <cmath>
#include <map>

#include "base/float_environment.h"
#include "scene/shapes.h"
#include "view/patch_grid.h"

namespace frontmost {
namespace {

constexpr double kMostTriangles = 1 << 26;

void append_globe(const Sphere& sphere, int rings, std::uint32_t face, Mesh& mesh) {
  const Mesh globe = frontmost::sphere(rings);
  const auto first = std::uint32_t(mesh.positions.size()), first_texcoord = std::uint32_t(mesh.texcoords.values.size());
  for (const glm::vec3& p : globe.positions) mesh.positions.emplace_back(sphere.centre + glm::dvec3(p) * sphere.radius);
  mesh.normals.values.insert(mesh.normals.values.end(), globe.normals.values.begin(), globe.normals.values.end());
  mesh.texcoords.values.insert(mesh.texcoords.values.end(), globe.texcoords.values.begin(),
                               globe.texcoords.values.end());
  for (const glm::uvec3& t : globe.triangles) mesh.triangles.push_back(t + first);
  for (const glm::uvec3& t : globe.texcoords.triangles) mesh.texcoords.triangles.push_back(t + first_texcoord);
  mesh.face_ids.resize(mesh.triangles.size(), face);
}

/// What is never seen has no triangles.
Mesh make_triangles(const Mesh& curved, const MeshLevel& level) {
  Mesh mesh;
  mesh.name = curved.name;
  mesh.material_ids = curved.material_ids;
  mesh.spheres = curved.spheres;
  mesh.patches = curved.patches;
  for (std::size_t i = 0; i < curved.spheres.size(); ++i)
    if (curved.spheres[i].radius > 0) append_globe(curved.spheres[i], level.rings[i], std::uint32_t(i), mesh);
  const std::vector<EdgeLevels> edges = edge_levels(curved.patches, level.patches);
  for (std::size_t i = 0; i < curved.patches.size(); ++i) {
    if (!is_finite(curved.patches[i])) continue;
    const std::size_t before = mesh.triangles.size();
    append_grid(curved.patches[i], level.patches[i], edges[i], std::uint32_t(curved.spheres.size() + i), mesh);
    // A grid numbers its texture coordinates as its positions; behind spheres they are elsewhere.
    const auto shift = std::uint32_t(mesh.texcoords.values.size() - mesh.positions.size());
    for (std::size_t t = before; t < mesh.triangles.size(); ++t)
      mesh.texcoords.triangles.push_back(mesh.triangles[t] + shift);
  }
  return mesh;
}

/// Gives every instance of a curved mesh the tessellation that it needs, and shares those that are alike.
class Tessellator {
 public:
  Tessellator(const Scene& scene, const ScreenTolerance& tolerance)
      : out_(scene), tolerance_(tolerance), is_made_(scene.meshes.size()) {}

  void place(std::uint32_t number) {
    Instance& instance = out_.instances[number];
    const std::uint32_t mesh = instance.mesh;
    if (!out_.meshes[mesh].is_curved()) return;
    const auto key = std::make_pair(mesh, level_of(out_.meshes[mesh], instance.world_from_mesh, tolerance_));
    const auto [made, is_new] = made_.try_emplace(key, 0u);
    if (is_new) made->second = make(number, mesh, key.second);
    instance.mesh = made->second;
  }
  [[nodiscard]] Scene take() { return std::move(out_); }

 private:
  /// The first takes the place of the mesh itself.
  std::uint32_t make(std::uint32_t instance, std::uint32_t mesh, const MeshLevel& level) {
    triangles_ += level.triangle_count();
    if (!(triangles_ <= kMostTriangles))
      throw Error(ErrorCode::limit_exceeded, out_.name + ": instance " + std::to_string(instance) + ", mesh " +
                                                 std::to_string(mesh) +
                                                 ": so small a tessellation error takes more than 2^26 triangles");
    Mesh triangles = make_triangles(out_.meshes[mesh], level);
    if (is_made_[mesh]) {
      out_.meshes.push_back(std::move(triangles));
      return std::uint32_t(out_.meshes.size() - 1);
    }
    is_made_[mesh] = true;
    out_.meshes[mesh] = std::move(triangles);
    return mesh;
  }

  Scene out_;
  const ScreenTolerance& tolerance_;
  double triangles_ = 0;
  std::vector<bool> is_made_;                                          ///< of the scene's meshes
  std::map<std::pair<std::uint32_t, MeshLevel>, std::uint32_t> made_;  ///< which mesh it became
};

}  // namespace

Scene tessellate(const Scene& scene, const View& view, double pixels) {
  if (!(pixels > 0))
    throw Error(ErrorCode::bad_argument, "tessellation error: " + std::to_string(pixels) + " pixels is not above 0");
  validate(scene);
  validate(view);
  const IeeeScope ieee;
  const ScreenTolerance tolerance(view, pixels);
  Tessellator tessellator(scene, tolerance);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) tessellator.place(i);
  return tessellator.take();
}

}  // namespace frontmost
