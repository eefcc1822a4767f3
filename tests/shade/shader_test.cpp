// SPDX-License-Identifier: Apache-2.0
// The Shader object: pictures that share prepared data equal those of the functions, and allocate no memory.
#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/frontmost.h"
#include "shade/support.h"
#include "support/allocation_count.h"

namespace frontmost::test {
namespace {

/// A scene with textures, a mesh without normals, a mesh with normals, and holes.
Scene scene_of_everything(Material::Alpha alpha) {
  std::vector<glm::u8vec4> texels;
  for (int i = 0; i < 64; ++i) texels.push_back({i * 4, 255 - i * 3, 90, i % 5 == 0 ? 40 : 255});
  Scene scene = builtin("teapot");
  scene.materials.assign(2, Material{});
  scene.textures = {texture_of(8, 8, texels)};
  scene.materials[0].base_color_texture.texture = 0;
  scene.materials[0].alpha = alpha;
  scene.materials[1].roughness = 0.3f;
  for (Mesh& mesh : scene.meshes) mesh.material_ids = {1};
  Mesh wall = square();
  wall.material_ids = {0};
  scene.meshes.push_back(wall);
  const Box bounds = Surfaces(scene).bounds();
  const glm::dvec3 middle = bounds.centre();
  const double size = glm::distance(bounds.low, bounds.high);
  for (const double side : {-1.0, 1.0}) {
    scene.instances.push_back({"wall", std::uint32_t(scene.meshes.size() - 1), glm::dmat4(0.3 * size)});
    scene.instances.back().world_from_mesh[3] = glm::dvec4(middle + glm::dvec3(0.1, 0.1, 0.3) * size * side, 1);
  }
  scene.meshes[0].normals = {};
  return scene;
}

/// Views from all around, with two sizes and two numbers of samples.
View view_of_flight(const Surfaces& surfaces, int i, int samples = 1) {
  View view = frame(surfaces, i % 5 == 4 ? 100 : 160, 120, {.samples = samples});
  const glm::dvec3 middle = surfaces.bounds().centre(), from = view.eye() - middle;
  const double turn = 0.7 * i, zoom = 1 - 0.1 * (i % 4);
  const glm::dvec3 turned(std::cos(turn) * from.x - std::sin(turn) * from.y,
                          std::sin(turn) * from.x + std::cos(turn) * from.y, from.z);
  return view.looking(middle + turned * zoom, middle, direction(surfaces.scene().up)).enclosing(surfaces.bounds());
}

void expect_same(const Bitmap& expected, const Bitmap& found) {
  ASSERT_EQ(expected.width, found.width);
  ASSERT_EQ(expected.height, found.height);
  EXPECT_EQ(std::memcmp(expected.rgba.data(), found.rgba.data(), expected.rgba.size()), 0);
}

void expect_same(const Image& expected, const Image& found) {
  ASSERT_EQ(expected.channels.size(), found.channels.size());
  for (std::size_t k = 0; k < expected.channels.size(); ++k) {
    const Buffer<float>&a = expected.channels[k].floats(), &b = found.channels[k].floats();
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << expected.channels[k].name;
  }
}

// Shadow maps of a flight are drawn from clusters, those of a single picture without.
TEST(Shader, ManyShadowMapsMakeClusters) {
  const Scene scene = scene_of_everything(Material::Alpha::opaque);
  const Surfaces surfaces(scene);
  const std::size_t without = surfaces.byte_count();
  Shader shader(surfaces);
  for (int i = 0; i < 4; ++i) {
    const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, i));
    ShadeOptions options;
    options.light.shadows = Shadows::map;
    options.light.direction = glm::dvec3(i, 1, 2);
    (void)shader.shade({.visible = &visible}, options);
    EXPECT_EQ(surfaces.byte_count() > without, i >= 2) << i;
  }
}

