// SPDX-License-Identifier: Apache-2.0
// Facts about the triangles around a vertex, and the work that they save.
#include <gtest/gtest.h>

#include <numbers>

#include "lines/mesh/mesh.h"
#include "support/crossings.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

struct Found {
  Surfaces surfaces;
  View view;
  WeldedMesh mesh;
  SeenMesh seen;
  Features features;

  explicit Found(const Scene& scene, const Execution& execution = {})
      : surfaces(scene),
        view(frame(surfaces, 64, 64)),
        mesh(weld(surfaces, execution)),
        seen(see(mesh, Sight(view), execution)),
        features(find_features(seen, corner_table(seen.mesh, {}), surfaces, {}, execution)) {}
};

/// A fan of triangles around the origin, over all points of `rim`.
void add_fan(Mesh& mesh, const std::vector<glm::vec3>& rim, bool is_closed = true) {
  for (std::size_t i = 0; i + (is_closed ? 0 : 1) < rim.size(); ++i)
    add_triangle(mesh, {0, 0, 0}, rim[i], rim[(i + 1) % rim.size()]);
}

/// Whether the origin is spread; the answer must be the same for all six orders of the axes.
bool is_spread(const Mesh& mesh) {
  std::vector<bool> answers;
  for (int turned = 0; turned < 6; ++turned) {
    Mesh other = mesh;
    for (glm::vec3& p : other.positions) {
      for (int k = 0; k < turned % 3; ++k) p = {p.y, p.z, p.x};
      if (turned >= 3) p = {p.y, p.x, p.z};
    }
    const Scene scene = scene_of(other);
    const Found found(scene);
    std::uint32_t origin = 0;
    while (found.mesh.positions[origin] != glm::dvec3(0)) ++origin;
    answers.push_back(found.features.is_spread[origin] != 0);
  }
  EXPECT_EQ(std::count(answers.begin(), answers.end(), answers[0]), 6);
  return answers[0];
}

/// `count` points over `turns` around z, alternately up and down.
std::vector<glm::vec3> rim(int count, float turns, float height) {
  std::vector<glm::vec3> places;
  for (int i = 0; i < count; ++i) {
    const float angle = 0.1f + 2 * std::numbers::pi_v<float> * turns * float(i) / float(count);
    places.push_back({std::cos(angle), std::sin(angle), height * float(i % 3)});
  }
  return places;
}

TEST(Stars, AreSpreadWhereTheyGoAroundOnce) {
  for (const int count : {3, 4, 6, 9, 16}) {
    Mesh mesh;
    add_fan(mesh, rim(count, 1, 0.2f));
    EXPECT_TRUE(is_spread(mesh)) << count;
  }
  Mesh twice;
  add_fan(twice, rim(11, 2, 0.2f));
  EXPECT_FALSE(is_spread(twice));
  Mesh backwards;
  std::vector<glm::vec3> places = rim(9, 1, 0.2f);
  std::swap(places[3], places[4]);
  add_fan(backwards, places);
  EXPECT_FALSE(is_spread(backwards));
}

TEST(Stars, AreNotKnownToBeSpreadWhereTheyAreOpenJoinedOrMany) {
  Mesh open;
  add_fan(open, rim(6, 0.9f, 0.2f), false);
  EXPECT_FALSE(is_spread(open));
  Mesh bow_tie;  // two closed fans, one above the other
  std::vector<glm::vec3> upper = rim(5, 1, 0.1f), lower = rim(5, 1, 0.1f);
  for (glm::vec3& p : upper) p.z += 1;
  add_fan(bow_tie, upper);
  add_fan(bow_tie, lower);
  EXPECT_FALSE(is_spread(bow_tie));
  Mesh fin;  // a third triangle at one edge
  add_fan(fin, rim(6, 1, 0.1f));
  add_triangle(fin, {0, 0, 0}, rim(6, 1, 0.1f)[0], {2, 0, 3});
  EXPECT_FALSE(is_spread(fin));
  Mesh flipped;  // one triangle has the reverse winding
  add_fan(flipped, rim(6, 1, 0.1f));
  std::swap(flipped.triangles[2].y, flipped.triangles[2].z);
  EXPECT_FALSE(is_spread(flipped));
  Mesh many;
  add_fan(many, rim(int(Star::most) + 1, 1, 0.2f));
  EXPECT_FALSE(is_spread(many));
  Mesh corner;  // of a cube: no axis shows all three faces from one side
  add_fan(corner, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}});
  EXPECT_FALSE(is_spread(corner));
}

