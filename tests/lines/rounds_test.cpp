// SPDX-License-Identifier: Apache-2.0
// Circles and cylinders of known sizes are found in their triangles, and nothing else is. Their centre lines are where
// a drafter draws them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "frontmost/files.h"
#include "frontmost/lines.h"
#include "support/models.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using std::numbers::pi;

/// A tube about z with sides of equal angle; a full tube with `has_lids` has a lid at each end.
struct Tube {
  double radius = 5, low = 0, high = 20;
  int sides = 24;
  double turn = 2 * pi;
  double ratio = 1;  ///< y extent divided by x extent; other than 1, an ellipse
  bool has_lids = true;
  double top_radius = 0;  ///< 0: as at the bottom
};

void add_tube(Mesh& mesh, const Tube& tube, const glm::dmat4& place = glm::dmat4(1), bool is_hollow = false) {
  const auto corner = [&](int k, bool is_high) {
    const double angle = tube.turn * k / tube.sides + 0.1;
    const double radius = is_high && tube.top_radius > 0 ? tube.top_radius : tube.radius;
    const double z = is_high ? tube.high : tube.low;
    const glm::dvec4 at(radius * std::cos(angle), tube.ratio * radius * std::sin(angle), z, 1);
    return glm::vec3(glm::dvec3(place * at));
  };
  const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    is_hollow ? add_triangle(mesh, a, c, b) : add_triangle(mesh, a, b, c);
  };
  const bool is_whole = tube.turn > 6.28;
  const glm::vec3 foot(glm::dvec3(place * glm::dvec4(0, 0, tube.low, 1)));
  const glm::vec3 head(glm::dvec3(place * glm::dvec4(0, 0, tube.high, 1)));
  for (int i = 0; i < tube.sides; ++i) {
    const int k = is_whole ? (i + 1) % tube.sides : i + 1;
    add(corner(i, false), corner(k, false), corner(k, true));
    add(corner(i, false), corner(k, true), corner(i, true));
    if (!is_whole || !tube.has_lids) continue;
    add(corner(k, false), corner(i, false), foot);
    add(corner(i, true), corner(k, true), head);
  }
}

/// A surface of revolution about z through the (radius, z) points, from first to last; back to the first if `closes`.
/// Points on the axis are poles.
void add_revolved(Mesh& mesh, const std::vector<glm::dvec2>& profile, int sides, bool closes,
                  const glm::dmat4& place = glm::dmat4(1), double ratio = 1) {
  const auto corner = [&](std::size_t i, int k) {
    const double angle = 2 * pi * (k % sides) / sides + 0.1;
    const glm::dvec2& p = profile[i % profile.size()];
    return glm::vec3(glm::dvec3(place * glm::dvec4(p.x * std::cos(angle), ratio * p.x * std::sin(angle), p.y, 1)));
  };
  for (std::size_t i = 0; i + (closes ? 0 : 1) < profile.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      if (profile[i].x > 0) add_triangle(mesh, corner(i, k), corner(i, k + 1), corner(i + 1, k + 1));
      if (profile[(i + 1) % profile.size()].x > 0)
        add_triangle(mesh, corner(i, k), corner(i + 1, k + 1), corner(i + 1, k));
    }
}

/// Points on a circle, from one angle to another.
std::vector<glm::dvec2> bow(double middle, double radius, double from, double to, int sides) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= sides; ++i) {
    const double angle = from + (to - from) * i / sides;
    const double x = middle + radius * std::cos(angle);
    points.emplace_back(std::abs(x) < 1e-12 ? 0 : x, radius * std::sin(angle));
  }
  return points;
}

std::vector<glm::dvec2> torus_profile(double middle, double radius, int sides) {
  std::vector<glm::dvec2> points = bow(middle, radius, 0, 2 * pi, sides);
  points.pop_back();
  return points;
}

