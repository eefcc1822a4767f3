// SPDX-License-Identifier: Apache-2.0
// The z-buffer against the oracle, to the bit: every instruction set, several threads, every kind of scene.

#include "support/oracle.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <numeric>

#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(ZBuffer, EveryKind, testing::ValuesIn(all_kinds));

TEST_P(EveryKind, EqualsTheOracleOnEveryInstructionSet) {
  expect_oracle_on_every_isa(
      GetParam(), [](const Surfaces& surfaces, const View& view) { return oracle(surfaces, view); },
      [](const Surfaces& surfaces, const View& view, const Execution& how) {
        return draw_both_ways(surfaces, view, how);
      });
}

TEST(ZBuffer, EqualsTheOracleWithEverySampleCount) {
  for (const int samples : {1, 2, 4, 8, 16}) {
    SCOPED_TRACE(testing::Message() << samples << " samples");
    Random random(7);
    const Scene scene = scene_of(random_mesh(Kind::soup, 300, 5));
    const Surfaces surfaces(scene);
    View view = random_view(random, 150, 140);
    view.samples = samples;
    const Visible expected = oracle(surfaces, view);
    for (const Isa isa : available_isas()) expect_same(expected, draw_both_ways(surfaces, view, {.isa = isa}));
  }
}

// Planes of triangles that cover a block hide others: the margin for rounding must suffice.
TEST(ZBuffer, SheetsARoundingErrorApartAreToldApart) {
  for (std::uint64_t seed = 0; seed < seeds(150); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Scene scene = scene_of(random_mesh(Kind::sheets, 40, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 128, 96);
    view.samples = seed % 8 == 0 ? 4 : 1;
    expect_same(oracle(surfaces, view), draw_both_ways(surfaces, view, {.threads = 1}));
  }
}

TEST(ZBuffer, DoesNotDependOnThreads) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 60'000, 3));
  const Surfaces surfaces(scene);
  Random random(11);
  const View view = random_view(random, 700, 500);
  const std::uint64_t one = content_hash(draw_both_ways(surfaces, view, {.threads = 1}));
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(content_hash(draw_both_ways(surfaces, view, {.threads = threads})), one);
}

TEST(ZBuffer, DoesNotDependOnTheCallersRoundingMode) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 500, 3));
  const Surfaces surfaces(scene);
  Random random(12);
  const View view = random_view(random, 300, 200);
  const std::uint64_t expected = content_hash(draw_both_ways(surfaces, view));
  std::fesetround(FE_UPWARD);
  const std::uint64_t upward = content_hash(draw_both_ways(surfaces, view));
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(upward, expected);
}

// Permuting triangles permutes ids; the visible surfaces and their depths must not change where depths differ.
TEST(ZBuffer, PermutedTrianglesShowTheSameSurfaces) {
  for (const Kind kind : {Kind::soup, Kind::tiny, Kind::shared_grid, Kind::slivers}) {
    Mesh mesh = random_mesh(kind, 2000, 9);
    std::vector<std::uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    Random random(21);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[std::size_t(random.below(int(i)))]);
    Mesh shuffled = mesh;
    for (std::size_t i = 0; i < order.size(); ++i) shuffled.triangles[i] = mesh.triangles[order[i]];

    const Scene scene = scene_of(mesh), scene_shuffled = scene_of(shuffled);
    const Surfaces a(scene), b(scene_shuffled);
    const View view = random_view(random, 320, 240);
    const Visible in_order = draw_both_ways(a, view), in_disorder = draw_both_ways(b, view);
    std::size_t ties = 0;
    for (std::size_t i = 0; i < in_order.keys.size(); ++i) {
      ASSERT_EQ(in_order.keys[i], in_disorder.keys[i]);
      const PrimitiveId id = in_disorder.primitives[i];
      ties += (id == no_primitive ? no_primitive : order[id]) != in_order.primitives[i];
    }
    EXPECT_LT(ties, in_order.keys.size() / 100) << "only exact ties may change";
  }
}

