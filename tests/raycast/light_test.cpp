// SPDX-License-Identifier: Apache-2.0
// Rays to a light: known answers, a comparison with every triangle one by one in fractions, and no self-shadowing.

#include <gmock/gmock.h>

#include <algorithm>

#include "frontmost/raycast.h"
#include "indexed_scene.h"
#include "support/effort.h"
#include "support/odd_numbers.h"
#include "support/random_scene.h"
#include "support/rational_vector.h"

namespace frontmost::test {
namespace {

using Corners = std::array<glm::vec3, 3>;

/// Position of a triangle point in exact fractions; src/methods/raycast computes it in doubles and expansions.
RationalVector position_of(const TrianglePoint& p) {
  RationalVector sum{0, 0, 0};
  for (int i = 0; i < 3; ++i)
    sum = sum + Rational(p.weights[i]) * RationalVector(glm::dvec3(p.corners[std::size_t(i)]));
  const Rational weights = Rational(p.weights.x) + Rational(p.weights.y) + Rational(p.weights.z);
  return Rational(1 / weights) * sum + RationalVector(glm::dvec3(p.lift));
}

bool oracle_stands_before(const Corners& corners, const TrianglePoint& point, const glm::vec3& to_light) {
  const RationalVector p = position_of(point), light{glm::dvec3(to_light)};
  const auto from = [&](int k) { return RationalVector(glm::dvec3(corners[std::size_t(k)])) - p; };
  const RationalVector a = from(0), b = from(1), c = from(2), n = cross(b - a, c - a);
  const Rational along = dot(n, light);
  if (along == 0) return false;
  const Rational t = dot(n, a) / along;
  if (t <= 0) return false;
  // Barycentric weights of the point where the line meets the plane.
  const RationalVector at = t * light;
  const Rational u = dot(n, cross(b - at, c - at)), v = dot(n, cross(c - at, a - at)),
                 w = dot(n, cross(a - at, b - at));
  return u >= 0 && v >= 0 && w >= 0;
}

bool same_corners(const Corners& a, const Corners& b) { return std::is_permutation(a.begin(), a.end(), b.begin()); }

std::uint8_t oracle_is_lit(const Surfaces& surfaces, const TrianglePoint& point, const glm::vec3& to_light) {
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const Corners corners = surfaces.corners(id);
    if (id == point.primitive || same_corners(corners, point.corners)) continue;
    if (oracle_stands_before(corners, point, to_light)) return 0;
  }
  return 1;
}

struct Lit : Indexed {
  using Indexed::Indexed;

  [[nodiscard]] TrianglePoint point(PrimitiveId id, const glm::vec3& weights) const {
    return {id, surfaces.corners(id), weights, glm::vec3(0)};
  }
  [[nodiscard]] std::vector<std::uint8_t> lit(const std::vector<TrianglePoint>& points, const glm::vec3& to_light,
                                              const Execution& execution = {}) const {
    std::vector<std::uint8_t> answers(points.size(), 7);
    are_lit(index, points, to_light, answers, execution);
    return answers;
  }
  [[nodiscard]] bool is_lit(const TrianglePoint& point, const glm::vec3& to_light) const {
    return lit({point}, to_light)[0] == 1;
  }
};

TEST(Light, AFloorAboveIsInTheWayUnlessTheLightComesPastIt) {
  const Lit of(floors({0, 1}));
  const TrianglePoint centre = of.point(0, {1, 0, 1});
  EXPECT_FALSE(of.is_lit(centre, {0, 0, 1}));
  EXPECT_TRUE(of.is_lit(centre, {0, 0, -1}));
  // From the middle, a slope of 1 hits the edge of the floor above exactly: edges count.
  EXPECT_FALSE(of.is_lit(centre, {1, 0, 1}));
  EXPECT_TRUE(of.is_lit(centre, {std::nextafter(1.0f, 2.0f), 0, 1}));
  EXPECT_TRUE(of.is_lit(centre, {1, 0, 0}));
  EXPECT_TRUE(of.is_lit(of.point(2, {1, 1, 1}), {0, 0, 1}));
}

TEST(Light, ALiftedPointIsWhereItSaysExactly) {
  const Lit of(floors({0, 1}));
  TrianglePoint point = of.point(0, {1, 2, 3});
  for (const float height : {0.5f, std::nextafter(1.0f, 0.0f)}) {
    point.lift = {0, 0, height};
    EXPECT_FALSE(of.is_lit(point, {0, 0, 1})) << height;
  }
  for (const float height : {1.0f, 1.5f}) {  // on the floor above, and over it
    point.lift = {0, 0, height};
    EXPECT_TRUE(of.is_lit(point, {0, 0, 1})) << height;
  }
  // The point is below its own triangle, which never shades it; the other half of the floor would.
  point.lift = {0, 0, -0.5f};
  EXPECT_TRUE(of.is_lit(point, {0, 0, -1}));
  const Lit one(floors({0}));
  point.lift = {-1, 1, -0.5f};
  EXPECT_FALSE(one.is_lit(point, {0, 0, 1}));
}

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1, i >> 1 & 1, i >> 2});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(Light, NothingShadowsItselfAlongEdgesAndCorners) {
  // A cube: every point of the faces towards the light is lit, on edges and at vertices too.
  Scene scene = scene_of(cube());
  scene.instances[0].world_from_mesh =
      glm::dmat4({0.36, 0.48, -0.8, 0}, {-0.8, 0.6, 0, 0}, {0.48, 0.64, 0.6, 0}, {0.1, 0.2, 0.3, 1});
  const Lit of(std::move(scene));
  Random random(5);
  for (int light = 0; light < 200; ++light) {
    const glm::vec3 to_light = random.point(1);
    std::vector<TrianglePoint> points;
    std::vector<std::uint8_t> expected;
    for (PrimitiveId id = 0; id < of.surfaces.primitive_count(); ++id) {
      const Corners c = of.surfaces.corners(id);
      const glm::dvec3 normal = glm::cross(glm::dvec3(c[1] - c[0]), glm::dvec3(c[2] - c[0]));
      const double facing = glm::dot(normal, glm::dvec3(to_light));
      if (std::abs(facing) < 1e-4) continue;
      for (int k = 0; k < 8; ++k) {
        // Points of faces away from the light are shaded by the far side, unless they lie on an edge that the light
        // reaches.
        const float least = facing > 0 ? 0.0f : 0.1f;
        const float a = least + float(random.below(3)), b = least + float(random.below(3)), d = 0.1f + random.unit();
        points.push_back(of.point(id, {a, b, d}));
        expected.push_back(facing > 0);
      }
    }
    ASSERT_EQ(of.lit(points, to_light), expected) << light;
  }
}

