// SPDX-License-Identifier: Apache-2.0
// Dimensions of parts of known sizes: the expected numbers, each once, and nothing drawn over them.
#include "sheets/dimensions/dimensions.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "frontmost/sheets.h"
#include "sheets/dimensions/obstacles.h"
#include "sheets/dimensions/positions.h"
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
    for (std::size_t i = 0; i < sheets_.size(); ++i)
      all.push_back({&sheets_[i], &drawings_[i], &rounds_, surfaces_.get()});
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

/// The texts among the paths of a group, in their order, as far as `known` has them; "?" for each other path. Texts are
/// recognised by the lengths and bulges of their strokes and by the distances between them, in any direction. Sets the
/// first point of each text.
std::vector<std::string> texts_of(const PageGroup& drawn, std::vector<std::string> known,
                                  std::vector<glm::dvec2>* begins = nullptr) {
  const auto signature = [](const PageGroup& group, std::size_t path) {
    const PagePath& p = group.paths[path];
    std::vector<double> values;
    for (std::uint32_t i = p.first; i + 1 < p.first + p.count; ++i) {
      values.push_back(glm::distance(group.points[i], group.points[i + 1]));
      values.push_back(group.bulges.empty() ? 0 : group.bulges[i]);
    }
    return values;
  };
  const auto are_near = [](double a, double b) { return std::abs(a - b) < 1e-4; };
  const auto is_at = [&](const PageGroup& text, std::size_t begin) {
    if (begin + text.paths.size() > drawn.paths.size()) return false;
    const auto start = [](const PageGroup& group, std::size_t path) { return group.points[group.paths[path].first]; };
    for (std::size_t i = 0; i < text.paths.size(); ++i) {
      const std::vector<double> a = signature(text, i), b = signature(drawn, begin + i);
      if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), are_near)) return false;
      if (!are_near(glm::distance(start(text, i), start(text, 0)),
                    glm::distance(start(drawn, begin + i), start(drawn, begin))))
        return false;
    }
    return true;
  };
  std::sort(known.begin(), known.end(), [](const std::string& a, const std::string& b) {
    return a.size() > b.size() || (a.size() == b.size() && a < b);
  });
  std::vector<std::string> found;
  for (std::size_t at = 0; at < drawn.paths.size();) {
    std::size_t length = 1;
    std::string name = "?";
    for (const std::string& text : known) {
      PageGroup group;
      add_text(group, text, {0, 0});
      if (!is_at(group, at)) continue;
      length = group.paths.size();
      name = text;
      break;
    }
    found.push_back(name);
    if (begins != nullptr) begins->push_back(drawn.points[drawn.paths[at].first]);
    at += length;
  }
  return found;
}

/// Expects exactly these numbers, in any order.
void expect_texts(const Dimensions& all, const std::vector<std::string>& expected) {
  ASSERT_EQ(all.layer.groups.size(), 2u);
  EXPECT_THAT(texts_of(all.layer.groups[1], expected), testing::UnorderedElementsAreArray(expected));
  EXPECT_EQ(all.count, expected.size());
}

/// Number of arrowheads, which are the closed paths among the lines.
std::size_t arrows_of(const Dimensions& all) {
  std::size_t count = 0;
  if (!all.layer.groups.empty())
    for (const PagePath& path : all.layer.groups[0].paths) count += path.is_closed;
  return count;
}

TEST(DimensionText, HasNoTrailingZeros) {
  EXPECT_EQ(dimension_text(50, {2}), "50");
  EXPECT_EQ(dimension_text(49.99997, {2}), "50");
  EXPECT_EQ(dimension_text(12.7, {2}), "12.7");
  EXPECT_EQ(dimension_text(33.3333333, {2}), "33.33");
  EXPECT_EQ(dimension_text(100.05, {2}), "100.05");
  EXPECT_EQ(dimension_text(0.266, {2}), "0.266");
  EXPECT_EQ(dimension_text(0.0123456, {2}), "0.0123");
  EXPECT_EQ(dimension_text(0, {2}), "0");
  // Two equal sides must not become 1.87 and 1.88.
  EXPECT_EQ(dimension_text(1.8749999, {2}), "1.875");
  EXPECT_EQ(dimension_text(1.8750001, {2}), "1.875");
  EXPECT_EQ(dimension_text(1234.5678, {0}), "1235");
  EXPECT_EQ(dimension_text(0.9996, {2}), "1");
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
  EXPECT_EQ(dimension_text(1e15, style), dimension_text(1e15, {3}));
}