// Splitting every triangle at the middle of an edge, if that is exact on the screen, covers the same samples.
TEST(ZBuffer, SharedEdgesLeaveNoGapAndNoOverlap) {
  for (std::uint64_t seed = 0; seed < seeds(30); ++seed) {
    // A fan around an inner vertex fills a square, covering every sample exactly once.
    Random random(seed);
    Mesh mesh;
    const glm::vec3 centre = random.point(0.4f) * glm::vec3(1, 1, 0);
    std::vector<glm::vec3> rim{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::vec3 a = rim[i], b = rim[(i + 1) % 4], m = a + (b - a) * random.unit();
      add_triangle(mesh, centre, a, m);
      add_triangle(mesh, centre, m, b);
    }
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    View view{256, 256, 1, look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}), make_orthographic(-1, 1, -1, 1, {1, 3}), {}};
    std::size_t total = 0;
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      Scene single = scene;
      single.meshes[0].triangles = {scene.meshes[0].triangles[id]};
      const Surfaces one(single);
      total += covered(draw_both_ways(one, view));
    }
    EXPECT_EQ(total, 128u * 128u);
    EXPECT_EQ(covered(draw_both_ways(surfaces, view)), 128u * 128u);
  }
}

TEST(ZBuffer, NonFiniteVerticesAreNeverSeenAndKeepTheirNumbers) {
  Mesh mesh;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  add_triangle(mesh, {nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 1}, {infinity, 0, 0.5f}, {0, 1, 0.5f});
  add_triangle(mesh, {0, 0, 1}, {3e38f, 3e38f, 3e38f}, {0, 1, 0.5f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  Random random(4);
  View view = random_view(random, 100, 100);
  view.world_from_eye = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  const Visible visible = draw_both_ways(surfaces, view);
  EXPECT_EQ(visible.primitives[visible.index(50, 50)], 1u);
  for (const PrimitiveId id : visible.primitives) EXPECT_TRUE(id == no_primitive || id == 1 || id == 3);
  expect_same(oracle(surfaces, view), visible);
}

TEST(ZBuffer, OnePixelAndTheLargestImage) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view{1, 1, 1, look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}), make_orthographic(-1, 1, -1, 1, {1, 3}), {}};
  expect_same(oracle(surfaces, view), draw_both_ways(surfaces, view));
  for (const glm::ivec2 size : {glm::ivec2(16384, 3), glm::ivec2(2, 16384)}) {
    view.width = size.x;
    view.height = size.y;
    expect_same(oracle(surfaces, view), draw_both_ways(surfaces, view));
  }
}

TEST(ZBuffer, BadViewsAreRefusedWithTheFieldsName) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 3, 1));
  const Surfaces surfaces(scene);
  Random random(1);
  const View good = random_view(random, 10, 10);
  const auto message = [&](View view) -> std::string {
    try {
      (void)draw_both_ways(surfaces, view);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  View view = good;
  view.width = 0;
  EXPECT_EQ(message(view), "width: must be 1 to 16384");
  view = good;
  view.height = 16385;
  EXPECT_EQ(message(view), "height: must be 1 to 16384");
  view = good;
  view.samples = 3;
  EXPECT_EQ(message(view), "samples: must be 1, 2, 4, 8 or 16");
  view = good;
  view.world_from_eye[0] = glm::dvec4(0);
  EXPECT_EQ(message(view), "pose: must be a rotation and a translation, last row 0 0 0 1");
  view = good;
  view.projection.clip = {1, 0.5};
  EXPECT_EQ(message(view), "far: must be greater than near");
}

TEST(ZBuffer, NothingToSeeIsNothing) {
  const Scene scene;
  const Surfaces surfaces(scene);
  Random random(1);
  const Visible visible = draw_both_ways(surfaces, random_view(random, 33, 17));
  EXPECT_EQ(covered(visible), 0u);
  EXPECT_EQ(visible.primitives.size(), 33u * 17u);
}

}  // namespace
}  // namespace frontmost::test
