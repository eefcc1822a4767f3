// SPDX-License-Identifier: Apache-2.0
// The light of a lit picture and its reflection by surfaces: passes over a batch, which add to batch.light.
//
//   begin_light        emitted light
//   add_direct_light   one light from one direction, multiplied by batch.shadow; once for every light
//   add_surroundings   light from all around, multiplied by the material's occlusion
//   finish_light       exposure and tone mapping, to a range that a picture can hold
//
// One key light moves with the camera. It shines from the upper left in front of the model, so that the visible side is
// lit and shadows fall to the lower right. A studio environment turns with the camera. Intensities are radiances of a
// white diffuse surface. One that faces the key light is just below 1, so textures keep their colours without tone
// mapping.
#pragma once

#include "frontmost/pictures.h"
#include "shade/batch.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {

/// A light at infinite distance: all of its light has one direction.
struct DirectLight {
  glm::vec3 to_light{0, 0, 1};            ///< unit
  glm::vec3 color{0.64f, 0.63f, 0.615f};  ///< radiance of a white diffuse surface that faces it

  [[nodiscard]] bool is_on() const { return color != glm::vec3(0); }
};

/// The radiance of a white diffuse surface in an environment, by its unit normal in world axes: coefficients of the
/// normal's coordinates and of their products, by colour channel.
struct IrradiancePolynomial {
  glm::vec3 constant{0}, x{0}, y{0}, z{0}, xx{0}, yy{0}, zz{0}, xy{0}, yz{0}, zx{0};
};

struct Surroundings {
  const PrefilteredEnvironment* environment = nullptr;  ///< null: no light
  glm::mat3 world_from_environment{1};                  ///< a rotation
  IrradiancePolynomial irradiance;
};

struct Lighting {
  DirectLight key;
  Surroundings around;
  float exposure = 1;  ///< factor of all light
  ToneMapping tone_mapping = ToneMapping::none;
};

[[nodiscard]] inline bool counts_key(Lights lights) { return lights == Lights::key || lights == Lights::both; }

/// \throws Error bad_argument as documented for LightOptions.
void check_light(const LightOptions& options);
/// The direction of the key light, of unit length. Precondition: check_light().
[[nodiscard]] glm::vec3 direction_to_key(const View& view, const LightOptions& options);
/// The intensity of the key light. Precondition: check_light().
[[nodiscard]] double key_intensity(const LightOptions& options);
/// The light for a picture of a scene with this up axis. Borrows the environment, which the options name or leave open.
/// Precondition: check_light().
[[nodiscard]] Lighting lighting_for(const View& view, Axis up, const LightOptions& options,
                                    const Environment& environment);

void begin_light(FragmentBatch& batch);
/// Metallic-roughness with GGX highlights (Schlick's Fresnel, Smith's correlated masking).
void add_direct_light(const DirectLight& light, FragmentBatch& batch, Isa isa);
/// add_direct_light() for a light whose direction differs from fragment to fragment.
void add_light_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa);
/// Adds the environment's light, reflected by the same model, by the split sum and with multiple scattering.
void add_surroundings(const Surroundings& around, FragmentBatch& batch, Isa isa);
/// Combines the material layers, and maps the light to 0 to 1. Unlit materials give their base colour.
void finish_light(const Lighting& lighting, FragmentBatch& batch, Isa isa);

}  // namespace frontmost::shading
