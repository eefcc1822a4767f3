// SPDX-License-Identifier: Apache-2.0
// Shapes of figures: some are joined, others stay apart, and nothing is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "figures/colored_order.h"
#include "figures/side_net.h"
#include "frontmost/zbuffer.h"
#include "shade/figure_support.h"

namespace frontmost {
namespace {

using namespace test;
using painter_detail::TrappedCorner;
using shading::SideNet;

TEST(MergeNeighbours, MakesOneSquareOfMany) {
  std::vector<Tile> tiles;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) tiles.push_back(box(x / 3.0, y / 7.0, 1 / 3.0, 1 / 7.0));
  const Figure figure = bare(merge_neighbours(order_of(tiles)));
  ASSERT_EQ(figure.shapes.size(), 1u);
  ASSERT_EQ(figure.rings.size(), 1u);
  EXPECT_EQ(figure.corners.size(), 4u);
  EXPECT_NEAR(area_of(figure, 0), 3, 2e-3);
}

TEST(MergeNeighbours, PartsSidesWhereCornersLieOnThem) {
  const ColoredOrder tiles = order_of({box(0, 0, 4, 4), box(4, 0, 3, 1.3), box(4, 1.3, 3, 2.7)});
  const Figure figure = bare(merge_neighbours(tiles));
  ASSERT_EQ(figure.shapes.size(), 1u);
  EXPECT_EQ(figure.corners.size(), 4u);
  EXPECT_NEAR(area_of(figure, 0), 28, 1e-2);
}

TEST(MergeNeighbours, LeavesHolesOpen) {
  std::vector<Tile> tiles;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      if (x != 1 || y != 1) tiles.push_back(box(x, y, 1, 1));
  const Figure figure = bare(merge_neighbours(order_of(tiles)));
  ASSERT_EQ(figure.shapes.size(), 1u);
  EXPECT_EQ(figure.rings.size(), 2u);
  EXPECT_EQ(figure.corners.size(), 8u);
  EXPECT_NEAR(area_of(figure, 0), 8, 1e-9);
}

TEST(MergeNeighbours, LeavesApartWhatDoesNotTouchOrHasAnotherColour) {
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 1, 1), box(1.1, 0, 1, 1)})).shapes.size(), 2u);
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 1, 1), box(1, 1, 1, 1)})).shapes.size(), 2u);  // they touch at a
                                                                                                // corner
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 1, 1), box(1, 0, 1, 1, kBlue)})).shapes.size(), 2u);
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 1, 1), box(1, 0, 1, 1, kGlass)})).shapes.size(), 2u);
}

TEST(MergeNeighbours, KeepsTheOrderOfWhatCovers) {
  // The blue tile covers the first red one, so the reds may not be painted together after it.
  const ColoredOrder merged =
      merge_neighbours(order_of({box(0, 0, 2, 2), box(1, 1, 0.5, 0.5, kBlue), box(2, 0, 2, 2)}));
  ASSERT_EQ(merged.shapes.size(), 3u);
  EXPECT_EQ(merged.shapes[1].color, kBlue);
  // The blue tile covers no red one: both become one shape, in the place of the later.
  const ColoredOrder free = merge_neighbours(order_of({box(0, 0, 2, 2), box(5, 1, 1, 1, kBlue), box(2, 0, 2, 2)}));
  EXPECT_EQ(free.shapes_of_polygons(), (std::vector<std::uint32_t>{0, 1, 1}));
  EXPECT_EQ(free.shapes[0].color, kBlue);
}

TEST(MergeNeighbours, TranslucentNeighboursBecomeOneUnlessTheyOverlap) {
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 2, 2, kGlass), box(2, 0, 2, 2, kGlass)})).shapes.size(), 1u);
  EXPECT_EQ(merge_neighbours(order_of({box(0, 0, 2, 2, kGlass), box(1.9, 0, 2, 2, kGlass)})).shapes.size(), 2u);
}

TEST(MergeNeighbours, NothingIsLostOfAScene) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 160, 90);
  FigureOptions options;
  options.merges_neighbours = true;
  options.shade.shading = Shading::ids;
  const ColoredOrder colored =
      color_order(surfaces, zbuffer(surfaces, view), visible_parts(painter(surfaces, view)), options);
  const ColoredOrder merged = merge_neighbours(colored);
  EXPECT_EQ(merged.polygons.size(), colored.polygons.size());
  EXPECT_LT(merged.shapes.size() * 10, colored.shapes.size());
  double before = 0, after = 0;
  const Figure apart = bare(colored), joined = bare(merged);
  for (std::size_t i = 0; i < apart.shapes.size(); ++i) before += area_of(apart, i);
  for (std::size_t i = 0; i < joined.shapes.size(); ++i) after += area_of(joined, i);
  EXPECT_NEAR(after, before, before * 1e-4);
  EXPECT_LT(joined.corners.size() * 3, apart.corners.size());
}

TEST(Outlined, TrapsReachUnderLaterShapesAlone) {
  const ColoredOrder tiles = order_of({box(0, 0, 8, 8), box(8, 0, 8, 4, kBlue), box(8, 4, 8, 4, kBlue)});
  const Figure figure = outlined(tiles, 1);
  ASSERT_EQ(figure.shapes.size(), 3u);
  EXPECT_GT(area_of(figure, 0), 64 + 3);
  EXPECT_LT(area_of(figure, 0), 64 + 8);
  EXPECT_NEAR(area_of(figure, 2), 32, 1e-9);
  // Joined into one shape, the blue tiles need no trap between them; the red one still has its own.
  const Figure merged = outlined(merge_neighbours(tiles), 1);
  ASSERT_EQ(merged.shapes.size(), 2u);
  EXPECT_GT(area_of(merged, 0), 64 + 3);
  EXPECT_NEAR(area_of(merged, 1), 64, 1e-2);
}

TEST(Outlined, OfNothingIsEmpty) { EXPECT_TRUE(bare({}).shapes.empty()); }

/// A box beside another that ends half way: the rest of its edge has a trap there.
TEST(Outlined, PartsOfSidesHaveTraps) {
  const Figure figure = outlined(order_of({box(0, 0, 8, 8), box(8, 0, 8, 4, kBlue)}), 1);
  // The trap is narrower by half of its height at the outline, and by all of it where it ends beside an open part.
  EXPECT_NEAR(area_of(figure, 0), 64 + 4 - 0.25 - 0.5, 1e-9);
}

TEST(SideNet, GivesEveryRingOnceWhateverWayOutlinesTouch) {
  SideNet net;
  const auto add = [&](std::vector<glm::dvec2> corners, std::uint32_t number) {
    net.add(std::span<const glm::dvec2>(corners), number);
  };
  // A bow tie: two triangles share only a vertex; a third shares an edge with the first.
  add({{0, 0}, {0, 2}, {1, 1}}, 0);
  add({{2, 0}, {1, 1}, {2, 2}}, 1);
  add({{0, 0}, {-1, 1}, {0, 2}}, 2);
  net.weave();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;
  net.for_each_shared([&](std::uint32_t a, std::uint32_t b) { shared.emplace_back(std::minmax(a, b)); });
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_EQ(shared[0], std::make_pair(0u, 2u));
  std::size_t corners = 0;
  net.for_each_ring([&](std::span<const TrappedCorner> ring) { corners += ring.size(); });
  EXPECT_EQ(corners, 7u);
}

}  // namespace
}  // namespace frontmost
