// SPDX-License-Identifier: Apache-2.0
// Facts about polygons side by side: their neighbours, what they hide together, and which of them overlap nothing.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "painter/painted.h"
#include "painter/seen/adjacency.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace painter_detail;
using OutlinePoints = std::vector<glm::dvec2>;

/// An order of outlines, one over the other, counter-clockwise as seen: with y down, (0, 0) (0, 1) (1, 1).
PaintOrder order_of(const std::vector<OutlinePoints>& outlines) {
  PaintOrder order;
  order.view.width = order.view.height = 100;
  for (const OutlinePoints& outline : outlines) {
    order.polygons.push_back({PrimitiveId(order.polygons.size()), std::uint32_t(outline.size()), order.corners.size()});
    for (const glm::dvec2& at : outline) order.corners.push_back({{at, 1}, false});
  }
  return order;
}

OutlinePoints square(double x, double y, double size = 10) {
  return {{x, y}, {x, y + size}, {x + size, y + size}, {x + size, y}};
}

/// `side` by `side` squares, from the corner of the picture on.
std::vector<OutlinePoints> tiles(int side) {
  std::vector<OutlinePoints> all;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) all.push_back(square(10 * x, 10 * y));
  return all;
}

struct Laid {
  explicit Laid(const std::vector<OutlinePoints>& outlines)
      : screen(order_of(outlines), Occluders::all()), adjacency(screen) {}
  ScreenPolygons screen;
  Adjacency adjacency;

  [[nodiscard]] std::vector<std::uint32_t> alone(const std::vector<std::uint8_t>& gone = {}) const {
    PaintEffort effort({}, screen.count());
    const std::vector<std::uint8_t> found = find_unoverlapped(screen, adjacency, gone, effort);
    std::vector<std::uint32_t> places;
    for (std::uint32_t place = 0; place < found.size(); ++place)
      if (found[screen.slot(place)]) places.push_back(place);
    return places;
  }
};

TEST(Adjacency, FindsWhatHasTheSameSide) {
  // Two triangles of a square, one that shares only half of an edge, and one on the wrong side of the first one's edge.
  const Laid laid(
      {{{0, 0}, {0, 8}, {8, 8}}, {{0, 0}, {8, 8}, {8, 0}}, {{0, 0}, {0, -4}, {-4, 0}}, {{0, 0}, {0, 8}, {3, 8}}});
  const auto across = [&](std::uint32_t place, std::size_t side) {
    const std::uint32_t slot = laid.adjacency.across(laid.screen.first_corner(laid.screen.slot(place)) + side);
    return slot == no_index ? no_index : laid.screen.place(slot);
  };
  EXPECT_EQ(across(0, 2), 1u);
  EXPECT_EQ(across(1, 0), 0u);
  for (const std::uint32_t place : {2u, 3u})
    for (std::size_t side = 0; side < 3; ++side) EXPECT_EQ(across(place, side), no_index);
  EXPECT_EQ(across(0, 0), no_index);
}

TEST(Adjacency, TilesHaveNoOtherOpenSidesThanTheirBorder) {
  std::vector<OutlinePoints> all = tiles(10);
  Random random(3);
  for (std::size_t i = all.size(); i-- > 1;) std::swap(all[i], all[std::size_t(random.below(int(i) + 1))]);
  const Laid laid(all);
  std::size_t open = 0;
  for (std::size_t slot = 0; slot < laid.screen.count(); ++slot)
    for (std::size_t side = 0; side < 4; ++side) {
      const std::uint32_t across = laid.adjacency.across(laid.screen.first_corner(slot) + side);
      open += across == no_index;
      if (across != no_index) {
        const glm::dvec2 from(laid.screen.outline(slot)[0].at), to(laid.screen.outline(across)[0].at);
        EXPECT_EQ(glm::length(from - to), 10);
      }
    }
  EXPECT_EQ(open, 40u);
}

/// Each would be compared with all others.
TEST(Adjacency, OfManyThatHaveTheSameSideAFewFindANeighbour) {
  std::vector<OutlinePoints> all(1000, square(10, 10));
  all.resize(2000, square(20, 10));
  const Laid laid(all);
  std::size_t found = 0;
  for (std::uint32_t corner = 0; corner < laid.screen.corners().size(); ++corner)
    found += laid.adjacency.across(corner) != no_index;
  EXPECT_EQ(found, 2u * 64);
}

/// All polygons but one hide others.
struct AllBut {
  const Laid& laid;
  std::uint32_t missing;
  std::size_t* asks;

  [[nodiscard]] bool may_hide(std::uint32_t slot) const {
    ++*asks;
    return laid.screen.place(slot) != missing;
  }
  [[nodiscard]] std::uint32_t at(const glm::dvec2& place) const {
    for (const std::uint32_t slot : laid.screen.cell_at(place))
      if (may_hide(slot) && is_within(laid.screen.outline(slot), place, 0)) return slot;
    return no_index;
  }
};

