// SPDX-License-Identifier: Apache-2.0
// Writers of model files, as save() calls them. The given file is empty and stays open.
#pragma once

#include "base/output_file.h"
#include "frontmost/files.h"
#include "frontmost/scene.h"

namespace frontmost::detail {

/// One object's triangles in the file's coordinates. Triangles of mirrored objects get the opposite winding, so that
/// their outer side stays outside.
class PlacedMesh {
 public:
  PlacedMesh(const Scene& scene, const Instance& instance)
      : mesh_(scene.meshes[instance.mesh]),
        place_(instance.world_from_mesh),
        origin_(scene.origin),
        is_mirrored_(glm::determinant(glm::dmat3(place_)) < 0) {}

  [[nodiscard]] std::size_t vertex_count() const { return mesh_.positions.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return mesh_.triangles.size(); }
  [[nodiscard]] glm::dvec3 vertex(std::size_t i) const {
    return origin_ + glm::dvec3(place_ * glm::dvec4(mesh_.positions[i], 1));
  }
  [[nodiscard]] glm::uvec3 corners(std::size_t triangle) const {
    const glm::uvec3& c = mesh_.triangles[triangle];
    return is_mirrored_ ? glm::uvec3(c.x, c.z, c.y) : c;
  }

 private:
  const Mesh& mesh_;
  const glm::dmat4& place_;
  glm::dvec3 origin_;
  bool is_mirrored_;
};

void write_ply(const Scene& scene, const Table& of_triangles, OutputFile& file);
void write_stl(const Scene& scene, OutputFile& file);
void write_glb(const Scene& scene, OutputFile& file);

}  // namespace frontmost::detail
