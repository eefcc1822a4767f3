// SPDX-License-Identifier: Apache-2.0
// Copies of the same triangles, too many to go through one by one.

#include <gtest/gtest.h>

#include "abuffer/fragment_pass.h"
#include "fragment_oracle.h"
#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/flat_picture.h"
#include "support/refusal.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

// More than fit into one tile's storage, also for the small squares.
const int kCrowd = tries_little ? 12'000 : 100'000;

/// A square of two triangles, `count` times: as it is, and with its vertices in other orders.
Mesh squares(int count, float size) {
  Mesh mesh;
  mesh.positions = {{-size, -size, -0.2f}, {size, -size, 0.1f}, {size, size, -0.3f}, {-size, size, 0.2f}};
  const glm::uvec3 first[] = {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {1, 0, 2}};
  for (int i = 0; i < count; ++i) {
    mesh.triangles.push_back(first[i % 4]);
    mesh.triangles.push_back({0, 2, 3});
  }
  return mesh;
}

Scene glass_scene(Mesh mesh) {
  Scene scene = scene_of(std::move(mesh));
  scene.materials.resize(1);
  scene.materials[0].alpha = Material::Alpha::blend;
  scene.materials[0].base_color.a = 0.5f;
  scene.meshes[0].material_ids = {0};
  return scene;
}

// Small copies lie in a few tiles, as parts of clusters; large ones are drawn one by one. 100,000 copies have more
// fragments than can be gone through: an hour of work to show one triangle.
TEST(Copies, OfOpaqueTrianglesCostAndShowWhatOneDoes) {
  for (const float size : {0.08f, 1.5f})
    for (const int grid : {0, 4}) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", grid " << grid);
      const std::vector<glm::vec4> blue = {{0.2f, 0.4f, 0.9f, 1}};
      const Scene many = painted(scene_of(squares(kCrowd, size)), blue),
                  one = painted(scene_of(squares(1, size)), blue);
      const Surfaces surfaces(many), single(one);
      View view = front_view(700, 500);
      const FragmentLists lists = abuffer(surfaces, view, {grid}), wanted = abuffer(single, view, {grid});
      ASSERT_EQ(lists.fragments.size(), wanted.fragments.size());
      for (std::size_t i = 0; i < lists.fragments.size(); ++i) {
        ASSERT_EQ(lists.fragments[i].primitive, wanted.fragments[i].primitive);
        ASSERT_EQ(lists.fragments[i].mask, wanted.fragments[i].mask);
      }
      EXPECT_EQ(content_hash(flat_picture(surfaces, view, {grid})), content_hash(flat_picture(single, view, {grid})));
      view.samples = 4;
      const std::vector<Visible> layers = visible_layers(surfaces, view, 3);
      expect_same(zbuffer(single, view), layers[0]);
      EXPECT_EQ(covered(layers[1]), 0u);
    }
}

TEST(Copies, OfGlassAreLayersAsManyAsAreAskedFor) {
  const Scene scene = glass_scene(squares(kCrowd, 1.5f));
  const View view = front_view(300, 200);
  const std::vector<Visible> layers = visible_layers(Surfaces(scene), view, 5);
  expect_same(zbuffer(Surfaces(scene), view), layers[0]);
  for (std::size_t k = 0; k < layers.size(); ++k)
    for (std::size_t i = 0; i < view.pixel_count(); ++i) {
      if (layers[0].primitives[i] == no_primitive) continue;
      ASSERT_EQ(layers[k].primitives[i], layers[0].primitives[i] + 2 * k);
      ASSERT_EQ(layers[k].keys[i], layers[0].keys[i]);
    }
}

TEST(Copies, BehindHolesAreSeen) {
  const Cut cuts[] = {Cut::all, Cut::half};
  for (const Cut cut : cuts) {
    Mesh mesh = squares(300, 1.5f);
    // Cutout scenes have texture coordinates by vertex: each copy gets vertices of its own, and other holes.
    Mesh apart;
    for (const glm::uvec3& t : mesh.triangles)
      add_triangle(apart, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
    const Scene scene = cutout_scene(std::move(apart), cut, 0.6f, 3);
    const Surfaces surfaces(scene);
    const View view = front_view(130, 70);
    const std::vector<Visible> layers = visible_layers(surfaces, view, 2);
    expect_same(zbuffer(surfaces, view), layers[0]);
    EXPECT_GT(covered(layers[0]), 5000u);
  }
}

TEST(Copies, OfGlassAreRefusedBeforeTheyAreGathered) {
  if (tries_little) return;
  const Scene scene = glass_scene(squares(kCrowd, 1.5f));
  const Surfaces surfaces(scene);
  const View view = front_view(700, 500);
  // The square covers the whole picture, within the eye's 0.9 radians: 100,000 times 700 x 500.
  const std::string wanted = "abuffer: about " + std::to_string(std::uint64_t(kCrowd) * 700 * 500) +
                             " fragments, and the most of " + std::to_string(2 * kCrowd) +
                             " triangles in a picture of 700 x 500 pixels are " +
                             std::to_string((std::uint64_t(1) << 28) + 1024 * 2 * std::uint64_t(kCrowd));
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)abuffer(surfaces, view); }), wanted);
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)flat_picture(surfaces, view); }), wanted);
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)count_fragments(surfaces, view); }), wanted);
  // All surfaces may be translucent.
  const Scene opaque = scene_of(squares(kCrowd, 1.5f));
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)abuffer(Surfaces(opaque), view, {0, 0.5f}); }), wanted);
}

// A large triangle that is mostly outside the picture counts only for its part inside.
TEST(Limit, CountsWhatThePictureShows) {
  constexpr int count = 1000;
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float z = -float(i) / count;
    add_triangle(mesh, {301.8f, -300, z}, {301.8f, 300, z}, {-298.2f, 300, z});
  }
  const Scene scene = scene_of(std::move(mesh));
  View view = front_view(1600, 900);
  view.projection = make_orthographic(-1, 1, -1, 1, {0.5, 6});
  // The line x + y = 1.8 leaves one two-hundredth of the picture; the whole picture would exceed the limit.
  const std::uint64_t picture = view.pixel_count(), fragments = count_fragments(Surfaces(scene), view).fragments;
  EXPECT_GT(picture * count, abuffer_detail::most_gathered_fragments(view, count));
  EXPECT_NEAR(double(fragments), double(picture * count) / 200, 0.01 * double(picture * count) / 200);
}

TEST(Limit, GrowsWithThePictureAndTheScene) {
  EXPECT_EQ(abuffer_detail::most_gathered_fragments(front_view(1920, 1080), 0), most_fragments / 4);
  EXPECT_EQ(abuffer_detail::most_gathered_fragments(front_view(1920, 1080), 1'000'000), most_fragments);
  EXPECT_EQ(abuffer_detail::most_gathered_fragments(front_view(8192, 8192), 0), std::uint64_t(1) << 32);
}

}  // namespace
}  // namespace frontmost::test