Rounds rounds_of(const Scene& scene, const Execution& execution = {}) {
  return find_rounds(Surfaces(scene), execution);
}
Rounds rounds_of(const Tube& tube, const glm::dmat4& place = glm::dmat4(1), bool is_hollow = false) {
  Mesh mesh;
  add_tube(mesh, tube, place, is_hollow);
  return rounds_of(scene_of(mesh));
}

std::vector<Round> of_kind(const Rounds& all, RoundKind kind) {
  std::vector<Round> found;
  for (const Round& round : all.rounds)
    if (round.kind == kind) found.push_back(round);
  return found;
}

/// An arbitrary rotation and translation.
glm::dmat4 anywhere() {
  const glm::dvec3 x = glm::normalize(glm::dvec3(3, 1, -2)), z = glm::normalize(glm::cross(x, glm::dvec3(1, 4, 2)));
  return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(40, -25, 13, 1)};
}

TEST(Rounds, ACylinderIsOneWallBetweenTwoCircles) {
  for (const int sides : {18, 24, 60, 500}) {
    const glm::dmat4 place = anywhere();
    const Rounds all = rounds_of({.sides = sides}, place);
    const std::vector<Round> walls = of_kind(all, RoundKind::cylinder), circles = of_kind(all, RoundKind::circle);
    ASSERT_EQ(walls.size(), 1u) << sides;
    ASSERT_EQ(circles.size(), 2u) << sides;
    for (const Round& round : all.rounds) {
      EXPECT_NEAR(round.radius, 5, 2e-5) << sides;
      EXPECT_NEAR(std::abs(glm::dot(round.axis, glm::dvec3(place[2]))), 1, 1e-9) << sides;
      EXPECT_NEAR(round.turn, 2 * pi, 1e-6) << sides;
    }
    const glm::dvec3 foot(place * glm::dvec4(0, 0, 0, 1)), head(place * glm::dvec4(0, 0, 20, 1));
    const Round& wall = walls[0];
    EXPECT_NEAR(std::min(glm::distance(wall.from, foot), glm::distance(wall.to, foot)), 0, 3e-5) << sides;
    EXPECT_NEAR(std::min(glm::distance(wall.from, head), glm::distance(wall.to, head)), 0, 3e-5) << sides;
    EXPECT_FALSE(wall.is_hollow);
    EXPECT_EQ(wall.count, 2u * std::uint32_t(sides));
    EXPECT_EQ(circles[0].count, 2u * std::uint32_t(sides));
  }
}

TEST(Rounds, ABoreIsHollow) {
  const std::vector<Round> walls = of_kind(rounds_of(Tube{}, anywhere(), true), RoundKind::cylinder);
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_TRUE(walls[0].is_hollow);
}

TEST(Rounds, AnOpenTubeHasItsRims) {
  const Rounds all = rounds_of({.has_lids = false});
  EXPECT_EQ(of_kind(all, RoundKind::cylinder).size(), 1u);
  EXPECT_EQ(of_kind(all, RoundKind::circle).size(), 2u);
}

TEST(Rounds, NutsAndPolygonsAreNotRound) {
  for (const int sides : {3, 4, 6, 8, 12, 17}) EXPECT_TRUE(rounds_of({.sides = sides}).rounds.empty()) << sides;
}