TEST_F(DimensionsTest, NumbersAreInTheUnitOfTheDrawing) {
  Mesh mesh;
  add_box(mesh, {25.4f, 50.8f, 2.54f});
  scene_ = scene_of(mesh);
  draw({NamedView::front});
  PageGroup expected;
  for (const char* const number : {"1", "2"}) add_text(expected, number, {0, 0});
  const Dimensions all = dimensioned({.numbers_per_unit = 1 / 25.4, .number_style = {3}});
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

TEST_F(DimensionsTest, OfTextKnowWhatTheyMeasure) {
  Mesh mesh;
  add_rounded_slab(mesh, {100, 60}, 7);
  add_peg(mesh, {20, 25, 10}, 6, 8);
  add_peg(mesh, {80, 25, 10}, 6, 8);
  scene_ = scene_of(mesh);
  draw({NamedView::front, NamedView::top});
  const DimensionOptions options{.level = Dimensioning::all, .numbers_per_unit = 2};
  DimensionOptions of_text = options;
  of_text.lettering = Lettering::text;
  const Dimensions all = dimensioned(of_text), drawn = dimensioned(options);
  ASSERT_EQ(all.count, 3u + 1u + 4u + 1u) << "sizes, diameters, positions, radii";
  EXPECT_EQ(drawn.count, all.count);
  ASSERT_EQ(all.layer.groups.size(), 1u);
  const PageGroup& group = all.layer.groups[0];
  EXPECT_EQ(group.paths.size(), drawn.layer.groups.at(0).paths.size()) << "the same lines";
  EXPECT_TRUE(drawn.layer.groups[0].dimensions.empty() && drawn.layer.groups[0].texts.empty());
  ASSERT_EQ(group.dimensions.size(), all.count);
  std::map<DimensionKind, std::vector<std::string>> texts;
  std::vector<int> uses(group.paths.size());
  for (const PageDimension& dimension : group.dimensions) {
    const std::string& text = group.texts.at(dimension.text).text;
    texts[dimension.kind].push_back(text);
    const glm::dvec2 way = dimension.to - dimension.from;
    const bool is_round = dimension.kind == DimensionKind::diameter || dimension.kind == DimensionKind::radius;
    const glm::dvec2 along(std::cos(dimension.angle), -std::sin(dimension.angle));
    const double length = is_round ? glm::length(way) : std::abs(glm::dot(way, along));
    const std::string digits = text.substr(text.find_last_not_of("0123456789.") + 1);
    EXPECT_NEAR(length * dimension.factor, std::stod(digits), 0.01) << text;
    for (std::size_t i = 0; i < dimension.path_count; ++i) ++uses.at(dimension.first_path + i);
  }
  EXPECT_THAT(texts[DimensionKind::linear], testing::UnorderedElementsAre("200", "120", "36"));
  EXPECT_THAT(texts[DimensionKind::position], testing::UnorderedElementsAre("40", "160", "50", "16"));
  EXPECT_THAT(texts[DimensionKind::diameter], ElementsAre("2\u00d7\u230024"));
  EXPECT_THAT(texts[DimensionKind::radius], ElementsAre("4\u00d7R14"));
  // Three rows of positions share a line, an origin and its extension line each.
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 9);
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), std::ptrdiff_t(uses.size()) - 9);
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
  const Dimensions all = dimensioned();
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
  for (const Dimensioning level : {Dimensioning::diameters, Dimensioning::holes, Dimensioning::all}) {
    const Dimensions all = dimensioned({.level = level});
    EXPECT_GE(all.count, level == Dimensioning::diameters ? 10u : 20u);
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

/// Points around an axis along z at equal angles: on a circle, a square or a hexagon with this radius of its inscribed
/// circle.
struct Ring {
  double radius, z;
  int corners = 0;  ///< 0: a circle; 4 or 6
};

/// A surface through rings from first to last, about (x, y, 0). It is closed if it begins and ends with rings of radius
/// 0. The outside is on the left of the way from ring to ring, with the axis on the left of the page.
void add_rings(
    Mesh& mesh, const glm::dvec2& axis, const std::vector<Ring>& rings, int sides = 48,
    const std::function<bool(int)>& is_wanted = [](int) { return true; }) {
  const auto at = [&](const Ring& ring, int k) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides;
    double radius = ring.radius;
    if (ring.corners > 0) {
      const double sector = 2 * std::numbers::pi / ring.corners;
      radius /= std::cos(std::remainder(angle, sector));
    }
    return glm::vec3(axis.x + radius * std::cos(angle), axis.y + radius * std::sin(angle), ring.z);
  };
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      if (rings[i].corners == 4 && rings[i + 1].corners == 4 && !is_wanted(k)) continue;
      if (rings[i].radius > 0) add_triangle(mesh, at(rings[i], k), at(rings[i], k + 1), at(rings[i + 1], k));
      if (rings[i + 1].radius > 0)
        add_triangle(mesh, at(rings[i], k + 1), at(rings[i + 1], k + 1), at(rings[i + 1], k));
    }
}

