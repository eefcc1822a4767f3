// SPDX-License-Identifier: Apache-2.0
// Building blocks of frames, each by itself: records, edges, planes, lists of tiles, stored depths.
#include <gmock/gmock.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include "zbuffer/tile/tile.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::test {
namespace {

using namespace zbuffer_detail;
using testing::ElementsAre;

TriangleRecord record_of(std::array<glm::ivec2, 3> corners, std::array<float, 3> keys = {0.25f, 0.5f, 0.75f}) {
  TriangleRecord record;
  for (std::size_t k = 0; k < 3; ++k) {
    record.x[k] = corners[k].x;
    record.y[k] = corners[k].y;
    record.key[k] = keys[k];
  }
  record.id = 7;
  return record;
}

/// A record with vertices within `reach` units of a picture of 40 x 30 pixels.
TriangleRecord random_record(Random& random, int reach) {
  std::array<glm::ivec2, 3> corners;
  for (glm::ivec2& corner : corners) {
    corner.x = random.below(40 * 256 + 2 * reach) - reach;
    corner.y = random.below(30 * 256 + 2 * reach) - reach;
  }
  const float first = random.unit(), second = random.unit(), third = random.unit();
  return record_of(corners, {first, second, third});
}

TEST(TriangleRecord, IsTurnedSoThatItsAreaIsPositive) {
  // y points down: right and then down is clockwise to the eye, so it is the back.
  TriangleRecord back = record_of({{{0, 0}, {256, 0}, {256, 256}}});
  EXPECT_EQ(doubled_area(back), 65536);
  EXPECT_TRUE(orient(back, FacingRule(Culling::none, nullptr)));
  EXPECT_EQ(back.key[1], 0.5f) << "it was turned rightly before";
  EXPECT_FALSE(orient(back, FacingRule(Culling::back, nullptr)));
  EXPECT_TRUE(orient(back, FacingRule(Culling::front, nullptr)));
  TriangleRecord front = record_of({{{0, 0}, {256, 256}, {256, 0}}});
  EXPECT_EQ(doubled_area(front), -65536);
  EXPECT_FALSE(orient(front, FacingRule(Culling::front, nullptr)));
  EXPECT_FALSE(orient(front, FacingRule(Culling::both, nullptr)));
  EXPECT_TRUE(orient(front, FacingRule(Culling::back, nullptr)));
  EXPECT_FALSE(orient(back, FacingRule(Culling::material, nullptr))) << "one-sided";
  EXPECT_EQ(doubled_area(front), 65536);
  EXPECT_THAT(front.key, ElementsAre(0.25f, 0.75f, 0.5f)) << "keys go with their corners, the first one stays first";
  TriangleRecord line = record_of({{{0, 0}, {256, 256}, {512, 512}}});
  EXPECT_FALSE(orient(line, FacingRule(Culling::none, nullptr))) << "no area, no side";
}

// The largest coordinates of the guard band have 22 bits, and their products need more than 32.
TEST(TriangleRecord, AreasOfTheGuardBandAreExact) {
  const int most = kGuardBand;
  EXPECT_EQ(doubled_area(record_of({{{-most, -most}, {most, -most}, {most, most}}})), 4 * std::int64_t(most) * most);
  EXPECT_EQ(doubled_area(record_of({{{-most, -most}, {most, most}, {most, most - 1}}})), -2 * std::int64_t(most));
}

TEST(PixelRects, AreThoseOfTheOutermostCorners) {
  const auto rect = [](std::array<glm::ivec2, 3> corners) {
    const PixelRect r = pixel_rect(record_of(corners), 40, 30);
    return std::array{r.x0, r.y0, r.x1, r.y1};
  };
  EXPECT_THAT(rect({{{0, 0}, {255, 0}, {0, 255}}}), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(rect({{{0, 0}, {256, 0}, {0, 511}}}), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(rect({{{-5000, 300}, {90000, 600}, {0, 400}}}), ElementsAre(0, 1, 39, 2)) << "within the picture";
  const PixelRect left = pixel_rect(record_of({{{-3000, 0}, {-1, 100}, {-10, 9}}}), 40, 30);
  EXPECT_LT(left.x1, left.x0) << "beside the picture";
}

TEST(PixelRects, OfSamplesHoldEverySampleBetweenTheCorners) {
  Random random(3);
  std::size_t empty = 0;
  for (int i = 0; i < 2000; ++i) {
    const TriangleRecord record = random_record(random, 300);
    const int samples = 1 << random.below(5);
    glm::ivec2 low(255), high(0);
    for (const glm::ivec2& s : sample_offsets(samples)) low = glm::min(low, s), high = glm::max(high, s);
    const PixelRect narrow = sampled_rect(record, low, high, 40, 30), wide = pixel_rect(record, 40, 30);
    empty += narrow.x1 < narrow.x0 || narrow.y1 < narrow.y0;
    const auto [x_min, x_max] = std::minmax({record.x[0], record.x[1], record.x[2]});
    const auto [y_min, y_max] = std::minmax({record.y[0], record.y[1], record.y[2]});
    for (int y = wide.y0; y <= wide.y1; ++y)
      for (int x = wide.x0; x <= wide.x1; ++x)
        for (const glm::ivec2& s : sample_offsets(samples)) {
          const glm::ivec2 at = glm::ivec2(x, y) * 256 + s;
          if (at.x < x_min || at.x > x_max || at.y < y_min || at.y > y_max) continue;
          ASSERT_TRUE(x >= narrow.x0 && x <= narrow.x1 && y >= narrow.y0 && y <= narrow.y1) << i;
        }
  }
  EXPECT_LT(empty, 500u);
}

TEST(PixelRects, HaveACommonPart) {
  const PixelRect both = common_part({0, 0, 9, 9}, {5, -3, 20, 4});
  EXPECT_THAT((std::array{both.x0, both.y0, both.x1, both.y1}), ElementsAre(5, 0, 9, 4));
  const PixelRect none = common_part({0, 0, 3, 3}, {5, 0, 9, 9});
  EXPECT_LT(none.x1, none.x0);
}

/// The coverage rule as stated: inside all edges, or on an edge that is a top or left one.
bool covers(const TriangleRecord& r, const glm::ivec2& at) {
  for (int k = 0; k < 3; ++k) {
    const int n = (k + 1) % 3;
    const std::int64_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
    const std::int64_t side = dx * (at.y - r.y[k]) - dy * (at.x - r.x[k]);
    const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
    if (side < 0 || (side == 0 && !is_top_left)) return false;
  }
  return true;
}

TEST(Coverage, TwoWaysToWalkFindWhatTheRuleSays) {
  Random random(5);
  std::size_t covered = 0;
  for (int i = 0; i < 400; ++i) {
    // Half of the triangles are on a coarse grid, so that many samples lie on edges.
    TriangleRecord record = random_record(random, i % 3 == 0 ? 200'000 : 2000);
    if (i % 2)
      for (std::size_t k = 0; k < 3; ++k) record.x[k] = record.x[k] / 128 * 128, record.y[k] = record.y[k] / 128 * 128;
    if (!orient(record, FacingRule(Culling::none, nullptr))) continue;
    const glm::ivec2 offset = sample_offsets(16)[std::size_t(random.below(16))];
    const PixelRect rect = pixel_rect(record, 40, 30);
    std::vector<std::pair<int, int>> visited, wanted;
    if (rect.x0 <= rect.x1 && rect.y0 <= rect.y1)
      visit_covered(record, rect, offset, [&](int x, int y) { visited.emplace_back(x, y); });
    const TriangleEdges edges(record, offset);
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        const bool inside = covers(record, glm::ivec2(x, y) * 256 + offset);
        if (inside) wanted.emplace_back(x, y);
        bool by_edges = true;
        for (int k = 0; k < 3; ++k) by_edges &= edges.first[k] + x * edges.step_x[k] + y * edges.step_y[k] >= 0;
        ASSERT_EQ(by_edges, inside) << i << ": " << x << ", " << y;
        if (inside) {
          ASSERT_FALSE(misses(record, {x, y, x, y})) << i << ": what is covered is not missed";
        }
      }
    ASSERT_EQ(visited, wanted) << i;
    covered += wanted.size();
  }
  EXPECT_GT(covered, 10'000u);
}

TEST(Misses, IsRightWhereItSaysSo) {
  Random random(6);
  std::size_t missed = 0;
  for (int i = 0; i < 3000; ++i) {
    TriangleRecord record = random_record(random, 3000);
    if (!orient(record, FacingRule(Culling::none, nullptr))) continue;
    const int x = random.below(40), y = random.below(30), w = random.below(6), h = random.below(6);
    if (!misses(record, {x, y, x + w, y + h})) continue;
    ++missed;
    for (int dy = 0; dy <= h; ++dy)
      for (int dx = 0; dx <= w; ++dx)
        for (const glm::ivec2& s : sample_offsets(16))
          ASSERT_FALSE(covers(record, glm::ivec2(x + dx, y + dy) * 256 + s)) << i;
  }
  EXPECT_GT(missed, 500u);
}

TEST(TileLists, HoldTheItemsOfTheirTilesInOrder) {
  TileLists lists;
  // Item i is in all tiles from 10 to 14 that it divides.
  const auto visit = [](std::size_t i, const auto& add) {
    for (std::size_t tile = 10; tile < 15; ++tile)
      if (tile % (i + 1) == 0) add(tile);
  };
  for (int round = 0; round < 2; ++round) {  // the second time in the same memory
    lists.make({10, 15}, 7, visit);
    EXPECT_THAT(lists.of(10), ElementsAre(0, 1, 4));
    EXPECT_THAT(lists.of(11), ElementsAre(0));
    EXPECT_THAT(lists.of(12), ElementsAre(0, 1, 2, 3, 5));
    EXPECT_THAT(lists.of(13), ElementsAre(0));
    EXPECT_THAT(lists.of(14), ElementsAre(0, 1, 6));
  }
  lists.make({3, 5}, 0, visit);
  EXPECT_TRUE(lists.of(3).empty());
  EXPECT_TRUE(lists.of(4).empty());
  EXPECT_EQ(TileRect({0, 0, 127, 128}).count(), 2);
  EXPECT_EQ(TileRect({127, 0, 128, 0}).count(), 2);
}

TEST(StoredDepth, TiesGoToEvenAndEndsAreExact) {
  EXPECT_EQ(stored_depth(DepthFormat::d8, 0), 0u);
  EXPECT_EQ(stored_depth(DepthFormat::d8, 1), 255u);
  EXPECT_EQ(stored_depth(DepthFormat::d8, 0.5), 128u) << "127.5 is as far from 127, which is odd";
  EXPECT_EQ(stored_depth(DepthFormat::d16, 0.5), 32768u);
  EXPECT_EQ(stored_depth(DepthFormat::d24, 0.5), 8388608u);
  EXPECT_EQ(stored_depth(DepthFormat::d8, 126.5 / 255), 126u);
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24}) {
    EXPECT_EQ(stored_depth(format, -5), 0u);
    EXPECT_EQ(stored_depth(format, 7), (1u << integer_bits(format)) - 1);
    EXPECT_EQ(depth_of_stored(format, 0), 0.0);
    EXPECT_EQ(depth_of_stored(format, (1u << integer_bits(format)) - 1), 1.0);
    for (std::uint32_t stored = 0; stored < 1u << integer_bits(format); stored += 1 + stored / 97)
      ASSERT_EQ(stored_depth(format, depth_of_stored(format, stored)), stored);
  }
  EXPECT_EQ(stored_depth(DepthFormat::f32, -0.0), 0u) << "one zero: bits are compared";
  EXPECT_EQ(depth_of_stored(DepthFormat::f32, stored_depth(DepthFormat::f32, 0.1)), double(0.1f));
  EXPECT_EQ(depth_of_stored(DepthFormat::f32, stored_depth(DepthFormat::f32, 2.5)), 2.5) << "not clamped";
  EXPECT_EQ(integer_bits(DepthFormat::f32), 0);
}

}  // namespace
}  // namespace frontmost::test