class SpreadTest : public testing::Test {
 protected:
  /// Starts at the polygon that contains a point next to the first vertex.
  OccluderUnion::Found spread(const Laid& laid, const OutlinePoints& outline, std::uint32_t missing = no_index) {
    const PaintOrder asked = order_of({outline});
    OccluderUnion spreader(laid.screen, laid.adjacency);
    asks_ = 0;
    const AllBut hiders{laid, missing, &asks_};
    const std::uint32_t first = hiders.at(outline[0] * 0.9 + outline[2] * 0.1);
    const OccluderUnion::Found found = spreader.spread(asked.corners, first, hiders);
    open_at_ = spreader.open_at();
    return found;
  }
  std::size_t asks_ = 0;
  glm::dvec2 open_at_{0};
};

TEST_F(SpreadTest, TellsWhereTilesHideTogether) {
  const Laid laid(tiles(10));
  const OutlinePoints asked{{12, 12}, {12, 38}, {38, 38}, {38, 12}};
  EXPECT_EQ(spread(laid, asked, 99), OccluderUnion::Found::hidden);
  EXPECT_EQ(spread(laid, asked, 22), OccluderUnion::Found::open);
  EXPECT_THAT(open_at_.x, testing::AllOf(testing::Ge(20 - 1e-9), testing::Le(30 + 1e-9)));
  EXPECT_THAT(open_at_.y, testing::AllOf(testing::Ge(20 - 1e-9), testing::Le(30 + 1e-9)));
  // Tiles outside the asked outline may be missing.
  for (const std::uint32_t missing : {0u, 10u, 41u, 44u, 77u})
    EXPECT_EQ(spread(laid, asked, missing), OccluderUnion::Found::hidden);
  // Nothing lies beyond the last tiles.
  EXPECT_EQ(spread(laid, {{85, 85}, {85, 95}, {105, 95}}), OccluderUnion::Found::open);
  EXPECT_NEAR(open_at_.x, 100, 0.01);
}

TEST_F(SpreadTest, TouchingIsNotCrossing) {
  // The outline is one tile exactly, and all other tiles are missing.
  const Laid laid({square(50, 50)});
  EXPECT_EQ(spread(laid, square(50, 50)), OccluderUnion::Found::hidden);
  EXPECT_EQ(spread(laid, square(50, 50, 10.01)), OccluderUnion::Found::open);
}

/// Cuts at a vertex leave it twice, and an edge of length zero has no inner side.
TEST_F(SpreadTest, ACornerMayBeThereTwice) {
  const Laid laid({square(50, 50)});
  EXPECT_EQ(spread(laid, {{50, 50}, {50, 70}, {70, 70}, {70, 70}, {70, 50}}), OccluderUnion::Found::open);
  EXPECT_EQ(spread(laid, {{50, 50}, {50, 60}, {60, 60}, {60, 60}, {60, 50}}), OccluderUnion::Found::hidden);
}

/// Bricks: few edges are shared whole, but all lie beside others.
TEST_F(SpreadTest, StepsAlongSidesThatLieBesideTwo) {
  std::vector<OutlinePoints> bricks;
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10; ++i) {
      const double x = 10 * i - 4 * (row % 2), y = 10 * row;
      bricks.push_back({{x, y}, {x, y + 10}, {x + 10, y + 10}, {x + 10, y}});
    }
  const Laid laid(bricks);
  const OutlinePoints asked{{22, 22}, {12, 44}, {31, 61}, {44, 33}};
  EXPECT_EQ(spread(laid, asked), OccluderUnion::Found::hidden);
  EXPECT_LT(asks_, 300u);
  std::size_t open = 0;
  for (std::uint32_t missing = 0; missing < bricks.size(); ++missing) {
    const PaintOrder brick = order_of({bricks[missing]});
    if (is_within(brick.corners, asked[0] * 0.9 + asked[2] * 0.1, 0)) continue;
    if (spread(laid, asked, missing) == OccluderUnion::Found::hidden) continue;
    ++open;
    EXPECT_TRUE(is_within(brick.corners, open_at_, 1e-9)) << missing;
  }
  // The outline reaches into one to four bricks of each of five rows.
  EXPECT_GE(open, 8u);
  EXPECT_LE(open, 16u);
}

TEST_F(SpreadTest, GivesUpOverTooMany) {
  std::vector<OutlinePoints> all;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) all.push_back(square(2 * x, 2 * y, 2));
  EXPECT_EQ(spread(Laid(all), square(1.5, 1.5, 70)), OccluderUnion::Found::unknown);
  EXPECT_LE(asks_, 300u);
}

