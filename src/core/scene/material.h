// SPDX-License-Identifier: Apache-2.0
// The numbers of a material, and their ranges by frontmost/scene.h. Readers report the numbers that they change.
// Shading changes numbers silently, because scenes are also made by code.
//
//   number                      range              NaN counts as
//   base colour, metallic,
//   roughness, occlusion        0 to 1             the default
//   emissive                    0 and up           0
//   ior                         0, or 1 and up     1.5
//   factors, roughnesses        0 to 1             the default
//   colours                     0 to 1             the default; colours of Specular reach higher
//   thickness                   0 and up           0
//   attenuation distance        above 0            infinite
//
// Ranges "and up" end at 1e12, so that squares and quotients stay finite.
#pragma once

#include "frontmost/scene.h"

namespace frontmost {

/// A number of a material, by its name in glTF, with its range and the value that replaces NaN.
struct MaterialNumber {
  const char* name;
  float* value;
  float least, greatest, otherwise;

  /// The value limited to its range, or `otherwise` if it is NaN.
  [[nodiscard]] float in_range() const;
};

inline constexpr std::size_t material_number_count = 28;
[[nodiscard]] std::array<MaterialNumber, material_number_count> numbers_of(Material& material);

/// Limits all numbers of a material to their ranges.
void limit_numbers(Material& material);

}  // namespace frontmost
