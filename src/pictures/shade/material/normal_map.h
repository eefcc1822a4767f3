// SPDX-License-Identifier: Apache-2.0
// Normals turned by a texture, along the directions in which its coordinates grow on the triangle.
#pragma once

#include "shade/batch.h"
#include "shade/geometry/triangle_setup.h"
#include "shade/texture/texture_sampler.h"

namespace frontmost::shading {

/// A set-up triangle, and its number in the batch.
struct NumberedTriangle {
  const TriangleSetup& setup;
  std::uint16_t number;
};

/// One use of a normal texture, for the fragments of one batch.
class NormalMap {
 public:
  /// Borrows `slot`. `scale` multiplies the bumps.
  NormalMap(const TextureSlot& slot, float scale) : slot_(&slot), scale_(scale) {}

  /// Turns normal `i`. `texel` is the texture's value, 0 to 1. Triangles without coordinates keep their normals.
  void turn(const NumberedTriangle& triangle, const glm::vec4& texel, int i, Lane3& normals);

 private:
  /// The unit directions on a triangle in which u and v grow; zero where the coordinates do not span a plane.
  struct TangentFrame {
    glm::vec3 along_u{0}, along_v{0};
  };
  [[nodiscard]] TangentFrame frame_of(const TriangleSetup& triangle) const;

  const TextureSlot* slot_;
  float scale_;
  int framed_ = -1;  ///< the triangle that frame_ belongs to
  TangentFrame frame_;
};

}  // namespace frontmost::shading
