// SPDX-License-Identifier: Apache-2.0
// The light of a lit picture and its reflection by surfaces: passes over a batch, which add to batch.light.
//
//   begin_light        emitted light
//   add_direct_light   one light, multiplied by batch.shadow; once for every light
//   add_surroundings   light from all around, multiplied by the material's occlusion
//   finish_light       exposure and tone mapping, to a range that a picture can hold
//   let_through        opacity of glass, once light holds the final colour
//
// Varnish and fibres of cloth reflect light themselves and keep some of it from the surface below. Glass transmits
// light. The light of varnish is in batch.coat->light, and that of fibres in batch.layers.sheen_light, until
// finish_light() combines all.
//
// One key light moves with the camera. It shines from the upper left in front of the model, so that the visible side is
// lit and shadows fall to the lower right. A studio environment turns with the camera. An intensity is the radiance of
// a white diffuse surface that faces the light. For the key light it is just below 1, so that textures keep their
// colours without tone mapping.
#pragma once

#include <span>
#include <vector>

#include "frontmost/pictures.h"
#include "frontmost/scene.h"
#include "shade/batch.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {

/// A light without extent.
struct DirectLight {
  glm::vec3 to_light{0, 0, 1};            ///< unit
  glm::vec3 color{0.64f, 0.63f, 0.615f};  ///< radiance of a white diffuse surface that faces it
  const Lane3* directions = nullptr;      ///< directions to the light, by fragment; null if `to_light` holds for all

  [[nodiscard]] bool is_on() const { return color != glm::vec3(0); }
};

/// The radiance of a white diffuse surface in an environment, as a polynomial of the surface's unit normal in world
/// axes. The coefficients, by colour channel, are those of the normal's coordinates and of their products.
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

/// A point or spot light, in world axes.
struct Lamp {
  glm::vec3 position{0};     ///< from the eye
  glm::vec3 axis{0, 0, -1};  ///< unit, the direction in which it shines
  glm::vec3 color{1};        ///< radiance of a white diffuse surface that faces it at distance 1
  float range = 0;           ///< 0: unlimited
  float cosine_outer = -1;   ///< cosine of the outer cone; -1 for points, which have no cone
  float cone_scale = 0;      ///< 1 / (cosine of the inner cone - cosine of the outer one); points: 0
};

/// The light of a lamp that arrives at each fragment.
struct LampLight {
  Lane3 to_lamp;  ///< unit
  Lane part;      ///< share of Lamp::color; 0 beyond the range and the cone
};

/// A box around the fragments of a batch, relative to the eye.
struct BatchBounds {
  glm::vec3 low, high;
};
[[nodiscard]] BatchBounds bounds_of(const FragmentBatch& batch);
/// Returns false only if the lamp's range or cone keeps all of its light from the box. Takes tens of operations.
[[nodiscard]] bool may_reach(const Lamp& lamp, const BatchBounds& bounds);
/// Computes the lamp's light at all fragments of the batch.
void find_lamp_light(const Lamp& lamp, const FragmentBatch& batch, LampLight& light, Isa isa);

/// The direct lights of one picture: the key light, and the lights of the file, by glTF's KHR_lights_punctual.
///
///   suns             one direction for the whole picture               add_direct_light()
///   points, spots    at every fragment a different direction and       find_lamp_light(), then
///                    share of the light                                add_direct_light()
///
///                  lamp         part = window * cone^2 / distance^2
///                   / : .       window = 1 - (distance / range)^4, at least 0: 1 near the lamp, 0 from its range on
///                  /  :  .      cone   = position between the outer cone (0) and the inner one (1), in cosines
///               ~~~~~~~~~~~ fragments
///
/// Units: the intensity of a lamp, in candela, divided by the square of a distance is in lux, like that of suns. A
/// white diffuse surface that faces a light of E lux reflects E / pi candela per square metre, which is the picture's
/// value.
///
/// `source` is the light of the file, or null for the key light.
struct PictureLights {
  struct Far {
    DirectLight light;
    const Light* source;
  };
  struct Near {
    Lamp lamp;
    const Light* source;
  };
  std::vector<Far> far;  ///< the key light first, if it is on
  std::vector<Near> near;

  /// Sets the lights of a picture seen from `eye`, in the order of the file, without dark ones. Borrows them.
  /// \throws Error limit_exceeded for more than 4096.
  void set(const DirectLight* key, std::span<const Light> lights, const glm::dvec3& eye);
};

/// Checks the options of light. \throws Error bad_argument as documented for LightOptions.
void check_light(const LightOptions& options);
/// Returns the direction of the key light, of unit length. Precondition: check_light().
[[nodiscard]] glm::vec3 direction_to_key(const View& view, const LightOptions& options);
/// Returns the intensity of the key light. Precondition: check_light().
[[nodiscard]] double key_intensity(const LightOptions& options);
/// Returns the light for a picture of a scene with this up axis. Borrows the environment: the one of the options, or a
/// default if they have none. Precondition: check_light().
[[nodiscard]] Lighting lighting_for(const View& view, Axis up, const LightOptions& options,
                                    const Environment& environment);

/// Sets the light to what the material emits, and the light of its layers to 0.
void begin_light(FragmentBatch& batch);
/// Adds a light, reflected by the metallic-roughness model with GGX highlights (Schlick's Fresnel, Smith's correlated
/// masking).
void add_direct_light(const DirectLight& light, FragmentBatch& batch, Isa isa);
/// Adds the environment's light, reflected by the same model, with the split sum and multiple scattering.
void add_surroundings(const Surroundings& around, FragmentBatch& batch, Isa isa);
/// Combines the light of the layers with that of the surface below. The share that a layer keeps from below is its
/// Fresnel term for the view direction, whatever the direction of the light.
void lay_layers_over(FragmentBatch& batch);
/// Calls lay_layers_over(), and maps the light to 0 to 1. Unlit materials give their base colour.
void finish_light(const Lighting& lighting, FragmentBatch& batch, Isa isa);

/// Whether let_through() subtracts the light that glass mirrors from the light that glass transmits. by_view is for lit
/// pictures.
enum class Mirroring : std::uint8_t { none, by_view };
/// Sets batch.alphas and the material's alpha of see-through fragments to their opacity, and divides their light by it.
/// So reflections on glass keep their brightness, however little the glass hides. Precondition:
/// layers.has_transmission.
void let_through(FragmentBatch& batch, Mirroring mirroring);
/// Scales light above white down to white, and raises the opacity by the same factor, for blending that clips light at
/// white. So bright reflections hide what is behind them. Precondition: let_through() was called.
void hide_by_highlights(FragmentBatch& batch);

}  // namespace frontmost::shading
