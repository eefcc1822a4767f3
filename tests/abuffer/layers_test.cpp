// SPDX-License-Identifier: Apache-2.0
// Every layer against brute force, pictures of opaque surfaces against the z-buffer, and how lists are run and ended.

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <mutex>

#include "abuffer/tile_parts.h"
#include "fragment_oracle.h"
#include "support/effort.h"
#include "support/flat_picture.h"
#include "support/random_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

RandomCase small_case(Kind kind, std::uint64_t seed) {
  Random random(seed + 900);
  const bool covers_little = kind == Kind::tiny || kind == Kind::slivers;
  const int count = (40 + random.below(80)) * (covers_little ? 8 : 1);
  const int width = 20 + random.below(40), height = 15 + random.below(35);
  RandomCase made{scene_of(random_mesh(kind, count, seed)), random_view(random, width, height)};
  made.view.culling = Culling(random.below(3));
  return made;
}

class EveryKindOfLayer : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(ABuffer, EveryKindOfLayer, testing::ValuesIn(all_kinds));

/// Surfaces seen at one sample, nearest first, whatever the order of the whole pixel.
std::vector<std::pair<float, PrimitiveId>> seen_at(const std::vector<OracleFragment>& list, const glm::ivec2& place,
                                                   std::size_t sample) {
  std::vector<std::pair<float, PrimitiveId>> seen;
  for (const OracleFragment& f : list)
    if (f.mask >> sample & 1) seen.emplace_back(-oracle_key(*f.triangle, place.x, place.y), f.id);
  std::sort(seen.begin(), seen.end());
  return seen;
}

TEST_P(EveryKindOfLayer, EqualsBruteForceToTheBit) {
  constexpr int layer_count = 6;
  constexpr int sample_counts[] = {1, 2, 4, 8, 16};
  std::array<std::size_t, layer_count> filled{};
  for (std::uint64_t seed = 0; seed < seeds(10); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomCase c = small_case(GetParam(), seed);
    c.view.samples = sample_counts[seed % 5];
    const Surfaces surfaces(c.scene);
    const std::vector<Visible> layers = visible_layers(surfaces, c.view, layer_count, {0, 0.5f});
    ASSERT_EQ(layers.size(), std::size_t(layer_count));
    const auto triangles = screen_triangles(surfaces, c.view);
    const auto samples = oracle_samples(c.view, 0);
    for (int y = 0; y < c.view.height; ++y)
      for (int x = 0; x < c.view.width; ++x) {
        const auto list = oracle_fragments(triangles, samples, x, y);
        for (std::size_t s = 0; s < samples.size(); ++s) {
          const auto seen = seen_at(list, glm::ivec2(256 * x, 256 * y) + samples[s], s);
          for (std::size_t k = 0; k < layer_count; ++k) {
            const std::size_t at = layers[k].index(x, y, int(s));
            const bool is_there = k < seen.size();
            ASSERT_EQ(layers[k].primitives[at], is_there ? seen[k].second : no_primitive)
                << x << ", " << y << ", " << k;
            ASSERT_EQ(layers[k].keys[at], is_there ? -seen[k].first : 0.0f) << x << ", " << y << ", " << k;
            filled[k] += is_there;
          }
        }
      }
  }
  if (tries_little) return;  // too few seeds to be sure that they see much
  EXPECT_GT(filled[0], 50u);
  // Grids lie flat, and small or thin triangles seldom overlap each other.
  if (GetParam() != Kind::shared_grid && GetParam() != Kind::tiny && GetParam() != Kind::slivers) {
    EXPECT_GT(filled[1], 20u) << "the test has become shallow";
  }
}

// With opaque surfaces, a picture is the z-buffer's answer averaged over the samples: two methods, one answer.
TEST_P(EveryKindOfLayer, PicturesOfOpaqueThingsAreTheZBuffers) {
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomCase c = small_case(GetParam(), seed + 50);
    c.view.samples = seed % 2 ? 4 : 16;
    Random random(seed);
    std::vector<glm::vec4> colors;
    for (std::size_t i = 0; i < c.scene.meshes[0].triangles.size(); ++i) {
      const float red = random.unit(), green = random.unit();
      colors.push_back({red, green, 0, 1});
    }
    c.scene = painted(std::move(c.scene), colors);
    const Surfaces surfaces(c.scene);
    const Image picture = flat_picture(surfaces, c.view);
    const Visible visible = zbuffer(surfaces, c.view);
    for (int y = 0; y < c.view.height; ++y)
      for (int x = 0; x < c.view.width; ++x) {
        glm::dvec4 sum(0);
        for (int s = 0; s < c.view.samples; ++s) {
          const PrimitiveId id = visible.primitives[visible.index(x, y, s)];
          if (id != no_primitive) sum += glm::dvec4(colors[id]);
        }
        sum /= double(c.view.samples);
        const glm::dvec4 found(pixel_of(picture, x, y));
        for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[k], sum[k], 1e-6) << x << ", " << y << ", channel " << k;
      }
  }
}

