// SPDX-License-Identifier: Apache-2.0
// From primitive ids to set-up triangles, and from these to the geometric data of each fragment.
#pragma once

#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "shade/batch.h"
#include "shade/bit_set.h"
#include "shade/geometry/smooth_normals.h"
#include "shade/geometry/triangle_setup.h"
#include "surfaces/cluster_set.h"

namespace frontmost::shading {

/// The set of primitives that hold a sample. Reuses `memory` for the result if its size fits. O(samples), in parallel.
[[nodiscard]] BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution,
                                     BitSet memory = {});

/// The set of the given ids. O(ids), in parallel.
[[nodiscard]] BitSet seen_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids,
                                     const Execution& execution, BitSet memory = {});

/// The set of primitives whose first samples cover three pixels in a row or around a corner. On smaller ones a smooth
/// normal hardly differs visibly from a flat one, so scans of millions of triangles are spared smoothing. Reuses
/// `memory` for the result if its size fits. O(pixels + primitives / 64), in parallel.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, const Visible& visible, const Execution& execution,
                                      BitSet memory = {});

/// large_primitives() for `ids` in rows of `width` pixels.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, int width,
                                      const Execution& execution, BitSet memory = {});

/// For every material of the scene, whether a seen triangle that is not in `known` has it. O(primitives / 64 + new
/// triangles).
[[nodiscard]] std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const BitSet& known);

/// A triangle to be set up, and its number in the batch.
struct NewTriangle {
  PrimitiveId id = no_primitive;
  std::uint16_t number = 0;
  glm::vec2 reference{0};  ///< a screen position on the triangle
};

/// View-independent data for setting up triangles: the placements of meshes, and smooth normals for meshes without
/// normals.
class TriangleStore {
 public:
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

  /// Borrows the surfaces and their scene. O(instances).
  explicit TriangleStore(const Surfaces& surfaces);

  /// Makes smooth normals for the large primitives of meshes without normals. The first call for a mesh makes only the
  /// requested ones. The second makes all normals of the mesh, since more requests are likely to follow.
  void smooth(const BitSet& large, const Execution& execution);

  /// Updates the placement of an instance that has moved.
  void follow(const Surfaces& surfaces, std::uint32_t instance);

  /// The placement that holds `id`; tries `guess` first.
  [[nodiscard]] const Placement& placement_with(PrimitiveId id, const Placement& guess) const;
  [[nodiscard]] const Placement& first_placement() const { return placements_.front(); }
  /// The smooth normals of a mesh: empty if the mesh has its own normals, or none were requested.
  [[nodiscard]] const PackedCornerNormals& smooth_normals_of(std::uint32_t mesh) const { return smooth_[mesh]; }

 private:
  void smooth_mesh(std::uint32_t mesh, const BitSet& large, const Execution& execution);

  const Scene& scene_;
  std::vector<Placement> placements_;             ///< by instance
  std::vector<std::vector<PrimitiveId>> firsts_;  ///< by mesh: the first primitive of each of its instances
  std::vector<PackedCornerNormals> smooth_;       ///< by mesh
  BitSet smoothed_;                               ///< primitives that have normals, the mesh's own or smooth ones
};

/// Sets up triangles with their attributes in world space, for one view.
class TriangleSource {
 public:
  /// Borrows `store` and `large`. Large primitives of meshes without normals are smooth, and the store must have their
  /// normals. Other primitives of these meshes are flat; all are if `large` is null.
  TriangleSource(const TriangleStore& store, const View& view, const BitSet* large)
      : rays_(view), large_(large), store_(store) {}

  /// Leaves out texture coordinates from now on, for pictures that do not need them.
  void leave_out_texcoords() { has_texcoords_ = false; }
  /// Fills setups[number] of each triangle. One call with many triangles is faster than many calls.
  void set_up(std::span<const NewTriangle> triangles, std::vector<TriangleSetup>& setups) const;
  [[nodiscard]] const ScreenRays& rays() const { return rays_; }

 private:
  using Placement = TriangleStore::Placement;

  void set_up(const NewTriangle& triangle, const Placement& placement, TriangleSetup& setup) const;
  void set_normals(PrimitiveId id, const Placement& placement, TriangleSetup& setup) const;
  void set_attributes(const Mesh& mesh, TriangleSetup& setup) const;

  ScreenRays rays_;
  const BitSet* large_;
  const TriangleStore& store_;
  bool has_texcoords_ = true;
};

/// Fills batch.geometry from batch.coverage, with the first set of texture coordinates. Fastest if the fragments of a
/// triangle are adjacent.
void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch,
                          Isa isa);

/// The fragments [begin, end) of a batch, and a set of texture coordinates.
struct TexcoordRequest {
  const std::vector<TriangleSetup>& setups;
  const Coverage& coverage;
  std::uint32_t set;
  int begin, end;
};
/// Fills `out` for these fragments, as interpolate_geometry() does for the first set; overwrites entries behind them.
void interpolate_texcoords(const TexcoordRequest& request, TexcoordLanes& out, Isa isa);

}  // namespace frontmost::shading