/// A plate 20 high and 30 deep, of one square cell for each profile. A profile leads from the upper face into a hole or
/// up a pin, to the axis or to the lower face.
void add_plate(Mesh& mesh, const std::vector<std::vector<Ring>>& profiles) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    std::vector<Ring> rings{{15, 0, 4}, {15, 20, 4}};
    rings.insert(rings.end(), profiles[i].begin(), profiles[i].end());
    if (rings.back().radius > 0) rings.push_back({15, 0, 4});
    const bool is_first = i == 0, is_last = i + 1 == profiles.size();
    // Sides 0 to 5 and 42 to 47 face +x, and 18 to 29 face -x. Neighbours have no wall between them.
    const auto is_wanted = [&](int k) { return k < 6 || k >= 42 ? is_last : k >= 18 && k < 30 ? is_first : true; };
    add_rings(mesh, {15 + 30.0 * double(i), 15}, rings, 48, is_wanted);
    if (rings.back().radius == 0) add_rings(mesh, {15 + 30.0 * double(i), 15}, {{0, 0}, {15, 0, 4}});
  }
}

const std::vector<Ring> blind_hole{{5, 20}, {5, 8}, {0, 8}}, drilled_hole{{5, 20}, {5, 8}, {0, 5}};
const std::vector<Ring> chamfered_hole{{5.5, 20}, {5, 19.5}, {5, 8}, {0, 8}}, shallow_hole{{5, 20}, {5, 14}, {0, 14}};
const std::vector<Ring> through_hole{{5, 20}, {5, 0}}, counterbore{{8, 20}, {8, 15}, {4, 15}, {4, 0}};
const std::vector<Ring> grooved_hole{{7, 20}, {7, 14}, {9, 14}, {9, 11}, {7, 11}, {7, 4}, {0, 4}};
const std::vector<Ring> pin{{6, 20}, {6, 28}, {0, 28}};

// Up is +y, so that the view from the front looks down on the plate.
constexpr NamedView above = NamedView::front, below = NamedView::back, beside = NamedView::bottom;

TEST_F(DimensionsTest, BlindHolesHaveDepths) {
  Mesh mesh;
  add_plate(mesh, {blind_hole, drilled_hole, chamfered_hole, shallow_hole, through_hole, counterbore, pin});
  scene_ = scene_of(mesh);
  draw({beside, above});
  std::vector<std::string> expected = {
      "210",     "28",      "30", "20", "15", "45", "75", "105", "135", "165", "195", "15", "\u230016\u21a75",
      "\u23008", "\u230012"};
  for (const char* const bore : {"3\u00d7\u230010\u21a712", "\u230010\u21a76", "\u230010"}) expected.push_back(bore);
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  expect_texts(all, expected);
  EXPECT_EQ(all.left_out + all.undrawn, 0u);
  // Lower levels have no depths, and unite equal diameters.
  const Dimensions lower = dimensioned({.level = Dimensioning::diameters});
  expect_texts(lower, {"210", "28", "30", "5\u00d7\u230010", "\u230016", "\u23008", "\u230012"});
}

TEST_F(DimensionsTest, DepthsAreThoseOfWalls) {
  Mesh mesh;
  add_plate(mesh, {blind_hole, drilled_hole, chamfered_hole, through_hole, counterbore, grooved_hole, pin});
  scene_ = scene_of(mesh);
  draw({above});
  std::vector<std::pair<double, double>> found;  // radius and depth
  for (const Round& round : rounds_.rounds) {
    EXPECT_TRUE(round.depth == 0 || round.kind == RoundKind::cylinder);
    if (round.depth == 0) continue;
    found.emplace_back(std::round(1000 * round.radius) / 1000, std::round(1000 * round.depth) / 1000);
    EXPECT_LT(round.axis.z, -0.999) << "from the open end to the closed one";
    EXPECT_GT(round.from.z, round.to.z);
  }
  // The groove is closed at both ends by plane faces that lead inwards: it has no depth.
  EXPECT_THAT(found, testing::UnorderedElementsAre(std::pair(5., 12.), std::pair(5., 12.), std::pair(5., 12.),
                                                   std::pair(8., 5.), std::pair(7., 16.)));
}

/// A hole of radius 5 and depth 12 in a plate 20 high, whose rim and floor are rounded with a radius of 1.
std::vector<Ring> rounded_hole(int facets) {
  std::vector<Ring> rings;
  for (const bool is_floor : {false, true})
    for (int i = 0; i <= facets; ++i) {
      const double angle = std::numbers::pi / 2 * i / facets, sine = std::sin(angle), cosine = std::cos(angle);
      rings.push_back(is_floor ? Ring{4 + cosine, 9 - sine} : Ring{6 - sine, 19 + cosine});
    }
  rings.push_back({0, 8});
  return rings;
}

