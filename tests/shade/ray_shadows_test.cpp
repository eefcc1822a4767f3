// SPDX-License-Identifier: Apache-2.0
// Shadows by rays: their places, no self-shadowing, and the distance of shadow maps from them.
#include <gtest/gtest.h>

#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "frontmost/files.h"
#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "scene/shapes.h"
#include "shade/support.h"
#include "support/models.h"
#include "support/shadow_band.h"

namespace frontmost::test {
namespace {

Image picture(const Scene& scene, const View& view, const ShadeOptions& options, const Execution& execution = {}) {
  const Surfaces surfaces(scene, execution);
  return shade(surfaces, zbuffer(surfaces, view, execution), options, execution);
}

Image by_rays(const Scene& scene, const View& view) {
  return picture(scene, view, {.light = {.shadows = Shadows::rays}});
}
Image unshadowed(const Scene& scene, const View& view) {
  return picture(scene, view, {.light = {.shadows = Shadows::off}});
}

std::size_t differing(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += color_at(a, x, y) != color_at(b, x, y);
  return count;
}

/// A small square in front of a large one.
Scene roof_and_floor(double height) {
  Scene scene = scene_of(square());
  scene.instances[0].world_from_mesh = glm::dmat4(2.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.instances.push_back({"roof", 0, glm::dmat4(0.25)});
  scene.instances[1].world_from_mesh[3] = {-0.5, 0.5, height, 1};
  return scene;
}

TEST(RayShadows, TheShadowIsTheRoofMovedAlongTheLight) {
  const Scene scene = roof_and_floor(0.6);
  const View view = front_view(128);
  const Image lit = unshadowed(scene, view), shadowed = by_rays(scene, view);
  const glm::vec3 to_key = shading::direction_to_key(view, {});
  const glm::dvec2 centre = glm::dvec2(-0.5, 0.5) - 0.6 * glm::dvec2(to_key) / double(to_key.z);
  std::size_t dark = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const glm::dvec2 at((x + 0.5) / 32 - 2, 2 - (y + 0.5) / 32);
      const glm::dvec2 from_roof = glm::abs(at - glm::dvec2(-0.5, 0.5)), from_shadow = glm::abs(at - centre);
      const bool is_roof = std::max(from_roof.x, from_roof.y) < 0.25;
      const bool expected = !is_roof && std::max(from_shadow.x, from_shadow.y) < 0.25;
      ASSERT_EQ(color_at(lit, x, y) != color_at(shadowed, x, y), expected) << x << ", " << y;
      dark += expected;
    }
  EXPECT_GT(dark, 200u);
}

TEST(RayShadows, EdgesHaveAsManyShadesAsSamples) {
  Scene scene = roof_and_floor(0.6);
  const glm::dvec4 place = scene.instances[1].world_from_mesh[3];
  scene.instances[1].world_from_mesh = glm::dmat4({0.24, 0.07, 0, 0}, {-0.07, 0.24, 0, 0}, {0, 0, 0.25, 0}, place);
  const Image lit = unshadowed(scene, front_view(64, 4)), shadowed = by_rays(scene, front_view(64, 4));
  std::vector<float> shades;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float difference = color_at(lit, x, y).g - color_at(shadowed, x, y).g;
      const auto same = [&](float other) { return std::abs(other - difference) < 1e-4f; };
      if (std::none_of(shades.begin(), shades.end(), same)) shades.push_back(difference);
    }
  // 0 to 4 of four samples are in shadow, and some pixels show roof and floor.
  EXPECT_GE(shades.size(), 5u);
  EXPECT_LE(shades.size(), 12u);
}

TEST(RayShadows, AConvexSolidShowsNoShadow) {
  // Flat and smooth faces at all angles: faces towards the light are lit, and others are dark without it.
  for (const char* name : {"cubes", "spheres"}) {
    Scene whole = builtin(name);
    Scene scene;
    scene.materials = whole.materials;
    scene.meshes = whole.meshes;
    scene.instances = {whole.instances.back()};
    const glm::dmat4 upright = scene.instances[0].world_from_mesh;
    for (const double turn : {0.0, 0.7, 2.1}) {
      const double c = std::cos(turn), sn = std::sin(turn);
      scene.instances[0].world_from_mesh =
          glm::dmat4({c, sn * 0.6, sn * 0.8, 0}, {0, 0.8, -0.6, 0}, {-sn, c * 0.6, c * 0.8, 0}, {0, 0, 0, 1}) * upright;
      const View view = frame(Surfaces(scene), 200, 150);
      EXPECT_EQ(differing(unshadowed(scene, view), by_rays(scene, view)), 0u) << name << " " << turn;
    }
  }
}

// A second ball around the first surely blocks all light, so it must not change anything inside.
TEST(RayShadows, NoLightComesThroughTheWallOfAHollowBall) {
  Scene alone = scene_of(sphere(12)), within = scene_of(sphere(12));
  within.instances.push_back({"outer", 0, glm::scale(glm::dmat4(1.0), glm::dvec3(3))});
  View view;
  view.width = view.height = 160;
  view.projection = make_projection(glm::radians(100.0), 1, {0.01, 100});
  for (const glm::dvec3 ahead : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(-0.6, 0.8, 0)}) {
    view.world_from_eye = look_at({0, 0, 0}, ahead, {0, 0.1, 1});
    EXPECT_EQ(differing(by_rays(alone, view), by_rays(within, view)), 0u);
  }
}

