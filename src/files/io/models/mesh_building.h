// SPDX-License-Identifier: Apache-2.0
// What readers build scenes with: named objects, and polygons that become triangles and are remembered.
//
//   polygon 7 of the file: five corners  ->  three triangles, each with face id 7
#pragma once

#include <vector>

#include "io/models/polygons/triangulate.h"
#include "io/models/reader.h"

namespace frontmost {

/// More objects than this are refused: each costs some hundred bytes, and a few bytes of text can start one.
inline constexpr std::size_t max_objects = std::size_t(1) << 20;

/// Adds an empty mesh and its one instance, both called `name`. `place` is for the message when there are too many.
Mesh& add_object(Scene& scene, const std::string& name, const ModelSource& source, const std::string& place);

/// Adds polygons to a mesh.
class PolygonWriter {
 public:
  /// Cuts a polygon with `corners`, numbers into `positions`, and adds its triangles and face ids to `mesh`.
  /// Numbers out of range are kept for validate() to find. Polygons of less than three corners add nothing, but are
  /// counted as faces. \returns the triangles as numbers into `corners`, valid until the next call.
  std::span<const glm::uvec3> add(std::span<const std::uint32_t> corners, std::span<const glm::vec3> positions,
                                  Mesh& mesh);
  /// Starts another mesh, with face 0.
  void restart() { face_ = 0; }
  /// How many polygons had less than three corners, over all meshes.
  [[nodiscard]] std::uint64_t skipped_count() const { return skipped_; }

 private:
  void remember_face(std::size_t triangles_before, Mesh& mesh) const;

  Triangulator triangulate_;
  std::vector<glm::vec3> polygon_;
  std::uint32_t face_ = 0;
  std::uint64_t skipped_ = 0;
};

/// Colours in files are sRGB, from 0 to 1; scenes hold linear ones. Alpha is linear in both. NaN counts as 1.
[[nodiscard]] glm::vec4 linear_color(const glm::vec4& srgb);

}  // namespace frontmost