TEST(Shader, PicturesOneAfterAnotherAreThoseOfTheFunctions) {
  for (const Material::Alpha alpha : {Material::Alpha::opaque, Material::Alpha::mask, Material::Alpha::blend}) {
    const Scene scene = scene_of_everything(alpha);
    const Surfaces surfaces(scene);
    Shader shader(surfaces);
    for (int i = 0; i < 24; ++i) {
      SCOPED_TRACE(i);
      const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, i, i % 7 == 6 ? 4 : 1));
      ShadeOptions options;
      options.shading = i % 3 == 0 ? Shading::lit : Shading(i % 6);
      options.light.shadows = Shadows(i / 3 % 3);
      const Execution execution{.threads = 1 + i % 3};
      if (i % 2 == 0)
        expect_same(shade_bitmap(surfaces, visible, options),
                    shader.shade_bitmap({.visible = &visible}, options, execution));
      else
        expect_same(shade(surfaces, visible, options), shader.shade({.visible = &visible}, options, execution));
      if (i % 8 == 5) expect_same(normal_image(surfaces, visible), shader.normal_image(visible, execution));
    }
  }
}

TEST(Shader, FiguresAndDeepImagesAreThoseOfTheFunctions) {
  const Scene scene = scene_of_everything(Material::Alpha::blend);
  const Surfaces surfaces(scene);
  Shader shader(surfaces);
  for (int i = 0; i < 3; ++i) {
    const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, i));
    const DeepImage expected = shade_deep(surfaces, visible), found = shader.shade_deep({.visible = &visible});
    ASSERT_EQ(expected.first.size(), found.first.size());
    EXPECT_EQ(std::memcmp(expected.channels[0].floats().data(), found.channels[0].floats().data(),
                          expected.channels[0].floats().size() * sizeof(float)),
              0);
    const Figure figure = draw_figure(surfaces, visible), again = draw_figure(shader, {.visible = &visible});
    ASSERT_EQ(figure.shapes.size(), again.shapes.size());
    for (std::size_t s = 0; s < figure.shapes.size(); ++s)
      ASSERT_EQ(figure.shapes[s].color, again.shapes[s].color) << s;
  }
}

TEST(Shader, AFlightAllocatesNothingOnceItHasBeenFlown) {
  Scene scene = scene_of_everything(Material::Alpha::opaque);
  const Surfaces surfaces(scene);
  Shader shader(surfaces);
  ZBuffer buffer;
  for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals, Shading::ids}) {
    ShadeOptions options{.shading = shading};
    if (shading == Shading::lit) options.light.ambient_occlusion.emplace();
    if (shading == Shading::flat) options.pixels.rate = ShadingRate::each_2x2;
    const void* planes = nullptr;
    const auto fly = [&] {
      std::size_t count = 0;
      for (int i = 0; i < 8; ++i) {
        const Visible& visible = buffer.draw(surfaces, view_of_flight(surfaces, i % 4), {.threads = 1});
        const std::size_t before = allocation_count();
        const Bitmap& bitmap = shader.shade_bitmap({.visible = &visible}, options, {.threads = 1});
        count += allocation_count() - before + (planes && bitmap.rgba.data() != planes);
        planes = bitmap.rgba.data();
      }
      return count;
    };
    fly();
    EXPECT_EQ(fly(), 0u) << int(shading);
  }
}

TEST(Shader, DrawsTheLightsMapAgainOnlyWhenTheLightSeesSomethingElse) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const Visible first = zbuffer(surfaces, view_of_flight(surfaces, 0));
  const Visible second = zbuffer(surfaces, view_of_flight(surfaces, 1));
  Shader shader(surfaces);
  std::size_t drawn = 0;
  const Watch watch{[&](std::string_view stage, double fraction) { drawn += stage == "visible" && fraction == 1; }, {}};
  const auto maps_for = [&](const Visible& visible) {
    drawn = 0;
    shader.shade({.visible = &visible}, {}, {.threads = 1, .watch = &watch});
    return drawn;
  };
  EXPECT_EQ(maps_for(first), 1u);
  EXPECT_EQ(maps_for(first), 0u);
  EXPECT_EQ(maps_for(second), 1u);
  EXPECT_EQ(maps_for(first), 1u);
}

