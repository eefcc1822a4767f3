// SPDX-License-Identifier: Apache-2.0
// Triangles of a scene and their attributes at fragments.
//
//   ids of a picture --> seen, large primitives --> smooth normals    (TriangleStore, view-independent)
//                                                        |
//   triangles of a tile --> TriangleSetup: corners, weights, attributes    (TriangleSource, for one view)
//                                |
//   fragments of a batch --> positions, normals, texture coordinates, colours    (interpolate_geometry)
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "shade/batch.h"
#include "surfaces/cluster_set.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// A set of numbers to which many threads may add at once. The result does not depend on their order.
class BitSet {
 public:
  BitSet() = default;
  explicit BitSet(std::size_t size) : words_((size + 63) / 64) {}

  void add(std::size_t i) {
    const std::uint64_t bit = std::uint64_t(1) << (i % 64);
    std::atomic<std::uint64_t>& word = words_[i / 64];
    // Most numbers are added many times; reading first keeps the cache line shared.
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] bool contains(std::size_t i) const {
    return (words_[i / 64].load(std::memory_order_relaxed) >> (i % 64)) & 1;
  }
  /// Whether the set contains all of `other`, which has the same size. Not while threads add to either.
  [[nodiscard]] bool holds(const BitSet& other) const {
    std::uint64_t missing = 0;
    for (std::size_t w = 0; w < words_.size(); ++w)
      missing |= other.words_[w].load(std::memory_order_relaxed) & ~words_[w].load(std::memory_order_relaxed);
    return missing == 0;
  }
  /// Calls visit(i), in ascending order, for every number in this set that `known`, of the same size, lacks. Not while
  /// threads add to either.
  template <class Visit>
  void visit_new(const BitSet& known, const Visit& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      const std::uint64_t old = known.words_[w].load(std::memory_order_relaxed);
      for (std::uint64_t left = words_[w].load(std::memory_order_relaxed) & ~old; left != 0; left &= left - 1)
        visit(64 * w + std::size_t(std::countr_zero(left)));
    }
  }
  /// Adds all numbers of `other`, which has the same size.
  void add_all(const BitSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w)
      words_[w].fetch_or(other.words_[w].load(std::memory_order_relaxed), std::memory_order_relaxed);
  }
  /// Empties the set, for numbers below `size`. Allocates nothing if the size is unchanged.
  void clear(std::size_t size) {
    if (words_.size() != (size + 63) / 64) words_ = std::vector<std::atomic<std::uint64_t>>((size + 63) / 64);
    for (std::atomic<std::uint64_t>& word : words_) word.store(0, std::memory_order_relaxed);
  }

 private:
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// Returns the set of the given ids. Reuses `memory` for the result if its size fits. O(ids), in parallel.
[[nodiscard]] BitSet seen_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids,
                                     const Execution& execution, BitSet memory = {});

/// Returns the set of primitives that cover three pixels in a row or around a corner. `ids` are those of the pixels, in
/// rows of `width`. On smaller primitives a smooth normal hardly looks different from a flat one, so scans of millions
/// of triangles need no smoothing. Reuses `memory` for the result if its size fits. O(pixels + primitives / 64), in
/// parallel.
[[nodiscard]] BitSet large_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, int width,
                                      const Execution& execution, BitSet memory = {});
/// Returns large_primitives() of the first samples.
[[nodiscard]] inline BitSet large_primitives(std::size_t primitive_count, const Visible& visible,
                                             const Execution& execution, BitSet memory = {}) {
  return large_primitives(primitive_count, {visible.primitives.data(), visible.view.pixel_count()}, visible.view.width,
                          execution, std::move(memory));
}

/// Returns, for every material of the scene, whether a triangle that is in `seen` but not in `known` has it.
/// O(primitives / 64 + new triangles).
[[nodiscard]] std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const BitSet& known);

/// A value that is affine in the screen position, relative to a reference point.
struct Affine {
  float at_reference = 0, step_x = 0, step_y = 0;
};

/// The values of a triangle that fragments interpolate stand first, in groups of four numbers: kernels read whole
/// groups.
struct TriangleSetup {
  std::array<Affine, 3> weight;  ///< barycentric weights; their sum at the reference is 1
  glm::vec2 reference{0};        ///< a screen position on the triangle
  bool is_smooth = false;        ///< the corner normals differ from the plane's
  bool is_backside = false;      ///< by its winding, the triangle shows its back
  bool has_color = false;
  std::array<glm::vec3, 3> corner;  ///< world axes, relative to the eye
  glm::vec3 plane_normal{0};        ///< unit, towards the viewer
  std::array<glm::vec3, 3> normal;  ///< at the corners: world axes, unit, on the viewer's side
  PrimitiveId id = no_primitive;
  std::uint32_t instance = no_index, mesh = no_index;
  std::array<glm::vec4, 3> color;
  std::array<std::array<glm::vec2, 3>, max_texcoord_sets> texcoord;  ///< by set; zero if it is missing
  std::array<bool, max_texcoord_sets> has_texcoord{};                ///< by set
  std::uint32_t triangle = no_index;
  std::uint32_t material = no_index;  ///< number in the scene
  std::array<glm::vec3, 3> corner_world;
};

