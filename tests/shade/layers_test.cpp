// SPDX-License-Identifier: Apache-2.0
// Single layers, and all layers as a deep image, which composite to the picture again.
#include "shade/layers/layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/abuffer.h"
#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/support.h"
#include "support/effort.h"
#include "support/flat_picture.h"

namespace frontmost {
namespace {

using namespace test;

/// Composites samples, nearest first, as programs flatten deep images.
glm::dvec4 flattened(const DeepImage& image, std::size_t pixel) {
  const char* const names[] = {"R", "G", "B", "A"};
  glm::dvec4 sum(0);
  for (std::uint64_t i = image.first[pixel]; i < image.first[pixel + 1]; ++i) {
    const double left = 1 - sum.a;
    for (int k = 0; k < 4; ++k) {
      const auto is_named = [&](const Channel& c) { return c.name == names[k]; };
      sum[k] += left * double(std::find_if(image.channels.begin(), image.channels.end(), is_named)->floats()[i]);
    }
  }
  return sum;
}

const Channel& channel(const DeepImage& image, std::string_view name) {
  for (const Channel& c : image.channels)
    if (c.name == name) return c;
  throw std::out_of_range(std::string(name));
}

const ShadeOptions flat_over_nothing{.shading = Shading::flat, .background = std::nullopt};

TEST(DeepImage, HoldsEveryFragmentThatShows) {
  const Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.25f});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view(64, 4));
  const DeepImage image = shade_deep(surfaces, visible, flat_over_nothing);
  validate(image);
  const auto samples = [&](int x, int y) {
    const std::size_t pixel = std::size_t(y) * 64 + std::size_t(x);
    return image.first[pixel + 1] - image.first[pixel];
  };
  EXPECT_EQ(samples(2, 2), 0u);
  EXPECT_EQ(samples(10, 32), 1u);
  ASSERT_EQ(samples(40, 30), 2u);
  const std::uint64_t i = image.first[30 * 64 + 40];
  EXPECT_FLOAT_EQ(channel(image, "Z").floats()[i], 10);
  EXPECT_FLOAT_EQ(channel(image, "ZBack").floats()[i], 10);
  EXPECT_FLOAT_EQ(channel(image, "Z").floats()[i + 1], 11);
  EXPECT_EQ(channel(image, "A").floats()[i], 0.25f);
  EXPECT_EQ(channel(image, "R").floats()[i], 0.25f);
  EXPECT_EQ(channel(image, "B").floats()[i + 1], 1.0f);
  EXPECT_EQ(channel(image, "object").integers()[i], 0u);
  EXPECT_EQ(channel(image, "object").integers()[i + 1], 1u);
  EXPECT_EQ(channel(image, "material").integers()[i + 1], 1u);
  EXPECT_LT(channel(image, "primitive").integers()[i], 2u);
}

TEST(DeepImage, FlattensToThePicture) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 160, 90);
  for (const int samples : {1, 4, 16})
    for (const float opacity : {1.0f, 0.4f}) {
      view.samples = samples;
      ShadeOptions options{.background = std::nullopt, .opacity = opacity};
      const Visible visible = zbuffer(surfaces, view);
      const DeepImage deep = shade_deep(surfaces, visible, options);
      options.layers.see_through = SeeThrough::always;
      const Image picture = shade(surfaces, visible, options);
      double worst = 0;
      for (std::size_t pixel = 0; pixel < view.pixel_count(); ++pixel) {
        const glm::dvec4 shown = flattened(deep, pixel);
        for (int k = 0; k < 4; ++k) {
          worst = std::max(worst, std::abs(shown[k] - double(picture.channels[std::size_t(k)].floats()[pixel])));
        }
      }
      EXPECT_LT(worst, 1e-5) << samples << " samples, opacity " << opacity;
    }
}

TEST(DeepImage, NeighboursAlongAnEdgeCloseIt) {
  // Two halves of a square, cut along its diagonal. Every pixel inside is hidden wholly, though on the diagonal no
  // fragment alone hides one.
  const Scene scene = scene_of(square(), colored({1, 1, 1, 1}));
  const Surfaces surfaces(scene);
  View view = front_view(63, 4);
  const DeepImage image = shade_deep(surfaces, zbuffer(surfaces, view), flat_over_nothing);
  int shared = 0;
  for (int y = 20; y < 43; ++y)
    for (int x = 20; x < 43; ++x) {
      const std::size_t pixel = std::size_t(y) * 63 + std::size_t(x);
      shared += image.first[pixel + 1] - image.first[pixel] == 2;
      ASSERT_NEAR(flattened(image, pixel).a, 1, 1e-6);
    }
  EXPECT_EQ(shared, 23);
}

