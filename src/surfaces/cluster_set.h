// SPDX-License-Identifier: Apache-2.0
// The inside of Surfaces: clusters of triangles as structure of arrays, the form in which every method reads geometry.
#pragma once

#include <vector>

#include "frontmost/surfaces.h"
#include "surfaces/cones.h"
#include "surfaces/cutouts.h"

namespace frontmost {

/// Up to 64 vertices and 124 triangles that are neighbours in space. Its vertices start at `first_vertex` of
/// ClusterSet::x, y, z; its corner numbers (0 to 63, relative) and primitive ids at `first_triangle` of i0, i1, i2, id.
/// Both are padded to whole vectors of 16: padding vertices repeat the last one, padding triangles are degenerate.
struct Cluster {
  static constexpr int max_vertices = 64;
  static constexpr int max_triangles = 124;
  static constexpr int lanes = 16;

  std::uint64_t first_vertex = 0;
  std::uint64_t first_triangle = 0;
  std::uint16_t vertex_count = 0;
  std::uint16_t triangle_count = 0;
};

/// World-space boxes, one array a side, padded to whole vectors of 16 with empty boxes.
struct BoxArrays {
  Buffer<float> low_x, low_y, low_z, high_x, high_y, high_z;

  BoxArrays() = default;
  explicit BoxArrays(std::size_t count);
  void set(std::size_t i, const Box& box);
  [[nodiscard]] Box get(std::size_t i) const {
    return {{low_x[i], low_y[i], low_z[i]}, {high_x[i], high_y[i], high_z[i]}};
  }
};

struct ClusterSet {
  const Scene* scene = nullptr;
  std::vector<PrimitiveId> first_primitives;  ///< by instance, and the total at the end
  std::vector<Box> instance_bounds;
  std::vector<std::uint8_t> mirrored;  ///< by instance: its triangles have their last two corners swapped
  Box bounds;

  std::vector<Cluster> clusters;
  std::size_t first_cutout = 0;  ///< clusters from here on hold what may have holes, those before nothing of it
  std::shared_ptr<const Cutouts> cutouts;  ///< null where nothing may
  BoxArrays boxes;                         ///< of the clusters; empty where no triangle has finite corners
  Buffer<float> x, y, z;                   ///< world space
  Buffer<std::uint8_t> i0, i1, i2;
  Buffer<PrimitiveId> id;
  LazyCones cones;
};

/// Cuts all triangles into clusters, every one into one. Triangles with a non-finite world-space corner become
/// degenerate (three times the same corner number), so that no method sees them.
[[nodiscard]] ClusterSet build_clusters(const Scene& scene, const Execution& execution);

/// \throws Error bad_argument for a transform that is not finite.
void check_transforms(const Scene& scene);

/// True for a transform that turns counter-clockwise into clockwise.
[[nodiscard]] inline bool mirrors(const glm::dmat4& world_from_mesh) {
  return glm::determinant(glm::dmat3(world_from_mesh)) < 0;
}

/// The world-space position of a vertex, in the one rounding that every part of the house uses.
[[nodiscard]] inline glm::vec3 to_world(const glm::dmat4& world_from_mesh, const glm::vec3& p) {
  const glm::dvec3 q(p);
  const glm::dmat4& m = world_from_mesh;
  return {float(m[0][0] * q.x + m[1][0] * q.y + m[2][0] * q.z + m[3][0]),
          float(m[0][1] * q.x + m[1][1] * q.y + m[2][1] * q.z + m[3][1]),
          float(m[0][2] * q.x + m[1][2] * q.y + m[2][2] * q.z + m[3][2])};
}

/// to_world() for many vertices of one instance, for which most files have no transform at all.
class ToWorld {
 public:
  explicit ToWorld(const glm::dmat4& world_from_mesh)
      : matrix_(world_from_mesh), is_identity_(world_from_mesh == glm::dmat4(1.0)) {}
  [[nodiscard]] glm::vec3 operator()(const glm::vec3& p) const { return is_identity_ ? p : to_world(matrix_, p); }
  [[nodiscard]] bool is_identity() const { return is_identity_; }

 private:
  const glm::dmat4& matrix_;
  bool is_identity_;
};

[[nodiscard]] inline bool is_finite(const glm::vec3& p) {
  // NaN and infinity times 0 are NaN, and NaN is not 0.
  const glm::vec3 zero = p * 0.0f;
  return zero.x == 0 && zero.y == 0 && zero.z == 0;
}

}  // namespace frontmost