Rounds rounds_of(const Mesh& mesh) {
  const Scene scene = scene_of(mesh);
  return find_rounds(Surfaces(scene));
}

std::vector<double> depths_of(const Rounds& all) {
  std::vector<double> depths;
  for (const Round& round : all.rounds)
    if (round.depth > 0) depths.push_back(std::round(1e4 * round.depth) / 1e4);
  return depths;
}

TEST_F(DimensionsTest, DepthsDoNotDependOnFacets) {
  for (const int facets : {1, 2, 3, 8, 40}) {
    Mesh mesh;
    add_plate(mesh, {rounded_hole(facets)});
    EXPECT_THAT(depths_of(rounds_of(mesh)), ElementsAre(12)) << facets;
  }
  const std::vector<Ring> two_rows{{5.5, 20}, {5.25, 19.75}, {5, 19.5}, {5, 8}, {0, 8}};
  const std::vector<Ring> stepped_drill{{5, 20}, {5, 10}, {3, 8}, {3, 4}, {0, 2}};
  const std::vector<Ring> ball{{5, 20}, {5, 10}, {4, 7}, {3, 6}, {0, 5}};
  const std::vector<Ring> grooved{{5, 20},   {5, 16},   {5.5, 15.5}, {7, 15.5}, {7, 13},
                                  {5.5, 13}, {5, 12.5}, {5, 6},      {0, 6}};
  Mesh mesh;
  add_plate(mesh, {two_rows, stepped_drill, ball, grooved});
  // The narrower bore has its own depth, with the cone that leads to the wider one.
  EXPECT_THAT(depths_of(rounds_of(mesh)), testing::UnorderedElementsAre(12, 10, 6, 10, 14));
}

TEST_F(DimensionsTest, DepthsAreThoseOfOneObject) {
  Mesh block, cover;
  add_plate(block, {blind_hole});
  add_plate(cover, {through_hole});
  scene_ = scene_of(block);
  scene_.meshes.push_back(cover);
  scene_.instances.push_back({"cover", 1, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 21))});
  EXPECT_THAT(depths_of(find_rounds(Surfaces(scene_))), ElementsAre(12));
}

TEST_F(DimensionsTest, HolesWithGroovesAreOneHole) {
  Mesh mesh;
  std::vector<Ring> hole;
  for (const double z : {20.0, 17.0, 14.0}) hole.insert(hole.end(), {{7, z}, {7, z - 2}, {8, z - 2}, {8, z - 3}});
  hole.insert(hole.end(), {{7, 11}, {7, 4}, {0, 4}});
  add_plate(mesh, {hole});
  scene_ = scene_of(mesh);
  draw({above});
  expect_texts(dimensioned({.level = Dimensioning::all}), {"30", "30", "15", "15", "\u230014\u21a716"});
}

TEST_F(DimensionsTest, HiddenCirclesHaveNoLeaders) {
  Mesh mesh;
  add_plate(mesh, {blind_hole, through_hole, counterbore, pin});
  scene_ = scene_of(mesh);
  // From below, only the through holes are seen.
  draw({below});
  const Dimensions seen = dimensioned({.level = Dimensioning::all});
  expect_texts(seen, {"120", "30", "45", "75", "15", "\u230010", "\u23008"});
  EXPECT_EQ(seen.undrawn, 3u) << "a blind hole, a counterbore and a pin";
  // Another view shows the others.
  draw({below, above});
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  expect_texts(all, {"120", "30", "45", "75", "15", "\u230010", "\u23008", "15", "75", "105", "15", "\u230010\u21a712",
                     "\u230016\u21a75", "\u230012"});
  EXPECT_EQ(all.undrawn, 0u);
}

TEST_F(DimensionsTest, HolesThatFaceEachOtherDiffer) {
  Mesh mesh;
  // A plate with holes of depth 6 from above and 8 from below.
  add_rings(mesh, {0, 0}, {{15, 0, 4}, {15, 20, 4}, {5, 20}, {5, 14}, {0, 14}});
  add_rings(mesh, {0, 0}, {{0, 8}, {5, 8}, {5, 0}, {15, 0, 4}});
  scene_ = scene_of(mesh);
  draw({above, below});
  expect_texts(dimensioned({.level = Dimensioning::all}),
               {"30", "30", "15", "15", "15", "15", "\u230010\u21a76", "\u230010\u21a78"});
  draw({above});
  EXPECT_EQ(dimensioned({.level = Dimensioning::all}).undrawn, 1u);
}