TEST(Alone, TilesAreAndWhatLiesOverOthersIsNot) {
  const std::vector<OutlinePoints> ten = tiles(10);
  EXPECT_EQ(Laid(ten).alone().size(), 100u);

  std::vector<OutlinePoints> with_small = ten;
  with_small.push_back(square(42, 42, 3));  // lies within tile 44
  std::vector<std::uint32_t> expected(100);
  std::iota(expected.begin(), expected.end(), 0u);
  expected.erase(expected.begin() + 44);
  EXPECT_EQ(Laid(with_small).alone(), expected);

  std::vector<OutlinePoints> twice = ten;
  twice.insert(twice.end(), ten.begin(), ten.end());
  EXPECT_TRUE(Laid(twice).alone().empty());
}

/// The middle of a sheet has no open edges near it, only its own neighbours; its group is known from where the sheet
/// begins.
TEST(Alone, SheetsOverEachOtherAreNot) {
  std::vector<OutlinePoints> two = tiles(10);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) two.push_back(square(5 + 10 * x, 5 + 10 * y));
  const Laid laid(two);
  const std::vector<std::uint32_t> alone = laid.alone();
  EXPECT_THAT(alone, testing::Each(testing::Lt(100u)));
  // The upper sheet ends within the tiles of the ninth column and row, so only the tenth of both are free.
  EXPECT_EQ(alone.size(), 19u);
  // With the upper sheet removed, all tiles are alone.
  std::vector<std::uint8_t> gone(two.size(), 0);
  for (std::uint32_t place = 100; place < two.size(); ++place) gone[laid.screen.slot(place)] = 1;
  EXPECT_EQ(laid.alone(gone).size(), 100u);
}

/// The definition: the line along an edge of one polygon has the other polygon on its outer side.
bool are_apart(const Outline& a, const Outline& b) {
  const auto parts = [](const Outline& p, const Outline& q) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      const glm::dvec2 from(p[i].at), way = glm::dvec2(p[(i + 1) % p.size()].at) - from;
      if (std::all_of(q.begin(), q.end(), [&](const PaintCorner& corner) {
            return way.x * (corner.at.y - from.y) - way.y * (corner.at.x - from.x) >= -1e-9 * glm::length(way);
          }))
        return true;
    }
    return false;
  };
  return parts(a, b) || parts(b, a);
}

TEST(Alone, OverlapNothingInAnyScene) {
  std::size_t alone = 0;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
      SCOPED_TRACE(testing::Message() << int(kind) << " " << seed);
      Mesh mesh = random_mesh(kind, kind == Kind::tiny ? 40 : 3, seed);
      const Mesh grid = random_mesh(Kind::shared_grid, 600, seed + 50);
      const auto first = std::uint32_t(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), grid.positions.begin(), grid.positions.end());
      for (const glm::uvec3& triangle : grid.triangles) mesh.triangles.push_back(triangle + first);
      const Scene scene = scene_of(std::move(mesh));
      const Surfaces surfaces(scene);
      Random random(seed + 7);
      const PaintOrder order = painter(surfaces, random_view(random, 100, 80), {.method = PaintMethod::farthest});
      const ScreenPolygons screen(order, Occluders::all());
      PaintEffort effort({}, screen.count());
      const std::vector<std::uint8_t> found = find_unoverlapped(screen, Adjacency(screen), {}, effort);
      for (std::size_t a = 0; a < found.size(); ++a) {
        alone += found[a];
        for (std::size_t b = 0; found[a] && b < found.size(); ++b)
          EXPECT_TRUE(a == b || are_apart(screen.outline(a), screen.outline(b))) << a << " " << b;
      }
    }
  EXPECT_GT(alone, 200u);
}

Mesh sphere(int sectors) {
  Mesh mesh;
  const auto at = [&](int ring, int sector) {
    const double down = 2 * M_PI * ring / sectors, around = 2 * M_PI * (sector % sectors) / sectors;
    return glm::vec3(std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around));
  };
  for (int ring = 0; 2 * ring < sectors; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      add_triangle(mesh, at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1));
      add_triangle(mesh, at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
    }
  return mesh;
}

/// In a closed surface, only polygons next to its outline still need an order.
TEST(Alone, TheFrontOfASphereIsNotAskedAbout) {
  const Scene scene = scene_of(sphere(120));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 400, 400);
  const auto asked = [](const PaintSteps& steps) {
    return steps.boxes_apart + steps.behind + steps.before + steps.projections_apart + steps.compared;
  };
  const PaintOrder all = painter(surfaces, view), front = painter(surfaces, view, {.occluders = Occluders::all()});
  EXPECT_GT(asked(all.steps), all.polygons.size());
  EXPECT_LT(asked(front.steps), front.polygons.size() / 4);
  EXPECT_LT(front.polygons.size(), all.polygons.size() * 0.6);
}

}  // namespace
}  // namespace frontmost::test
