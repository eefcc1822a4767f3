// SPDX-License-Identifier: Apache-2.0
// Lists, pictures and layers against brute force and against the z-buffer.

#include <gtest/gtest.h>

#include "fragment_oracle.h"
#include "support/flat_picture.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// The view's samples and the grid of sub-samples.
struct Sampling {
  int samples, grid;
};
constexpr Sampling all_samplings[] = {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {16, 0}, {1, 2}, {1, 4}, {1, 8}};

std::vector<glm::vec4> random_colors(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<glm::vec4> colors;
  for (std::size_t i = 0; i < count; ++i)
    colors.push_back({random.unit(), random.unit(), random.unit(), random.below(5) ? random.within(0.1f, 0.9f) : 1.0f});
  return colors;
}

RandomCase sampled_case(Kind kind, std::uint64_t seed, const Sampling& sampling) {
  Random random(seed + 77);
  const bool covers_little = kind == Kind::tiny || kind == Kind::slivers;
  RandomCase c{scene_of(random_mesh(kind, (10 + random.below(60)) * (covers_little ? 6 : 1), seed)),
               random_view(random, 1 + random.below(90), 1 + random.below(80))};
  c.view.culling = Culling(random.below(3));
  c.view.samples = sampling.samples;
  return c;
}

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(ABuffer, EveryKind, testing::ValuesIn(all_kinds));

void expect_as_oracle(std::span<const Fragment> found, const std::vector<OracleFragment>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].primitive, wanted[i].id) << "fragment " << i;
    ASSERT_EQ(found[i].key, wanted[i].key) << "fragment " << i;
    ASSERT_EQ(found[i].mask, wanted[i].mask) << "fragment " << i;
  }
}

TEST_P(EveryKind, ListsEqualBruteForce) {
  std::size_t fragments = 0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    const Sampling& sampling = all_samplings[seed % 8];
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", samples " << sampling.samples << ", grid "
                                    << sampling.grid);
    const RandomCase c = sampled_case(GetParam(), seed, sampling);
    const Surfaces surfaces(c.scene);
    const FragmentLists lists = abuffer(surfaces, c.view, {sampling.grid, 0.5f});
    const auto triangles = screen_triangles(surfaces, c.view);
    const auto samples = oracle_samples(c.view, sampling.grid);
    ASSERT_EQ(lists.samples, samples);
    for (int y = 0; y < c.view.height; ++y)
      for (int x = 0; x < c.view.width; ++x) {
        SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
        expect_as_oracle(lists.at(x, y), oracle_fragments(triangles, samples, x, y));
        if (HasFatalFailure()) return;
      }
    fragments += lists.fragments.size();
  }
  EXPECT_GT(fragments, 200u);
}

TEST_P(EveryKind, PicturesEqualBruteForce) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    const Sampling& sampling = all_samplings[seed % 8];
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomCase c = sampled_case(GetParam(), seed + 100, sampling);
    const std::vector<glm::vec4> colors = random_colors(c.scene.meshes[0].triangles.size(), seed);
    c.scene = painted(std::move(c.scene), colors);
    const Surfaces surfaces(c.scene);
    // At opacity 1, some triangles are opaque and hide the rest.
    const float opacity = seed % 3 ? 0.8f : 1.0f;
    const Image picture = flat_picture(surfaces, c.view, {sampling.grid, opacity});
    const auto triangles = screen_triangles(surfaces, c.view);
    const auto samples = oracle_samples(c.view, sampling.grid);
    for (int y = 0; y < c.view.height; ++y)
      for (int x = 0; x < c.view.width; ++x) {
        const glm::dvec4 wanted =
            oracle_pixel(oracle_fragments(triangles, samples, x, y), samples, x, y, colors, opacity);
        const glm::dvec4 found(pixel_of(picture, x, y));
        for (int k = 0; k < 4; ++k) {
          worst = std::max(worst, std::abs(found[k] - wanted[k]));
          ASSERT_NEAR(found[k], wanted[k], 2e-6) << "pixel " << x << ", " << y << ", channel " << k;
        }
      }
  }
  EXPECT_LT(worst, 2e-6);
}

TEST_P(EveryKind, NearestLayerEqualsTheZBufferToTheBit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const RandomCase c = sampled_case(GetParam(), seed + 200, all_samplings[seed % 5]);
    const Surfaces surfaces(c.scene);
    const Visible wanted = zbuffer(surfaces, c.view);
    for (const float opacity : {1.0f, 0.5f}) {
      const std::vector<Visible> layers = visible_layers(surfaces, c.view, 2, {0, opacity});
      EXPECT_EQ(content_hash(layers[0]), content_hash(wanted));
    }
  }
}

TEST_P(EveryKind, BytesDependOnNeitherThreadsNorInstructionSet) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Sampling& sampling = all_samplings[seed];
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomCase c = sampled_case(GetParam(), seed + 300, sampling);
    const std::vector<glm::vec4> colors = random_colors(c.scene.meshes[0].triangles.size(), seed);
    c.scene = painted(std::move(c.scene), colors);
    const Surfaces surfaces(c.scene);
    const AbufferOptions options{sampling.grid, 0.9f};
    const Image wanted = flat_picture(surfaces, c.view, options, {.threads = 1});
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(std::string(name(isa)));
      const Image found = flat_picture(surfaces, c.view, options, {.threads = 3, .isa = isa});
      EXPECT_EQ(content_hash(found), content_hash(wanted));
    }
  }
}

}  // namespace
}  // namespace frontmost::test