/// Points of every kind: inside, on edges, at vertices, lifted much or by almost nothing.
std::vector<TrianglePoint> random_points(const Surfaces& surfaces, int count, Random& random) {
  std::vector<TrianglePoint> points;
  for (int i = 0; i < count; ++i) {
    TrianglePoint p;
    const auto id = PrimitiveId(random.below(int(surfaces.primitive_count())));
    p.corners = surfaces.corners(id);
    if (random.below(4) != 0) p.primitive = id;
    const auto weight = [&] { return random.below(3) == 0 ? float(random.below(2)) : random.unit(); };
    const float a = weight(), b = weight();
    p.weights = {a, b, random.unit() + 0.01f};
    if (random.below(4) == 0) p.lift = random.point(random.below(2) ? 0.1f : 1e-9f);
    points.push_back(p);
  }
  return points;
}

TEST(Light, EqualsEveryTriangleInFractions) {
  std::size_t lit = 0, asked = 0;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < 1; ++seed) {
      const Lit of(scene_of(random_mesh(kind, 14, seed)));
      Random random(seed + 99);
      const std::vector<TrianglePoint> points = random_points(of.surfaces, tries_little ? 20 : 70, random);
      const glm::vec3 slanted = random.point(1);
      for (const glm::vec3& to_light : {slanted, glm::vec3(0, 0, 1), glm::vec3(-1, 0, 0)}) {
        const std::vector<std::uint8_t> answers = of.lit(points, to_light);
        for (std::size_t i = 0; i < points.size(); ++i)
          ASSERT_EQ(answers[i], oracle_is_lit(of.surfaces, points[i], to_light))
              << "kind " << int(kind) << ", seed " << seed << ", point " << i;
        lit += std::size_t(std::count(answers.begin(), answers.end(), 1));
        asked += answers.size();
      }
    }
  EXPECT_GT(lit, asked / 10);
  EXPECT_LT(lit, asked * 9 / 10);
}

TEST(Light, TheSameForEveryInstructionSetOrderAndNumberOfThreads) {
  for (const Kind kind : {Kind::soup, Kind::shared_grid, Kind::coplanar, Kind::sheets}) {
    const Lit of(scene_of(random_mesh(kind, 300, 3)));
    Random random(8);
    std::vector<TrianglePoint> points = random_points(of.surfaces, 200, random);
    const glm::vec3 to_light(0.3f, -0.2f, 0.9f);
    const std::vector<std::uint8_t> first = of.lit(points, to_light);
    for (const Isa isa : {Isa::scalar, Isa::best})
      EXPECT_EQ(of.lit(points, to_light, {.threads = 3, .isa = isa}), first);
    std::reverse(points.begin(), points.end());
    std::vector<std::uint8_t> reversed = of.lit(points, to_light);
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_EQ(reversed, first);
  }
}

TEST(Light, ScalingByPowersOfTwoChangesNothing) {
  Mesh mesh = random_mesh(Kind::soup, 300, 1);
  std::vector<std::uint8_t> first;
  for (const int exponent : {0, 90, -90}) {
    Mesh scaled = mesh;
    for (glm::vec3& p : scaled.positions)
      p = glm::vec3(std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent));
    const Lit of(scene_of(scaled));
    Random random(8);
    std::vector<TrianglePoint> points;
    for (PrimitiveId id = 0; id < of.surfaces.primitive_count(); ++id) {
      const float a = random.unit(), b = random.unit();
      points.push_back(of.point(id, {a, b, 0.5f}));
    }
    const std::vector<std::uint8_t> answers = of.lit(points, {0.3f, 0.5f, -0.4f});
    if (first.empty()) first = answers;
    EXPECT_EQ(answers, first) << exponent;
  }
  EXPECT_THAT(first, testing::Contains(1));
  EXPECT_THAT(first, testing::Contains(0));
}

