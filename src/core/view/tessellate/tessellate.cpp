// SPDX-License-Identifier: Apache-2.0
// Curved meshes as triangles that are fine enough for one view: first the levels, so that limits are known, then
// triangles.
//
//   scene, view --Plan--> a level for every instance of a curved mesh --> one mesh for every pair of mesh and level
//                         count of triangles, or an error                 instances refer to theirs
//
// A model may place a sphere a thousand times at the same size; instances that need the same fineness share a mesh.

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "base/parallel.h"
#include "frontmost/view.h"
#include "scene/shapes.h"
#include "scene/validate.h"
#include "view/tessellate/level.h"

namespace frontmost {
namespace {

/// Some 3 GiB of mesh. A double, as the requested number may exceed all integers.
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

/// The triangles of a mesh at one level. Primitives that are never seen have no triangles.
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
    // A grid numbers its texture coordinates like its positions; behind spheres their numbers differ.
    const auto shift = std::uint32_t(mesh.texcoords.values.size() - mesh.positions.size());
    for (std::size_t t = before; t < mesh.triangles.size(); ++t)
      mesh.texcoords.triangles.push_back(mesh.triangles[t] + shift);
  }
  return mesh;
}

/// The fineness of each instance of a curved mesh, known before anything is made; instances that are alike share
/// meshes.
class Plan {
 public:
  using Key = std::pair<std::uint32_t, MeshLevel>;  ///< a mesh, and its level

  Plan(const Scene& scene, const View& view, double pixels) {
    if (!(pixels > 0))
      throw Error(ErrorCode::bad_argument, "tessellation error", std::to_string(pixels) + " pixels is not above 0");
    validate(scene);
    validate(view);
    const ScreenTolerance tolerance(view, pixels);
    for (const Instance& instance : scene.instances) {
      counts_.push_back(triangles_);
      keys_.emplace_back();
      if (!scene.meshes[instance.mesh].is_curved()) continue;
      const MeshLevel level = level_of(scene.meshes[instance.mesh], instance.world_from_mesh, tolerance);
      keys_.back().emplace(instance.mesh, level);
      if (seen_.insert(*keys_.back()).second) triangles_ += level.triangle_count();
      counts_.back() = triangles_;
    }
  }
  /// None if the instance's mesh is not curved.
  [[nodiscard]] const std::optional<Key>& key(std::size_t instance) const { return keys_[instance]; }
  [[nodiscard]] double triangle_count() const { return triangles_; }

  void check_limit(const Scene& scene) const {
    const auto over = std::find_if(counts_.begin(), counts_.end(), [](double n) { return !(n <= kMostTriangles); });
    if (over == counts_.end()) return;
    const auto instance = std::size_t(over - counts_.begin());
    throw Error(ErrorCode::limit_exceeded,
                place_in(scene) + "instance " + std::to_string(instance) + ", mesh " +
                    std::to_string(scene.instances[instance].mesh),
                "so small a tessellation error takes more than 2^26 triangles");
  }

 private:
  std::vector<std::optional<Key>> keys_;  ///< by instance
  std::vector<double> counts_;            ///< triangles made for it and the instances before
  std::set<Key> seen_;
  double triangles_ = 0;
};

/// Gives every instance of a curved mesh the tessellation that it needs.
class Tessellator {
 public:
  explicit Tessellator(const Scene& scene) : out_(scene), is_made_(scene.meshes.size()) {}

  void place(std::uint32_t number, const Plan::Key& key) {
    const auto [made, is_new] = made_.try_emplace(key, 0u);
    if (is_new) made->second = make(key);
    out_.instances[number].mesh = made->second;
  }
  [[nodiscard]] Scene take() { return std::move(out_); }

 private:
  /// The first level takes the place of the mesh itself.
  std::uint32_t make(const Plan::Key& key) {
    const auto& [mesh, level] = key;
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
  std::vector<bool> is_made_;                ///< of the scene's meshes
  std::map<Plan::Key, std::uint32_t> made_;  ///< number of the mesh made for a key
};

}  // namespace

double tessellated_count(const Scene& scene, const View& view, double pixels) {
  const IeeeScope ieee;
  return Plan(scene, view, pixels).triangle_count();
}

bool has_curved(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh < scene.meshes.size() && scene.meshes[instance.mesh].is_curved();
  });
}

Scene tessellate(const Scene& scene, const View& view, double pixels) {
  const IeeeScope ieee;
  const Plan plan(scene, view, pixels);
  plan.check_limit(scene);
  Tessellator tessellator(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    if (plan.key(i)) tessellator.place(i, *plan.key(i));
  return tessellator.take();
}

}  // namespace frontmost
