// SPDX-License-Identifier: Apache-2.0
// Pictures of translucent triangles of one colour each: by shade(), and composited from the A-buffer's lists in
// doubles.
#pragma once

#include <algorithm>
#include <tuple>

#include "frontmost/abuffer.h"
#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"

namespace frontmost::test {

/// The scene with its triangles in these colours (linear, straight alpha) by primitive; the colours repeat if there are
/// fewer. Triangles of alpha 1 are opaque, all others blended.
inline Scene painted(Scene scene, std::span<const glm::vec4> colors) {
  scene.materials.assign(colors.size(), Material());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    scene.materials[i].base_color = colors[i];
    if (colors[i].a != 1) scene.materials[i].alpha = Material::Alpha::blend;
  }
  std::size_t primitive = 0;
  for (Mesh& mesh : scene.meshes) {
    mesh.material_ids.resize(mesh.triangles.size());
    for (std::uint32_t& id : mesh.material_ids) id = std::uint32_t(primitive++ % colors.size());
  }
  return scene;
}

/// Picture by shade() of all layers in their base colours, without a background.
inline Image flat_picture(const Surfaces& surfaces, const View& view, const AbufferOptions& options = {},
                          const Execution& execution = {}) {
  ShadeOptions flat{.shading = Shading::flat, .background = std::nullopt};
  flat.opacity = options.opacity;
  flat.layers.see_through = SeeThrough::always;
  flat.layers.grid = options.grid;
  return shade(surfaces, zbuffer(surfaces, view, execution), flat, execution);
}

/// Premultiplied colour and alpha of a pixel.
inline glm::vec4 pixel_of(const Image& picture, std::size_t pixel) {
  glm::vec4 color;
  for (int k = 0; k < 4; ++k) color[k] = picture.channels[std::size_t(k)].floats()[pixel];
  return color;
}
inline glm::vec4 pixel_of(const Image& picture, int x, int y) {
  return pixel_of(picture, std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
}

/// Composites a pixel's fragments in the order of their keys at every sub-sample; returns the premultiplied mean.
/// Colours are by primitive; their alphas are ignored, and the fragments' opacities count.
inline glm::dvec4 laid_over(const FragmentLists& lists, int x, int y, std::span<const glm::vec4> colors) {
  glm::dvec4 sum(0);
  for (std::size_t s = 0; s < lists.samples.size(); ++s) {
    const glm::dvec2 from_centre = glm::dvec2(lists.samples[s] - 128) / 256.0;
    std::vector<std::tuple<double, PrimitiveId, double>> order;  // nearest first
    for (const Fragment& f : lists.at(x, y)) {
      const double key = double(f.key) + from_centre.x * double(f.key_dx) + from_centre.y * double(f.key_dy);
      if (f.mask >> s & 1) order.emplace_back(-key, f.primitive, f.opacity);
    }
    std::sort(order.begin(), order.end());
    double left = 1;
    for (const auto& [key, id, opacity] : order) {
      sum += glm::dvec4(glm::dvec3(colors[id]) * (left * opacity), 0);
      left *= 1 - opacity;
    }
    sum.a += 1 - left;
  }
  return sum / double(lists.samples.size());
}

}  // namespace frontmost::test