TEST(Rounds, CylindersOfFewSidesAreTold) {
  for (const int sides : {7, 8, 12, 17})
    for (const bool is_hollow : {false, true}) {
      const glm::dmat4 place = anywhere();
      const Rounds all = rounds_of({.sides = sides}, place, is_hollow);
      ASSERT_EQ(all.prisms.size(), 1u) << sides;
      const Round& prism = all.prisms[0];
      EXPECT_NEAR(prism.radius, 5, 2e-5);
      EXPECT_NEAR(std::abs(glm::dot(prism.axis, glm::dvec3(place[2]))), 1, 1e-6);
      EXPECT_NEAR(glm::distance(prism.from, prism.to), 20, 1e-4);
    }
  for (const int sides : {4, 5, 6, 18, 60}) EXPECT_TRUE(rounds_of({.sides = sides}).prisms.empty()) << sides;
  for (const Tube& other : {Tube{.sides = 12, .turn = pi}, {.sides = 12, .ratio = 0.9}, {.sides = 12, .top_radius = 4}})
    EXPECT_TRUE(rounds_of(other).prisms.empty());
  Mesh holes;  // side by side, and two on one axis
  for (int i = 0; i < 50; ++i) {
    glm::dmat4 place(1);
    place[3] = {10 * (i % 7), 10 * (i / 7), 0, 1};
    add_tube(holes, {.radius = 2, .sides = 8}, place);
  }
  add_tube(holes, {.radius = 2, .low = 30, .high = 31, .sides = 8});
  EXPECT_EQ(rounds_of(scene_of(holes)).prisms.size(), 51u);
}

TEST(Rounds, EllipsesAreNotRound) {
  for (const double ratio : {0.5, 0.9, 1.03})
    EXPECT_TRUE(rounds_of({.sides = 60, .ratio = ratio}, anywhere()).rounds.empty()) << ratio;
}

TEST(Rounds, AConeHasItsCircles) {
  const Rounds all = rounds_of({.sides = 48, .top_radius = 2}, anywhere());
  const std::vector<Round> circles = of_kind(all, RoundKind::circle);
  ASSERT_EQ(circles.size(), 2u);
  EXPECT_NEAR(circles[0].radius + circles[1].radius, 7, 1e-4);
  EXPECT_TRUE(of_kind(all, RoundKind::cylinder).empty());
}

TEST(Rounds, HalvesCountAndFilletsDoNot) {
  const std::vector<Round> half = of_kind(rounds_of({.sides = 18, .turn = pi}), RoundKind::cylinder);
  ASSERT_EQ(half.size(), 1u);
  EXPECT_NEAR(half[0].turn, pi, 1e-6);
  EXPECT_TRUE(rounds_of({.sides = 18, .turn = pi / 2}).rounds.empty());
}

// A wall of one quad from rim to rim, where every triangle has a neighbour outside the wall.
TEST(Rounds, WallsEndAtFilletsAndSlightChamfers) {
  struct Case {
    double radius, fillet;
    int sides, steps;         // of the fillet; 0: a chamfer of 15 degrees
    double turned_first = 0;  // 0 if the fillet begins along the wall
  };
  for (const Case& c : {Case{8, 1.5, 48, 6}, Case{8, 1.5, 24, 5}, Case{50, 3, 24, 8}, Case{50, 0.5, 24, 10},
                        Case{5, 4, 64, 20}, Case{8, 3, 36, 0}, Case{8, 1.5, 36, 6, 0.5}}) {
    SCOPED_TRACE(testing::Message() << c.radius << ' ' << c.fillet << ' ' << c.sides << ' ' << c.steps);
    std::vector<glm::dvec2> upper{{c.radius, 5}};
    const double first = c.steps > 0 ? c.turned_first * pi / 2 / c.steps : 0;
    for (int i = 1; i <= c.steps; ++i) {
      const double angle = first + (pi / 2 - first) * i / c.steps;
      upper.emplace_back(c.radius + c.fillet * (std::cos(first) - std::cos(angle)), 5 + c.fillet * std::sin(angle));
    }
    if (c.steps == 0) upper.emplace_back(c.radius + c.fillet * std::tan(pi / 12), 5 + c.fillet);
    upper.emplace_back(2 * c.radius, 5 + c.fillet);
    std::vector<glm::dvec2> profile(upper.rbegin(), upper.rend());
    for (const glm::dvec2& p : upper) profile.emplace_back(p.x, -p.y);
    Mesh mesh;
    add_revolved(mesh, profile, c.sides, false, anywhere());
    const std::vector<Round> walls = of_kind(rounds_of(scene_of(mesh)), RoundKind::cylinder);
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_NEAR(walls[0].radius, c.radius, 3e-5);
    EXPECT_NEAR(walls[0].turn, 2 * pi, 1e-6);
  }
}