void expect_same_lists(const FragmentLists& found, const FragmentLists& wanted) {
  ASSERT_EQ(found.first.size(), wanted.first.size());
  for (std::size_t i = 0; i < wanted.first.size(); ++i) ASSERT_EQ(found.first[i], wanted.first[i]) << "pixel " << i;
  ASSERT_EQ(found.fragments.size(), wanted.fragments.size());
  for (std::size_t i = 0; i < wanted.fragments.size(); ++i) {
    const Fragment &a = found.fragments[i], &b = wanted.fragments[i];
    ASSERT_EQ(a.mask, b.mask) << i;
    ASSERT_EQ(a.primitive, b.primitive) << i;
    const float numbers_a[] = {a.key, a.key_dx, a.key_dy, a.opacity},
                numbers_b[] = {b.key, b.key_dx, b.key_dy, b.opacity};
    ASSERT_EQ(0, std::memcmp(numbers_a, numbers_b, sizeof numbers_a)) << i;
  }
}

TEST_P(EveryKindOfLayer, ListsLayersAndCountsAreTheSameForThreadsAndInstructionSets) {
  for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomCase c = small_case(GetParam(), seed + 150);
    c.view.width = 150;  // several tiles
    c.view.samples = seed % 2 ? 8 : 1;
    const AbufferOptions options{seed < 2 ? 0 : 4, seed % 3 ? 1.0f : 0.5f};
    const Surfaces surfaces(c.scene);
    const FragmentLists lists = abuffer(surfaces, c.view, options, {.threads = 1});
    const std::vector<Visible> layers = visible_layers(surfaces, c.view, 3, options, {.threads = 1});
    const FragmentCounts counts = count_fragments(surfaces, c.view, options, {.threads = 1});
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(std::string(name(isa)));
      const Execution execution{.threads = 3, .isa = isa};
      expect_same_lists(abuffer(surfaces, c.view, options, execution), lists);
      const std::vector<Visible> found = visible_layers(surfaces, c.view, 3, options, execution);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(content_hash(found[k]), content_hash(layers[k])) << k;
      const FragmentCounts others = count_fragments(surfaces, c.view, options, execution);
      EXPECT_EQ(others.fragments, counts.fragments);
      EXPECT_EQ(others.longest, counts.longest);
    }
  }
}

// A triangle split at a point on the grid of 1/256 pixel covers the same sub-samples, each once.
TEST(SplitTriangles, CoverWhatTheWholeOneDid) {
  View view;
  view.width = 40;
  view.height = 30;
  view.world_from_eye = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(0, 40, -30, 0, {1, 9});
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    Random random(seed);
    const auto corner = [&] {
      const int x = random.below(40 * 64), y = random.below(30 * 64);
      return glm::vec3(float(x) / 64, -float(y) / 64, 0);
    };
    const glm::vec3 a = corner(), b = corner(), c = corner();
    // An inner point on the grid: a quarter of the way from a to the middle of b and c, in multiples of 1/256.
    const glm::vec3 inner = glm::floor((2.0f * a + b + c) * 64.0f) / 256.0f;
    Mesh whole, parts;
    add_triangle(whole, a, b, c);
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) add_triangle(parts, p, q, inner);
    const Scene one = scene_of(whole), three = scene_of(parts);
    for (const int grid : {0, 2, 8}) {
      const FragmentLists lists = abuffer(Surfaces(one), view, {grid, 0.5f});
      const FragmentLists cut = abuffer(Surfaces(three), view, {grid, 0.5f});
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          std::uint64_t expected = 0, found = 0;
          for (const Fragment& f : lists.at(x, y)) expected |= f.mask;
          for (const Fragment& f : cut.at(x, y)) {
            ASSERT_EQ(found & f.mask, 0u) << seed << ": twice in " << x << ", " << y;
            found |= f.mask;
          }
          ASSERT_EQ(found, expected) << seed << ": " << x << ", " << y;
        }
    }
  }
}

// ---- Running ----

