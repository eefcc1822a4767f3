// SPDX-License-Identifier: Apache-2.0
// The numbers of a material and the ranges that they have by frontmost/scene.h. Readers tell what they change; whoever
// shades changes it in silence, as scenes are also made by code.
//
//   number                      range              not a number counts as
//   base colour, metallic,
//   roughness, occlusion        0 to 1             the default
//   emissive                    0 and up           0
//   ior                         0, or 1 and up     1.5
//   factors, roughnesses        0 to 1             the default
//   colours                     0 to 1             the default; colours of Specular reach higher
//   thickness                   0 and up           0
//   attenuation distance        above 0            infinite
//
// What goes "and up" ends at a million million, so that squares and quotients are numbers still.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// A number of a material, by its name in glTF, with its range and what counts where it is not a number.
struct MaterialNumber {
  const char* name;
  float* value;
  float least, greatest, otherwise;

  /// What the number counts as.
  [[nodiscard]] float in_range() const;
};

inline constexpr std::size_t material_number_count = 28;
[[nodiscard]] std::array<MaterialNumber, material_number_count> numbers_of(Material& material);

/// Brings all of them into their ranges.
void limit_numbers(Material& material);

}  // namespace frontmost
