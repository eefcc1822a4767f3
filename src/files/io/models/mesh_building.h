// SPDX-License-Identifier: Apache-2.0
// Helpers that build scenes: named objects, and polygons that are cut into triangles with face ids.
//
//   polygon 7 of the file: five corners  ->  three triangles, each with face id 7
#pragma once

#include <memory>
#include <vector>

#include "io/models/reader.h"

namespace frontmost {

/// Greatest number of objects, because each costs some hundred bytes, and a few bytes of text can start one.
inline constexpr std::size_t max_objects = std::size_t(1) << 20;

/// Adds an empty mesh and its one instance, both called `name`. The error names `place` if there are too many objects.
Mesh& add_object(Scene& scene, const std::string& name, const ModelSource& source, const std::string& place);

/// Cuts the polygons of a file into triangles. A polygon of n corners becomes n - 2 triangles, the same ones on every
/// machine. The object keeps its arrays from polygon to polygon, and counts the work of all polygons, so that hostile
/// files cannot make it slow.
class Triangulator {
 public:
  Triangulator();
  ~Triangulator();

  /// Returns triangles as indices of `corners`, in the polygon's winding. Correct for each simple polygon, convex or
  /// not, flat or nearly flat, and for outlines that touch themselves without crossing: at corners, along bridges to
  /// holes and islands, at spikes. Zero-area triangles appear only where corners coincide or are collinear. Polygons
  /// that cross themselves are covered somehow; small ones have the least area of wrong winding. Polygons without a
  /// direction (all corners collinear, or not finite), and the rest of a polygon that takes too long, become fans. The
  /// result is valid until the next call. Precondition: at least 3 corners.
  std::span<const glm::uvec3> operator()(std::span<const glm::vec3> corners);

 private:
  class Cutter;
  std::unique_ptr<Cutter> cutter_;
};

/// Adds polygons to a mesh as triangles.
class PolygonWriter {
 public:
  /// Cuts a polygon with `corners`, indices of `positions`, and adds its triangles and face ids to `mesh`. Indices out
  /// of range are kept; validate() finds them. Polygons with fewer than three corners add nothing, but count as faces.
  /// \returns the triangles as indices of `corners`, valid until the next call.
  std::span<const glm::uvec3> add(std::span<const std::uint32_t> corners, std::span<const glm::vec3> positions,
                                  Mesh& mesh);
  /// Starts another mesh, whose first face is 0.
  void restart() { face_ = 0; }
  /// Returns the number of polygons with fewer than three corners, over all meshes.
  [[nodiscard]] std::uint64_t skipped_count() const { return skipped_; }

 private:
  void remember_face(std::size_t triangles_before, Mesh& mesh) const;

  Triangulator triangulate_;
  std::vector<glm::vec3> polygon_;
  std::uint32_t face_ = 0;
  std::uint64_t skipped_ = 0;
};

/// Returns a warning for Scene::warnings about polygons that PolygonWriter skipped.
[[nodiscard]] std::string skipped_faces_warning(std::uint64_t count);

/// Converts a colour of a file, sRGB from 0 to 1, to a linear one. Alpha is linear in both. NaN counts as 1.
[[nodiscard]] glm::vec4 linear_color(const glm::vec4& srgb);

}  // namespace frontmost