// A sphere or torus of an odd number of rings has one ring with rims of equal radius.
TEST(Rounds, RingsOfWhatIsBentBothWaysAreNoWalls) {
  for (const int rings : {19, 25, 61}) {
    Mesh sphere, torus;
    add_revolved(sphere, bow(0, 8, -pi / 2, pi / 2, rings), 48, false, anywhere());
    std::vector<glm::dvec2> profile = bow(15, 5, pi / rings, 2 * pi + pi / rings, rings);
    profile.pop_back();
    add_revolved(torus, profile, 48, true, anywhere());
    for (const Mesh* const mesh : {&sphere, &torus})
      EXPECT_TRUE(of_kind(rounds_of(scene_of(*mesh)), RoundKind::cylinder).empty()) << rings;
  }
}

TEST(Rounds, WhatIsRoundAboutAnAxisIsOne) {
  const glm::dmat4 place = anywhere();
  struct Case {
    const char* name;
    std::vector<glm::dvec2> profile;
    bool closes;
    double radius, low, high;
  };
  const Case cases[] = {{"torus", torus_profile(10, 3, 24), true, 13, -3, 3},
                        {"dome", bow(0, 8, 0, pi / 2, 12), false, 8, 0, 8},
                        {"cone", {{6, -1}, {0, 9}}, false, 6, -1, 9},
                        {"frustum", {{6, -1}, {4, 9}}, false, 6, -1, 9},
                        {"bottle", {{5, 0}, {5.2, 3}, {5, 8}, {4.2, 10}, {3, 12}, {2.2, 15}}, false, 5.2, 0, 15}};
  for (const Case& c : cases)
    for (const int sides : {19, 48}) {
      SCOPED_TRACE(testing::Message() << c.name << ", " << sides << " sides");
      Mesh mesh;
      add_revolved(mesh, c.profile, sides, c.closes, place);
      const Rounds all = rounds_of(scene_of(mesh));
      const std::vector<Round> found = of_kind(all, RoundKind::revolved);
      ASSERT_EQ(found.size(), 1u);
      const Round& round = found[0];
      EXPECT_NEAR(round.radius, c.radius, 3e-5);
      EXPECT_EQ(round.count, mesh.triangles.size());
      const glm::dvec3 foot(place * glm::dvec4(0, 0, c.low, 1)), head(place * glm::dvec4(0, 0, c.high, 1));
      EXPECT_NEAR(std::min(glm::distance(round.from, foot), glm::distance(round.to, foot)), 0, 3e-5);
      EXPECT_NEAR(std::min(glm::distance(round.from, head), glm::distance(round.to, head)), 0, 3e-5);
    }
}

TEST(Rounds, WhatIsNotRoundAboutAnAxisIsNone) {
  const auto revolved = [](const std::vector<glm::dvec2>& profile, int sides, double ratio) {
    Mesh mesh;
    add_revolved(mesh, profile, sides, false, anywhere(), ratio);
    return of_kind(rounds_of(scene_of(mesh)), RoundKind::revolved).size();
  };
  const std::vector<glm::dvec2> dome = bow(0, 8, 0, pi / 2, 12);
  EXPECT_EQ(revolved(dome, 48, 1), 1u);
  for (const double ratio : {0.5, 0.9, 1.002}) EXPECT_EQ(revolved(dome, 48, ratio), 0u) << ratio;
  for (const int sides : {6, 12, 17}) EXPECT_EQ(revolved(dome, sides, 1), 0u) << sides;
  EXPECT_EQ(revolved(bow(0, 8, -pi / 2, pi / 2, 24), 48, 1), 0u);  // a sphere is round about any axis
  EXPECT_EQ(revolved({{5, 0}, {5, 9}}, 48, 1), 0u);                // a cylinder
  EXPECT_EQ(revolved({{5, 0}, {9, 0}}, 48, 1), 0u);                // flat
}