TEST(DeepImage, ShownPartsAreThoseOfEverySubSample) {
  // Two crossing fragments, half transparent: left of the middle, the second one is nearer.
  const std::vector<glm::ivec2> samples = {{64, 128}, {192, 128}};
  std::vector<Fragment> fragments(3);
  fragments[0] = {3, 0, 0.5f, 0.2f, 0, 1};
  fragments[1] = {3, 1, 0.5f, -0.2f, 0, 1};
  fragments[2] = {1, 2, 0.1f, 0, 0, 1};
  const std::vector<float> alphas = {0.5f, 0.5f, 1.0f};
  const auto key_at = [&](std::size_t i, std::size_t s) {
    return fragments[i].key + float(samples[s].x - 128) / 256 * fragments[i].key_dx;
  };
  const std::vector<float> parts = shading::shown_parts(fragments, alphas, samples.size(), key_at);
  EXPECT_FLOAT_EQ(parts[0], (0.25f + 0.5f) / 2);
  EXPECT_FLOAT_EQ(parts[1], (0.5f + 0.25f) / 2);
  EXPECT_FLOAT_EQ(parts[2], 0.25f / 2);
}

// Sheets that all cross within a pixel have opposite orders at its left and right. Insertion one by one would take
// minutes for 300,000 sheets.
TEST(DeepImage, ManyThatChangePlacesAreSorted) {
  const std::size_t count = tries_little ? 3'000 : 300'000;
  const float alpha = 1e-5f;
  const std::vector<Fragment> fragments(count, Fragment{3, 0, 0.5f, 0, 0, 1});
  const std::vector<float> alphas(count, alpha);
  const auto key_at = [&](std::size_t i, std::size_t s) {
    return float(s == 0 ? count - i : i + 1) / float(2 * count);
  };
  const std::vector<float> parts = shading::shown_parts(fragments, alphas, 2, key_at);
  for (std::size_t i = 0; i < count; i += count / 10) {
    const double left = std::pow(1 - double(alpha), double(i)),
                 right = std::pow(1 - double(alpha), double(count - 1 - i));
    EXPECT_NEAR(parts[i], (left + right) / 2 * double(alpha), 1e-3 * double(alpha)) << i;
  }
}

TEST(DeepImage, IsTheSameForAnyThreads) {
  const Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.5f});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view(200, 4));
  Execution one;
  one.threads = 1;
  EXPECT_EQ(content_hash(shade_deep(surfaces, visible, {}, one)), content_hash(shade_deep(surfaces, visible)));
}

TEST(DeepImage, RefusesWhatItCannotHold) {
  const Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.5f});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view());
  EXPECT_THROW((void)shade_deep(surfaces, visible, {.shading = Shading::depth}), Error);
  EXPECT_THROW((void)shade_deep(surfaces, visible, {.opacity = 2}), Error);
  EXPECT_THROW((void)shade_deep(surfaces, visible, {.layers = {.grid = 3}}), Error);
  DeepImage image = shade_deep(surfaces, visible);
  image.first[5] = 1u << 30;
  EXPECT_THROW(validate(image), Error);
}

TEST(SeeThrough, NeverShowsOneLayerOverTheBackground) {
  const Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.25f});
  const Surfaces surfaces(scene);
  ShadeOptions options = flat_over_nothing;
  options.layers.see_through = SeeThrough::never;
  const Image image = shade(surfaces, zbuffer(surfaces, front_view()), options);
  EXPECT_EQ(color_at(image, 32, 32), glm::vec4(0.25f, 0, 0, 0.25f));
  EXPECT_EQ(color_at(image, 10, 32), glm::vec4(0, 0, 1, 1));
  options.opacity = 0.5f;
  const Image faded = shade(surfaces, zbuffer(surfaces, front_view()), options);
  EXPECT_EQ(color_at(faded, 32, 32), glm::vec4(0.125f, 0, 0, 0.125f));
  EXPECT_EQ(color_at(faded, 10, 32), glm::vec4(0, 0, 0.5f, 0.5f));
}

TEST(SeeThrough, LayersLaidOverEachOtherAreThePicture) {
  const Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.25f});
  const Surfaces surfaces(scene);
  const View view = front_view();  // one sample: every pixel has one order
  const std::vector<Visible> layers = visible_layers(surfaces, view, 2);
  ShadeOptions options = flat_over_nothing;
  const Image picture = shade(surfaces, layers[0], options);
  options.layers.see_through = SeeThrough::never;
  const Image front = shade(surfaces, layers[0], options), behind = shade(surfaces, layers[1], options);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const glm::vec4 a = color_at(front, x, y), b = color_at(behind, x, y), sum = a + (1.0f - a.a) * b;
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(sum[k], color_at(picture, x, y)[k], 1e-6);
    }
}

TEST(SeeThrough, WhatNextToNothingPassesToIsNotMissed) {
  // In a stack of 60 sheets of opacity 0.5, the last twenty contribute less than 2^-40 each.
  Scene scene = scene_of(square(), colored({1, 0.25f, 0, 1}));
  for (int i = 1; i < 60; ++i) {
    scene.instances.push_back(scene.instances[0]);
    scene.instances.back().world_from_mesh[3] = {0, 0, -0.1 * i, 1};
  }
  const Surfaces surfaces(scene);
  for (const int samples : {1, 4}) {
    const View view = front_view(64, samples);
    ShadeOptions options = flat_over_nothing;
    options.opacity = 0.5f;
    const Image picture = shade(surfaces, zbuffer(surfaces, view), options);
    const std::vector<glm::vec4> colors(surfaces.primitive_count(), glm::vec4(1, 0.25f, 0, 1));
    const FragmentLists all = abuffer(surfaces, view, {0, 0.5f});
    EXPECT_EQ(all.at(32, 30).size(), 60u);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const glm::dvec4 expected = laid_over(all, x, y, colors), found(pixel_of(picture, x, y));
        for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[k], expected[k], 1e-6) << x << ", " << y;
      }
  }
}

