// SPDX-License-Identifier: Apache-2.0
// Pictures blended as light, and as viewers of figures blend, with numbers computed by hand.
#include <gtest/gtest.h>

#include "frontmost/frontmost.h"
#include "shade/support.h"

namespace frontmost::test {
namespace {

constexpr glm::vec4 kHalfRed{1, 0, 0, 0.5f};

/// The middle, where red covers blue, and a corner, where red covers the background.
struct Shown {
  glm::ivec4 over_blue, over_background;
};

glm::ivec4 pixel_of(const Bitmap& bitmap, int x, int y) {
  const std::uint8_t* const p = bitmap.rgba.data() + 4 * (y * bitmap.width + x);
  return {p[0], p[1], p[2], p[3]};
}

/// A half-transparent red square of side 2 in front of a blue one of side 1.
Scene red_before_blue() {
  Scene scene = layered_scene(Material::Alpha::blend, kHalfRed);
  scene.instances[1].world_from_mesh = glm::dmat4(0.5);
  scene.instances[1].world_from_mesh[3] = {0, 0, -1, 1};
  return scene;
}

Shown shown(const ShadeOptions& options, int samples = 1) {
  const Scene scene = red_before_blue();
  const Surfaces surfaces(scene);
  const Bitmap bitmap = shade_bitmap(surfaces, zbuffer(surfaces, front_view(64, samples)), options);
  return {pixel_of(bitmap, 32, 32), pixel_of(bitmap, 19, 19)};
}

void expect_near(const glm::ivec4& found, const glm::ivec4& expected) {
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], 1) << k;
}

// sRGB of a half is 188; half of 255 is 127.5.
TEST(SrgbBlend, HalfARedIsWhatViewersMakeOfIt) {
  for (const int samples : {1, 4}) {
    const Shown linear = shown({.shading = Shading::flat}, samples);
    expect_near(linear.over_background, {255, 188, 188, 255});
    expect_near(linear.over_blue, {188, 0, 188, 255});
    const Shown srgb = shown({.shading = Shading::flat, .pixels = {.blend = Blend::srgb}}, samples);
    expect_near(srgb.over_background, {255, 128, 128, 255});
    expect_near(srgb.over_blue, {128, 0, 128, 255});
  }
}

// Without a background there is nothing to blend with.
TEST(SrgbBlend, ATransparentBackgroundKeepsColourAndAlpha) {
  for (const Blend blend : {Blend::linear, Blend::srgb}) {
    const Shown found = shown({.shading = Shading::flat, .background = std::nullopt, .pixels = {.blend = blend}});
    expect_near(found.over_background, {255, 0, 0, 128});
  }
}

// The red shapes of a figure, blended over white by hand, equal the picture.
TEST(SrgbBlend, PicturesAreWhatFiguresAre) {
  const Scene scene = red_before_blue();
  const Surfaces surfaces(scene);
  const Figure figure = draw_figure(surfaces, zbuffer(surfaces, front_view()), {.shade = {.shading = Shading::flat}});
  const Shown srgb = shown({.shading = Shading::flat, .pixels = {.blend = Blend::srgb}});
  int reds = 0;
  for (const FigureShape& shape : figure.shapes) {
    if (shape.color.r < 200) continue;
    const float alpha = float(shape.color.a) / 255;
    const glm::vec3 over_white = glm::vec3(255 * (1 - alpha)) + glm::vec3(shape.color) * alpha;
    expect_near(srgb.over_background, glm::ivec4(glm::ivec3(over_white + 0.5f), 255));
    ++reds;
  }
  EXPECT_GT(reds, 0);
}

// Opaque surfaces keep their colours, to the step.
TEST(SrgbBlend, OpaqueColoursStayWhatTheyAre) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, frame(surfaces, 80, 60));
  const Bitmap one = shade_bitmap(surfaces, visible),
               other = shade_bitmap(surfaces, visible, {.pixels = {.blend = Blend::srgb}});
  for (std::size_t i = 0; i < one.rgba.size(); ++i) EXPECT_NEAR(one.rgba[i], other.rgba[i], 1);
}

// Rims are averaged in the same values: between black and white, the middle of the bytes.
TEST(SrgbBlend, RimsAreAsWellBlended) {
  const Scene scene = scene_of(square(), colored({0, 0, 0, 1}));
  const Surfaces surfaces(scene);
  View view = front_view(64, 16);
  view.projection = make_orthographic(-2 + 2.0 / 64, 2 + 2.0 / 64, -2, 2, {1, 20});  // shifted half a pixel to the left
  const Visible visible = zbuffer(surfaces, view);
  const auto rim = [&](Blend blend) {
    return pixel_of(shade_bitmap(surfaces, visible, {.shading = Shading::flat, .pixels = {.blend = blend}}), 15, 32).r;
  };
  EXPECT_NEAR(rim(Blend::linear), 188, 1);
  EXPECT_NEAR(rim(Blend::srgb), 128, 1);
}

}  // namespace
}  // namespace frontmost::test
