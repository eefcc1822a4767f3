// SPDX-License-Identifier: Apache-2.0
// Dimensions of parts of known sizes: the expected numbers, each once, and nothing drawn over them.
#include "sheets/dimensions/dimensions.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "frontmost/sheets.h"
#include "sheets/dimensions/obstacles.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace detail;
using testing::ElementsAre;
using testing::IsEmpty;

/// A box from the origin; faces with holes have no lids.
void add_box(Mesh& mesh, const glm::vec3& size) {
  const auto corner = [&](int i) { return glm::vec3(i & 1 ? size.x : 0, i & 2 ? size.y : 0, i & 4 ? size.z : 0); };
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    add_triangle(mesh, corner(f[0]), corner(f[1]), corner(f[2]));
    add_triangle(mesh, corner(f[0]), corner(f[2]), corner(f[3]));
  }
}

/// A peg along z, with lids.
void add_peg(Mesh& mesh, const glm::vec3& foot, float radius, float height, int sides = 36) {
  const auto at = [&](int k, float z) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides + 0.03;
    return foot + glm::vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int i = 0; i < sides; ++i) {
    add_triangle(mesh, at(i, 0), at(i + 1, 0), at(i + 1, height));
    add_triangle(mesh, at(i, 0), at(i + 1, height), at(i, height));
    add_triangle(mesh, at(i, height), at(i + 1, height), foot + glm::vec3(0, 0, height));
    add_triangle(mesh, at(i + 1, 0), at(i, 0), foot);
  }
}

/// A ring of square section, 10 high, with a bevel at each end of the bore as wide as high: at 45 degrees, or rounded
/// in six steps.
void add_ring(Mesh& mesh, const glm::dvec3& foot, double bore, double bevel, bool is_rounded) {
  constexpr int sides = 36;
  std::vector<glm::dvec2> profile = {{bore + 5, 0}};
  for (const int end : {0, 1})
    for (int i = 0; i <= 6; i += is_rounded ? 1 : 6) {
      const double angle = std::numbers::pi / 12 * (end == 0 ? 6 - i : i), out = bevel * (1 - std::cos(angle));
      const double up = bevel * (1 - std::sin(angle));
      profile.emplace_back(bore + out, end == 0 ? up : 10 - up);
    }
  profile.emplace_back(bore + 5, 10);
  const auto at = [&](std::size_t i, int k) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides + 0.03;
    const glm::dvec2& p = profile[i % profile.size()];
    return glm::vec3(foot + glm::dvec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y));
  };
  for (std::size_t i = 0; i < profile.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      add_triangle(mesh, at(i, k), at(i + 1, k + 1), at(i, k + 1));
      add_triangle(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1));
    }
}

/// Views of a scene at full scale, one below the other on a large page.
class DimensionsTest : public testing::Test {
 protected:
  void draw(std::initializer_list<NamedView> directions) {
    surfaces_ = std::make_unique<Surfaces>(scene_);
    rounds_ = find_rounds(*surfaces_);
    sheets_.clear();
    drawings_.clear();
    for (const NamedView direction : directions) {
      FrameOptions options;
      options.direction = direction;
      options.orthographic = true;
      drawings_.push_back(draw_lines(*surfaces_, frame(*surfaces_, 2000, 2000, options)));
      const View& view = drawings_.back().view;
      SheetView& sheet = sheets_.emplace_back();
      sheet.millimetres_per_pixel = (view.projection.right - view.projection.left) / view.width;
      sheet.strokes =
          chain_strokes(*surfaces_, drawings_.back(), {.by_kind = false, .by_outline = false, .arc_tolerance = 0.1});
      sheet.origin = {100, 50 + 250.0 * double(sheets_.size() - 1)};
    }
  }

  [[nodiscard]] std::vector<DimensionedView> views() const {
    std::vector<DimensionedView> all;
    for (std::size_t i = 0; i < sheets_.size(); ++i) all.push_back({&sheets_[i], &drawings_[i], &rounds_});
    return all;
  }

