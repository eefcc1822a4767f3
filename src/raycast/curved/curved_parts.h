// SPDX-License-Identifier: Apache-2.0
// What a CurvedIndex holds: an index of the triangles, the curved primitives in world space, and a tree of boxes around
// these.
//
// A ray asks the triangles first. What they give ends the ray, so that curved primitives behind it are never searched;
// of two hits at the same place the lower id is seen, as everywhere.
#pragma once

#include "frontmost/curved.h"
#include "raycast/curved/box_tree.h"
#include "raycast/curved/placed_curves.h"

namespace frontmost {

namespace raycast_detail {

/// The nearest of what a ray has met so far: of several at the same t the lowest id, and of a patch's pieces the first,
/// in whatever order they come.
struct NearestHit {
  CurvedHit hit;
  std::uint32_t item = no_index;  ///< of the tree

  /// Shortens the ray to what is met, if that is nearer.
  bool keep(const RayMeeting& met, PrimitiveId id, std::uint32_t from_item, DoubleRay& ray);
};

}  // namespace raycast_detail

struct CurvedParts {
  CurvedParts(const Scene& scene, const Execution& execution);

  /// Nearest curved primitive that the ray sees; shortens the ray to it.
  [[nodiscard]] CurvedHit nearest(raycast_detail::DoubleRay& ray) const;
  /// The same of up to kPacketRays rays near each other, which is several times as fast; equal to the bit.
  void nearest(std::span<raycast_detail::DoubleRay> rays, std::span<CurvedHit> hits, Isa isa) const;
  /// Of one item of the tree.
  [[nodiscard]] std::optional<raycast_detail::RayMeeting> meet_item(std::uint32_t item,
                                                                    const raycast_detail::DoubleRay& ray) const;
  [[nodiscard]] PrimitiveId id_of(std::uint32_t item) const {
    return item < spheres.size() ? spheres[item].id : pieces[item - spheres.size()].id;
  }
  /// The element of a triangle of `surfaces`.
  [[nodiscard]] PrimitiveId element_of(PrimitiveId triangle) const;
  /// Of an element that is a triangle.
  [[nodiscard]] std::array<glm::vec3, 3> corners_of(PrimitiveId element) const;
  [[nodiscard]] PrimitiveSource source(PrimitiveId element) const;

  Scene flat;  ///< of meshes that are not curved, positions and triangles; all instances, in their order
  Surfaces surfaces;
  RayIndex triangles;
  std::vector<PrimitiveId> first_elements;  ///< by instance, and one more
  std::vector<std::uint32_t> meshes;        ///< by instance
  std::vector<raycast_detail::PlacedSphere> spheres;
  std::vector<raycast_detail::PatchPiece> pieces;
  raycast_detail::DoubleBoxTree tree;  ///< items: the spheres, then the pieces

 private:
  void place_all(const Scene& scene);
};

}  // namespace frontmost
