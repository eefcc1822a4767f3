// SPDX-License-Identifier: Apache-2.0
// Pictures where two by two pixels share colours, against pictures where every pixel has its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "frontmost/abuffer.h"
#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/support.h"

namespace frontmost {
namespace {

using namespace test;

std::vector<std::uint8_t> bytes_of(const Bitmap& bitmap) { return {bitmap.rgba.begin(), bitmap.rgba.end()}; }

ShadeOptions with_rate(ShadeOptions options, ShadingRate rate) {
  options.pixels.rate = rate;
  return options;
}

View odd_view(const Surfaces& surfaces, int samples) {
  View view = frame(surfaces, 333, 187);
  view.samples = samples;
  return view;
}

/// The primitive that all samples of a pixel show; no_primitive if they show several.
PrimitiveId only_primitive(const Visible& visible, int x, int y) {
  const PrimitiveId first = visible.primitives[visible.index(x, y)];
  for (int s = 1; s < visible.view.samples; ++s)
    if (visible.primitives[visible.index(x, y, s)] != first) return no_primitive;
  return first;
}

/// The pixel whose colour the one at (x, y) takes.
glm::ivec2 leader_of(const Visible& visible, int x, int y) {
  const PrimitiveId own = only_primitive(visible, x, y);
  if (own == no_primitive) return {x, y};
  for (const glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1)}) {
    const glm::ivec2 p = glm::ivec2(x / 2 * 2, y / 2 * 2) + at;
    if (p.x < visible.view.width && p.y < visible.view.height && only_primitive(visible, p.x, p.y) == own) return p;
  }
  ADD_FAILURE() << "the pixel is in its own block";
  return {x, y};
}

struct Compared {
  std::size_t shared = 0;
  float farthest = 0;  ///< largest difference of any channel from its expected value
};

Compared compare_with_leaders(const Visible& visible, const Image& coarse, const Image& fine) {
  Compared compared;
  for (int y = 0; y < visible.view.height; ++y)
    for (int x = 0; x < visible.view.width; ++x) {
      const glm::ivec2 leader = leader_of(visible, x, y);
      compared.shared += leader != glm::ivec2(x, y);
      const glm::vec4 off = glm::abs(color_at(coarse, x, y) - color_at(fine, leader.x, leader.y));
      compared.farthest = std::max({compared.farthest, off.r, off.g, off.b, off.a});
    }
  return compared;
}

TEST(ShadingRate, PixelsOfABlockHaveTheColourOfTheFirstThatShowsTheirPrimitive) {
  for (const char* name : {"teapot", "cubes", "city"})
    for (const int samples : {1, 4})
      for (const Shading shading : {Shading::lit, Shading::normals}) {
        SCOPED_TRACE(testing::Message() << name << ", " << samples << " samples");
        const Scene scene = builtin(name);
        const Surfaces surfaces(scene);
        const Visible visible = zbuffer(surfaces, odd_view(surfaces, samples));
        const ShadeOptions options{.shading = shading, .layers = {.see_through = SeeThrough::never}};
        const Image fine = shade(surfaces, visible, options);
        const Image coarse = shade(surfaces, visible, with_rate(options, ShadingRate::each_2x2));
        const Compared compared = compare_with_leaders(visible, coarse, fine);
        EXPECT_LT(compared.farthest, plane_rounding);
        EXPECT_GT(compared.shared, visible.view.pixel_count() / 100);
      }
}

/// How far the colour of a pixel with one primitive is from the nearest colour of that primitive's pixels in its block.
float distance_to_block(const Visible& visible, const Image& coarse, const Image& fine, int x, int y) {
  float nearest = 1;
  for (int j = y / 2 * 2; j <= y; ++j)
    for (int i = x / 2 * 2; i < std::min(x / 2 * 2 + 2, visible.view.width); ++i) {
      if (only_primitive(visible, i, j) != only_primitive(visible, x, y)) continue;
      const glm::vec4 off = glm::abs(color_at(coarse, x, y) - color_at(fine, i, j));
      nearest = std::min(nearest, std::max({off.r, off.g, off.b, off.a}));
    }
  return nearest;
}