TEST_F(DimensionsTest, PinsInBlindHolesHaveNoDepths) {
  Mesh mesh;
  add_plate(mesh, {blind_hole, shallow_hole});
  add_rings(mesh, {15, 15}, {{0, 10}, {5, 10}, {5, 28}, {0, 28}});
  scene_ = scene_of(mesh);
  draw({above});
  expect_texts(dimensioned({.level = Dimensioning::all}),
               {"60", "30", "15", "45", "15", "\u230010", "\u230010\u21a76"});
}

/// A solid of the filled cells of a grid.
void add_cells(Mesh& mesh, const std::array<std::vector<double>, 3>& places,
               const std::function<bool(int, int, int)>& is_filled) {
  const auto size = [&](int axis) { return int(places[std::size_t(axis)].size()) - 1; };
  const auto filled = [&](const glm::ivec3& c) {
    for (int axis = 0; axis < 3; ++axis)
      if (c[axis] < 0 || c[axis] >= size(axis)) return false;
    return is_filled(c.x, c.y, c.z);
  };
  const auto at = [&](const glm::ivec3& c) {
    return glm::vec3(places[0][std::size_t(c.x)], places[1][std::size_t(c.y)], places[2][std::size_t(c.z)]);
  };
  for (int x = 0; x < size(0); ++x)
    for (int y = 0; y < size(1); ++y)
      for (int z = 0; z < size(2); ++z)
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            const glm::ivec3 cell(x, y, z);
            glm::ivec3 next = cell, u(0), v(0), corner = cell;
            next[axis] += side == 1 ? 1 : -1;
            if (!filled(cell) || filled(next)) continue;
            corner[axis] += side;
            u[(axis + (side == 1 ? 1 : 2)) % 3] = 1;
            v[(axis + (side == 1 ? 2 : 1)) % 3] = 1;
            add_triangle(mesh, at(corner), at(corner + u), at(corner + u + v));
            add_triangle(mesh, at(corner), at(corner + u + v), at(corner + v));
          }
}

/// Stairs of three steps: 40, 25 and 10 high.
void add_stairs(Mesh& mesh) {
  add_cells(mesh, {{{0, 30, 60, 100}, {0, 50}, {0, 10, 25, 40}}}, [](int x, int, int z) { return x + z < 3; });
}

TEST_F(DimensionsTest, StepsHavePositionsOnce) {
  Mesh mesh;
  add_stairs(mesh);
  scene_ = scene_of(mesh);
  const std::vector<std::string> expected{"100", "40", "50", "30", "60", "10", "25"};
  draw({beside, above});
  expect_texts(dimensioned({.level = Dimensioning::all}), expected);
  // Nothing lies between the edges that the view from above shows and the row below the view.
  const std::vector<glm::dvec2> rooms = position_rooms_of(views(), {.level = Dimensioning::all});
  EXPECT_TRUE(rooms[0].x > 0 && rooms[0].y == 0 && rooms[1].x == 0 && rooms[1].y > 0);
  for (const glm::dvec2& room : position_rooms_of(views(), {.level = Dimensioning::holes}))
    EXPECT_EQ(room, glm::dvec2(0));
  // Long numbers take more room.
  EXPECT_GT(position_rooms_of(views(), {.level = Dimensioning::all, .numbers_per_unit = 1e8})[0].x, rooms[0].x + 5);
  EXPECT_EQ(dimensioned({.level = Dimensioning::holes}).count, 3u);
  draw({beside, above, NamedView::left, NamedView::right, NamedView::top, below});
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  // Nothing lies below the steps in the view from the right, which has the top of the stairs on its left.
  expect_texts(all, {"100", "40", "50", "30", "60", "15", "30"});
  EXPECT_EQ(all.left_out, 0u);
}

TEST(Positions, AtOneDistanceAreOne) {
  std::vector<Position> positions{
      {10, 1, 5, {0}}, {10.03, 3, 7, {1}}, {10.04, 2, 6, {2}}, {20, 0, 4, {3}}, {0.01, 0, 9, {4}}};
  const NumberRoom room{4.5, 2, 8, -100, 100};
  std::sort(positions.begin(), positions.end(),
            [](const Position& a, const Position& b) { return a.length < b.length; });
  do {
    for (const double away : {1.0, -1.0}) {
      std::size_t left_out = 0;
      const std::vector<Position> chosen = chosen_positions(positions, away, room, left_out);
      ASSERT_EQ(chosen.size(), 2u);
      EXPECT_EQ(chosen[0].foot, away > 0 ? 3 : 1) << "nearest to the row";
      EXPECT_EQ(chosen[0].length, 7);
      EXPECT_THAT(chosen[0].planes, testing::UnorderedElementsAre(0, 1, 2));
      EXPECT_THAT(chosen[1].planes, ElementsAre(3));
      EXPECT_EQ(left_out, 0u);
    }
  } while (std::next_permutation(positions.begin(), positions.end(),
                                 [](const Position& a, const Position& b) { return a.length < b.length; }));
}