TEST(RayShadows, TheSameForAnyThreadsInstructionSetAndIndex) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  FrameOptions four;
  four.samples = 4;
  const Visible visible = zbuffer(surfaces, frame(surfaces, 240, 160, four));
  const RayIndex index(surfaces);
  const Image first = shade(surfaces, visible, {.light = {.shadows = Shadows::rays}}, {.threads = 1});
  const Image with_index =
      shade(surfaces, {.visible = &visible, .index = &index}, {.light = {.shadows = Shadows::rays}}, {.threads = 3});
  const Image scalar = shade(surfaces, visible, {.light = {.shadows = Shadows::rays}}, {.isa = Isa::scalar});
  EXPECT_EQ(differing(first, with_index), 0u);
  EXPECT_EQ(differing(first, scalar), 0u);
  EXPECT_GT(differing(first, shade(surfaces, visible, {.light = {.shadows = Shadows::off}})), 100u);
}

TEST(RayShadows, GlassThrowsNoneAndIsNotKnownByIds) {
  // The glass comes first, so that shadow casters have other numbers than shaded triangles.
  Scene scene = roof_and_floor(0.6);
  std::swap(scene.instances[0], scene.instances[1]);
  scene.meshes.push_back(scene.meshes[0]);
  scene.instances[0].mesh = 1;
  Material glass = colored({1, 1, 1, 0.5f});
  glass.alpha = Material::Alpha::blend;
  scene.materials = {colored(glm::vec4(0.8f)), glass};
  scene.meshes[0].material_ids = {0};
  scene.meshes[1].material_ids = {1};
  const View view = front_view(64);
  EXPECT_EQ(differing(unshadowed(scene, view), by_rays(scene, view)), 0u);
  scene.meshes[1].material_ids = {0};
  EXPECT_GT(differing(unshadowed(scene, view), by_rays(scene, view)), 50u);
}

void expect_explained(const char* name, const Scene& scene, int stride) {
  SCOPED_TRACE(name);
  const Surfaces surfaces(scene);
  const ShadowBand band = ShadowBandMeter(surfaces, frame(surfaces, 480, 360)).measure(stride);
  EXPECT_GT(band.asked, 300u);
  EXPECT_EQ(band.unexplained, 0u) << "of " << band.differing;
  EXPECT_LE(band.widest, 4 + 1.0 / 128);
  std::printf(
      "%s: %zu pixels, %zu in shadow; %zu differ, %zu wholly, %zu by the bias; %zu unexplained, band %.2f texels\n",
      name, band.asked, band.in_shadow, band.differing, band.opposite, band.by_bias, band.unexplained, band.widest);
}

TEST(RayShadows, TheMapDiffersOnlyWhereAnEdgeIsWithinItsFilter) {
  expect_explained("roof", roof_and_floor(0.4), 1);
  for (const char* name : {"teapot", "cubes", "spheres"}) expect_explained(name, builtin(name), 3);
  expect_explained("city", builtin("city"), 5);
}

TEST(RayShadows, TheMapDiffersOnlyWhereAnEdgeIsWithinItsFilterOnModels) {
  FRONTMOST_NEEDS_MODELS();
  for (const char* name : {"cad/crank-arm.stl", "assembly/2-cylinder-engine.glb", "scenes/sponza.glb"})
    expect_explained(name, load(model(name)), 7);
}

}  // namespace
}  // namespace frontmost::test
