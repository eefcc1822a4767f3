// SPDX-License-Identifier: Apache-2.0
#include "zbuffer/frame_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace zbuffer_detail;

/// Every tile's list of records over all rounds; checks that rounds are consecutive and within their budget.
std::vector<std::vector<std::uint32_t>> lists_of(FramePlan& plan, const View& view, std::size_t budget) {
  std::vector<std::vector<std::uint32_t>> lists;
  for (const TileRange& round : plan.records().rounds()) {
    EXPECT_EQ(round.begin, lists.size());
    plan.records().list(round, view);
    std::size_t items = 0;
    for (std::size_t tile = round.begin; tile < round.end; ++tile) {
      const auto list = plan.job(tile, view).solid.records;
      lists.emplace_back(list.begin(), list.end());
      items += list.size();
    }
    EXPECT_TRUE(items <= budget || round.end - round.begin == 1);
  }
  EXPECT_EQ(lists.size(), Tile::count(view));
  return lists;
}

TEST(FramePlan, RoundsListTheSameRecordsWithinTheirBudget) {
  const Scene scene = scene_of(random_mesh(Kind::through_eye, 300, 5));
  const Surfaces surfaces(scene);
  Random random(4);
  const View view = random_view(random, 1000, 700);
  const ScreenTransform transform(view);
  FramePlan whole;
  const PlaceTarget target(transform, view, nullptr, Isa::best);
  whole.make(cluster_set(surfaces), target, {});
  ASSERT_EQ(whole.records().rounds().size(), 1u);
  const auto expected = lists_of(whole, view, kMostRecordItems);
  std::size_t items = 0;
  for (const auto& list : expected) items += list.size();
  ASSERT_GT(items, 1000u);
  FramePlan plan;
  for (const std::size_t budget : {std::size_t(0), std::size_t(1), std::size_t(200), items - 1, items}) {
    plan.make(cluster_set(surfaces), target, {}, budget);
    EXPECT_EQ(plan.records().rounds().size() == 1, budget == items) << budget;
    EXPECT_EQ(lists_of(plan, view, budget), expected) << budget;
  }
}

// A tile's list must contain every record that covers one of its samples.
TEST(FramePlan, ListsHoldEveryRecordThatCoversASample) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = scene_of(random_mesh(seed % 2 ? Kind::through_eye : Kind::huge, 30, seed));
    const Surfaces surfaces(scene);
    Random random(seed);
    const View view = random_view(random, 400, 300);
    FramePlan plan;
    const ScreenTransform transform(view);
    plan.make(cluster_set(surfaces), PlaceTarget(transform, view, nullptr, Isa::best), {});
    const auto lists = lists_of(plan, view, kMostRecordItems);
    for (std::uint32_t i = 0; i < plan.records().records.size(); ++i)
      for (int y = 0; y < view.height; y += 9)
        for (int x = 0; x < view.width; x += 9) {
          const PixelRect pixel{x, y, x, y};
          if (misses(plan.records().records[i], pixel)) continue;
          const auto& list =
              lists[std::size_t(y / kTileSize * ((view.width + kTileSize - 1) / kTileSize) + x / kTileSize)];
          const PixelRect rect = pixel_rect(plan.records().records[i], view.width, view.height);
          const bool inside = x >= rect.x0 && x <= rect.x1 && y >= rect.y0 && y <= rect.y1;
          ASSERT_EQ(inside, inside && std::binary_search(list.begin(), list.end(), i)) << "seed " << seed;
        }
  }
}

}  // namespace
}  // namespace frontmost::test
