// SPDX-License-Identifier: Apache-2.0
// What becomes of a material whose texture cannot be used. A factor is the greatest value that its texture allows, not
// a mean: where the texture says which parts glow or are of metal, the factor alone would make all of them so.
#pragma once

#include <string>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// The material does not glow. `who` names it in the warning.
void lose_emissive_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);
/// The material is no metal, as most that are seen. Its roughness stays.
void lose_metallic_roughness_texture(Material& material, const std::string& who, std::vector<std::string>& warnings);

}  // namespace frontmost
