// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "base/orientation.h"
#include "frontmost/files.h"
#include "io/models/mesh_building.h"
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
  std::size_t flat = 0;  ///< triangles of zero area
  double area = 0;
};

/// Checks the result for a simple polygon in the xy plane: n - 2 triangles, every vertex used, all wound like the
/// polygon, so that their areas add up without overlap.
Result check(const Polygon& polygon) {
  Triangulator triangulate;
  const auto span = triangulate(polygon);
  Result result;
  result.triangles.assign(span.begin(), span.end());
  EXPECT_EQ(result.triangles.size(), polygon.size() - 2);
  const int side = signed_area(polygon) > 0 ? 1 : -1;
  double& sum = result.area;
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
  // An arrow head, with the reflex vertex in all four places.
  const Polygon arrow{{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Polygon polygon = arrow;
    std::rotate(polygon.begin(), polygon.begin() + std::ptrdiff_t(turn), polygon.end());
    EXPECT_EQ(check(polygon).flat, 0u);
    EXPECT_EQ(check(reversed(polygon)).flat, 0u);
  }
}

TEST(Triangulate, CornersOnALineNeedNoFlatTriangles) {
  // A square with a vertex in the middle of each side, and a triangle with many vertices on one side.
  EXPECT_EQ(check({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}}).flat, 0u);
  Polygon comb{{0, 5, 0}};
  for (int i = 0; i < 20; ++i) comb.emplace_back(i, 0, 0);
  EXPECT_EQ(check(comb).flat, 0u);
}

TEST(Triangulate, EveryPlaneAndDirection) {
  // An L shape in many planes: areas agree, and normals point the polygon's way.
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

// Staircases and combs on a coarse grid: many vertices are collinear, and many touch.
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

TEST(Triangulate, OutlinesThatTouchThemselves) {
  // Two squares that meet at a vertex, a spike outside and one inside, an outline that passes a vertex twice, a hole
  // that touches the outline, two squares joined by a bent bridge, and a hole with such a bridge.
  EXPECT_EQ(check({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {4, 2, 0}, {4, 4, 0}, {2, 4, 0}, {2, 2, 0}, {0, 2, 0}}).area, 8);
  EXPECT_EQ(check({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 4, 0}, {2, 8, 0}, {2, 4, 0}, {0, 4, 0}}).area, 16);
  EXPECT_EQ(check({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 4, 0}, {2, 1, 0}, {2, 4, 0}, {0, 4, 0}}).area, 16);
  EXPECT_EQ(check({{6, 18, 0}, {6, 14, 0}, {4, 14, 0}, {6, 12, 0}, {6, 14, 0}, {17, 16, 0}}).area, 24);
  EXPECT_EQ(check({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 2, 0}, {2, 1, 0}}).area, 14.5);
  const Polygon squares{{0, 0, 0}, {1, 0, 0}, {2, 2, 0}, {5, 1, 0}, {6, 1, 0}, {6, 2, 0},
                        {5, 2, 0}, {5, 1, 0}, {2, 2, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(check(squares).area, 2);
  EXPECT_EQ(check({{0, 0, 0},
                   {8, 0, 0},
                   {8, 8, 0},
                   {0, 8, 0},
                   {0, 0, 0},
                   {4, 1, 0},
                   {3, 3, 0},
                   {3, 5, 0},
                   {5, 5, 0},
                   {5, 3, 0},
                   {3, 3, 0},
                   {4, 1, 0}})
                .area,
            60);
}

using Loop = std::vector<glm::ivec2>;
constexpr glm::ivec2 steps[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// Boundary of random cells of a grid, with the cells on its left. Where two cells meet only at a corner, the boundary
/// turns left or right, so that loops touch themselves and each other there and never cross.
std::vector<Loop> boundary_of_cells(int size, std::mt19937& random) {
  std::set<std::pair<int, int>> cells;
  for (int i = 0; i < size * size; ++i)
    if (random() % 3 != 0) cells.emplace(i % size, i / size);
  std::multimap<std::pair<int, int>, glm::ivec2> ahead;
  for (const auto& [x, y] : cells) {
    glm::ivec2 corner(x, y);
    for (const glm::ivec2& step : steps) {
      const glm::ivec2 outside = glm::ivec2(x, y) + glm::ivec2(step.y, -step.x);
      if (!cells.contains({outside.x, outside.y})) ahead.emplace(std::pair(corner.x, corner.y), corner + step);
      corner += step;
    }
  }
  std::vector<Loop> loops;
  while (!ahead.empty()) {
    const glm::ivec2 start(ahead.begin()->first.first, ahead.begin()->first.second);
    Loop& loop = loops.emplace_back();
    for (glm::ivec2 at = start; loop.empty() || at != start;) {
      loop.push_back(at);
      auto next = ahead.find({at.x, at.y});
      if (ahead.count({at.x, at.y}) == 2 && random() % 2 == 0) ++next;
      at = next->second;
      ahead.erase(next);
    }
  }
  return loops;
}

/// Adds detours from vertices that the loops pass once, by one step of the grid. A step to such a vertex of another
/// loop makes one loop of both; any other step goes there and back.
void add_bridges_and_spikes(std::vector<Loop>& loops, int count, std::mt19937& random) {
  const auto is_passed_once = [&](const glm::ivec2& corner) {
    std::ptrdiff_t passes = 0;
    for (const Loop& loop : loops) passes += std::count(loop.begin(), loop.end(), corner);
    return passes == 1;
  };
  for (int i = 0; i < count; ++i) {
    Loop& loop = loops[random() % loops.size()];
    const std::size_t place = random() % loop.size();
    const glm::ivec2 from = loop[place], to = from + steps[random() % 4];
    if (!is_passed_once(from)) continue;
    Loop detour{to, from};
    const bool is_bridge = is_passed_once(to);
    for (Loop& other : loops) {
      const auto found = std::find(other.begin(), other.end(), to);
      if (!is_bridge || found == other.end() || &other == &loop) continue;
      std::rotate(other.begin(), found, other.end());
      detour.insert(detour.begin(), other.begin(), other.end());
      other.clear();
    }
    loop.insert(loop.begin() + std::ptrdiff_t(place) + 1, detour.begin(), detour.end());
    std::erase_if(loops, [](const Loop& l) { return l.empty(); });
  }
}

/// The vertices of a loop. With `is_moved`, grid points are moved so little that no edges meet elsewhere. Otherwise
/// some vertices on straight lines are left out, so that edges overlap others. A few vertices occur twice in a row.
Polygon outline_of(const Loop& loop, bool is_moved, std::mt19937& random) {
  std::map<std::pair<int, int>, glm::vec3> places;
  Polygon outline;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::ivec2 &corner = loop[i], &next = loop[(i + 1) % loop.size()];
    if (!is_moved && i > 0 && corner - loop[i - 1] == next - corner && random() % 2 == 0) continue;
    const glm::vec2 by = is_moved ? glm::vec2(random() % 25, random() % 25) / 64.0f : glm::vec2(0);
    const glm::vec3 place =
        places.try_emplace({corner.x, corner.y}, glm::vec3(glm::vec2(corner) + by, 0)).first->second;
    outline.insert(outline.end(), random() % 16 == 0 ? 2 : 1, place);
  }
  return outline;
}

/// Winding number of an outline around a point.
int winding(const Polygon& outline, const glm::dvec2& p) {
  int turns = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = glm::dvec2(outline[i]) - p, b = glm::dvec2(outline[(i + 1) % outline.size()]) - p;
    if ((a.y > 0) == (b.y > 0)) continue;
    turns += a.x * b.y - b.x * a.y > 0 ? b.y > 0 : -int(b.y <= 0);
  }
  return turns;
}

