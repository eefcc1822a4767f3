// SPDX-License-Identifier: Apache-2.0
// Further sets of texture coordinates: if a model's sets are exchanged and its textures name the other set, the
// pictures are the same to the bit.
#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/abuffer.h"
#include "frontmost/drawings.h"
#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "shade/support.h"

namespace frontmost {
namespace {

using namespace test;

Texture random_texture(Random& random) {
  Texture texture = texture_of(9, 7, {});
  for (int i = 0; i < 9 * 7; ++i) {
    const std::uint32_t bits = random.next();
    texture.pixels.emplace_back(bits, bits >> 8, bits >> 16, bits >> 24);
  }
  return texture;
}

std::vector<glm::vec2> random_texcoords(std::size_t count, Random& random) {
  std::vector<glm::vec2> values;
  for (std::size_t i = 0; i < count; ++i) {
    const float u = random.within(-1, 2);
    values.emplace_back(u, random.within(-1, 2));
  }
  return values;
}

/// Triangles of three materials: opaque with every texture, cut out, and blended. All textures use the set `used`,
/// except the emissive one, which uses `other`. Unused sets hold nonsense; colours are by vertex.
Scene scene_with_sets(std::uint32_t used, std::uint32_t other) {
  Random random(5);
  Mesh mesh = random_mesh(Kind::soup, 60, 3);
  const std::size_t count = mesh.positions.size();
  mesh.further_texcoords.resize(max_texcoord_sets - 1);
  const auto set = [&](std::uint32_t k) -> Attribute<glm::vec2>& {
    return k == 0 ? mesh.texcoords : mesh.further_texcoords[k - 1];
  };
  Random nonsense(used * 10 + other);
  for (std::uint32_t k = 0; k < max_texcoord_sets; ++k) set(k).values = random_texcoords(count, nonsense);
  set(used).values = random_texcoords(count, random);
  set(other).values = random_texcoords(count, random);
  for (std::size_t i = 0; i < count; ++i) mesh.colors.values.emplace_back(random.unit(), 1, 0.5f, 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.material_ids.push_back(std::uint32_t(t % 3));
  Scene scene = scene_of(std::move(mesh));
  for (int i = 0; i < 5; ++i) scene.textures.push_back(random_texture(random));
  Material material;
  std::uint32_t texture = 0;
  for (TextureUse* use : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                          &material.occlusion_texture, &material.emissive_texture})
    *use = {.texture = texture++, .scale = {1, 0.5f}, .rotation = 0.3f, .set = used};
  material.emissive_texture.set = other;
  material.emissive = glm::vec3(0.1f);
  scene.materials.assign(3, material);
  scene.materials[1].alpha = Material::Alpha::mask;
  scene.materials[2].alpha = Material::Alpha::blend;
  return scene;
}

/// Results of everything that looks up textures, one after the other.
std::vector<float> everything(const Scene& scene) {
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 70, 50);
  std::vector<float> values;
  const auto add = [&](const Image& image) {
    for (const Channel& channel : image.channels)
      if (channel.name != "primitive") values.insert(values.end(), channel.floats().begin(), channel.floats().end());
  };
  for (const int samples : {1, 4}) {
    view.samples = samples;
    for (const Visible& visible : {zbuffer(surfaces, view), raycast(surfaces, view)}) {
      add(depth_image(visible));
      add(normal_image(surfaces, visible));
      for (const SeeThrough see_through : {SeeThrough::never, SeeThrough::always})
        for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals})
          add(shade(surfaces, visible, {.shading = shading, .layers = {.see_through = see_through}}));
      add(shade(surfaces, visible, {.light = {.shadows = Shadows::rays}}));
    }
  }
  view.samples = 1;
  const Figure figure = draw_figure(surfaces, view);
  for (const FigureShape& shape : figure.shapes)
    for (int c = 0; c < 4; ++c) values.push_back(float(shape.color[c]));
  for (const auto& corner : figure.corners) values.insert(values.end(), {float(corner.x), float(corner.y)});
  return values;
}

TEST(TexcoordSets, ExchangedSetsMakeTheSamePictures) {
  const std::vector<float> first = everything(scene_with_sets(0, 1));
  EXPECT_GT(first.size(), 100'000u);
  for (const auto& [used, other] : {std::pair(1u, 0u), {3u, 0u}, {2u, 3u}}) {
    const std::vector<float> exchanged = everything(scene_with_sets(used, other));
    ASSERT_EQ(exchanged.size(), first.size()) << used;
    EXPECT_EQ(std::memcmp(exchanged.data(), first.data(), first.size() * sizeof(float)), 0) << used;
  }
  // The comparison can tell sets apart.
  Scene wrong = scene_with_sets(1, 0);
  for (Material& material : wrong.materials) material.base_color_texture.set = 0;
  EXPECT_NE(everything(wrong), first);
}

TEST(TexcoordSets, ASetThatIsNotThereIsTheOrigin) {
  Material material;
  material.base_color_texture = {.texture = 0, .set = 2};
  Scene scene = scene_of(square(), material);
  scene.textures.push_back(texture_of(2, 1, {{255, 0, 0, 255}, {0, 255, 0, 255}}));
  scene.textures[0].nearest = true;
  const Surfaces surfaces(scene);
  const Image image = shade(surfaces, zbuffer(surfaces, front_view()), {.shading = Shading::flat});
  for (const int x : {20, 31, 43}) EXPECT_EQ(color_at(image, x, 32), glm::vec4(1, 0, 0, 1));
}

TEST(TexcoordSets, EveryInstructionSetLooksUpTheSame) {
  const Scene scene = scene_with_sets(2, 1);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 61, 43);
  const Visible visible = zbuffer(surfaces, view);
  const Image best = shade(surfaces, visible);
  for (const Isa isa : available_isas()) {
    const Image image = shade(surfaces, visible, {}, {.threads = 2, .isa = isa});
    EXPECT_EQ(content_hash(image), content_hash(best)) << name(isa);
  }
}

}  // namespace
}  // namespace frontmost