// A slanted plane cuts the sides of a bore between their ends, where its vertices lie within the circle.
TEST(Rounds, WallsMayEndAtASlantedCut) {
  constexpr int sides = 36;
  for (const double slope : {0.2, 1.0}) {
    Mesh mesh;
    const auto at = [&](double turn, double radius, double z) {
      return glm::vec3(float(radius * std::cos(turn)), float(radius * std::sin(turn)), float(z));
    };
    const auto cut = [&](double turn, double radius) { return at(turn, radius, slope * radius * std::cos(turn)); };
    for (int k = 0; k < sides; ++k) {
      const double a = 2 * pi * k / sides, b = 2 * pi * (k + 1) / sides;
      // A point of the edge from a to b, a third of the way from its middle to its end.
      const glm::dvec2 place =
          (glm::dvec2(std::cos(a), std::sin(a)) * 1.0 + glm::dvec2(std::cos(b), std::sin(b)) * 2.0) / 3.0;
      const double turn = std::atan2(place.y, place.x), radius = 5 * glm::length(place);
      add_triangle(mesh, at(a, 5, 20), cut(a, 5), cut(turn, radius));
      add_triangle(mesh, at(a, 5, 20), cut(turn, radius), at(b, 5, 20));
      add_triangle(mesh, at(b, 5, 20), cut(turn, radius), cut(b, 5));
      add_triangle(mesh, at(a, 5, 20), at(b, 5, 20), at(0, 0, 20));
    }
    const std::vector<Round> walls = of_kind(rounds_of(scene_of(mesh)), RoundKind::cylinder);
    ASSERT_EQ(walls.size(), 1u) << slope;
    EXPECT_NEAR(walls[0].radius, 5, 1e-5) << slope;
    EXPECT_NEAR(walls[0].turn, 2 * pi, 1e-6) << slope;
    EXPECT_EQ(walls[0].count, 3u * sides) << slope;
  }
}

TEST(Rounds, SpheresAndKnotsHaveNone) {
  for (const char* const name : {"spheres", "gallery"}) {
    const Rounds all = rounds_of(builtin(name));
    for (const Round& round : of_kind(all, RoundKind::cylinder)) EXPECT_GT(round.turn, 6.28) << name;
  }
  EXPECT_TRUE(rounds_of(builtin("cubes")).rounds.empty());
}

/// Random triangles are not round, and nothing crashes.
TEST(Rounds, RandomTrianglesHaveNone) {
  for (const Kind kind : all_kinds)
    for (const std::uint64_t seed : {1u, 2u, 3u})
      EXPECT_TRUE(of_kind(rounds_of(scene_of(random_mesh(kind, 300, seed))), RoundKind::cylinder).empty()) << int(kind);
}

TEST(Rounds, AreTheSameForAllThreads) {
  Mesh mesh;
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    glm::dmat4 place = anywhere();
    place[3] += glm::dvec4(glm::dvec3(random.point(500)), 0);
    add_tube(mesh, {.radius = 1.0 + i % 7, .sides = 18 + i}, place, i % 2 == 0);
  }
  const Scene scene = scene_of(mesh);
  const Rounds one = rounds_of(scene, {.threads = 1}), four = rounds_of(scene, {.threads = 4});
  EXPECT_EQ(of_kind(one, RoundKind::cylinder).size(), 200u);
  EXPECT_EQ(of_kind(one, RoundKind::circle).size(), 400u);
  ASSERT_EQ(one.rounds.size(), four.rounds.size());
  for (std::size_t i = 0; i < one.rounds.size(); ++i) {
    EXPECT_EQ(one.rounds[i].from, four.rounds[i].from);
    EXPECT_EQ(one.rounds[i].axis, four.rounds[i].axis);
    EXPECT_EQ(one.rounds[i].radius, four.rounds[i].radius);
  }
  EXPECT_EQ(one.triangles, four.triangles);
}

