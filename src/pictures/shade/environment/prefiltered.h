// SPDX-License-Identifier: Apache-2.0
// What an Environment holds: octahedral maps for surfaces of nine roughnesses, and moments for matt ones.
#pragma once

#include <array>
#include <functional>

#include "frontmost/image.h"
#include "frontmost/pictures.h"
#include "shade/environment/octahedral_map.h"

namespace frontmost::shading {

/// What a white matt surface sends back is a polynomial of its normal: mean + 2 first . n + 15/8 n . second n. These
/// are spherical harmonics up to order 2, written so that they are easy to turn.
struct IrradianceMoments {
  /// Of one colour channel: means over all directions d of the light, of the light times d, and of the light times
  /// d d^T - 1/3.
  struct Moments {
    double mean = 0;
    glm::dvec3 first{0};
    glm::dmat3 second{0};
  };
  std::array<Moments, 3> channels;
};

struct PrefilteredEnvironment {
  static constexpr int level_count = 9;

  /// Level k is what surfaces of roughness k / 8 mirror, seen from straight ahead; level 0 is the environment itself.
  std::array<OctahedralMap, level_count> levels;
  IrradianceMoments irradiance;
  bool turns_with_camera = false;
  bool is_dark = false;  ///< no light at all; without levels
  Image picture;         ///< equirectangular; empty where it was made by code
};

/// What an environment holds, for the shading of fragments.
[[nodiscard]] const PrefilteredEnvironment& prefiltered(const Environment& environment);

/// Makes levels 1 and up, and the moments, of level 0, whose size is a power of two, at least 64. The same bits on
/// every machine.
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
