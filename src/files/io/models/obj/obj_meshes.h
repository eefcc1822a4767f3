// SPDX-License-Identifier: Apache-2.0
// Turns the lists of an OBJ file, which all faces share, into meshes that own their values.
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

/// A polygon's contribution to its mesh beside the positions.
struct ObjFace {
  std::span<const glm::uvec3> triangles;                 ///< as indices of the corners
  const std::vector<std::uint32_t>&texcoords, &normals;  ///< one a corner; no_index: none
  std::uint32_t material;
};

class ObjMeshes {
 public:
  /// Starts a mesh.
  void begin(const Mesh&) { is_mixed_ = false; }
  /// Adds the attributes of the triangles that `mesh` just got. Indices are those of the pool until finish().
  void add(Mesh& mesh, const ObjFace& face);
  /// Gives each mesh its part of the pool. A single mesh gets the whole pool, in the file's order.
  void finish(Scene& scene, ObjPool pool);

 private:
  void add_material(Mesh& mesh, std::size_t triangles_before, std::uint32_t material);

  bool is_mixed_ = false;  ///< the current mesh has more than one material
};

}  // namespace frontmost