TEST_F(DimensionsTest, RowsHaveRoomForTheirNumbers) {
  Mesh mesh;
  add_box(mesh, {1000, 20, 10});
  add_peg(mesh, {988 + 63 / 64.0, 10, 10}, 4, 5);
  scene_ = scene_of(mesh);
  draw({above});
  const auto room = [&](const NumberStyle& style, double numbers_per_unit) {
    return position_rooms_of(views(), {Dimensioning::holes, numbers_per_unit, style})[0];
  };
  constexpr double distances = 8.5;  // the overall size and its distances
  EXPECT_GE(room({3, true}, 1).y, text_width("988 63/64", 3.5) + distances);
  EXPECT_GE(room({2}, 1e-6).y, text_width("0.000989", 3.5) + distances);
  EXPECT_GE(room({2}, 1e-7).x, text_width("0.000001", 3.5) + distances);
  EXPECT_LT(room({2}, 1).y, room({3, true}, 1).y);
}

TEST_F(DimensionsTest, HolesAndStepsShareNumbers) {
  Mesh mesh;
  add_stairs(mesh);
  add_peg(mesh, {60, 25, 25}, 4, 15);
  add_peg(mesh, {80, 25, 10}, 4, 30);
  scene_ = scene_of(mesh);
  draw({beside, above});
  expect_texts(dimensioned({.level = Dimensioning::all}),
               {"100", "40", "50", "10", "25", "30", "60", "80", "25", "2\u00d7\u23008"});
}

TEST_F(DimensionsTest, StepsWithoutRoomAreCounted) {
  Mesh mesh;
  // A block with 8 ribs: all or none of 14 equal faces have numbers.
  for (const double pitch : {12.0, 4.0}) {
    mesh = {};
    std::vector<double> places;
    for (int i = 0; i < 16; ++i) places.push_back(pitch * (i / 2) + (i % 2) * pitch / 2);
    add_cells(mesh, {{places, {0, 30}, {0, 10, 30}}}, [](int x, int, int z) { return z == 0 || x % 2 == 0; });
    scene_ = scene_of(mesh);
    draw({above, beside});
    const Dimensions all = dimensioned({.level = Dimensioning::all});
    const bool has_room = pitch > 10;
    EXPECT_EQ(all.count, 3u + 1u + (has_room ? 14u : 0u)) << pitch;
    EXPECT_EQ(all.left_out, has_room ? 0u : 14u) << pitch;
  }
}

TEST_F(DimensionsTest, StepsWithoutRoomMoveToAnotherView) {
  Mesh mesh;
  // Two blocks on a plate, 20 and 21 high: one of them is stated in the view from the right, which shows it, too.
  add_cells(mesh, {{{0, 20, 40, 80}, {0, 20, 40, 50}, {0, 10, 20, 21, 40}}}, [](int x, int y, int z) {
    return z == 0 || (x == 0 && z < 2) || (x == 1 && y == 0) || (x == 2 && y == 1 && z < 3);
  });
  scene_ = scene_of(mesh);
  draw({beside});
  const Dimensions alone = dimensioned({.level = Dimensioning::all});
  expect_texts(alone, {"80", "40", "20", "40", "10", "21"});
  EXPECT_EQ(alone.left_out, 1u);
  draw({beside, NamedView::right});
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  expect_texts(all, {"80", "40", "50", "20", "40", "21", "20", "40", "30", "20"});
  EXPECT_EQ(all.left_out, 0u);
}

TEST_F(DimensionsTest, FacetsAreNoSteps) {
  Mesh slab, peg;
  add_rounded_slab(slab, {100, 60}, 7);
  add_peg(peg, {0, 0, 10}, 8, 8, 40);
  scene_ = scene_of(slab);
  // Facets of the peg are parallel to the faces of the slab.
  scene_.meshes.push_back(peg);
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1), std::numbers::pi / 40 - 0.03, glm::dvec3(0, 0, 1));
  scene_.instances.push_back({"peg", 1, glm::translate(glm::dmat4(1), glm::dvec3(50, 30, 0)) * turned});
  draw({beside, above, NamedView::left});
  expect_texts(dimensioned({.level = Dimensioning::all}),
               {"100", "60", "18", "10", "50", "30", "\u230016", "4\u00d7R7"});
}