  [[nodiscard]] Dimensions dimensioned(const DimensionOptions& options = {}) const {
    return place_dimensions(views(), {{0, 0}, {1000, 1000}}, {}, options);
  }

  Scene scene_;
  std::unique_ptr<Surfaces> surfaces_;
  Rounds rounds_;
  std::vector<SheetView> sheets_;
  std::vector<Drawing> drawings_;
};

/// Number of arrowheads, which are the closed paths among the lines.
std::size_t arrows_of(const Dimensions& all) {
  std::size_t count = 0;
  if (!all.layer.groups.empty())
    for (const PagePath& path : all.layer.groups[0].paths) count += path.is_closed;
  return count;
}

TEST(DimensionText, HasNoTrailingZeros) {
  EXPECT_EQ(dimension_text(50, 2), "50");
  EXPECT_EQ(dimension_text(49.99997, 2), "50");
  EXPECT_EQ(dimension_text(12.7, 2), "12.7");
  EXPECT_EQ(dimension_text(33.3333333, 2), "33.33");
  EXPECT_EQ(dimension_text(100.05, 2), "100.05");
  EXPECT_EQ(dimension_text(0.266, 2), "0.266");
  EXPECT_EQ(dimension_text(0.0123456, 2), "0.0123");
  EXPECT_EQ(dimension_text(0, 2), "0");
  // Two equal sides must not become 1.87 and 1.88.
  EXPECT_EQ(dimension_text(1.8749999, 2), "1.875");
  EXPECT_EQ(dimension_text(1.8750001, 2), "1.875");
  EXPECT_EQ(dimension_text(1234.5678, 0), "1235");
  EXPECT_EQ(dimension_text(0.9996, 2), "1");
}

TEST_F(DimensionsTest, ABoxHasThree) {
  Mesh mesh;
  add_box(mesh, {40, 30, 20});
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top, NamedView::left});
  const std::vector<OverallSizes> sizes = overall_sizes_of(views());
  ASSERT_EQ(sizes.size(), 3u);
  EXPECT_TRUE(sizes[0].width && sizes[0].height);
  EXPECT_TRUE(!sizes[1].width && sizes[1].height);
  EXPECT_TRUE(!sizes[2].width && !sizes[2].height);
  const Dimensions all = dimensioned();
  EXPECT_EQ(all.count, 3u);
  EXPECT_EQ(all.left_out, 0u);
  EXPECT_EQ(arrows_of(all), 6u);
  // 40, 30 and 20 have two digits each.
  PageGroup expected;
  for (const char* const number : {"40", "30", "20"}) add_text(expected, number, {0, 0});
  ASSERT_EQ(all.layer.groups.size(), 2u);
  EXPECT_EQ(all.layer.groups[1].points.size(), expected.points.size());
}

TEST_F(DimensionsTest, StandTenMillimetresFromWhatTheyMeasure) {
  Mesh mesh;
  add_box(mesh, {40, 30, 20});
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  const DrawingBounds drawn = bounds_of(drawings_[0], true);
  const glm::dvec2 low = sheets_[0].on_page(drawn.low), high = sheets_[0].on_page(drawn.high);
  const Dimensions all = dimensioned();
  const PageGroup& lines = all.layer.groups.at(0);
  std::vector<std::array<double, 4>> straight;
  for (const PagePath& path : lines.paths)
    if (!path.is_closed)
      straight.push_back({lines.points[path.first].x - low.x, lines.points[path.first].y - high.y,
                          lines.points[path.first + 1].x - low.x, lines.points[path.first + 1].y - high.y});
  const auto near = [](double a, double b, double c, double d) {
    return ElementsAre(testing::DoubleNear(a, 1e-4), testing::DoubleNear(b, 1e-4), testing::DoubleNear(c, 1e-4),
                       testing::DoubleNear(d, 1e-4));
  };
  // The extension lines run from 1 mm below the corners to 2 mm beyond the dimension line; the latter is checked too.
  EXPECT_THAT(straight, testing::IsSupersetOf({near(0, 1, 0, 12), near(40, 1, 40, 12), near(0, 10, 40, 10)}));
  EXPECT_THAT(straight, testing::Contains(near(-10, 0, -10, -30)));
  EXPECT_GT(high.x - low.x, 39.9);
}