TEST(ShadingRate, LayersOfWholePixelsAreSharedWithWholePixelsAlone) {
  // No surface is in front of another, so a primitive shows wherever it covers a sample.
  Mesh mesh = square();
  mesh.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  Scene scene = scene_of(std::move(mesh), colored({1, 1, 1, 1}));
  scene.instances[0].world_from_mesh = glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(0, 0, 1));
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view(65, 4));
  const ShadeOptions options{.shading = Shading::flat, .layers = {.see_through = SeeThrough::always}};
  const Image fine = shade(surfaces, visible, options);
  const Image coarse = shade(surfaces, visible, with_rate(options, ShadingRate::each_2x2));
  float farthest = 0;
  std::size_t shared = 0;
  for (int y = 0; y < visible.view.height; ++y)
    for (int x = 0; x < visible.view.width; ++x) {
      if (only_primitive(visible, x, y) == no_primitive) continue;
      farthest = std::max(farthest, distance_to_block(visible, coarse, fine, x, y));
      shared += color_at(coarse, x, y) != color_at(fine, x, y);
    }
  EXPECT_LT(farthest, plane_rounding);
  EXPECT_GT(shared, 500u);
}

TEST(ShadingRate, RaysOfShadowsAreCastFromTheFirstPixel) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, odd_view(surfaces, 2));
  const ShadeOptions options{.light = {.shadows = Shadows::rays}};
  const Image fine = shade(surfaces, visible, options);
  const Image coarse = shade(surfaces, visible, with_rate(options, ShadingRate::each_2x2));
  EXPECT_LT(compare_with_leaders(visible, coarse, fine).farthest, plane_rounding);
}

/// Three squares one behind the other, the front two of glass, with colours that change from pixel to pixel.
Scene panes() {
  Scene scene;
  scene.up = Axis::y;
  for (std::uint32_t i = 0; i < 3; ++i) {
    Mesh mesh = square();
    mesh.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    mesh.material_ids = {i};
    const std::uint32_t object = add(scene, std::move(mesh));
    scene.instances[object].world_from_mesh[3] = {0.3 * i, 0.17 * i, -double(i), 1};
    Material material = colored({1, 1, 1, i == 2 ? 1.0f : 0.4f});
    if (i < 2) material.alpha = Material::Alpha::blend;
    scene.materials.push_back(material);
  }
  return scene;
}

/// Fragments of one pixel of a deep image, nearest first.
struct DeepPixel {
  const DeepImage& image;
  std::size_t begin, end;

  DeepPixel(const DeepImage& deep, int x, int y) : image(deep) {
    const auto pixel = std::size_t(y * deep.width + x);
    begin = deep.first[pixel], end = deep.first[pixel + 1];
  }
  [[nodiscard]] std::size_t size() const { return end - begin; }
  [[nodiscard]] const Channel& channel(std::string_view name) const {
    return *std::find_if(image.channels.begin(), image.channels.end(),
                         [&](const Channel& c) { return c.name == name; });
  }
  [[nodiscard]] std::uint32_t primitive(std::size_t k) const { return channel("primitive").integers()[begin + k]; }
  [[nodiscard]] float value(std::string_view name, std::size_t k) const { return channel(name).floats()[begin + k]; }
};

/// The k-th fragment of a pixel, or that of the first pixel in its block whose k-th has the same primitive.
std::pair<DeepPixel, std::size_t> shared_layer(const DeepImage& deep, int x, int y, std::size_t k) {
  const DeepPixel own(deep, x, y);
  for (const glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
    const glm::ivec2 p = glm::ivec2(x / 2 * 2, y / 2 * 2) + at;
    if (p.x >= deep.width || p.y * deep.width + p.x >= y * deep.width + x) continue;
    const DeepPixel other(deep, p.x, p.y);
    if (k < other.size() && other.primitive(k) == own.primitive(k)) return {other, k};
  }
  return {own, k};
}

/// A pixel's composited layers, each with the colour that it should have.
glm::vec4 laid_over(const DeepImage& deep, int x, int y, std::size_t& shared) {
  const DeepPixel own(deep, x, y);
  glm::vec4 sum(0);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto [layer, i] = shared_layer(deep, x, y, k);
    shared += layer.begin != own.begin;
    sum += (1 - sum.a) * glm::vec4(layer.value("R", i), layer.value("G", i), layer.value("B", i), layer.value("A", i));
  }
  return sum;
}

/// Compares two images of odd sizes, allowing for shared colours.
void expect_shared_layers(const Surfaces& surfaces, const View& view, std::size_t least_shared) {
  const ShadeOptions options{.background = std::nullopt, .light = {.shadows = Shadows::off}};
  const Visible visible = zbuffer(surfaces, view);
  const DeepImage deep = shade_deep(surfaces, visible, options);
  const Image coarse = shade(surfaces, visible, with_rate(options, ShadingRate::each_2x2));
  std::size_t shared = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const glm::vec4 wanted = laid_over(deep, x, y, shared), found = color_at(coarse, x, y);
      for (int c = 0; c < 4; ++c)
        ASSERT_NEAR(found[c], wanted[c], plane_rounding) << x << ", " << y << ", channel " << c;
    }
  EXPECT_GT(shared, least_shared);
}

