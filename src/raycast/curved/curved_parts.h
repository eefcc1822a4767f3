// SPDX-License-Identifier: Apache-2.0
// What a CurvedIndex holds.
#pragma once

#include "frontmost/curved.h"
#include "raycast/curved/box_tree.h"
#include "raycast/curved/placed_patch.h"
#include "raycast/curved/placed_sphere.h"

namespace frontmost {

struct CurvedParts {
  CurvedParts(const Scene& scene, const Execution& execution);

  /// Nearest curved primitive that the ray sees; shortens the ray to it.
  [[nodiscard]] CurvedHit nearest(raycast_detail::DoubleRay& ray) const;
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
  raycast_detail::BoxTree tree;  ///< items: the spheres, then the pieces

 private:
  void place_all(const Scene& scene);
};

}  // namespace frontmost