TEST_F(DimensionsTest, CloseNumbersMoveAside) {
  Mesh mesh;
  add_cells(mesh, {{{0, 3, 10, 13, 60}, {0, 40}, {0, 10, 20}}}, [](int x, int, int z) { return z == 0 || x % 2 == 0; });
  scene_ = scene_of(mesh);
  draw({above, beside});
  const Dimensions all = dimensioned({.level = Dimensioning::all});
  expect_texts(all, {"60", "40", "20", "3", "10", "13", "10"});
  // Numbers are at least their height and their distance apart.
  std::vector<glm::dvec2> begins;
  const std::vector<std::string> texts = texts_of(all.layer.groups[1], {"60", "40", "20", "3", "10", "13"}, &begins);
  const double bottom = sheets_[0].on_page(bounds_of(drawings_[0], true).high).y;
  std::map<std::string, double> places;
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (begins[i].y > bottom && begins[i].y < bottom + 30) places[texts[i]] = begins[i].x;
  ASSERT_EQ(places.size(), 3u) << "numbers below the first view";
  // The first strokes of these digits begin at about one height.
  EXPECT_GT(places.at("10"), places.at("3") + 4.3);
  EXPECT_GT(places.at("13"), places.at("10") + 4.3);
}

TEST_F(DimensionsTest, HexagonsHaveWidthsAcrossFlats) {
  Mesh mesh;
  add_box(mesh, {100, 60, 10});
  // Heads of bolts with chamfers; the flats of the second one face left and right.
  for (const double x : {30.0, 70.0})
    add_rings(mesh, {x, 30}, {{0, 10}, {6.5, 10, 6}, {6.5, 15.5, 6}, {6.2, 16}, {0, 16}});
  scene_ = scene_of(mesh);
  draw({beside, above, NamedView::left});
  ASSERT_EQ(rounds_.flats.size(), 2u);
  for (const Flats& flats : rounds_.flats) {
    EXPECT_NEAR(flats.width, 13, 1e-4);
    EXPECT_EQ(flats.sides, 6u);
    EXPECT_NEAR(flats.from.y, 30, 1e-4);
    EXPECT_NEAR(glm::distance(flats.from, flats.to), 5.5, 1e-4);
  }
  expect_texts(dimensioned({.level = Dimensioning::all}), {"100", "60", "16", "10", "30", "70", "30", "2\u00d7AF 13"});
  EXPECT_EQ(dimensioned({.level = Dimensioning::holes}).count, 3u + 1u + 3u) << "the chamfers' circles";
}

TEST_F(DimensionsTest, HexagonHolesHavePositions) {
  Mesh mesh;
  add_plate(mesh, {{{6.5, 20, 6}, {6.5, 0, 6}}, {{6.5, 20, 6}, {6.5, 0, 6}}});
  scene_ = scene_of(mesh);
  draw({above});
  expect_texts(dimensioned({.level = Dimensioning::all}), {"60", "30", "15", "45", "15", "2\u00d7AF 13"});
}

TEST_F(DimensionsTest, RoundingSplitsNoWidthsAcrossFlats) {
  Mesh mesh;
  add_plate(mesh, {{{6.4974, 20, 6}, {6.4974, 0, 6}}, {{6.4976, 20, 6}, {6.4976, 0, 6}}});
  scene_ = scene_of(mesh);
  draw({above});
  expect_texts(dimensioned({.level = Dimensioning::all}), {"60", "30", "15", "45", "15", "2\u00d7AF 12.99"});
}

/// A nut without its bore, 13 across flats and 8 high, whose ends have chamfers of 30 degrees in facets of a degree, as
/// in ISO 4032.
Mesh chamfered_nut() {
  constexpr int sides = 360;
  Mesh mesh;
  std::array<std::vector<glm::vec3>, 4> rings;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides, inner = 6.2;
    const double outer = 6.5 / std::cos(std::remainder(angle, std::numbers::pi / 3));
    const double low = (outer - inner) * std::tan(std::numbers::pi / 6);
    const glm::dvec2 out(std::cos(angle), std::sin(angle));
    rings[0].emplace_back(glm::dvec3(inner * out, 0));
    rings[1].emplace_back(glm::dvec3(outer * out, low));
    rings[2].emplace_back(glm::dvec3(outer * out, 8 - low));
    rings[3].emplace_back(glm::dvec3(inner * out, 8));
  }
  for (std::size_t k = 0; k < sides; ++k) {
    const std::size_t next = (k + 1) % sides;
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      add_triangle(mesh, rings[i][k], rings[i][next], rings[i + 1][k]);
      add_triangle(mesh, rings[i][next], rings[i + 1][next], rings[i + 1][k]);
    }
    add_triangle(mesh, rings[0][next], rings[0][k], {0, 0, 0});
    add_triangle(mesh, rings[3][k], rings[3][next], {0, 0, 8});
  }
  return mesh;
}

