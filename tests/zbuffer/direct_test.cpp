// SPDX-License-Identifier: Apache-2.0
// One picture straight from the scene's arrays: equal to the bit to the clusters' picture, for any scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

using zbuffer_detail::draw_directly;
using zbuffer_detail::draw_pixels_directly;

/// Compares the pictures of both ways. \returns the number of covered samples.
std::size_t expect_same_both_ways(const Scene& scene, const View& view, int threads) {
  const Surfaces surfaces(scene);
  const Visible expected = draw_clusters(surfaces, view);
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    const Surfaces again(scene, {.isa = isa});
    const Execution execution{.threads = threads, .isa = isa};
    expect_same(expected, draw_directly(placed_scene(again), view, execution));
    const std::size_t mixed = expect_same_pixels(expected, draw_pixels_directly(placed_scene(again), view, execution));
    EXPECT_EQ(mixed, expect_same_pixels(expected, pixels_of(expected)));
  }
  return covered(expected);
}

class DirectOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Direct, DirectOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(DirectOfEveryKind, EqualsTheClusters) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 900);
    const int count = 20 + random.below(400);
    const Scene scene = scene_of(random_mesh(GetParam(), count, seed));
    const int width = 1 + random.below(400);
    View view = random_view(random, width, 1 + random.below(300));
    view.culling = Culling(seed % 4 == 3 ? random.below(4) : 0);
    view.samples = seed % 5 == 4 ? 1 << random.below(5) : 1;
    seen += expect_same_both_ways(scene, view, 1 + int(seed % 3));
  }
  if (!tries_little) EXPECT_GT(seen, 1'000u) << "the scenes have become empty";
}

// The scene has more batches than are drawn at a time, so tiles are resumed.
TEST(Direct, TakesUpTilesAgain) {
  for (const Kind kind : {Kind::tiny, Kind::shared_grid}) {
    Scene scene = scene_of(random_mesh(kind, tries_little ? 9'000 : 90'000, 3));
    for (int i = 0; i < 6; ++i) scene.instances.push_back(scene.instances.front());
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
      scene.instances[i].world_from_mesh[3] += glm::dvec4(0.1, 0.02, 0.05, 0) * double(i);
    Random random(5);
    View view = random_view(random, 200, 160);
    view.samples = kind == Kind::tiny ? 1 : 2;
    EXPECT_GT(expect_same_both_ways(scene, view, 2), 1'000u);
  }
}

// One or a few triangles an instance, some mirrored, turned and flattened.
TEST(Direct, ManySmallInstances) {
  Random random(7);
  Scene scene;
  for (int m = 0; m < 5; ++m) scene.meshes.push_back(random_mesh(m % 2 ? Kind::soup : Kind::shared_grid, 3 + 9 * m, 5));
  scene.meshes.emplace_back();  // an empty mesh
  for (int i = 0; i < 3'000; ++i) {
    Instance instance{"", std::uint32_t(random.below(6)), glm::dmat4(1.0)};
    for (int column = 0; column < 3; ++column) {
      const float scale = random.within(-0.3f, 0.3f);
      instance.world_from_mesh[column][column] = i % 50 == 49 ? 0 : scale;
      instance.world_from_mesh[3][column] = random.within(-1, 1);
    }
    scene.instances.push_back(instance);
  }
  for (const Culling culling : {Culling::none, Culling::back, Culling::front, Culling::both}) {
    View view = random_view(random, 500, 300);
    view.culling = culling;
    EXPECT_EQ(expect_same_both_ways(scene, view, 2) > 0, culling != Culling::both);
  }
}

TEST(Direct, HolesOfCutOuts) {
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Kind kinds[] = {Kind::soup, Kind::through_eye, Kind::shared_grid};
    const Scene scene = cutout_scene(random_mesh(kinds[seed % 3], 200, seed), Cut(seed % 2), 0.5f, seed);
    View view = random_view(random, 200, 150);
    view.samples = seed % 4 == 3 ? 4 : 1;
    EXPECT_GT(expect_same_both_ways(scene, view, 2), 10u);
  }
}

