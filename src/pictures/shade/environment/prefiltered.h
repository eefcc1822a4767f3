// SPDX-License-Identifier: Apache-2.0
// The data of an Environment: octahedral maps for nine roughnesses, and moments for diffuse surfaces.
#pragma once

#include <array>
#include <functional>

#include "frontmost/image.h"
#include "frontmost/pictures.h"
#include "shade/environment/octahedral_map.h"

namespace frontmost::shading {

/// The light reflected by a white diffuse surface is a polynomial of its normal: mean + 2 first . n + 15/8 n . second
/// n. These are spherical harmonics up to order 2, in a form that is easy to rotate.
struct IrradianceMoments {
  /// For one colour channel: means over all directions d of the light, of the light times d, and of the light times d
  /// d^T - 1/3.
  struct Moments {
    double mean = 0;
    glm::dvec3 first{0};
    glm::dmat3 second{0};
  };
  std::array<Moments, 3> channels;
};

struct PrefilteredEnvironment {
  static constexpr int level_count = 9;

  /// Level k is the light mirrored by surfaces of roughness k / 8 at normal incidence; level 0 is the environment
  /// itself.
  std::array<OctahedralMap, level_count> levels;
  IrradianceMoments irradiance;
  bool turns_with_camera = false;
  bool is_dark = false;  ///< no light at all; then there are no levels
  Image picture;         ///< equirectangular; empty if the environment was made by code
};

/// The data of an environment, for shading.
[[nodiscard]] const PrefilteredEnvironment& prefiltered(const Environment& environment);

/// Computes levels 1 and up, and the moments, from level 0. The size of level 0 is a power of two, at least 64. The
/// bits are the same on every machine.
void prefilter(PrefilteredEnvironment& environment, const Execution& execution);

/// Radiance from a direction of unit length.
using Radiance = std::function<glm::vec3(const glm::vec3& towards)>;
/// Level 0 from code: the radiance at the middle of every texel. In parallel.
[[nodiscard]] OctahedralMap draw_map(int size, const Radiance& radiance, const Execution& execution);
/// Level 0 from an equirectangular picture: the mean over each texel. In parallel.
[[nodiscard]] OctahedralMap draw_map(const Image& equirectangular, const Execution& execution);

/// Radiances of the environments that are made by code.
[[nodiscard]] glm::vec3 studio_radiance(const glm::vec3& towards);
[[nodiscard]] glm::vec3 sky_radiance(const glm::vec3& towards);

}  // namespace frontmost::shading
