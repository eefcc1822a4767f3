// SPDX-License-Identifier: Apache-2.0
// The data that Surfaces finds in a scene at once: the numbers of all triangles, and their places in the world.
//
//   scene      instance 0 of mesh a    instance 1 of mesh a    instance 2 of mesh b
//   ranges     | 2048 | 2048 | rest |  | 2048 | 2048 | rest |  | rest |           triangles that follow one another
//   boxes      one for 64 triangles each, in world space
//
// Positions are not copied: they stay in the meshes and go through to_world() when read. Frequent readers use clusters.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "surfaces/cutouts.h"
#include "surfaces/material_sides.h"

namespace frontmost {

/// True for a transform that turns counter-clockwise into clockwise.
[[nodiscard]] inline bool mirrors(const glm::dmat4& world_from_mesh) {
  return glm::determinant(glm::dmat3(world_from_mesh)) < 0;
}

/// The world-space position of a vertex, rounded in the one way that all code uses.
[[nodiscard]] inline glm::vec3 to_world(const glm::dmat4& world_from_mesh, const glm::vec3& p) {
  const glm::dvec3 q(p);
  const glm::dmat4& m = world_from_mesh;
  return {float(m[0][0] * q.x + m[1][0] * q.y + m[2][0] * q.z + m[3][0]),
          float(m[0][1] * q.x + m[1][1] * q.y + m[2][1] * q.z + m[3][1]),
          float(m[0][2] * q.x + m[1][2] * q.y + m[2][2] * q.z + m[3][2])};
}

/// Whether a cluster has a single vertex for two positions of an instance: their bits are the same.
[[nodiscard]] inline bool has_same_bits(const glm::vec3& a, const glm::vec3& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// to_world() for many vertices of one instance. Copies them if there is no transform, as in most files.
class ToWorld {
 public:
  explicit ToWorld(const glm::dmat4& world_from_mesh)
      : matrix_(&world_from_mesh), is_identity_(world_from_mesh == glm::dmat4(1.0)) {}
  [[nodiscard]] glm::vec3 operator()(const glm::vec3& p) const { return is_identity_ ? p : to_world(*matrix_, p); }
  [[nodiscard]] bool is_identity() const { return is_identity_; }

 private:
  const glm::dmat4* matrix_;
  bool is_identity_;
};

/// The least and the greatest of some numbers.
struct NumberRange {
  std::uint32_t low, high;

  /// Whether so many triangles use most vertices of the range, so that it is best to read all of them; true in files
  /// whose order is not random.
  [[nodiscard]] bool is_dense(std::size_t triangle_count) const { return high - low < 6 * triangle_count; }
};

/// Consecutive triangles of one instance.
struct MeshRange {
  /// Drawing so many takes long compared with handing them over; their vertices stay in the second-level cache.
  static constexpr std::uint32_t most_triangles = 2048;
  /// Triangles in a box of PlacedScene::boxes.
  static constexpr std::uint32_t triangles_in_box = 64;

  std::uint32_t instance;
  std::uint32_t begin, end;  ///< within the mesh
  NumberRange vertices;      ///< bounds of all vertex numbers, perhaps not the tightest ones
  std::uint32_t first_box;

  [[nodiscard]] std::uint32_t count() const { return end - begin; }
  [[nodiscard]] std::uint32_t box_count() const { return (count() + triangles_in_box - 1) / triangles_in_box; }
};

/// The instances that have moved, for owners of derived data. Moves are numbered from 0, since the surfaces were made.
class MoveLog {
 public:
  [[nodiscard]] std::uint64_t count() const { return first_ + instances_.size(); }
  /// Keeps at most as many moves as there are instances; an owner that is farther behind updates all instances.
  void add(std::uint32_t instance, std::size_t instance_count) {
    if (instances_.size() >= instance_count) {
      first_ += instances_.size();
      instances_.clear();
    }
    instances_.push_back(instance);
  }
  /// Calls visit(instance) for instances that may have moved after the first `seen` moves, and sets `seen` to count().
  template <class Visit>
  void visit_since(std::uint64_t& seen, std::size_t instance_count, const Visit& visit) const {
    if (seen < first_)
      for (std::uint32_t i = 0; i < instance_count; ++i) visit(i);
    else
      for (std::size_t i = seen - first_; i < instances_.size(); ++i) visit(instances_[i]);
    seen = count();
  }

 private:
  std::uint64_t first_ = 0;  ///< number of the first kept move
  std::vector<std::uint32_t> instances_;
};

/// A scene whose indices have all been checked.
struct PlacedScene {
  const Scene* scene = nullptr;
  std::vector<PrimitiveId> first_primitives;  ///< first id of each instance; then the number of all ids
  std::vector<std::uint8_t> mirrored;         ///< by instance: whether its triangles have their last two vertices
                                              ///< swapped
  std::shared_ptr<Cutouts> cutouts;           ///< null if no triangle may have holes
  std::shared_ptr<const MaterialSides> sides;
  std::vector<MeshRange> ranges;  ///< ranges of all triangles, in the order of their ids
  std::vector<Box> boxes;         ///< each around a few consecutive triangles, those with finite vertices
  std::vector<Box> instance_bounds;
  /// Each box encloses 16 consecutive boxes of the level below, or, on the lowest level, 16 instances. The last level
  /// has a single box.
  std::vector<std::vector<Box>> levels;
  Box bounds;
  MoveLog moves;

  [[nodiscard]] const Mesh& mesh(const MeshRange& range) const {
    return scene->meshes[scene->instances[range.instance].mesh];
  }
  [[nodiscard]] std::span<const glm::uvec3> corners(const MeshRange& range) const {
    return std::span(mesh(range).triangles).subspan(range.begin, range.count());
  }
  [[nodiscard]] PrimitiveId first_id(const MeshRange& range) const {
    return first_primitives[range.instance] + range.begin;
  }
  /// Whether a triangle of the instance may have holes. O(triangles).
  [[nodiscard]] bool has_cutouts(std::uint32_t instance) const;
  /// Moves an instance to its place in the scene.
  void follow(std::uint32_t instance, Isa isa);
  /// Makes the levels, and from them the bounds. O(instances * log(instances)).
  void find_bounds();
  /// Updates the levels and the bounds for one instance. O(log(instances)).
  void follow_bounds(std::uint32_t instance);

  /// Calls visit(vertex) for the world-space vertices of a box's triangles, but those shared with the triangle before.
  template <class Visit>
  void visit_box(std::size_t box, const Visit& visit) const;
};

/// The placed scene of surfaces, which methods read.
[[nodiscard]] const PlacedScene& placed_scene(const Surfaces& surfaces);

/// Numbers the triangles and finds their boxes. Precondition: validate_besides_vertices(scene) and
/// check_transform() of all instances have passed. O(triangles), in parallel: 3 ns a triangle on one thread. \throws
/// Error as validate(scene) does for the number of a vertex that does not exist.
[[nodiscard]] PlacedScene place_scene(const Scene& scene, const Execution& execution);

/// \throws Error bad_argument if a transform, which need not be that of the instance yet, is not finite.
void check_transform(const Scene& scene, std::size_t instance, const glm::dmat4& world_from_mesh);

/// Triangles of a range in world space. Borrows from the scene, or from the scratch memory.
struct WorldTriangles {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> corners;  ///< numbers of positions
  std::uint32_t first_position = 0;     ///< the number of positions[0]
  bool is_mirrored = false;             ///< the last two vertices change places
  PrimitiveId first_id = 0;

  [[nodiscard]] std::array<glm::vec3, 3> operator[](std::size_t triangle) const {
    const glm::uvec3& c = corners[triangle];
    std::array<glm::vec3, 3> world{positions[c.x - first_position], positions[c.y - first_position],
                                   positions[c.z - first_position]};
    if (is_mirrored) std::swap(world[1], world[2]);
    return world;
  }
};

template <class Visit>
void PlacedScene::visit_box(std::size_t box, const Visit& visit) const {
  const auto next = std::upper_bound(ranges.begin(), ranges.end(), box,
                                     [](std::size_t b, const MeshRange& range) { return b < range.first_box; });
  const MeshRange& range = *std::prev(next);
  const ToWorld world(scene->instances[range.instance].world_from_mesh);
  const std::vector<glm::vec3>& positions = mesh(range).positions;
  const std::span<const glm::uvec3> all = corners(range);
  const std::size_t first = (box - range.first_box) * MeshRange::triangles_in_box;
  glm::uvec3 last(no_index);
  for (std::size_t i = first; i < std::min<std::size_t>(first + MeshRange::triangles_in_box, all.size()); ++i) {
    const glm::uvec3& c = all[i];
    const glm::vec3 corner[3] = {world(positions[c.x]), world(positions[c.y]), world(positions[c.z])};
    if (!is_finite(corner[0]) || !is_finite(corner[1]) || !is_finite(corner[2])) continue;
    for (int k = 0; k < 3; ++k)
      if (c[k] != last.x && c[k] != last.y && c[k] != last.z) visit(corner[k]);
    last = c;
  }
}

/// Memory of world_triangles(), one a thread.
struct WorldScratch {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> corners;
  std::vector<std::uint32_t> known;  ///< by vertex: its index in positions + known_from, if not less than known_from
  std::uint32_t known_from = 1;
};

/// The triangles of a range, with every vertex once: all vertices of the range of numbers if that is dense, else those
/// in use.
[[nodiscard]] WorldTriangles world_triangles(const PlacedScene& placed, const MeshRange& range, Isa isa,
                                             WorldScratch& scratch);
/// to_world() of each position, to the bit. `to` has the size of `from`, and may be the same array.
void place_vertices(const glm::dmat4& world_from_mesh, std::span<const glm::vec3> from, glm::vec3* to, Isa isa);

/// The least and greatest vertex number. Precondition: not empty.
[[nodiscard]] NumberRange range_of_numbers(std::span<const glm::uvec3> corners, Isa isa);
/// Finds a box for each MeshRange::triangles_in_box triangles. Triangles with non-finite vertices are in none.
void find_boxes(const WorldTriangles& triangles, Isa isa, Box* boxes);

}  // namespace frontmost