// Neighbours in the file are far apart in the array of vertices.
TEST(Direct, ScatteredNumbersOfVertices) {
  Mesh mesh = random_mesh(Kind::shared_grid, 20'000, 2);
  Random random(3);
  for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i)
    std::swap(mesh.triangles[i], mesh.triangles[std::size_t(random.below(int(i)))]);
  Scene scene = scene_of(std::move(mesh));
  for (const double scale : {1.0, -1.0}) {
    scene.instances[0].world_from_mesh[0][0] = scale;
    EXPECT_GT(expect_same_both_ways(scene, random_view(random, 400, 300), 2), 1'000u);
  }
}

TEST(Direct, VerticesThatAreNoNumbers) {
  Mesh mesh = random_mesh(Kind::through_eye, 3'000, 2);
  Random random(3);
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(), 3e38f, 1e-42f};
  for (int i = 0; i < 4'000; ++i)
    mesh.positions[std::size_t(random.below(int(mesh.positions.size())))][random.below(3)] = odd[i % 5];
  for (int i = 0; i < 8; ++i) {
    View view = random_view(random, 300, 200);
    view.projection.orthographic = i % 2 == 1;
    if (view.projection.orthographic) view.projection.clip.far = 20;
    EXPECT_GT(expect_same_both_ways(scene_of(mesh), view, 1), 100u);
  }
}

TEST(Direct, NothingAtAll) {
  Random random(1);
  const View view = random_view(random, 200, 150);
  EXPECT_EQ(expect_same_both_ways(Scene{}, view, 1), 0u);
  EXPECT_EQ(expect_same_both_ways(scene_of(Mesh{}), view, 1), 0u);
}

// zbuffer() makes no clusters, however often it is called; it uses those that are there. All pictures are the same.
TEST(Direct, OnlyAskedForClustersAreMade) {
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 9'000, 1));
  Random random(1);
  const View view = random_view(random, 200, 160);
  const Surfaces surfaces(scene), many(scene);
  const std::size_t without = surfaces.byte_count();
  const Visible first = zbuffer(surfaces, view);
  for (int i = 0; i < 3; ++i) expect_same(first, zbuffer(surfaces, view));
  EXPECT_EQ(surfaces.byte_count(), without);
  surfaces.make_clusters();
  expect_same(first, zbuffer(surfaces, view));
  EXPECT_GT(surfaces.byte_count(), without + 9'000 * 7);
  ZBuffer buffer;
  expect_same(first, buffer.draw(many, view));
  EXPECT_EQ(many.byte_count(), surfaces.byte_count());
}

// The first thread makes the clusters, and all threads draw the same picture.
TEST(Direct, ThreadsMayAskForClustersAtOnce) {
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 9'000, 1));
  Random random(1);
  const View view = random_view(random, 100, 80);
  const Visible expected = draw_clusters(Surfaces(scene), view);
  const Surfaces surfaces(scene);
  std::vector<Visible> found(8);
  std::vector<std::thread> threads;
  for (Visible& visible : found) threads.emplace_back([&] { visible = draw_clusters(surfaces, view, {.threads = 2}); });
  for (std::thread& thread : threads) thread.join();
  for (const Visible& visible : found) expect_same(expected, visible);
}

// A wall in front of a crowd, last in the file: skipping the batches behind it must not show.
TEST(Direct, WhatAWallHides) {
  for (const int holes : {0, 1}) {
    Scene scene = scene_of(random_mesh(Kind::tiny, 300'000, 9));
    Mesh wall;
    add_triangle(wall, {-9, -9, 1.2f}, {9, -9, 1.2f}, {0, holes ? 0.3f : 30.0f, 1.2f});
    scene.meshes.push_back(wall);
    scene.instances.push_back({"wall", 1, glm::dmat4(1.0)});
    View view;
    view.width = 300;
    view.height = 200;
    view.world_from_eye = look_at({0.3, 0.2, 2.5}, {0, 0, 0}, {0, 1, 0});
    view.projection = make_projection(0.8, 1.5, {0.1, 9});
    EXPECT_GT(expect_same_both_ways(scene, view, 2), 10'000u);
  }
}

}  // namespace
}  // namespace frontmost::test
