// SPDX-License-Identifier: Apache-2.0
// Translucent polygons in blend groups: neighbours together, and everything in an order that paints the same.
#include <gtest/gtest.h>

#include <random>

#include "shade/figure_support.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

using namespace test;

constexpr glm::u8vec4 kGreenGlass(0, 255, 0, 99), kThinGlass(255, 0, 0, 50);

std::vector<PrimitiveId> ids_of(const ColoredOrder& colored) {
  std::vector<PrimitiveId> ids;
  for (const PaintPolygon& polygon : colored.polygons) ids.push_back(polygon.id);
  return ids;
}

/// A pane in two halves, another behind the second of them, and a wall before all.
TEST(BlendGroups, HalvesOfAPaneStayTogetherWhateverIsBehind) {
  const ColoredOrder gathered = gather_blend_groups(order_of(
      {box(0, 0, 4, 4, kGlass), box(5, 1, 2, 2, kGreenGlass), box(4, 0, 4, 4, kGlass), box(3, 3, 2, 4, kBlue)}));
  EXPECT_EQ(ids_of(gathered), (std::vector<PrimitiveId>{1, 0, 2, 3}));
  EXPECT_NE(gathered.shapes[0].blend_group, gathered.shapes[1].blend_group);
  EXPECT_EQ(gathered.shapes[1].blend_group, gathered.shapes[2].blend_group);
  EXPECT_NE(gathered.shapes[2].blend_group, gathered.shapes[3].blend_group);
  const Figure figure = outlined(gathered, 1);
  ASSERT_EQ(figure.shapes.size(), 4u);
  EXPECT_EQ(figure.shapes[1].blend_group, figure.shapes[2].blend_group);
  EXPECT_NE(figure.shapes[0].blend_group, figure.shapes[1].blend_group);
  EXPECT_NE(figure.shapes[2].blend_group, figure.shapes[3].blend_group);
  // The first half reaches under the second, and nothing else under anything.
  EXPECT_NEAR(area_of(figure, 0), 4, 1e-9);
  EXPECT_NEAR(area_of(figure, 1), 16 + 4 - 0.5, 1e-9);
  EXPECT_NEAR(area_of(figure, 2), 16, 1e-9);
}

/// The front and the back of a box of glass, seen along an axis; their halves come in any order.
TEST(BlendGroups, PanesInOneOutlineStayWhole) {
  const Tile half{{{0, 0}, {0, 4}, {4, 4}}, kGlass}, other{{{0, 0}, {4, 4}, {4, 0}}, kGlass};
  for (const std::vector<Tile>& tiles :
       {std::vector{half, other, half, other, other, half}, std::vector{half, half, half, other, other, other}}) {
    const ColoredOrder gathered = gather_blend_groups(order_of(tiles));
    ASSERT_EQ(gathered.shapes.size(), tiles.size());
    const Figure figure = outlined(gathered, 1);
    for (std::size_t i = 0; i < tiles.size(); i += 2) {
      EXPECT_EQ(gathered.shapes[i].blend_group, gathered.shapes[i + 1].blend_group) << i;
      if (i > 0) {
        EXPECT_NE(gathered.shapes[i].blend_group, gathered.shapes[i - 1].blend_group) << i;
      }
      EXPECT_GT(area_of(figure, i), 8 + 3) << i;  // with a trap under the other half
    }
  }
}

TEST(BlendGroups, OpacitiesStayApartAndOpaqueFiguresAsTheyAre) {
  const ColoredOrder glass = gather_blend_groups(order_of({box(0, 0, 4, 4, kGlass), box(4, 0, 4, 4, kThinGlass)}));
  EXPECT_NE(glass.shapes[0].blend_group, glass.shapes[1].blend_group);
  EXPECT_NEAR(area_of(outlined(glass, 1), 1), 16, 1e-9);
  const ColoredOrder opaque = gather_blend_groups(order_of({box(0, 0, 4, 4), box(4, 0, 4, 4)}));
  EXPECT_EQ(ids_of(opaque), (std::vector<PrimitiveId>{0, 1}));
  EXPECT_NE(opaque.shapes[0].blend_group, opaque.shapes[1].blend_group);
}

bool overlap(const Tile& a, const Tile& b) {
  return a.corners[0].x < b.corners[2].x && b.corners[0].x < a.corners[2].x && a.corners[0].y < b.corners[2].y &&
         b.corners[0].y < a.corners[2].y;
}

/// By the definition: whoever lies over another still does, no blend_group has two over each other, and shapes are
/// whole.
TEST(BlendGroups, PaintTheSame) {
  std::size_t together = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(test::noted_seed(seed));
    const auto below = [&](std::uint32_t end) { return std::size_t(random() % end); };
    std::vector<Tile> tiles;
    const std::size_t count = 2 + below(38);
    const glm::u8vec4 colors[] = {kRed, kBlue, kGlass, kGreenGlass, kThinGlass};
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = double(below(12)), y = double(below(8)), width = double(1 + below(3)),
                 height = double(1 + below(3));
      tiles.push_back(box(x, y, width, height, colors[below(5)]));
    }
    // Consecutive polygons of one colour form a shape.
    ColoredOrder colored;
    colored.view = front_view();
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || tiles[i].color != tiles[i - 1].color) colored.begin_shape(tiles[i].color);
      colored.add_polygon(PrimitiveId(i), tiles[i].corners);
    }
    const ColoredOrder gathered = gather_blend_groups(colored);
    const std::vector<PrimitiveId> ids = ids_of(gathered);
    ASSERT_EQ(ids.size(), count);
    const std::vector<std::uint32_t> shapes = colored.shapes_of_polygons(), after = gathered.shapes_of_polygons();
    for (std::size_t i = 0; i < count; ++i) {
      const ColoredShape& shape = gathered.shapes[after[i]];
      EXPECT_EQ(shape.color, tiles[ids[i]].color);
      for (std::size_t k = i + 1; k < count; ++k) {
        const bool is_same_shape = shapes[ids[i]] == shapes[ids[k]];
        EXPECT_EQ(after[i] == after[k], is_same_shape) << seed;
        const bool is_group = shape.blend_group == gathered.shapes[after[k]].blend_group && shape.color.a < 255;
        together += is_group && !is_same_shape;
        if (!overlap(tiles[ids[i]], tiles[ids[k]]) || is_same_shape) continue;
        EXPECT_LT(ids[i], ids[k]) << seed;
        EXPECT_FALSE(is_group) << seed;
      }
    }
  }
  EXPECT_GT(together, 300u);
}

}  // namespace
}  // namespace frontmost
