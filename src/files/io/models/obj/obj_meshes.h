// SPDX-License-Identifier: Apache-2.0
// From the lists of an OBJ file, which all its faces share, to meshes that own what they use.
#pragma once

#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// The lists of the whole file.
struct ObjPool {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec4> colors;  ///< as many as positions, or none
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec3> normals;
};

/// What one polygon adds to its mesh beside the corners.
struct ObjFace {
  std::span<const glm::uvec3> triangles;                 ///< as numbers into the corners
  const std::vector<std::uint32_t>&texcoords, &normals;  ///< one per corner; no_index: none
  std::uint32_t material;
};

class ObjMeshes {
 public:
  /// Starts a mesh.
  void begin(const Mesh&) { is_mixed_ = false; }
  /// Adds what belongs to the triangles that `mesh` just got. Indices are those of the pool for now.
  void add(Mesh& mesh, const ObjFace& face);
  /// Gives every mesh the part of the pool that it uses. A single mesh gets all of it, in the file's order.
  void finish(Scene& scene, ObjPool pool);

 private:
  void add_material(Mesh& mesh, std::size_t triangles_before, std::uint32_t material);

  bool is_mixed_ = false;  ///< the current mesh has more than one material
};

}  // namespace frontmost
