// SPDX-License-Identifier: Apache-2.0
// Environment: the light that comes from all around, made ready to be asked for by any surface.
//
//   a picture of all directions, or code
//     --> the same on an octahedron unfolded to a square           mirrored by smooth surfaces
//     --> that blurred as surfaces of eight roughnesses blur it    mirrored by rough ones
//     --> its mean, its first and its second moments               sent back by matt ones
//
// Directions are those of a Panorama: ahead is the middle of the picture, right a quarter of its width from there, up
// its upper side. In the axes of an environment x is right, y up and z behind.
#pragma once

#include <memory>

#include "frontmost/image.h"

namespace frontmost {

namespace shading {
struct PrefilteredEnvironment;
}

/// Cheap to copy: copies share what was made, which never changes, and may be used by several threads at once.
class Environment {
 public:
  /// From an equirectangular picture with channels R, G and B, twice as wide as high, as load_environment() gives it.
  /// Keeps the picture, which is what a background shows. O(pixels), in parallel; about 7 MB beside the picture, less
  /// for pictures below 1024 x 512. \throws Error bad_argument for other sizes and channels, or values that are not 0
  /// to max_environment_value; limit_exceeded above 16384 x 8192.
  explicit Environment(Image equirectangular, const Execution& execution = {});
  /// A neutral room, grey below and brighter above, with soft boxes that metals mirror; the brightest stands before the
  /// model to the left, where the key light is. Turns with the camera. White matt surfaces send back 0.15 of it from
  /// below and 0.36 from above. About three milliseconds.
  [[nodiscard]] static Environment studio(const Execution& execution = {});
  /// A clear sky without a sun over dull ground; as bright as the studio.
  [[nodiscard]] static Environment sky(const Execution& execution = {});
  /// No light at all.
  [[nodiscard]] static Environment none();

  /// True of studio(): what is ahead in it is ahead of the camera; in others it is ahead in the world, where
  /// NamedView::front looks.
  [[nodiscard]] bool turns_with_camera() const;
  /// The picture that it was made from, or null.
  [[nodiscard]] const Image* picture() const;

  /// Radiance from a direction as a surface of this roughness (0 to 1) mirrors it that is seen from straight ahead: the
  /// mean weighted by the GGX lobe and the cosine. `towards` is in the environment's axes, of any length but zero.
  [[nodiscard]] glm::vec3 radiance(const glm::vec3& towards, float roughness = 0) const;
  /// What a white matt surface with this unit normal sends back: irradiance / pi, by spherical harmonics of order 2.
  /// (R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment Maps. SIGGRAPH 2001.)
  [[nodiscard]] glm::vec3 irradiance(const glm::vec3& normal) const;

  /// For the shading of fragments.
  [[nodiscard]] const shading::PrefilteredEnvironment& prefiltered() const { return *made_; }

 private:
  explicit Environment(std::shared_ptr<const shading::PrefilteredEnvironment> made) : made_(std::move(made)) {}
  std::shared_ptr<const shading::PrefilteredEnvironment> made_;
};

}  // namespace frontmost
