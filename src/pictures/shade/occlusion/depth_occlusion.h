// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion on the depth map: how much of the sky above a point is hidden by what the picture shows around it.
//
//                V  to the viewer          A slice through the line of sight, seen from its side. On both sides of it
//      \   h0    |    h1  /                the map is stepped along, and the steepest rise is the horizon. Between the
//    ___\        |       /   ____          horizons is sky, of which a part is counted by the cosine to the normal, in
//        |       |      /___|              closed form; slices all around V make up the whole of it.
//        |_______P_____|
//
// (J. Jimenez, X. Wu, A. Pesce, A. Jarabo. Practical Real-Time Strategies for Accurate Indirect Occlusion. 2016: ground
// truth ambient occlusion. Here the part is taken of what the same slices count without any horizon, so that a plane is
// unoccluded to the last bit, and nothing is random.)
#pragma once

#include "frontmost/pictures.h"
#include "shade/batch.h"

namespace frontmost::shading {

/// The depth map as the kernel reads it.
struct OcclusionGrid {
  int width = 0, height = 0;
  const float* depths = nullptr;  ///< planar, by rows; infinite where nothing is seen
  bool is_parallel = false;
  glm::vec3 right{0}, up{0}, back{0};  ///< the eye's axes in the world
  glm::vec2 first{0}, step{0};         ///< place of the first pixel's sample at unit distance, and of the next ones
  float radius = 0, strength = 0;
};

/// How far away what hides may be, in scene units, and what part of what is hidden counts.
struct OcclusionReach {
  double radius, strength;
};

/// Of one picture of the same scene after another.
class DepthOcclusion {
 public:
  /// Takes the depths of the first samples, which lie where the first of `samples` in a pixel does. Memory of pictures
  /// before is used again.
  void find(const Visible& visible, int samples, const OcclusionReach& reach);
  /// Weakens batch.material.occlusion by what is near.
  void darken(FragmentBatch& batch, Isa isa) const;

 private:
  OcclusionGrid grid_;
  Buffer<float> depths_;
};

/// \throws Error bad_argument naming the field.
void check_ambient_occlusion(const ShadeOptions& options);
/// What AmbientOcclusion::radius is where it is not given.
[[nodiscard]] double default_occlusion_radius(const Surfaces& surfaces);

}  // namespace frontmost::shading
