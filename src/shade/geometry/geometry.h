// SPDX-License-Identifier: Apache-2.0
// From primitive ids to set-up triangles, and from those to what the geometry says of each fragment.
#pragma once

#include <span>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"
#include "shade/batch.h"
#include "shade/bit_set.h"
#include "shade/geometry/smooth_normals.h"
#include "shade/geometry/triangle_setup.h"
#include "shade/materials.h"
#include "surfaces/cluster_set.h"

namespace frontmost::shading {

/// Every primitive that holds a sample. O(samples), in parallel.
[[nodiscard]] BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution);

/// Every primitive whose first samples cover three pixels in a row or around a corner. On smaller ones a smooth
/// normal could hardly be told from a flat one: scans of millions of triangles are spared it.
/// O(pixels), in parallel.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, const Visible& visible, const Execution& execution);

/// For every material of the scene, whether one of the seen triangles has it.
[[nodiscard]] std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen,
                                               const Execution& execution);

/// A triangle that is to be set up as number `number`.
struct NewTriangle {
  PrimitiveId id = no_primitive;
  std::uint16_t number = 0;
  glm::vec2 reference{0};  ///< a screen position on the triangle
};

/// Sets up triangles with their attributes in world space.
class TriangleSource {
 public:
  /// Borrows `surfaces` and `large`; makes smooth normals for the large primitives of meshes that have none. Others of
  /// those meshes, and all of them with no `large`, stay flat.
  TriangleSource(const Surfaces& surfaces, const View& view, const BitSet* large, const Execution& execution);

  /// From now on no triangle has texture coordinates: for pictures that look at none.
  void leave_out_texcoords() { has_texcoords_ = false; }
  /// Fills setups[number] of each triangle. Many at once are quicker than one by one.
  void set_up(std::span<const NewTriangle> triangles, std::vector<TriangleSetup>& setups) const;
  [[nodiscard]] const ScreenRays& rays() const { return rays_; }

 private:
  struct Placement {
    std::uint32_t instance;
    PrimitiveId first;
    std::uint32_t count;
    const Mesh* mesh;
    std::uint32_t mesh_number;
    ToWorld world;
    glm::mat3 normal_matrix;  ///< takes normals to world space; any length
    bool is_mirrored;

    [[nodiscard]] bool holds(PrimitiveId id) const { return id - first < count; }  // wraps for ids below
  };

  static Placement placement_of(const Surfaces& surfaces, std::uint32_t number);
  [[nodiscard]] const Placement& placement_with(PrimitiveId id, const Placement& guess) const;
  void set_up(const NewTriangle& triangle, const Placement& placement, TriangleSetup& setup) const;
  void set_normals(PrimitiveId id, const Placement& placement, TriangleSetup& setup) const;
  void set_attributes(const Mesh& mesh, TriangleSetup& setup) const;

  ScreenRays rays_;
  const BitSet* large_;
  bool has_texcoords_ = true;
  std::vector<Placement> placements_;        ///< by instance
  std::vector<PackedCornerNormals> smooth_;  ///< by mesh; empty where the mesh has normals of its own or is not seen
};

/// Fills batch.geometry from batch.coverage.
void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch);

}  // namespace frontmost::shading
