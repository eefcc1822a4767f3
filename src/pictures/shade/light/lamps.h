// SPDX-License-Identifier: Apache-2.0
// The direct lights of one picture: the key light, and the lights of the file, by glTF's KHR_lights_punctual.
//
//   suns             one direction for the whole picture               add_direct_light()
//   points, spots    at every fragment a different direction and       find_lamp_light(), then
//                    share of the light                                add_light_from()
//
//                  lamp         part = window * cone^2 / distance^2
//                   / : .       window = 1 - (distance / range)^4, at least 0: 1 near the lamp, 0 from its range on
//                  /  :  .      cone   = position between the outer cone (0) and the inner one (1), in cosines
//               ~~~~~~~~~~~ fragments
//
// Units: the intensity of a lamp, in candela, divided by the square of a distance is in lux, like that of suns. A white
// diffuse surface that faces a light of E lux reflects E / pi candela per square metre, which is the picture's value.
#pragma once

#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "shade/light/lighting.h"

namespace frontmost::shading {

/// A point or spot light, in world axes.
struct Lamp {
  glm::vec3 position{0};     ///< from the eye
  glm::vec3 axis{0, 0, -1};  ///< unit, the direction in which it shines
  glm::vec3 color{1};        ///< radiance of a white diffuse surface that faces it at distance 1
  float range = 0;           ///< 0: unlimited
  float cosine_outer = -1;   ///< of the outer cone; -1 for points, which have none
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
/// False only if none of the lamp's light can arrive in the box, by its range or its cone. Tens of operations.
[[nodiscard]] bool may_reach(const Lamp& lamp, const BatchBounds& bounds);
/// Computes the lamp's light at all fragments of the batch.
void find_lamp_light(const Lamp& lamp, const FragmentBatch& batch, LampLight& light, Isa isa);

/// The direct lights of a picture. `source` is the light of the file, or null for the key light.
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

}  // namespace frontmost::shading
