// SPDX-License-Identifier: Apache-2.0
// Triangles in the order of submission: of mixed sizes, cut at tiles, clipped, transformed, and with scattered vertex
// numbers.
#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/zbuffer.h"
#include "support/depth_oracle.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// Small triangles, large ones and ones that pass the eye, in turn: no two neighbours are drawn alike.
Mesh mixed_mesh(int count, std::uint64_t seed) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Kind kinds[] = {Kind::tiny, Kind::soup, Kind::tiny, Kind::slivers, Kind::through_eye, Kind::huge};
    const Mesh one = random_mesh(kinds[(seed + std::uint64_t(i) * 5) % 6], 1, seed * 1000 + std::uint64_t(i));
    const auto n = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    mesh.triangles.push_back(one.triangles[0] + n);
  }
  return mesh;
}

bool is_as_oracle(const DepthOracle& expected, const DepthBuffer& actual, const View& view) {
  return std::memcmp(expected.stored().data(), actual.stored().data(), 4 * expected.stored().size()) == 0 &&
         content_hash(expected.visible()) == content_hash(actual.visible(view));
}

// ALWAYS shows the last triangle, so any triangle out of order is visible.
TEST(Submission, OrderIsKeptAcrossSizesTilesAndClipping) {
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Scene scene = scene_of(mixed_mesh(1 + random.below(90), seed));
    const Surfaces surfaces(scene);
    const int width = 100 + random.below(200);
    View view = random_view(random, width, 60 + random.below(100));
    view.samples = seed % 5 == 4 ? 4 : 1;
    const auto begin = PrimitiveId(random.below(9));
    const DepthDraw call{.state = {.func = DepthFunc::always, .offset = {0.5, 2, 0}}, .begin = begin};
    DepthOracle oracle(view, DepthFormat::f32);
    oracle.draw(surfaces, call);
    for (const Isa isa : available_isas()) {
      DepthBuffer buffer(view.width, view.height, view.samples, DepthFormat::f32);
      buffer.draw(surfaces, view, call, {.threads = 2, .isa = isa});
      EXPECT_TRUE(is_as_oracle(oracle, buffer, view)) << name(isa);
    }
  }
}

TEST(Submission, InstancesAreTransformedAndMirrored) {
  Random random(3);
  Scene scene = scene_of(mixed_mesh(70, 2));
  for (int i = 0; i < 3; ++i) {
    glm::dmat4 place(1.0);
    for (int column = 0; column < 4; ++column) place[column] += glm::dvec4(glm::dvec3(random.point(0.3f)), 0);
    place[0] *= i == 1 ? -1.0 : 1.0;
    scene.instances.push_back({"placed", 0, place});
  }
  const Surfaces surfaces(scene);
  View view = random_view(random, 180, 140);
  for (const Culling culling : {Culling::none, Culling::back, Culling::front}) {
    view.culling = culling;
    DepthOracle oracle(view, DepthFormat::d24);
    oracle.draw(surfaces, {});
    for (const Isa isa : available_isas()) {
      DepthBuffer buffer(180, 140);
      buffer.draw(surfaces, view, {}, {.isa = isa});
      EXPECT_TRUE(is_as_oracle(oracle, buffer, view)) << name(isa);
    }
  }
}

// Vertices far apart in their array are fetched one by one, not as a range.
TEST(Submission, NumbersOfVerticesDoNotMatter) {
  const Mesh mesh = mixed_mesh(300, 7);
  Mesh scattered;
  scattered.positions.resize(100'003 * 9 + 1);
  std::uint32_t at = 5;
  for (const glm::uvec3& corners : mesh.triangles) {
    glm::uvec3 moved;
    for (int k = 0; k < 3; ++k) {
      at = (at * 7919 + 13) % 100'003;
      moved[k] = 9 * at;
      scattered.positions[moved[k]] = mesh.positions[corners[k]];
    }
    scattered.triangles.push_back(moved);
  }
  const Scene a = scene_of(mesh), b = scene_of(scattered);
  const Surfaces compact(a), sparse(b);
  Random random(9);
  const View view = random_view(random, 300, 200);
  DepthBuffer first(300, 200), second(300, 200);
  first.draw(compact, view);
  second.draw(sparse, view);
  EXPECT_EQ(content_hash(first.visible(view)), content_hash(second.visible(view)));
}

}  // namespace
}  // namespace frontmost::test
