// SPDX-License-Identifier: Apache-2.0
// Scenes of triangles with holes.
#pragma once

#include "support/random_scene.h"

namespace frontmost::test {

/// Which triangles have holes, from a texture of random alphas: all, every second one, or none.
enum class Cut { all, half, none };

inline Texture random_alphas(Random& random) {
  Texture texture;
  texture.width = 1 + random.below(9);
  texture.height = 1 + random.below(9);
  for (int i = 0; i < texture.width * texture.height; ++i)
    texture.pixels.emplace_back(255, 255, 255, std::uint8_t(random.below(256)));
  texture.wrap_u = Texture::Wrap(random.below(3));
  texture.wrap_v = Texture::Wrap(random.below(3));
  texture.nearest = random.below(3) == 0;
  return texture;
}

/// A scene with holes wherever alpha is below `cutoff`: nowhere for 0, everywhere for more than 1.
inline Scene cutout_scene(Mesh mesh, Cut cut, float cutoff, std::uint64_t seed) {
  Random random(seed + 77);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float u = random.within(-2, 3);
    mesh.texcoords.values.emplace_back(u, random.within(-2, 3));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.material_ids.push_back(cut == Cut::all || (cut == Cut::half && t % 2 == 0) ? 1u : 0u);
  Scene scene = scene_of(std::move(mesh));
  scene.textures.push_back(random_alphas(random));
  scene.materials.resize(2);
  scene.materials[1].alpha = Material::Alpha::mask;
  scene.materials[1].alpha_cutoff = cutoff;
  scene.materials[1].base_color_texture.texture = 0;
  return scene;
}

}  // namespace frontmost::test