TEST(Shader, AMaterialThatIsNeverSeenCostsNoMemory) {
  Scene scene = scene_of_everything(Material::Alpha::opaque);
  scene.materials.push_back(scene.materials[0]);
  Mesh hidden = square();
  hidden.material_ids = {2};
  scene.meshes.push_back(hidden);
  scene.instances.push_back({"behind the camera", std::uint32_t(scene.meshes.size() - 1), glm::dmat4(1e-3)});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, 0));
  Shader shader(surfaces);
  for (int i = 0; i < 4; ++i) {
    const std::size_t before = allocation_count();
    shader.shade_bitmap({.visible = &visible}, {}, {.threads = 1});
    if (i > 1) {
      EXPECT_EQ(allocation_count(), before);
    }
  }
}

TEST(Shader, RefusesWhatItCannotReadBeforeItAsksForMemory) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, 0));
  Shader shader(surfaces);
  const Bitmap good = shader.shade_bitmap({.visible = &visible});
  const auto is_refused = [](const auto& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.code() == ErrorCode::bad_argument;
    }
    return false;
  };
  for (const int width : {-5, 2'000'000'000}) {
    Visible wrong = visible;
    wrong.view.width = width;
    EXPECT_TRUE(is_refused([&] { shader.shade({.visible = &wrong}); })) << width;
    EXPECT_TRUE(is_refused([&] { shader.shade_bitmap({.visible = &wrong}); })) << width;
    EXPECT_TRUE(is_refused([&] { (void)draw_figure(surfaces, wrong); })) << width;
  }
  Visible moved = visible;
  const Visible planes = std::move(moved);
  EXPECT_TRUE(is_refused([&] { (void)draw_figure(surfaces, moved); }));
  EXPECT_TRUE(is_refused([&] { shader.shade({.visible = &visible, .seen_by_light = &moved}); }))
      << "what the light sees";
  EXPECT_TRUE(is_refused([&] { shader.shade({.visible = &visible, .seen_by_light = &visible}); }))
      << "not a light's view";
  EXPECT_TRUE(is_refused([&] { (void)draw_figure(surfaces, {.visible = &visible, .seen_by_light = &moved}); }));
  expect_same(good, shader.take_bitmap());
  EXPECT_TRUE(shader.take_bitmap().rgba.empty());
  EXPECT_EQ(shader.take_bitmap().width, 0);
  // The light's picture must use the view of key_light_view().
  const Visible light = zbuffer(surfaces, *key_light_view(visible, surfaces.bounds()));
  expect_same(good, shader.shade_bitmap({.visible = &visible, .seen_by_light = &light}));
}

TEST(Shader, ErrorsLeaveItUsable) {
  const Scene scene = scene_of_everything(Material::Alpha::mask);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view_of_flight(surfaces, 0));
  const Bitmap expected = shade_bitmap(surfaces, visible);
  for (int last = 1; last < 40; last += 3) {
    Shader shader(surfaces);
    int asked = 0;
    const Watch watch{{}, [&] { return ++asked >= last; }};
    try {
      shader.shade_bitmap({.visible = &visible}, {}, {.threads = 1, .watch = &watch});
      EXPECT_GT(last, 10);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    expect_same(expected, shader.shade_bitmap({.visible = &visible}));
  }
  Shader shader(surfaces);
  EXPECT_THROW(shader.shade({.visible = &visible}, {.opacity = 2}), Error);
  Visible other = visible;
  other.primitives[0] = surfaces.primitive_count();
  EXPECT_THROW(shader.shade({.visible = &other}), Error);
}

}  // namespace
}  // namespace frontmost::test