/// A sheet with vertices on a lattice, so that it folds, touches and overlaps itself exactly.
Mesh crumpled(int size, int jitter, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i <= size; ++i)
    for (int j = 0; j <= size; ++j) {
      const float x = float(2 * i + random.below(jitter)), y = float(2 * j + random.below(jitter));
      mesh.positions.push_back({x, y, float(random.below(3))});
    }
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const auto a = std::uint32_t(i * (size + 1) + j), b = a + std::uint32_t(size) + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

TEST(Stars, SpareNoCrossing) {
  std::size_t spread = 0, crossings = 0;
  for (std::uint64_t seed = 0; seed < seeds(60); ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = scene_of(crumpled(12, 2 + int(seed % 4), seed));
    Found found(scene);
    const std::vector<Crossing> some = crossings_of(found.mesh, found.features, {});
    spread += std::size_t(std::count(found.features.is_spread.begin(), found.features.is_spread.end(), 1));
    found.features.is_spread = {};
    const std::vector<Crossing> all = crossings_of(found.mesh, found.features, {});
    crossings += all.size();
    ASSERT_EQ(some.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(some[i].from.place, all[i].from.place);
      ASSERT_EQ(some[i].to.place, all[i].to.place);
      ASSERT_EQ(some[i].left, all[i].left);
      ASSERT_EQ(some[i].right, all[i].right);
    }
  }
  EXPECT_GT(spread, seeds(60) * 30);
  EXPECT_GT(crossings, seeds(60) * 10);
}

TEST(Stars, OfAnySizeHaveTheirCreases) {
  for (const float size : {1.0f, 1e-27f}) {  // for the smaller one, squares of normals underflow
    Mesh mesh;
    for (const glm::vec3 p : {glm::vec3(1, 1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, 1, -1), glm::vec3(-1, -1, 1)})
      mesh.positions.push_back(p * size);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    View view;
    view.world_from_eye = look_at(glm::dvec3(1, 2, 9) * double(size), glm::dvec3(0), {0, 1, 0});
    const WeldedMesh welded = weld(surfaces, {});
    const SeenMesh seen = see(welded, Sight(view), {});
    for (const double angle : {0.5, 1.8, 2.0}) {  // normals differ by 1.91
      const LineOptions options{.crease_angle = angle, .silhouettes = false};
      EXPECT_EQ(find_features(seen, corner_table(seen.mesh, {}), surfaces, options, {}).edges.size(),
                angle < 1.91 ? 6u : 0u)
          << size << " " << angle;
    }
  }
}

TEST(SeenMesh, FacesAsSightSays) {
  for (const Kind kind : all_kinds)
    for (const bool parallel : {false, true}) {
      const Scene scene = scene_of(random_mesh(kind, 300, 5));
      const Surfaces surfaces(scene);
      const View view = frame(surfaces, 64, 64, {.orthographic = parallel});
      const Sight sight(view);
      const WeldedMesh mesh = weld(surfaces, {});
      for (const Isa isa : available_isas()) {
        const SeenMesh seen = see(mesh, sight, {.threads = 2, .isa = isa});
        const SeenMesh best = see(mesh, sight, {});
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
          const glm::uvec3& t = mesh.triangles[i];
          const int facing = sight.facing(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
          ASSERT_EQ(seen.facing[i], facing) << name(isa);
          ASSERT_EQ(seen.triangles[i].facing(), facing);
          ASSERT_EQ(seen.triangles[i].bits, best.triangles[i].bits);
          ASSERT_EQ(seen.triangles[i].normal, best.triangles[i].normal);
        }
      }
    }
}

}  // namespace
}  // namespace frontmost::test