std::size_t count_of(const Rounds& all, RoundKind kind, double radius) {
  const std::vector<Round> found = of_kind(all, kind);
  return std::size_t(std::count_if(found.begin(), found.end(),
                                   [&](const Round& r) { return std::abs(r.radius - radius) < 1e-4 * radius; }));
}

TEST(Rounds, OfPartsAreKnown) {
  FRONTMOST_NEEDS_MODELS();
  const Rounds as1 = rounds_of(load(model("cad/as1.stl")));
  // Cylinders of radius 5: the rod, six bolts and their bores in nuts, brackets and plate, and the rod's bores in two
  // nuts and two brackets.
  EXPECT_EQ(count_of(as1, RoundKind::cylinder, 5), 1u + 6 + 3 * 6 + 2 * 2);
  EXPECT_EQ(count_of(as1, RoundKind::cylinder, 7.5), 6u);  // heads
  EXPECT_EQ(of_kind(as1, RoundKind::cylinder).size(), 29u + 6);
  const Rounds crank = rounds_of(load(model("cad/crank-arm.stl")));
  for (const double radius : {6.0, 10.2, 11.0}) EXPECT_EQ(count_of(crank, RoundKind::cylinder, radius), 1u) << radius;
  const Rounds tubes = rounds_of(load(model("cad/two-cylinders.stl")));
  EXPECT_EQ(count_of(tubes, RoundKind::cylinder, 10), 1u);
  EXPECT_EQ(count_of(tubes, RoundKind::cylinder, 8), 1u);
  // Three bores and two counterbores; the largest bore ends at a slanted face.
  const Rounds angle = rounds_of(load(model("cad/angle-block.stl")));
  for (const double radius : {0.133, 0.25, 0.07812})
    EXPECT_EQ(count_of(angle, RoundKind::cylinder, radius), 1u) << radius;
  const Rounds torus = rounds_of(load(model("cad/torus.stl")));
  EXPECT_EQ(of_kind(torus, RoundKind::revolved).size(), 1u);
  const Rounds block = rounds_of(load(model("cad/featuretype.stl")));
  EXPECT_EQ(count_of(block, RoundKind::cylinder, 0.133), 8u);
  // The counterbores; in the file, one of them is in two halves that share no vertices.
  EXPECT_EQ(count_of(block, RoundKind::cylinder, 0.21875), 9u);
}

TEST(Rounds, OfScansAreNone) {
  FRONTMOST_NEEDS_MODELS();
  for (const char* const name : {"organic/stanford-bunny.obj", "organic/armadillo-86k.obj", "cad/fandisk.obj"})
    EXPECT_TRUE(rounds_of(load(model(name))).rounds.empty()) << name;
}

/// A drawing at ten pixels a unit, whose centre lines extend three units beyond.
class CentreLines : public testing::Test {
 protected:
  static constexpr double pixels = 10;

  void draw(NamedView direction, const CentreLineOptions& options = {}) {
    const Scene scene = scene_of(mesh_);
    const Surfaces surfaces(scene);
    FrameOptions frame_options;
    frame_options.direction = direction;
    frame_options.orthographic = true;
    View view = frame(surfaces, 1000, 1000, frame_options);
    view.projection.left = view.projection.bottom = -50;
    view.projection.right = view.projection.top = 50;
    const Drawing drawing = draw_lines(surfaces, view);
    lines_ = centre_lines_of(
        find_rounds(surfaces), drawing,
        chain_strokes(surfaces, drawing, {.by_kind = false, .by_outline = false, .arc_tolerance = 0.1}), options);
  }