TEST(DimensionText, IsAFractionOfAnInchWhereThatIsExactEnough) {
  const NumberStyle style{3, true};
  EXPECT_EQ(dimension_text(1.875, style), "1 7/8");
  EXPECT_EQ(dimension_text(3 / 64.0, style), "3/64");
  EXPECT_EQ(dimension_text(0.5, style), "1/2");
  EXPECT_EQ(dimension_text(2, style), "2");
  EXPECT_EQ(dimension_text(12 + 31 / 32.0, style), "12 31/32");
  // 0.0005 inches are exact enough; more are not.
  EXPECT_EQ(dimension_text(1.875 + 0.00049, style), "1 7/8");
  EXPECT_EQ(dimension_text(1.875 - 0.00049, style), "1 7/8");
  EXPECT_EQ(dimension_text(1.875 + 0.00051, style), "1.876");
  EXPECT_EQ(dimension_text(1.99951, style), "2");
  EXPECT_EQ(dimension_text(40 / 25.4, style), "1.575");
  // Below 1/64, nothing is taken for 0.
  EXPECT_EQ(dimension_text(0.0004, style), "0.0004");
  EXPECT_EQ(dimension_text(0, style), "0");
  EXPECT_EQ(dimension_text(1e15, style), dimension_text(1e15, 3));
}

TEST_F(DimensionsTest, NumbersAreInTheUnitOfTheDrawing) {
  Mesh mesh;
  add_box(mesh, {25.4f, 50.8f, 2.54f});
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  PageGroup expected;
  for (const char* const number : {"1", "2"}) add_text(expected, number, {0, 0});
  const Dimensions all = dimensioned({.numbers_per_unit = 1 / 25.4, .decimals = 3});
  EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size());
}

TEST_F(DimensionsTest, OfOneCylinderAreItsDiameterAndItsLength) {
  Mesh mesh;
  add_peg(mesh, {0, 0, 0}, 10, 50, 37);  // no vertex lies at its widest point
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top, NamedView::left});
  const Dimensions all = dimensioned();
  EXPECT_EQ(all.count, 2u);
  PageGroup expected;
  for (const char* const number : {"\u230020", "50"}) add_text(expected, number, {0, 0});
  EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size());
}

TEST_F(DimensionsTest, DiametersOfOneSizeAreOne) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  for (int i = 0; i < 4; ++i) add_peg(mesh, {20 + 20 * i, 30, 10}, 6, 8);
  add_peg(mesh, {10, 10, 10}, 3, 5);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  const Dimensions all = dimensioned();
  EXPECT_EQ(all.count, 3u + 2u);
  EXPECT_EQ(arrows_of(all), 6u + 2u);
  PageGroup expected;
  for (const char* const number : {"100", "60", "18", "4\u00d7\u230012", "\u23006"}) add_text(expected, number, {0, 0});
  EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size());
}

TEST_F(DimensionsTest, EachLevelHasThoseBeforeIt) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  for (int i = 0; i < 4; ++i) add_peg(mesh, {20 + 20 * i, 30, 10}, 6, 8);
  add_peg(mesh, {10, 10, 10}, 3, 5);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  EXPECT_EQ(dimensioned({.level = Dimensioning::overall}).count, 3u);
  EXPECT_EQ(dimensioned({.level = Dimensioning::diameters}).count, 5u);
  const Dimensions all = dimensioned({.level = Dimensioning::holes});
  EXPECT_EQ(all.count, 5u + 5u + 2u);
  EXPECT_EQ(all.left_out, 0u);
  EXPECT_EQ(arrows_of(all), 6u + 2u + 7u + 2u) << "and two origins, which are closed, too";
  PageGroup expected;
  for (const char* const number : {"100", "60", "18", "4\u00d7\u230012", "\u23006"}) add_text(expected, number, {0, 0});
  for (const char* const number : {"10", "20", "40", "60", "80", "10", "30"}) add_text(expected, number, {0, 0});
  EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size());
}

