// SPDX-License-Identifier: Apache-2.0
// Intersections of triangles, compared with a test of all pairs.

#include "support/crossings.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <optional>

#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

using Triangle = std::array<glm::dvec3, 3>;

/// Interval along `direction` where the triangle's outline passes through the plane of another; empty if it does not.
std::optional<std::pair<double, double>> chord(const Triangle& t, const Triangle& other, const glm::dvec3& direction) {
  const glm::dvec3 n = glm::cross(other[1] - other[0], other[2] - other[0]);
  std::vector<double> met;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &p = t[k], &q = t[(k + 1) % 3];
    const double a = glm::dot(n, p - other[0]), b = glm::dot(n, q - other[0]);
    if ((a > 0) == (b > 0)) continue;
    met.push_back(glm::dot(direction, p + (q - p) * (a / (a - b))));
  }
  if (met.size() != 2) return std::nullopt;
  return std::minmax(met[0], met[1]);
}

/// Length of the common segment of two triangles, in doubles.
double common_length(const Triangle& a, const Triangle& b) {
  const glm::dvec3 along = glm::cross(glm::cross(a[1] - a[0], a[2] - a[0]), glm::cross(b[1] - b[0], b[2] - b[0]));
  if (glm::length(along) == 0) return 0;
  const glm::dvec3 direction = glm::normalize(along);
  const auto one = chord(a, b, direction), two = chord(b, a, direction);
  if (!one || !two) return 0;
  return std::max(0.0, std::min(one->second, two->second) - std::max(one->first, two->first));
}

Triangle corners(const WeldedMesh& mesh, std::size_t i) {
  const glm::uvec3& t = mesh.triangles[i];
  return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
}

TEST(Crossings, EqualThoseOfAllPairs) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < seeds(20); ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = scene_of(random_mesh(seed % 2 == 0 ? Kind::soup : Kind::slivers, 120, seed));
    const WeldedMesh mesh = weld(Surfaces(scene), {});
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> lengths;
    for (const Crossing& c : crossings_of(mesh, {}, {}))
      lengths[{c.left, c.right}] = glm::length(c.to.place - c.from.place);
    found += lengths.size();
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a)
      for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
        const auto it = lengths.find({a, b});
        ASSERT_NEAR(common_length(corners(mesh, a), corners(mesh, b)), it == lengths.end() ? 0 : it->second, 1e-5)
            << a << " " << b;
      }
  }
  EXPECT_GT(found, 40u);
}