TEST(Running, IsEndedByTheWatchAndReportsAllTiles) {
  const RandomCase c = small_case(Kind::soup, 3);
  const Surfaces surfaces(c.scene);
  View view = c.view;
  view.width = 300;
  view.height = 200;  // 20 tiles
  const Watch ending{.progress = {}, .cancelled = [] { return true; }};
  const Execution ended{.threads = 2, .watch = &ending};
  const std::function<void(const Execution&)> runs[] = {
      [&](const Execution& e) { (void)abuffer(surfaces, view, {4}, e); },
      [&](const Execution& e) { (void)count_fragments(surfaces, view, {4}, e); },
      [&](const Execution& e) { (void)visible_layers(surfaces, view, 2, {}, e); },
      [&](const Execution& e) { (void)flat_picture(surfaces, view, {4}, e); },
  };
  for (const auto& run : runs) {
    try {
      run(ended);
      ADD_FAILURE() << "went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    std::mutex mutex;
    double most = 0;
    const Watch telling{.progress =
                            [&](std::string_view stage, double done) {
                              const std::lock_guard lock(mutex);
                              if (stage == "visible") most = std::max(most, done);
                            },
                        .cancelled = {}};
    run({.threads = 2, .watch = &telling});
    EXPECT_EQ(most, 1.0);
  }
}

// ---- Errors, in full ----

TEST(Errors, NameOptionAndValue) {
  const RandomCase c = small_case(Kind::soup, 1);
  const Surfaces surfaces(c.scene);
  for (const int grid : {-2, 1, 3, 5, 16, 64}) {
    const std::string words = "abuffer: grid: must be 0, 2, 4 or 8, not " + std::to_string(grid);
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { (void)abuffer(surfaces, c.view, {grid}); }), words);
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { (void)count_fragments(surfaces, c.view, {grid}); }), words);
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { (void)flat_picture(surfaces, c.view, {grid}); }), words);
  }
  EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { (void)visible_layers(surfaces, c.view, 1, {3}); }), "none")
      << "has no grid";
  for (const float opacity : {-1e-6f, 1.000001f, std::numeric_limits<float>::infinity(), std::nanf("")})
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument,
                         [&] {
                           (void)visible_layers(surfaces, c.view, 1, {0, opacity});
                         }),
              "abuffer: opacity: must be 0 to 1");
  for (const int count : {-1, 0, 1025})
    EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { (void)visible_layers(surfaces, c.view, count); }),
              "abuffer: layers: must be 1 to 1024");
}

// ---- Putting lists together ----

using abuffer_detail::TilePart;
using abuffer_detail::TileParts;

/// A part of the picture; its pixel (x, y) has length(x, y) items, named by pixel and number.
template <class Length>
TilePart<int> part_of(const abuffer_detail::Rectangle& pixels, const Length& length) {
  TilePart<int> part{pixels, {0}, {}};
  for (int y = pixels.y; y < pixels.y + pixels.height; ++y)
    for (int x = pixels.x; x < pixels.x + pixels.width; ++x) {
      for (int i = 0; i < length(x, y); ++i) part.items.push_back(100 * (10 * y + x) + i);
      part.begin.push_back(std::uint32_t(part.items.size()));
    }
  return part;
}

TEST(TileParts, ComeTogetherInTheOrderOfPixelsHoweverTheyArrive) {
  View view;
  view.width = 7;
  view.height = 5;
  const auto length = [](int x, int y) { return (x * 3 + y * 5) % 4; };
  // Pixels 5 and 6 of the third row are in no part, as nothing was seen there.
  std::vector<TilePart<int>> parts = {part_of({4, 0, 3, 2}, length), part_of({0, 0, 4, 5}, length),
                                      part_of({4, 3, 3, 2}, length), part_of({4, 2, 1, 1}, length)};
  std::vector<int> wanted;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      for (int i = 0; i < (y == 2 && x > 4 ? 0 : length(x, y)); ++i) wanted.push_back(100 * (10 * y + x) + i);
  for (int round = 0; round < 4; ++round) {
    std::rotate(parts.begin(), parts.begin() + 1, parts.end());
    TileParts<int> all(view, wanted.size(), "abuffer", "too many");
    for (const TilePart<int>& part : parts) all.add(part);
    const Buffer<std::uint64_t> first = all.beginnings();
    ASSERT_EQ(first.size(), 36u);
    EXPECT_EQ(first[0], 0u);
    EXPECT_EQ(first[35], wanted.size());
    std::vector<int> items(wanted.size(), -1);
    all.place(first, [&](std::uint64_t at, int item) { items.at(at) = item; }, {.threads = 2});
    EXPECT_EQ(items, wanted);
    TileParts<int> too_many(view, wanted.size() - 1, "abuffer", "too many");
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) too_many.add(parts[i]);
    EXPECT_THROW(too_many.add(parts.back()), Error);
  }
}

}  // namespace
}  // namespace frontmost::test
