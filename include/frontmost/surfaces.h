// SPDX-License-Identifier: Apache-2.0
// Surfaces: a scene made ready for every visibility method. Its triangles are numbered over all instances, in the order
// of the scene, and these numbers are all that methods answer with:
//
//   instance       0: a cube        1: the same cube again    2: a floor
//   triangle       0 ... 11         0 ... 11                  0    1
//   primitive id   0 ... 11         12 ... 23                 24   25          source(13) is instance 1, triangle 1
#pragma once

#include <memory>
#include <span>

#include "frontmost/base.h"
#include "frontmost/scene.h"

namespace frontmost {

struct PlacedScene;  // src/core/surfaces/placed_scene.h, and
struct ClusterSet;   // src/core/surfaces/cluster_set.h: what the methods read

/// Where a primitive id comes from.
struct PrimitiveSource {
  std::uint32_t instance = no_index;
  std::uint32_t mesh = no_index;
  std::uint32_t triangle = no_index;  ///< within the mesh
};

/// All triangles of a scene in world space, flattened over instances, with stable ids: the id of a triangle is its
/// running number over all instances in scene order. World space is about Scene::origin, which models
/// far from zero have: so are all places that are given to methods, and that they answer with. Safe to share between
/// threads, but for move(), which is all that changes them. Triangles with a corner that is not finite in world space
/// are never seen, but keep their number. Singular transforms are no error: they flatten what they place. Only the
/// first three rows of a transform count. Triangles whose material is of alpha mode MASK have holes wherever their
/// alpha (base colour, texture and vertices) is below the cutoff; the texture is looked up as it is stored. Every
/// method that answers in samples sees through holes; draw_lines() does not.
class Surfaces {
 public:
  /// Borrows `scene`, which must outlive the surfaces and stay as it is.
  /// O(triangles), in parallel; half a byte a triangle. Whatever looks at the triangles often (a ZBuffer, rays, the
  /// third zbuffer()) first brings them into clusters, once, which takes ten times as long and 20 bytes a triangle, 40
  /// while they are made.
  /// \throws Error as validate(scene) does, and bad_argument for a non-finite instance transform.
  explicit Surfaces(const Scene& scene, const Execution& execution = {});
  explicit Surfaces(Scene&&, const Execution& = {}) = delete;  // it would be gone at once
  ~Surfaces();
  Surfaces(Surfaces&&) noexcept;
  Surfaces& operator=(Surfaces&&) noexcept;
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  /// Gives an instance another transform, in the scene and here: from then on everything answers as if these surfaces
  /// had been made of the scene as it is now. An Occlusion and a Shader of these surfaces follow by themselves at their
  /// next call; a RayIndex by RayIndex::follow(). O(triangles of the instance + log(instances)); the first time
  /// O(triangles), where there are clusters, to list what is where. Clusters stay as
  /// they were cut, so that pictures grow slower the less of the old neighbourhoods is left; they are made anew where
  /// corners become finite, or are so no more. Where an index shares triangles with holes, all of these are copied.
  /// Not while anything else reads the surfaces or the scene. \param scene the one that the surfaces were made of.
  /// \throws Error bad_argument for another scene, an instance that is not there, and a transform that is not finite;
  /// nothing has moved then.
  void move(Scene& scene, std::uint32_t instance, const glm::dmat4& world_from_mesh, const Execution& execution = {});

  struct Placement {
    std::uint32_t instance;
    glm::dmat4 world_from_mesh;
  };
  /// Moves many instances, one after the other, each as above. \throws Error as above if any placement is wrong; no
  /// instance has moved then.
  void move(Scene& scene, std::span<const Placement> placements, const Execution& execution = {});

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] std::uint32_t primitive_count() const;
  /// The instance, mesh and triangle behind an id. O(log instances). Precondition: id < primitive_count().
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const;
  /// The first id of an instance; its ids are consecutive.
  [[nodiscard]] PrimitiveId first_primitive(std::uint32_t instance) const;
  /// World-space bounds of all triangles with finite corners; of one instance.
  [[nodiscard]] const Box& bounds() const;
  [[nodiscard]] const Box& bounds(std::uint32_t instance) const;
  /// World-space corners of one triangle, in the mesh's order, to the bit those that the methods draw.
  [[nodiscard]] std::array<glm::vec3, 3> corners(PrimitiveId id) const;
  /// True when the instance's transform mirrors. Its front faces are then clockwise in the order of corners(): what is
  /// outside of a mesh stays outside (glTF 2.0, 3.7.4).
  [[nodiscard]] bool is_mirrored(std::uint32_t instance) const;
  /// Bytes held beside the scene's own arrays; those of the clusters count once they are made.
  [[nodiscard]] std::size_t byte_count() const;

  /// Brings the triangles into clusters now, for whoever will show many pictures.
  void make_clusters(const Execution& execution = {}) const;

 private:
  friend const PlacedScene& placed_scene(const Surfaces& surfaces);
  friend const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution);
  friend const ClusterSet* made_cluster_set(const Surfaces& surfaces);
  friend const ClusterSet* cluster_set_for_picture(const Surfaces& surfaces, const Execution& execution);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
