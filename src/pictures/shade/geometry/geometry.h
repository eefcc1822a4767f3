// SPDX-License-Identifier: Apache-2.0
// From primitive ids to set-up triangles, and from those to what the geometry says of each fragment.
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

/// Every primitive that holds a sample. O(samples), in parallel.
/// `memory` is that of the result, where it fits.
[[nodiscard]] BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution,
                                     BitSet memory = {});

/// The same of any ids. O(ids), in parallel.
[[nodiscard]] BitSet seen_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids,
                                     const Execution& execution, BitSet memory = {});

/// Every primitive whose first samples cover three pixels in a row or around a corner. On smaller ones a smooth
/// normal could hardly be told from a flat one: scans of millions of triangles are spared it.
/// O(pixels + primitives / 64), in parallel. `memory` is that of the result, where it fits.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, const Visible& visible, const Execution& execution,
                                      BitSet memory = {});

/// The same of `ids` in rows of `width` pixels.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, int width,
                                      const Execution& execution, BitSet memory = {});

/// For every material of the scene, whether one of the seen triangles has it that are not `known` yet.
/// O(primitives / 64 + new ones).
[[nodiscard]] std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const BitSet& known);

/// A triangle that is to be set up as number `number`.
struct NewTriangle {
  PrimitiveId id = no_primitive;
  std::uint16_t number = 0;
  glm::vec2 reference{0};  ///< a screen position on the triangle
};

/// What the triangles of surfaces are set up from in every view: where their meshes stand, and smooth normals for
/// meshes that have none.
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

  /// Makes smooth normals for the large primitives of meshes that have none. Those that were not asked for before are
  /// made alone the first time; whoever asks again will ask for more, so that the second time makes the whole mesh's.
  void smooth(const BitSet& large, const Execution& execution);

  /// Follows an instance to where it is now.
  void follow(const Surfaces& surfaces, std::uint32_t instance);

  /// The placement that holds `id`; `guess` is looked at first.
  [[nodiscard]] const Placement& placement_with(PrimitiveId id, const Placement& guess) const;
  [[nodiscard]] const Placement& first_placement() const { return placements_.front(); }
  /// Those of a mesh: empty where it has normals of its own, or none were asked for.
  [[nodiscard]] const PackedCornerNormals& smooth_normals_of(std::uint32_t mesh) const { return smooth_[mesh]; }

 private:
  void smooth_mesh(std::uint32_t mesh, const BitSet& large, const Execution& execution);

  const Scene& scene_;
  std::vector<Placement> placements_;             ///< by instance
  std::vector<std::vector<PrimitiveId>> firsts_;  ///< by mesh: the first primitive of each of its instances
  std::vector<PackedCornerNormals> smooth_;       ///< by mesh
  BitSet smoothed_;                               ///< primitives whose normals are there, the mesh's own or smooth ones
};

/// Sets up triangles with their attributes in world space, for one view.
class TriangleSource {
 public:
  /// Borrows `store` and `large`. The large primitives of meshes without normals are smooth, and the store has smooth
  /// normals for them; others of those meshes, and all of them with no `large`, stay flat.
  TriangleSource(const TriangleStore& store, const View& view, const BitSet* large)
      : rays_(view), large_(large), store_(store) {}

  /// From now on no triangle has texture coordinates: for pictures that look at none.
  void leave_out_texcoords() { has_texcoords_ = false; }
  /// Fills setups[number] of each triangle. Many at once are quicker than one by one.
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

/// Fills batch.geometry from batch.coverage, with the first set of texture coordinates. Quickest where the fragments of
/// a triangle lie together.
void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch,
                          Isa isa);

/// Fragments [begin, end) of a batch, and a set of the texture coordinates of their triangles.
struct TexcoordRequest {
  const std::vector<TriangleSetup>& setups;
  const Coverage& coverage;
  std::uint32_t set;
  int begin, end;
};
/// Fills `out` of these fragments as interpolate_geometry() does for the first set; what it holds behind them is lost.
void interpolate_texcoords(const TexcoordRequest& request, TexcoordLanes& out, Isa isa);

}  // namespace frontmost::shading