TEST(ShadingRate, LayersAreSharedWhereTheyAreAsManyDeep) {
  const Scene scene = panes();
  const Surfaces surfaces(scene);
  View view = front_view(64);
  view.width = 63;
  view.height = 61;
  expect_shared_layers(surfaces, view, 2000);
}

/// Tinted glass in front of a wall whose colour changes from pixel to pixel.
Scene tinted() {
  Scene scene = panes();
  scene.instances.resize(2);
  scene.instances[1].mesh = 2;
  scene.materials[0] = colored({0.9f, 0.5f, 0.2f, 1});
  scene.materials[0].transmission.factor = 1;
  scene.materials[0].roughness = 0.5f;
  return scene;
}

TEST(ShadingRate, TintedGlassIsShared) {
  for (const Scene& scene : {panes(), tinted()}) {
    const Surfaces surfaces(scene);
    View view = front_view(65, 4);
    const Visible visible = zbuffer(surfaces, view);
    for (const Shading shading : {Shading::lit, Shading::flat}) {
      const ShadeOptions options{
          .shading = shading, .light = {.shadows = Shadows::off}, .layers = {.see_through = SeeThrough::always}};
      const Image fine = shade(surfaces, visible, options);
      const Image coarse = shade(surfaces, visible, with_rate(options, ShadingRate::each_2x2));
      // Colours change slowly from pixel to pixel; those of other triangles and of edges are farther away.
      float farthest = 0;
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          const glm::vec4 off = glm::abs(color_at(coarse, x, y) - color_at(fine, x, y));
          farthest = std::max({farthest, off.r, off.g, off.b, off.a});
        }
      EXPECT_GT(farthest, 0.001f);
      EXPECT_LT(farthest, 0.1f);
    }
  }
}

TEST(ShadingRate, PixelsOfSeveralSamplesAreThoseOfPlanes) {
  for (const char* name : {"city", "gallery"}) {
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    for (const int samples : {2, 4, 16}) {
      const View view = odd_view(surfaces, samples);
      const ShadeOptions options{.pixels = {.rate = ShadingRate::each_2x2}};
      EXPECT_EQ(bytes_of(shade_bitmap(surfaces, zbuffer_pixels(surfaces, view), options)),
                bytes_of(shade_bitmap(surfaces, zbuffer(surfaces, view), options)))
          << name << ", " << samples << " samples";
    }
  }
}

TEST(ShadingRate, TheSmallestPicturesAreWhole) {
  const Scene scene = panes();
  const Surfaces surfaces(scene);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 7), std::pair(7, 1), std::pair(65, 9)})
    for (const SeeThrough see_through : {SeeThrough::always, SeeThrough::never}) {
      View view = front_view(64, 2);
      view.width = width;
      view.height = height;
      const ShadeOptions options{.shading = Shading::flat, .layers = {.see_through = see_through}};
      const Image fine = shade(surfaces, zbuffer(surfaces, view), options);
      const Image coarse = shade(surfaces, zbuffer(surfaces, view), with_rate(options, ShadingRate::each_2x2));
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) EXPECT_EQ(color_at(coarse, x, y).a, color_at(fine, x, y).a) << x << ", " << y;
    }
}

TEST(ShadingRate, TheBytesDependNeitherOnThreadsNorOnTheInstructionSet) {
  for (const char* name : {"teapot", "gallery"}) {
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, odd_view(surfaces, 1));
    const ShadeOptions options{.pixels = {.rate = ShadingRate::each_2x2}};
    const std::vector<std::uint8_t> one = bytes_of(shade_bitmap(surfaces, visible, options, {.threads = 1}));
    for (const Isa isa : available_isas())
      EXPECT_EQ(bytes_of(shade_bitmap(surfaces, visible, options, {.threads = 3, .isa = isa})), one) << name;
  }
}

TEST(ShadingRate, MapsAreOfEveryPixel) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, odd_view(surfaces, 1));
  for (const Shading shading : {Shading::depth, Shading::ids, Shading::uv}) {
    const ShadeOptions options{.shading = shading};
    EXPECT_EQ(bytes_of(shade_bitmap(surfaces, visible, with_rate(options, ShadingRate::each_2x2))),
              bytes_of(shade_bitmap(surfaces, visible, options)));
  }
}

}  // namespace
}  // namespace frontmost
