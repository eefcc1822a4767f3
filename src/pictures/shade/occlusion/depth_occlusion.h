// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion from the depth map: the share of the sky above a point that visible surfaces around it hide.
//
//                V  to the viewer          A slice through the line of sight, seen from its side. The map is sampled
//      \   h0    |    h1  /                on both sides of the line; the steepest rise on a side is its horizon. The
//    ___\        |       /   ____          sky between the horizons counts by its cosine to the normal, in closed form.
//        |       |      /___|              Slices at all angles around V together give the whole sky.
//        |_______P_____|
//
// (J. Jimenez, X. Wu, A. Pesce, A. Jarabo. Practical Real-Time Strategies for Accurate Indirect Occlusion. 2016: ground
// truth ambient occlusion. Here the free share is relative to the same slices without horizons, so that a plane is
// exactly unoccluded, and nothing is random.)
#pragma once

#include "frontmost/pictures.h"
#include "shade/batch.h"

namespace frontmost::shading {

/// The depth map in the form that the kernel reads.
struct OcclusionGrid {
  int width = 0, height = 0;
  const float* depths = nullptr;  ///< planar, by rows; infinite where nothing is seen
  bool is_parallel = false;
  glm::vec3 right{0}, up{0}, back{0};  ///< the eye's axes in world space
  glm::vec2 first{0}, step{0};         ///< place of the first pixel's sample at unit distance, and its step from pixel
                                       ///< to pixel
  float radius = 0, strength = 0;
};

/// The greatest distance of an occluder, in scene units, and the factor of the occlusion.
struct OcclusionReach {
  double radius, strength;
};

/// Ambient occlusion for successive pictures of a scene.
class DepthOcclusion {
 public:
  /// Takes the depths of the first samples from `visible`. The picture has `samples` samples per pixel. Reuses the
  /// memory of earlier pictures.
  void find(const Visible& visible, int samples, const OcclusionReach& reach);
  /// Reduces batch.material.occlusion by nearby occluders.
  void darken(FragmentBatch& batch, Isa isa) const;

 private:
  OcclusionGrid grid_;
  Buffer<float> depths_;
};

/// Checks the options of ambient occlusion. \throws Error bad_argument naming the field.
void check_ambient_occlusion(const ShadeOptions& options);
/// Returns the default of AmbientOcclusion::radius.
[[nodiscard]] double default_occlusion_radius(const Surfaces& surfaces);

}  // namespace frontmost::shading
