// SPDX-License-Identifier: Apache-2.0
#include "io/models/polygons/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/orientation.h"
#include "frontmost/io.h"
#include "support/models.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

using Polygon = std::vector<glm::vec3>;

double area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a))) / 2;
}

/// Signed area of a polygon in the xy plane.
double signed_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
    sum += a.x * b.y - b.x * a.y;
  }
  return sum / 2;
}

struct Result {
  std::vector<glm::uvec3> triangles;
  std::size_t flat = 0;  ///< of zero area
};

/// Checks what holds for every simple polygon in the xy plane: n - 2 triangles, every corner used, all turned like
/// the polygon, so that their areas add up without overlap.
Result check(const Polygon& polygon) {
  Triangulator triangulate;
  const auto span = triangulate(polygon);
  Result result{{span.begin(), span.end()}, 0};
  EXPECT_EQ(result.triangles.size(), polygon.size() - 2);
  const int side = signed_area(polygon) > 0 ? 1 : -1;
  double sum = 0;
  std::vector<int> uses(polygon.size(), 0);
  for (const glm::uvec3& t : result.triangles) {
    const glm::vec3 a = polygon[t.x], b = polygon[t.y], c = polygon[t.z];
    const int turn = orientation(a, b, c);
    EXPECT_TRUE(turn == side || turn == 0) << t.x << " " << t.y << " " << t.z;
    result.flat += turn == 0;
    sum += area(a, b, c);
    for (int k = 0; k < 3; ++k) ++uses[t[k]];
  }
  for (const int use : uses) EXPECT_GT(use, 0);
  EXPECT_NEAR(sum, std::abs(signed_area(polygon)), 1e-6 * sum);
  return result;
}

Polygon reversed(Polygon polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

TEST(Triangulate, ConvexPolygonsAreFans) {
  Polygon polygon;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * std::numbers::pi * i / 12;
    polygon.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  for (const Polygon& p : {polygon, reversed(polygon)}) {
    const Result result = check(p);
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(result.triangles[i], glm::uvec3(0, i + 1, i + 2));
  }
}

TEST(Triangulate, ConcaveQuadsAreCutAtTheirReflexCorner) {
  // An arrow head; the reflex corner is tried in all four places.
  const Polygon arrow{{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Polygon polygon = arrow;
    std::rotate(polygon.begin(), polygon.begin() + std::ptrdiff_t(turn), polygon.end());
    EXPECT_EQ(check(polygon).flat, 0u);
    EXPECT_EQ(check(reversed(polygon)).flat, 0u);
  }
}

TEST(Triangulate, CornersOnALineNeedNoFlatTriangles) {
  // A square with a corner in the middle of each side, and a triangle with many corners on one side.
  EXPECT_EQ(check({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}}).flat, 0u);
  Polygon comb{{0, 5, 0}};
  for (int i = 0; i < 20; ++i) comb.emplace_back(i, 0, 0);
  EXPECT_EQ(check(comb).flat, 0u);
}

TEST(Triangulate, EveryPlaneAndDirection) {
  // An L in many planes: areas agree, and normals point the polygon's way.
  const std::vector<glm::dvec2> shape{{0, 0}, {2, 0}, {2, 0.5}, {0.5, 0.5}, {0.5, 2}, {0, 2}};
  std::mt19937 random(test::noted_seed(4));
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 u(normal(random), normal(random), normal(random)),
        v(normal(random), normal(random), normal(random));
    const glm::dvec3 up = glm::cross(u, v), origin(normal(random), normal(random), normal(random));
    Polygon polygon;
    for (const glm::dvec2& p : shape) polygon.emplace_back(origin + u * p.x + v * p.y);
    Triangulator triangulate;
    double sum = 0;
    for (const glm::uvec3& t : triangulate(polygon)) {
      const glm::dvec3 a(polygon[t.x]), b(polygon[t.y]), c(polygon[t.z]);
      EXPECT_GT(glm::dot(glm::cross(b - a, c - a), up), 0);
      sum += area(a, b, c);
    }
    EXPECT_NEAR(sum, 1.75 * glm::length(up), 1e-4 * glm::length(up));
  }
}

TEST(Triangulate, HolesJoinedByDoubledEdges) {
  // A square with a square hole, as exporters without holes write it.
  check({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}});
}