/// A slab 10 high whose four corners are rounded.
void add_rounded_slab(Mesh& mesh, glm::vec2 size, double radius) {
  std::vector<glm::vec2> outline;
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= 8; ++i) {
      const double angle = std::numbers::pi / 2 * (corner + i / 8.0);
      const glm::dvec2 centre(corner == 0 || corner == 3 ? size.x - radius : radius,
                              corner < 2 ? size.y - radius : radius);
      outline.emplace_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
  const glm::vec2 middle = size / 2.0f;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    add_triangle(mesh, {a, 10}, {b, 10}, {middle, 10});
    add_triangle(mesh, {b, 0}, {a, 0}, {middle, 0});
    add_triangle(mesh, {a, 0}, {b, 0}, {b, 10});
    add_triangle(mesh, {a, 0}, {b, 10}, {a, 10});
  }
}

TEST_F(DimensionsTest, ArcsHaveRadii) {
  Mesh mesh;
  add_rounded_slab(mesh, {100, 60}, 7);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  EXPECT_EQ(rounds_.arcs.size(), 8u) << "four corners, above and below";
  for (const CircleArc& arc : rounds_.arcs) {
    EXPECT_NEAR(arc.radius, 7, 1e-4);
    // A chain of edges that begins within an arc may lose one of the arc's eight sides.
    const double side = std::numbers::pi / 16;
    EXPECT_NEAR(arc.turn, std::numbers::pi / 2, 1.001 * side);
    // The middle lies in the direction of the slab's corner.
    const glm::dvec3 out = arc.middle - arc.centre;
    EXPECT_NEAR(std::atan2(std::abs(out.y), std::abs(out.x)), std::numbers::pi / 4, 0.501 * side);
    EXPECT_NEAR(glm::length(out), 7, 1e-4);
  }
  EXPECT_EQ(dimensioned({.level = Dimensioning::holes}).count, 3u);
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  EXPECT_EQ(all.count, 4u);
  PageGroup expected;
  for (const char* const number : {"100", "60", "10", "4\u00d7R7"}) add_text(expected, number, {0, 0});
  EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size());
}

TEST_F(DimensionsTest, PositionsWithoutRoomAreCounted) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  for (const float x : {10.f, 14.f, 30.f}) add_peg(mesh, {x, 30, 10}, 1.5f, 8);
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  const Dimensions all = dimensioned({.level = Dimensioning::holes});
  EXPECT_EQ(all.count, 2u + 1u + 2u + 1u) << "sizes, a diameter, two of three positions along, and one upwards";
  EXPECT_EQ(all.left_out, 1u);
}

TEST_F(DimensionsTest, RoundPartsHaveNoPositions) {
  Mesh mesh;
  add_peg(mesh, {0, 0, 0}, 20, 10);
  add_peg(mesh, {0, 0, 10}, 8, 10);
  add_peg(mesh, {12, 0, 10}, 2, 10);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  EXPECT_EQ(dimensioned({.level = Dimensioning::holes}).count, dimensioned().count);
}

TEST_F(DimensionsTest, BoresHaveDiametersWhateverTheirRims) {
  for (const bool is_rounded : {false, true}) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) add_ring(mesh, {25 * (i % 4), 25 * (i / 4), 0}, 4, 1, is_rounded);
    scene_ = scene_of(mesh);
    draw({NamedView::front, NamedView::top});
    const Dimensions all = dimensioned();
    PageGroup expected;
    for (const char* const number : {"93", "43", "10", "8\u00d7\u23008", "8\u00d7\u230018"})
      add_text(expected, number, {0, 0});
    EXPECT_EQ(all.layer.groups.at(1).points.size(), expected.points.size()) << is_rounded;
    EXPECT_EQ(all.left_out + all.undrawn, 0u) << is_rounded;
  }
}

