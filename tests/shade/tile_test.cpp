// SPDX-License-Identifier: Apache-2.0
// Fragments that a tile finds, and the sums of their colours.
#include "shade/tile.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "frontmost/zbuffer.h"
#include "shade/support.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

using namespace test;

/// A made-up Visible with ids of `count` tiny triangles.
struct Fake {
  Scene scene;
  Surfaces surfaces;
  Visible visible;

  Fake(std::uint32_t count, int width, int height, int samples) : scene(scene_with(count)), surfaces(scene) {
    visible.view = front_view(64, samples);
    visible.view.width = width;
    visible.view.height = height;
    visible.primitives = Buffer<PrimitiveId>(visible.view.sample_count(), no_primitive);
    visible.keys = Buffer<float>(visible.view.sample_count(), 0.5f);
  }

  static Scene scene_with(std::uint32_t count) {
    Mesh mesh = square();
    while (mesh.triangles.size() < count) mesh.triangles.push_back({0, 1, 2});
    return scene_of(mesh);
  }
};

struct Seen {
  PrimitiveId id;
  float weight;
  glm::vec2 screen;
};

/// All fragments of a picture by pixel, and the tiles' sums.
std::map<std::pair<int, int>, std::vector<Seen>> fragments(const Fake& fake) {
  std::map<std::pair<int, int>, std::vector<Seen>> result;
  const TriangleStore store(fake.surfaces);
  const TriangleSource source(store, fake.visible.view, nullptr);
  TileRectangle tile;
  const TileWork::Colorist colorist = [&](const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
    for (int i = 0; i < batch.coverage.count; ++i) {
      const int pixel = int(batch.coverage.pixel[i]);
      result[{tile.x + pixel % tile.width, tile.y + pixel / tile.width}].push_back(
          {setups[batch.coverage.triangle[i]].triangle, batch.coverage.weight[i], batch.coverage.screen.at(i)});
      batch.material.alpha[i] = 1;
      batch.light.set(i, glm::vec3(1, 0.5f, 0));
    }
  };
  TileWork work;
  work.begin({source, fake.visible}, colorist, ShadingRate::each_pixel, Isa::best);
  const View& view = fake.visible.view;
  for (int y = 0; y < view.height; y += tile_height)
    for (int x = 0; x < view.width; x += tile_width) {
      tile = {x, y, std::min(tile_width, view.width - x), std::min(tile_height, view.height - y)};
      work.shade(tile);
    }
  return result;
}

TEST(Tile, EverySampleBelongsToExactlyOneFragment) {
  std::mt19937 random(test::noted_seed(5));
  for (const int samples : {1, 2, 4, 8, 16}) {
    Fake fake(3000, 131, 21, samples);
    // Long runs, salt noise and emptiness in turn; a tile has more triangles than its table holds.
    for (PrimitiveId& id : fake.visible.primitives) {
      const auto draw = random() % 4;
      id = draw == 0 ? no_primitive : draw == 1 ? 7 : PrimitiveId(random() % 3000);
    }
    const auto found = fragments(fake);
    const auto offsets = sample_offsets(samples);
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 131; ++x) {
        std::map<PrimitiveId, std::pair<int, glm::vec2>> expected;
        for (int s = 0; s < samples; ++s) {
          const PrimitiveId id = fake.visible.primitives[fake.visible.index(x, y, s)];
          if (id == no_primitive) continue;
          auto& [count, sum] = expected.try_emplace(id, 0, glm::vec2(0)).first->second;
          ++count;
          sum += glm::vec2(offsets[std::size_t(s)]) / 256.0f;
        }
        const auto it = found.find({x, y});
        ASSERT_EQ(it == found.end() ? 0u : it->second.size(), expected.size()) << x << ", " << y;
        if (it == found.end()) continue;
        for (const Seen& seen : it->second) {
          ASSERT_TRUE(expected.count(seen.id)) << "id " << seen.id;
          const auto& [count, sum] = expected[seen.id];
          ASSERT_FLOAT_EQ(seen.weight, float(count) / float(samples));
          ASSERT_LT(glm::length(seen.screen - (glm::vec2(x, y) + sum / float(count))), 1e-4f);
        }
      }
  }
}

TEST(Tile, APixelOfOnePrimitiveIsShadedOnceAtItsMiddle) {
  for (const int samples : {1, 2, 4}) {
    Fake fake(2, 8, 8, samples);
    for (PrimitiveId& id : fake.visible.primitives) id = 1;
    const auto found = fragments(fake);
    ASSERT_EQ(found.size(), 64u);
    for (const auto& [pixel, seen] : found) {
      ASSERT_EQ(seen.size(), 1u);
      EXPECT_EQ(seen[0].weight, 1.0f);
      EXPECT_EQ(seen[0].screen, glm::vec2(pixel.first, pixel.second) + 0.5f);
    }
  }
}

TEST(TriangleCache, NumbersAreStableUntilCleared) {
  TriangleCache cache;
  std::set<std::uint16_t> numbers;
  PrimitiveId id = 17;
  for (; !cache.is_full(); id += 2048) {
    const auto found = cache.find_or_add(id);
    EXPECT_TRUE(found.is_new);
    EXPECT_TRUE(numbers.insert(found.number).second);
    EXPECT_FALSE(cache.find_or_add(17).is_new);
    if (cache.is_full()) break;
  }
  EXPECT_EQ(numbers.size(), std::size_t(TriangleCache::capacity));
  cache.clear();
  EXPECT_FALSE(cache.is_full());
  EXPECT_TRUE(cache.find_or_add(17).is_new);
}

}  // namespace
}  // namespace frontmost::shading