void expect_filled_as_it_winds(const Polygon& outline, int size, std::mt19937& random) {
  const Result result = check(outline);
  std::uniform_real_distribution<double> anywhere(-1, size + 1);
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 p(anywhere(random), anywhere(random));
    int covered = 0;
    for (const glm::uvec3& t : result.triangles) covered += winding({outline[t.x], outline[t.y], outline[t.z]}, p);
    ASSERT_EQ(covered, winding(outline, p)) << p.x << ", " << p.y;
    ASSERT_LE(std::abs(covered), 1);
  }
}

/// The outline is one loop of grid edges that touches itself in all ways but never crosses itself.
template <class Use>
void for_each_touching_outline(int rounds, std::uint64_t seed, Use use) {
  std::mt19937 random(std::uint32_t(test::noted_seed(seed)));
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    const int size = round % 100 == 0 ? 40 : 2 + int(random() % 6);
    std::vector<Loop> loops = boundary_of_cells(size, random);
    if (!loops.empty()) add_bridges_and_spikes(loops, int(random() % unsigned(2 * size * size)), random);
    for (Loop& loop : loops) {
      std::rotate(loop.begin(), loop.begin() + std::ptrdiff_t(random() % loop.size()), loop.end());
      const Polygon outline = outline_of(loop, random() % 2 == 0, random);
      use(random() % 2 == 0 ? outline : reversed(outline), size, random);
    }
  }
}

TEST(Triangulate, RandomOutlinesThatTouchThemselvesAreFilledAsTheyWind) {
  for_each_touching_outline(1000, 9, expect_filled_as_it_winds);
}

// In a tilted plane vertices are rounded, and edges that should touch cross a little.
TEST(Triangulate, TouchingOutlinesInTiltedPlanesKeepTheirArea) {
  const glm::vec3 u(0.3f, -0.1f, 0.7f), v(0.2f, 0.9f, -0.4f), origin(3, 1, 2);
  for_each_touching_outline(300, 10, [&](const Polygon& outline, int, std::mt19937&) {
    if (outline.size() > 500) return;  // too many to try
    Polygon tilted;
    for (const glm::vec3& p : outline) tilted.push_back(origin + u * p.x + v * p.y);
    Triangulator triangulate;
    double sum = 0;
    for (const glm::uvec3& t : triangulate(tilted)) sum += area(tilted[t.x], tilted[t.y], tilted[t.z]);
    EXPECT_NEAR(sum, std::abs(signed_area(outline)) * double(glm::length(glm::cross(u, v))), 1e-4 * sum);
  });
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

// A saw around a disc, where every other vertex blocks. Within the budget of work, each triangle is wound like the
// polygon, which would not hold for a fan over the rest.
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

// The budget of work ends what would take hours, and the number of triangles still holds.
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