TEST_F(DimensionsTest, FlatsMayHaveManyNeighboursAndTriangles) {
  const glm::vec2 foot(0);
  Mesh prism;
  add_rings(prism, foot, {{0, 0}, {6.5, 0, 6}, {6.5, 2, 6}, {6.5, 4, 6}, {6.5, 6, 6}, {0, 6}}, 120);
  for (Mesh mesh : {prism, chamfered_nut()}) {
    // Triangles in the middle of a face come first, so those next to another face of the hexagon come last.
    const auto distance = [&](const glm::uvec3& t) {
      return glm::length(glm::vec2((mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f) - foot);
    };
    std::stable_sort(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const glm::uvec3& a, const glm::uvec3& b) { return distance(a) < distance(b); });
    const Rounds all = rounds_of(mesh);
    ASSERT_EQ(all.flats.size(), 1u);
    EXPECT_EQ(all.flats[0].sides, 6u);
    EXPECT_NEAR(all.flats[0].width, 13, 1e-4);
  }
}

TEST_F(DimensionsTest, AWidthAcrossFlatsMayBeAnOverallSize) {
  Mesh mesh;
  add_rings(mesh, {0, 0}, {{0, 0}, {4, 0}, {4, 20}, {6.5, 20, 6}, {6.5, 26, 6}, {0, 26}});
  scene_ = scene_of(mesh);
  draw({beside, below});
  // The hexagon is 13 wide and 15.01 deep.
  expect_texts(dimensioned({.level = Dimensioning::all}), {"AF 13", "26", "20", "15.01", "7.51", "6.5", "\u23008"});
}

TEST_F(DimensionsTest, SquaresAboutAnAxisHaveWidthsAcrossFlats) {
  for (const bool has_peg : {true, false}) {
    Mesh mesh;
    add_box(mesh, {100, 60, 10});
    add_rings(mesh, {40, 30}, {{0, 10}, {10, 10, 4}, {10, 16, 4}, {0, 16}});
    if (has_peg) add_peg(mesh, {40, 30, 16}, 4, 4);
    scene_ = scene_of(mesh);
    draw({beside, above});
    if (has_peg)
      expect_texts(dimensioned({.level = Dimensioning::all}),
                   {"100", "60", "20", "10", "16", "40", "30", "AF 20", "\u23008"});
    else
      expect_texts(dimensioned({.level = Dimensioning::all}), {"100", "60", "16", "10", "30", "50", "20", "40"});
  }
}

TEST_F(DimensionsTest, RingsOfAThreadHaveOneNumber) {
  Mesh mesh;
  add_box(mesh, {40, 40, 10});
  std::vector<Ring> sharp{{0, 10}}, square{{0, 10}};
  for (int i = 0; i < 12; ++i) {
    sharp.insert(sharp.end(), {{4, 10 + 2.0 * i}, {5, 11 + 2.0 * i}});
    square.insert(square.end(), {{4, 10 + 2.0 * i}, {4, 11 + 2.0 * i}, {5, 11 + 2.0 * i}, {5, 12 + 2.0 * i}});
  }
  for (std::vector<Ring>* const rings : {&sharp, &square}) rings->push_back({0, 34});
  sharp.insert(sharp.end() - 1, {4, 34});
  for (const bool is_square : {false, true}) {
    Mesh part = mesh;
    add_rings(part, {20, 20}, is_square ? square : sharp);
    scene_ = scene_of(part);
    draw({beside, above});
    const Dimensions all = dimensioned({.level = Dimensioning::all});
    std::vector<std::string> expected{"40", "34", "40", "10", "20", "20", "12\u00d7\u230010"};
    expected.push_back(is_square ? "12\u00d7\u23008" : "13\u00d7\u23008");
    expect_texts(all, expected);
    EXPECT_EQ(all.left_out, is_square ? 23u : 0u) << "the flanks, which are a millimetre apart";
  }
}

TEST_F(DimensionsTest, ShanksHaveDiametersFromTheSide) {
  Mesh mesh;
  add_rings(mesh, {20, 20}, {{0, 0}, {5, 0}, {5, 24}, {10, 24}, {10, 30}, {0, 30}});
  add_rings(mesh, {60, 20}, {{0, 0}, {5, 0}, {5, 24}, {10, 24}, {10, 30}, {0, 30}});
  scene_ = scene_of(mesh);
  draw({beside, above});
  expect_texts(dimensioned({.level = Dimensioning::all}),
               {"60", "30", "\u230020", "24", "10", "\u230020", "2\u00d7\u230010"});
  EXPECT_EQ(dimensioned({.level = Dimensioning::all}).undrawn, 0u);
  // At lower levels they are counted.
  EXPECT_EQ(dimensioned({.level = Dimensioning::holes}).undrawn, 2u);
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
  EXPECT_THROW(static_cast<void>(dimensioned({.number_style = {-1}})), Error);
  EXPECT_THROW(static_cast<void>(dimensioned({.number_style = {7}})), Error);
  EXPECT_THROW(static_cast<void>(dimensioned({.text_height = 0})), Error);
}

}  // namespace
}  // namespace frontmost::test