TEST(Triangulate, RandomStarsAndSpirals) {
  std::mt19937 random(test::noted_seed(5));
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (int i = 0; i < 300; ++i) {
    const int count = 4 + int(random() % 60);
    Polygon star;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * k / count, r = radius(random);
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    check(star);
    check(reversed(star));
  }
  Polygon spiral;
  for (int k = 0; k <= 200; ++k) spiral.emplace_back((1 + k) * std::cos(k * 0.1), (1 + k) * std::sin(k * 0.1), 0);
  for (int k = 200; k >= 0; --k) spiral.emplace_back((4 + k) * std::cos(k * 0.1), (4 + k) * std::sin(k * 0.1), 0);
  check(spiral);
}

// Staircases and combs on a coarse grid: many corners on one line, many touching.
TEST(Triangulate, RandomRectilinearSkylines) {
  std::mt19937 random(test::noted_seed(6));
  for (int i = 0; i < 300; ++i) {
    Polygon skyline{{0, -1, 0}};
    const int count = 3 + int(random() % 20);
    for (int k = 0; k < count; ++k) {
      const float height = float(random() % 4);
      skyline.insert(skyline.begin(), glm::vec3(k, height, 0));
      skyline.insert(skyline.begin(), glm::vec3(k + 1, height, 0));
    }
    skyline.insert(skyline.begin(), glm::vec3(count, -1, 0));
    Triangulator triangulate;
    double sum = 0;
    for (const glm::uvec3& t : triangulate(skyline)) {
      EXPECT_GE(orientation(skyline[t.x], skyline[t.y], skyline[t.z]), 0);
      sum += area(skyline[t.x], skyline[t.y], skyline[t.z]);
    }
    EXPECT_NEAR(sum, signed_area(skyline), 1e-6);
  }
}

TEST(Triangulate, DegenerateAndCrossingPolygonsKeepTheirCount) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Polygon polygons[] = {
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
      {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {1, 1, 1}},
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},  // a bow tie
      {{nan, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, inf, 0}},
      {{1, 0, 0}, {-0.8f, 0.6f, 0}, {0.3f, -0.95f, 0}, {0.3f, 0.95f, 0}, {-0.8f, -0.6f, 0}},  // a pentagram
      {{3e38f, 3e38f, 0}, {-3e38f, 3e38f, 0}, {-3e38f, -3e38f, 0}, {0, 0, 0}, {3e38f, -3e38f, 0}},
      {{1e-44f, 0, 0}, {0, 1e-44f, 0}, {-1e-44f, 0, 0}, {0, 1e-45f, 0}}};
  for (const Polygon& polygon : polygons) {
    Triangulator triangulate;
    const auto triangles = triangulate(polygon);
    EXPECT_EQ(triangles.size(), polygon.size() - 2);
    for (const glm::uvec3& t : triangles)
      for (int k = 0; k < 3; ++k) EXPECT_LT(t[k], polygon.size());
  }
}

// A saw around a disc: every other corner is a blocker. Within the budget of work, which once ended at a few ten
// thousand corners, each triangle turns the polygon's way; a fan over what is left would not.
TEST(Triangulate, ManyJaggedCornersAreCutRightly) {
  std::mt19937 random(test::noted_seed(8));
  std::uniform_real_distribution<double> radius(0.8, 1);
  Polygon saw;
  for (int i = 0; i < 200'000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 200'000, r = radius(random);
    saw.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  check(saw);
}

// The budget of work ends what would take hours, and the count still holds.
TEST(Triangulate, HostilePolygonsEndSoon) {
  std::mt19937 random(test::noted_seed(7));
  Polygon tangle;
  for (int i = 0; i < 100'000; ++i) tangle.emplace_back(random() % 1000, random() % 1000, 0);
  Triangulator triangulate;
  EXPECT_EQ(triangulate(tangle).size(), tangle.size() - 2);
}

TEST(Triangulate, TheHandMadePolygonsHaveTheirStatedAreas) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("difficult/handmade/concave-ngons.obj"));
  ASSERT_EQ(scene.meshes.size(), 5u);
  const auto total = [](const Mesh& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      EXPECT_GT(orientation(a, b, c), 0) << mesh.name;
      sum += area(a, b, c);
    }
    return sum;
  };
  EXPECT_NEAR(total(scene.meshes[0]), 1.75, 1e-6);
  EXPECT_NEAR(total(scene.meshes[1]), 1.1168, 1e-4);
  EXPECT_NEAR(total(scene.meshes[2]), 2.08, 1e-6);
  EXPECT_NEAR(total(scene.meshes[4]), 3, 1e-6);
}

}  // namespace
}  // namespace frontmost