/// Fills weights, reference, corners, plane normal, and is_backside (for a triangle that was not mirrored). If the
/// triangle is seen edge-on or a result is not finite, the weights are equal everywhere.
void set_up_plane(TriangleSetup& setup, const ScreenRays& rays, const std::array<glm::vec3, 3>& corners_world,
                  const glm::vec2& reference);

/// The weights of the corners at a screen position. None is negative and they sum to 1, so interpolation stays within
/// the triangle. `divisor` is their sum before normalization, which gradients need.
struct Barycentric {
  glm::vec3 weight;
  float divisor;
};
[[nodiscard]] inline Barycentric barycentric(const TriangleSetup& t, float x, float y) {
  const float dx = x - t.reference.x, dy = y - t.reference.y;
  glm::vec3 w;
  for (int k = 0; k < 3; ++k) {
    const Affine& a = t.weight[std::size_t(k)];
    const float value = a.at_reference + dx * a.step_x + dy * a.step_y;
    w[k] = value > 0.0f ? value : 0.0f;
  }
  const float sum = w.x + w.y + w.z;
  const bool valid = sum > 1e-30f;
  const float scale = valid ? 1.0f / sum : 0.0f;
  const float rest = valid ? 0.0f : 1.0f / 3;
  return {{w.x * scale + rest, w.y * scale + rest, w.z * scale + rest}, valid ? sum : 1.0f};
}

/// A direction in 4 bytes, by the octahedral mapping to a square. The error is about 0.003 degrees.
struct PackedNormal {
  std::int16_t x = 0, y = 0;
};
[[nodiscard]] PackedNormal pack(const glm::vec3& direction);
/// Returns the direction, which is not normalized.
[[nodiscard]] glm::vec3 unpack(PackedNormal packed);

/// Facets that meet at a larger angle keep an edge between them.
inline constexpr double crease_cosine = 0.766044443118978;  // 40 degrees

/// Corner normals in mesh space, three for each triangle. Normals of triangles that were not requested are undefined.
using PackedCornerNormals = Buffer<std::array<PackedNormal, 3>>;

/// Returns a normal for each corner of the triangles for which `is_wanted` is true: the mean of the facet normals at
/// the corner's exact position, weighted by area and by the angle at the corner. Only facets within the crease angle of
/// the corner's own facet count. Degenerate facets do not count, and their own normals are arbitrary. O(triangles).
[[nodiscard]] PackedCornerNormals smooth_normals(const Mesh& mesh, const std::function<bool(std::uint32_t)>& is_wanted,
                                                 const Execution& execution = {});

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
    glm::mat3 normal_matrix;  ///< turns normals to world space; their length changes
    bool is_mirrored;

    /// The difference wraps around for ids below `first`.
    [[nodiscard]] bool holds(PrimitiveId id) const { return id - first < count; }
  };

  /// Borrows the surfaces and their scene. O(instances).
  explicit TriangleStore(const Surfaces& surfaces);

  /// Makes smooth normals for the large primitives of meshes without normals. The first call for a mesh makes the
  /// normals of these primitives only. The second call makes all normals of the mesh, because more requests are likely.
  void smooth(const BitSet& large, const Execution& execution);

  /// Updates the placement of an instance that has moved.
  void follow(const Surfaces& surfaces, std::uint32_t instance);

  /// Returns the placement that holds `id`. Tries `guess` first.
  [[nodiscard]] const Placement& placement_with(PrimitiveId id, const Placement& guess) const;
  [[nodiscard]] const Placement& first_placement() const { return placements_.front(); }
  /// Returns the smooth normals of a mesh, or none if the mesh has its own normals, or none were requested.
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
  /// Borrows `store` and `large`. On meshes without normals, the primitives in `large` are smooth, and the store must
  /// have their normals. The other primitives of these meshes are flat; without `large`, all are.
  /// If `has_texcoords` is false, setups have no texture coordinates, which not all pictures need.
  TriangleSource(const TriangleStore& store, const View& view, const BitSet* large, bool has_texcoords = true)
      : rays_(view), large_(large), store_(store), has_texcoords_(has_texcoords) {}

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
  bool has_texcoords_;
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
/// Fills `out` for these fragments in the manner of interpolate_geometry(). Overwrites entries behind them.
void interpolate_texcoords(const TexcoordRequest& request, TexcoordLanes& out, Isa isa);

}  // namespace frontmost::shading