  /// Length of the only line in a direction, in units; 0 if there is none.
  [[nodiscard]] double length(bool is_level) const {
    double length = 0;
    for (const CentreLine& line : lines_) {
      const glm::dvec2 along = glm::abs(line.to - line.from) / pixels;
      if ((along.x > along.y) != is_level) continue;
      EXPECT_EQ(length, 0) << "more than one line";
      EXPECT_NEAR(is_level ? along.y : along.x, 0, 1e-6);
      length = is_level ? along.x : along.y;
    }
    return length;
  }

  Mesh mesh_;
  std::vector<CentreLine> lines_;
};

// Without an up axis a mesh is y-up: its tubes, along z, are seen along their axes from the front.
TEST_F(CentreLines, AreACrossOverWhatIsSeenAlongItsAxis) {
  add_tube(mesh_, {});
  draw(NamedView::front);
  ASSERT_EQ(lines_.size(), 2u);
  EXPECT_NEAR(length(true), 2 * (5 + 3), 1e-4);
  EXPECT_NEAR(length(false), 2 * (5 + 3), 1e-4);
}

TEST_F(CentreLines, AreTheAxisOfWhatIsSeenFromTheSide) {
  add_tube(mesh_, {});
  draw(NamedView::top);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(false), 20 + 2 * 3, 1e-4);
  draw(NamedView::left);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(true), 20 + 2 * 3, 1e-4);
}

TEST_F(CentreLines, AreTheAxesOfToriAndDomesFromTheSide) {
  add_revolved(mesh_, torus_profile(15, 4, 32), 64, true);
  draw(NamedView::top);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(false), 2 * 4 + 2 * 3, 1e-3);
  draw(NamedView::left);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(true), 2 * 4 + 2 * 3, 1e-3);
  draw(NamedView::front);
  ASSERT_EQ(lines_.size(), 2u);
  EXPECT_NEAR(length(true), 2 * (19 + 3), 1e-3);
  mesh_ = {};
  add_revolved(mesh_, bow(0, 10, 0, pi / 2, 24), 64, false);
  draw(NamedView::top);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(false), 10 + 2 * 3, 1e-3);
}

TEST_F(CentreLines, OfSmallCirclesReachLessBeyond) {
  add_tube(mesh_, {.radius = 2});
  draw(NamedView::front);
  EXPECT_NEAR(length(true), 2 * (2 + 2), 1e-4);
}

TEST_F(CentreLines, AreOneCrossForAllAboutOneAxis) {
  add_tube(mesh_, {});
  add_tube(mesh_, {.radius = 8, .low = -20, .high = 0, .sides = 50});
  draw(NamedView::front);
  ASSERT_EQ(lines_.size(), 2u);
  EXPECT_NEAR(length(true), 2 * (8 + 3), 1e-4);
  draw(NamedView::top);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NEAR(length(false), 40 + 2 * 3, 1e-4);
}

TEST_F(CentreLines, OfWhatIsHiddenGoWithIt) {
  add_tube(mesh_, {});
  // A plate stands in front of the tube.
  for (const float z : {30.0f}) {
    add_triangle(mesh_, {-20, -20, z}, {20, -20, z}, {20, 20, z});
    add_triangle(mesh_, {-20, -20, z}, {20, 20, z}, {-20, 20, z});
  }
  draw(NamedView::front);
  EXPECT_EQ(lines_.size(), 2u);
  draw(NamedView::front, {.with_hidden = false});
  EXPECT_TRUE(lines_.empty());
  draw(NamedView::back, {.with_hidden = false});
  EXPECT_EQ(lines_.size(), 2u);
}

TEST_F(CentreLines, AreNotDrawnAtAnAngle) {
  add_tube(mesh_, {});
  draw(NamedView::iso);
  EXPECT_TRUE(lines_.empty());
}

TEST_F(CentreLines, RefuseAnOvershootThatIsNone) {
  add_tube(mesh_, {});
  for (const double overshoot : {0.0, -1.0, 1e7, std::nan("")})
    EXPECT_THROW(draw(NamedView::front, {.overshoot = overshoot}), Error) << overshoot;
}

}  // namespace
}  // namespace frontmost::test