TEST(Light, NonsenseIsLit) {
  const Lit of(floors({0, 1})), empty{Scene{}};
  const TrianglePoint good = of.point(0, {1, 1, 1});
  std::vector<TrianglePoint> points(10, good);
  points[1].weights = glm::vec3(0);
  points[2].weights = {1, -1, 1};
  points[3].weights = {1, kNan, 1};
  points[4].corners[2].y = kNan;
  points[5].corners[0].x = -kFloatInfinity;
  points[6].lift = {kFloatInfinity, 0, 0};
  points[7].weights = {kFloatInfinity, 1, 1};
  const std::vector<std::uint8_t> expected{0, 1, 1, 1, 1, 1, 1, 1, 0, 0};
  EXPECT_EQ(of.lit(points, {0, 0, 1}), expected);
  for (const glm::vec3& no_light : {glm::vec3(0), glm::vec3(kNan, 0, 1), glm::vec3(0, kFloatInfinity, 0)})
    EXPECT_TRUE(of.is_lit(good, no_light));
  EXPECT_TRUE(empty.is_lit(good, {0, 0, 1}));
  EXPECT_TRUE(of.lit({}, {0, 0, 1}).empty());
  std::vector<std::uint8_t> few(3);
  EXPECT_THROW(are_lit(of.index, points, {0, 0, 1}, few), Error);
}

TEST(Light, HugeTinyAndEmptyTrianglesAreNoTrouble) {
  constexpr float huge = 3e38f;
  Mesh mesh;
  add_triangle(mesh, {-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0});
  add_triangle(mesh, {-1, -1, 1}, {1, -1, 1}, {0, 1, 1});
  add_triangle(mesh, {0, 0, 1e-45f}, {1e-45f, 0, 1e-45f}, {0, 1e-45f, 1e-45f});
  add_triangle(mesh, {0, 0, 2}, {0, 0, 2}, {1, 1, 2});
  add_triangle(mesh, {-huge, -huge, huge}, {huge, -huge, huge}, {0, huge, huge});
  const Lit of(scene_of(mesh));
  std::vector<TrianglePoint> points;
  for (PrimitiveId id = 0; id < 5; ++id)
    for (const glm::vec3& weights : {glm::vec3(1, 1, 1), glm::vec3(1, 0, 0), glm::vec3(1e-20f, 1, 1e20f)})
      points.push_back(of.point(id, weights));
  for (const glm::vec3& to_light : {glm::vec3(0, 0, 1), glm::vec3(1e-40f, 0, 1e-40f), glm::vec3(huge, 1, -huge)}) {
    const std::vector<std::uint8_t> answers = of.lit(points, to_light);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(answers[i], oracle_is_lit(of.surfaces, points[i], to_light)) << i << " " << to_light.z;
  }
}

// Instances near the largest float: an overflow must not depend on how a processor compares NaN with a number.
TEST(Light, InstancesNearTheEndOfFloatsThrowTheSameShadowsOnEveryInstructionSet) {
  Scene scene;
  Mesh receiver;
  receiver.positions = {{-1e30f, 0, -1e30f}, {1e30f, 0, -1e30f}, {0, 0, 1e30f}};
  receiver.triangles = {{0, 1, 2}};
  add(scene, receiver);
  Mesh caster;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const float along = 1e9f + 4.8e5f * float(i), aside = 3.2e9f + 3e6f * (float(i % 200) - 100);
    caster.positions.insert(caster.positions.end(), {{along, -along + 64, aside - 3e8f},
                                                     {along + 3.2e7f, -along - 3.2e7f + 64, aside},
                                                     {along, -along + 64, aside + 3e8f}});
    caster.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  glm::dmat4 placed(0.0);
  placed[0] = {0, 1e30, 1e22, 0}, placed[1] = {0, 1e30, 0, 0}, placed[2] = {1e22, 0, 0, 0};
  placed[3] = {0, 0, -1.05e31, 1};
  add(scene, caster, placed);
  add(scene, caster, placed);
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  std::vector<TrianglePoint> points(400);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {.primitive = 0,
                 .corners = surfaces.corners(0),
                 .weights = glm::vec3(float(i % 20), float(i / 20), 7.5f) / 30.0f};
  std::vector<std::uint8_t> expected;
  for (const Isa isa : available_isas()) {
    std::vector<std::uint8_t> lit(points.size());
    are_lit(index, points, {0.5f, 1, 0}, lit, {.isa = isa});
    if (expected.empty()) expected = lit;
    EXPECT_EQ(lit, expected) << name(isa);
  }
}

}  // namespace
}  // namespace frontmost::test