/// A sphere without vertices at special places.
Mesh ball(const glm::vec3& centre, float radius, int rings) {
  Mesh mesh;
  const auto at = [&](int i, int j) {
    const float a = float(std::numbers::pi) * float(i) / float(rings);
    const float b = 2 * float(std::numbers::pi) * float(j % (2 * rings)) / float(2 * rings) + 0.1f;
    const float r = i == 0 || i == rings ? 0 : std::sin(a);
    return centre + radius * glm::vec3(r * std::cos(b), r * std::sin(b), std::cos(a));
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) add_triangle(mesh, at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) add_triangle(mesh, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

TEST(Crossings, OfTwoBallsAreOneClosedLine) {
  Scene scene = scene_of(ball({0, 0, 0}, 1, 24));
  scene.meshes.push_back(ball({0.7f, 0.31f, 0.23f}, 0.8f, 31));
  scene.instances.push_back({"other", 1, glm::dmat4(1.0)});
  for (const int threads : {1, 3}) {
    const std::vector<Crossing> crossings = crossings_of(weld(Surfaces(scene), {}), {}, {.threads = threads});
    std::map<std::array<double, 3>, int> ends;
    for (const Crossing& c : crossings)
      for (const CrossingEnd* end : {&c.from, &c.to}) ++ends[{end->place.x, end->place.y, end->place.z}];
    EXPECT_GT(crossings.size(), 50u);
    EXPECT_EQ(ends.size(), crossings.size());
    for (const auto& [place, count] : ends) EXPECT_EQ(count, 2) << place[0] << " " << place[1] << " " << place[2];
  }
}

TEST(Crossings, NeighboursTouchesAndTwinsGiveNone) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  add_triangle(mesh, {0, 0, 0}, {2, 0, 0}, {0, 2, 1});                  // shares an edge
  add_triangle(mesh, {0, 0, 0}, {-2, 0, 1}, {0, -2, -1});               // shares a vertex, on the other side
  add_triangle(mesh, {0.5f, 0.5f, 0}, {1, 0.5f, 0}, {0.5f, 0.5f, -1});  // stands on it with an edge
  add_triangle(mesh, {3, 3, -1}, {3, 3, 1}, {4, 3, 0});
  const Scene scene = scene_of(mesh);
  EXPECT_TRUE(crossings_of(weld(Surfaces(scene), {}), {}, {}).empty());
}

TEST(Crossings, ATwinAddsNothing) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {3, -1, 0}, {-1, 3, 0});
  add_triangle(mesh, {0, 0, -1}, {0, 0, 1}, {1, 0, 0.5f});
  add_triangle(mesh, {0, 0, -1}, {0, 0, 1}, {1, 0, 0.5f});
  const Scene scene = scene_of(mesh);
  const std::vector<Crossing> crossings = crossings_of(weld(Surfaces(scene), {}), {}, {});
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].from.place, glm::dvec3(0));
  EXPECT_NEAR(crossings[0].to.place.x, 2.0 / 3, 1e-15);
}

TEST(Crossings, FromASharedCornerOn) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  add_triangle(mesh, {0, 0, 0}, {1, 1, 1}, {1, 1, -1});
  const Scene scene = scene_of(mesh);
  const std::vector<Crossing> crossings = crossings_of(weld(Surfaces(scene), {}), {}, {});
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].from.place, glm::dvec3(0));
  EXPECT_EQ(crossings[0].to.place, glm::dvec3(1, 1, 0));
}

/// Relative to the many small triangles, the large one is endless. Boxes that fill up a group of the tree must not
/// touch it.
TEST(Crossings, OfATriangleWithoutEndAndManySmallOnes) {
  for (const int count : {15, 16, 17, 40, 300}) {
    Mesh mesh;
    const float size = 1e-20f, end = 3e38f;
    for (int i = 0; i < count; ++i) {
      const float x = 4 * size * float(i);
      add_triangle(mesh, {x, 0, -size}, {x + size, 0, size}, {x, size, size});
    }
    add_triangle(mesh, {-end, -end, 0}, {end, -end, 0}, {0, end, 0});
    const Scene scene = scene_of(mesh);
    const WeldedMesh welded = weld(Surfaces(scene), {});
    for (const Isa isa : available_isas()) {
      const std::vector<Crossing> crossings = crossings_of(welded, {}, {.threads = 2, .isa = isa});
      ASSERT_EQ(crossings.size(), std::size_t(count)) << name(isa);
      for (const Crossing& c : crossings) {
        EXPECT_EQ(c.right, std::uint32_t(count));
        EXPECT_NEAR(glm::length(c.to.place - c.from.place), size / std::sqrt(2.0), size * 1e-3);  // x is rounded
      }
    }
  }
}

TEST(Crossings, EveryInstructionSetFindsTheSame) {
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    const Scene scene = scene_of(random_mesh(Kind::soup, 700, seed));
    const WeldedMesh mesh = weld(Surfaces(scene), {});
    const std::vector<Crossing> expected = crossings_of(mesh, {}, {});
    for (const Isa isa : available_isas()) {
      const std::vector<Crossing> crossings = crossings_of(mesh, {}, {.threads = 2, .isa = isa});
      ASSERT_EQ(crossings.size(), expected.size()) << name(isa);
      for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(crossings[i].to.place, expected[i].to.place);
    }
  }
}

}  // namespace
}  // namespace frontmost::test
