// SPDX-License-Identifier: Apache-2.0
// The direct lights of one picture: the key light, and those of the file, as glTF's KHR_lights_punctual has them.
//
//   suns             one direction for the whole picture               add_direct_light()
//   points, spots    another direction, and another part of the        find_lamp_light(), then
//                    light, at every fragment                          add_light_from()
//
//                  lamp         part = window * cone^2 / distance^2
//                   / : .       window = 1 - (distance / range)^4, from 0 on: 1 near the lamp, 0 from its range on
//                  /  :  .      cone   = how much of the way from the outer cone to the inner one, in cosines
//               ~~~~~~~~~~~ fragments
//
// Units: what a lamp sends out in candela is divided by the square of a distance, and is then lux, as of suns. A white
// matt surface that faces a light of E lux sends back E / pi candela a square metre, which is the picture's value.
#pragma once

#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "shade/light/lighting.h"

namespace frontmost::shading {

/// Points and spots, in world axes.
struct Lamp {
  glm::vec3 position{0};     ///< from the eye
  glm::vec3 axis{0, 0, -1};  ///< unit, the way that it shines
  glm::vec3 color{1};        ///< what a white matt surface that faces it sends back at a distance of one
  float range = 0;           ///< 0: it reaches everywhere
  float cosine_outer = -1;   ///< of the outer cone; points: there is none
  float cone_scale = 0;      ///< 1 / (cosine of the inner cone - cosine of the outer one); points: 0
};

/// What arrives of a lamp at each fragment.
struct LampLight {
  Lane3 to_lamp;  ///< unit
  Lane part;      ///< of Lamp::color; 0 beyond the range and the cone
};

/// A box around the fragments of a batch, from the eye.
struct BatchBounds {
  glm::vec3 low, high;
};
[[nodiscard]] BatchBounds bounds_of(const FragmentBatch& batch);
/// False only where nothing of the lamp's light can arrive in the box, by its range or its cone. Tens of operations.
[[nodiscard]] bool may_reach(const Lamp& lamp, const BatchBounds& bounds);
/// Of all fragments of the batch.
void find_lamp_light(const Lamp& lamp, const FragmentBatch& batch, LampLight& light, Isa isa);

/// The direct lights of a picture, each with the light of the file that it is, or null: the key light.
struct PictureLights {
  struct Far {
    DirectLight light;
    const Light* source;
  };
  struct Near {
    Lamp lamp;
    const Light* source;
  };
  std::vector<Far> far;  ///< the key light first, where it counts
  std::vector<Near> near;

  /// Those that count in a picture seen from `eye`, in the order of the file; dark ones are left out. Borrows them.
  /// \throws Error limit_exceeded for more than 4096.
  void set(const DirectLight* key, std::span<const Light> lights, const glm::dvec3& eye);
};

}  // namespace frontmost::shading