TEST(SeeThrough, AlwaysGivesOpaqueScenesTheSubSamplesOfTheABuffer) {
  // The left edge is at 16.3 of 64: of the 8 columns of sub-samples in pixel 16, those from 5/16 on are covered.
  Scene scene = scene_of(square(), colored({1, 0, 0, 1}));
  scene.instances[0].world_from_mesh[3] = {0.3 / 16, 0, 0, 1};
  const Surfaces surfaces(scene);
  ShadeOptions options = flat_over_nothing;
  options.layers.see_through = SeeThrough::always;
  options.layers.grid = 8;
  const Image image = shade(surfaces, zbuffer(surfaces, front_view()), options);
  EXPECT_FLOAT_EQ(color_at(image, 16, 32).a, 6.0f / 8);
  EXPECT_EQ(color_at(image, 17, 32), glm::vec4(1, 0, 0, 1));
}

struct Difference {
  float farthest = 0;      ///< largest difference of any channel
  std::size_t pixels = 0;  ///< pixels that differ by more than rounding
};

Difference difference_of(const Image& a, const Image& b) {
  Difference found;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const glm::vec4 off = glm::abs(color_at(a, x, y) - color_at(b, x, y));
      const float most = std::max({off.r, off.g, off.b, off.a});
      found.farthest = std::max(found.farthest, most);
      found.pixels += most > plane_rounding;
    }
  return found;
}

/// Pictures with layers in every tile, and with layers only in tiles with translucent surfaces.
struct Pictures {
  Image everywhere, where_needed;

  Pictures(const Surfaces& surfaces, const auto& input, ShadeOptions options = {}) {
    where_needed = shade(surfaces, input, options);
    options.layers.see_through = SeeThrough::always;
    everywhere = shade(surfaces, input, options);
  }
  [[nodiscard]] Difference difference() const { return difference_of(everywhere, where_needed); }
};

TEST(SeeThrough, TilesOfWhatIsOpaqueNeedNoLayers) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  for (const int samples : {1, 4, 16})
    for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals}) {
      View view = frame(surfaces, 333, 187);
      view.samples = samples;
      const ShadeOptions options{.shading = shading};
      SCOPED_TRACE(testing::Message() << samples << " samples, shading " << int(shading));
      const Pictures pictures(surfaces, zbuffer(surfaces, view), options);
      const Difference difference = pictures.difference();
      // The A-buffer shades a fragment at the middle of its covered part of the pixel, even if something hides part of
      // that.
      EXPECT_LT(difference.farthest, samples == 1 ? plane_rounding : 0.1f);
      EXPECT_LT(difference.pixels, samples == 1 ? 1 : view.pixel_count() / 50);
      if (samples > 1) {
        EXPECT_GT(difference.pixels, 0u) << "layers are found everywhere";
      }
      const Image by_pixels = shade(surfaces, zbuffer_pixels(surfaces, view), options);
      EXPECT_EQ(content_hash(by_pixels), content_hash(pictures.where_needed));
    }
}

/// A blue wall behind a red pane far narrower than a pixel.
Scene wall_behind_sliver(double middle, double width) {
  Scene scene = layered_scene(Material::Alpha::blend, {1, 0, 0, 0.25f});
  glm::dmat4& place = scene.instances[0].world_from_mesh;
  place = glm::dmat4(1);
  place[0][0] = width / 2;
  place[3] = {middle, 0, 0, 1};
  return scene;
}

TEST(SeeThrough, LayersAreFoundWhereOneSampleOfATileSeesThroughSomething) {
  std::size_t unseen_by_first = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = wall_behind_sliver(-1 + i * 0.0517, 0.02);
    const Surfaces surfaces(scene);
    const VisiblePixels pixels = zbuffer_pixels(surfaces, front_view(64, 4));
    const auto is_pane = [](PrimitiveId id) { return id < 2; };
    unseen_by_first += std::none_of(pixels.first.primitives.begin(), pixels.first.primitives.end(), is_pane) &&
                       std::any_of(pixels.others.data(), pixels.others.data() + pixels.other_count, is_pane);
    EXPECT_EQ(Pictures(surfaces, pixels).difference().pixels, 0u) << i;
    EXPECT_EQ(Pictures(surfaces, zbuffer(surfaces, front_view(64, 4))).difference().pixels, 0u) << i;
  }
  EXPECT_GT(unseen_by_first, 5u);
}

}  // namespace
}  // namespace frontmost