TEST_F(DimensionsTest, WhatIsNotDrawnIsCounted) {
  Mesh mesh;
  add_box(mesh, {100, 60, 20});
  add_peg(mesh, {20, 30, 5}, 6, 8);
  add_peg(mesh, {20, 30, 15}, 6, 2);  // the same dimension again
  add_peg(mesh, {60, 30, 5}, 3, 8);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  EXPECT_EQ(dimensioned().undrawn, 0u);
  std::vector<DimensionedView> seen = views();
  for (DimensionedView& view : seen) view.with_hidden = false;
  const Dimensions all = place_dimensions(seen, {{0, 0}, {1000, 1000}}, {});
  EXPECT_EQ(all.count, 3u);
  EXPECT_EQ(all.undrawn, 2u);
  EXPECT_EQ(all.left_out, 0u);
}

TEST_F(DimensionsTest, CylindersOfFewSidesAreCounted) {
  Mesh mesh;
  add_box(mesh, {100, 60, 20});
  add_peg(mesh, {20, 30, 20}, 6, 8, 12);
  add_peg(mesh, {20, 30, 28}, 6, 2, 12);  // the same dimension again
  add_peg(mesh, {60, 30, 20}, 3, 8, 8);
  add_peg(mesh, {80, 30, 20}, 3, 8, 6);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  const Dimensions all = dimensioned();
  EXPECT_EQ(all.count, 3u) << "width, depth and height";
  EXPECT_EQ(all.prisms, 2u) << "six sides are a nut";
  EXPECT_EQ(all.left_out + all.undrawn, 0u);
  draw({NamedView::top});
  EXPECT_EQ(dimensioned().prisms, 0u) << "seen from the side alone";
}

TEST_F(DimensionsTest, NothingLiesOnANumber) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  for (int i = 0; i < 12; ++i) add_peg(mesh, {8 + 7.5 * i, 10 + 37 * (i % 2), 10}, 1 + 0.2f * float(i), 8);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  for (const Dimensioning level : {Dimensioning::diameters, Dimensioning::holes}) {
    const Dimensions all = dimensioned({.level = level});
    EXPECT_GE(all.count, level == Dimensioning::holes ? 20u : 10u);
    detail::Obstacles obstacles({{0, 0}, {1000, 1000}});
    for (const SheetView& sheet : sheets_) obstacles.add(sheet);
    const PageGroup &drawn = all.layer.groups.at(0), &texts = all.layer.groups.at(1);
    for (const PagePath& path : drawn.paths)
      if (!path.is_closed) obstacles.add(detail::PageSegment{drawn.points[path.first], drawn.points[path.first + 1]});
    for (const PagePath& path : texts.paths)
      for (std::uint32_t i = path.first; i < path.first + path.count; ++i)
        EXPECT_TRUE(obstacles.is_free({texts.points[i] - 0.3, texts.points[i] + 0.3})) << i;
  }
}

TEST_F(DimensionsTest, KeepOffWhatIsTaken) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  add_peg(mesh, {50, 30, 10}, 6, 8);
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  EXPECT_EQ(dimensioned().count, 3u);
  const PageBox all_of_it{{0, 0}, {1000, 1000}};
  const Dimensions none = place_dimensions(views(), all_of_it, std::span(&all_of_it, 1));
  EXPECT_EQ(none.count, 2u);
  EXPECT_EQ(none.left_out, 1u);
}

TEST_F(DimensionsTest, OfNothingAreNone) {
  scene_ = scene_of({});
  draw({NamedView::front});
  const Dimensions all = dimensioned();
  EXPECT_EQ(all.count, 0u);
  EXPECT_THAT(all.layer.groups, IsEmpty());
}

TEST_F(DimensionsTest, BadOptionsAreRefused) {
  Mesh mesh;
  add_box(mesh, {1, 1, 1});
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double unit : {0.0, -1.0, infinity, std::nan("")})
    EXPECT_THROW(static_cast<void>(dimensioned({.numbers_per_unit = unit})), Error);
  EXPECT_THROW(static_cast<void>(dimensioned({.decimals = -1})), Error);
  EXPECT_THROW(static_cast<void>(dimensioned({.decimals = 7})), Error);
  EXPECT_THROW(static_cast<void>(dimensioned({.text_height = 0})), Error);
}

}  // namespace
}  // namespace frontmost::test
