// SPDX-License-Identifier: Apache-2.0
// From primitive ids to set-up triangles, and from those to what the geometry says of each fragment.
#pragma once

#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"
#include "shade/batch.h"
#include "shade/bit_set.h"
#include "shade/materials.h"
#include "shade/smooth_normals.h"
#include "shade/triangle_setup.h"

namespace frontmost::shading {

/// Every primitive that holds a sample. O(samples), in parallel.
[[nodiscard]] BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution);

/// Every primitive whose first samples cover three pixels in a row or around a corner. On smaller ones a smooth
/// normal could hardly be told from a flat one: scans of millions of triangles are spared it.
/// O(pixels), in parallel.
[[nodiscard]] BitSet large_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution);

/// For every material of the scene, whether one of the seen triangles has it.
[[nodiscard]] std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen,
                                               const Execution& execution);

/// Sets up triangles with their attributes in world space.
class TriangleSource {
 public:
  /// Borrows `surfaces` and `large`; makes smooth normals for the large primitives of meshes that have none. Others of
  /// those meshes, and all of them with no `large`, stay flat.
  TriangleSource(const Surfaces& surfaces, const View& view, const BitSet* large, const Execution& execution);

  /// From now on no triangle has texture coordinates: for pictures that look at none.
  void leave_out_texcoords() { has_texcoords_ = false; }
  /// `reference` is a screen position on the triangle.
  void set_up(PrimitiveId id, const glm::vec2& reference, TriangleSetup& setup) const;
  [[nodiscard]] const ScreenRays& rays() const { return rays_; }

 private:
  struct Placement {
    glm::mat3 normal_matrix{1.0f};  ///< takes normals to world space; any length
    bool is_mirrored = false;
  };

  static Placement placement_of(const glm::dmat4& world_from_mesh);
  void set_normals(PrimitiveId id, TriangleSetup& setup) const;
  void set_attributes(TriangleSetup& setup) const;

  const Surfaces& surfaces_;
  ScreenRays rays_;
  const BitSet* large_;
  bool has_texcoords_ = true;
  std::vector<Placement> placements_;  ///< by instance
  std::vector<CornerNormals> smooth_;  ///< by mesh; empty where the mesh has normals of its own or is not seen
};

/// Fills batch.geometry from batch.coverage.
void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, Batch& batch);

}  // namespace frontmost::shading
