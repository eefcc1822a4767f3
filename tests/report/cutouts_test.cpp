// SPDX-License-Identifier: Apache-2.0
// Every method sees through the holes of alpha mode MASK, and all methods see the same.
#include <gtest/gtest.h>

#include "frontmost/frontmost.h"
#include "support/cutout_scene.h"
#include "support/flat_picture.h"
#include "surfaces/cluster_set.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"

namespace frontmost::test {
namespace {

/// The answer of each method, with its name.
std::vector<std::pair<const char*, Visible>> all_answers(const Surfaces& surfaces, const View& view) {
  std::vector<std::pair<const char*, Visible>> answers;
  answers.emplace_back("zbuffer", zbuffer(surfaces, view));
  answers.emplace_back("raycast", raycast(surfaces, view));
  answers.emplace_back("abuffer", visible_layers(surfaces, view, 1)[0]);
  DepthBuffer buffer(view.width, view.height, view.samples, DepthFormat::f32);
  buffer.draw(surfaces, view);
  answers.emplace_back("depth buffer", buffer.visible(view));
  return answers;
}

/// A square of 8 x 8 texels over 16 x 16 pixels, where every second texel is a hole; an opaque square behind it.
Scene checkers() {
  Mesh mesh;
  for (const float z : {0.0f, -1.0f}) {
    const auto n = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
    mesh.texcoords.values.insert(mesh.texcoords.values.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  }
  mesh.material_ids = {1, 1, 0, 0};
  Scene scene = scene_of(std::move(mesh));
  Texture& texture = scene.textures.emplace_back();
  texture.width = texture.height = 8;
  texture.nearest = true;
  for (int i = 0; i < 64; ++i) texture.pixels.emplace_back(255, 255, 255, (i + i / 8) % 2 == 0 ? 255 : 0);
  scene.materials.resize(2);
  scene.materials[1].alpha = Material::Alpha::mask;
  scene.materials[1].base_color_texture.texture = 0;
  return scene;
}

View front_view(int samples) {
  View view;
  view.width = view.height = 16;
  view.samples = samples;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-1, 1, -1, 1, {1, 20});
  return view;
}

TEST(Holes, ShowWhatIsBehindThem) {
  const Scene scene = checkers();
  const Surfaces surfaces(scene);
  for (const int samples : {1, 4}) {
    for (const auto& answer : all_answers(surfaces, front_view(samples))) {
      SCOPED_TRACE(answer.first);
      const Visible& visible = answer.second;
      for (int s = 0; s < samples; ++s)
        for (int y = 0; y < 16; ++y)
          for (int x = 0; x < 16; ++x) {
            const bool is_solid = (x / 2 + y / 2) % 2 == 0;
            const std::size_t i = visible.index(x, y, s);
            ASSERT_EQ(visible.primitives[i] < 2, is_solid) << x << ", " << y;
            ASSERT_NEAR(depth_of_key(visible.view, visible.keys[i]), is_solid ? 10 : 11, 1e-4);
          }
    }
  }
}

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Holes, EveryKind, testing::ValuesIn(all_kinds));

TEST_P(EveryKind, WithoutHolesIsAsIfOpaque) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Mesh mesh = random_mesh(GetParam(), 120, seed);
    const Scene whole = cutout_scene(mesh, seed % 2 == 0 ? Cut::all : Cut::half, 0.0f, seed);
    const Scene opaque = cutout_scene(mesh, Cut::none, 0.0f, seed);
    const Surfaces surfaces(whole), expected_surfaces(opaque);
    View view = random_view(random, 1 + random.below(150), 1 + random.below(150));
    view.samples = seed % 3 == 0 ? 4 : 1;
    view.culling = Culling(seed % 4);
    const auto answers = all_answers(surfaces, view), expected = all_answers(expected_surfaces, view);
    for (std::size_t m = 0; m < answers.size(); ++m)
      ASSERT_EQ(content_hash(answers[m].second), content_hash(expected[m].second)) << answers[m].first;
  }
}

TEST_P(EveryKind, WithNothingButHolesShowsNothing) {
  Random random(5);
  const Scene scene = cutout_scene(random_mesh(GetParam(), 120, 5), Cut::all, 1.5f, 5);
  const Surfaces surfaces(scene);
  const View view = random_view(random, 90, 70);
  for (const auto& answer : all_answers(surfaces, view))
    EXPECT_EQ(content_hash(answer.second), content_hash(nothing_visible(view))) << answer.first;
  EXPECT_TRUE(abuffer(surfaces, view).fragments.empty());
}

TEST_P(EveryKind, IsSeenAlikeByEveryMethod) {
  std::size_t samples = 0, seen_through = 0, differing = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 40);
    const Mesh mesh = random_mesh(GetParam(), 150, seed);
    const Scene scene = cutout_scene(mesh, seed % 2 == 0 ? Cut::all : Cut::half, 0.5f, seed);
    const Surfaces surfaces(scene);
    View view = random_view(random, 20 + random.below(100), 20 + random.below(100));
    view.samples = seed % 3 == 0 ? 4 : 1;
    view.culling = Culling(seed % 3);
    const Visible drawn = zbuffer(surfaces, view), cast = raycast(surfaces, view);
    ASSERT_EQ(content_hash(visible_layers(surfaces, view, 1)[0]), content_hash(drawn));
    const Agreement answer = check_agreement(surfaces, drawn, cast);
    EXPECT_EQ(answer.count(Difference::unexplained), 0u);
    differing += answer.differing();
    samples += view.sample_count();
    const Scene opaque = cutout_scene(mesh, Cut::none, 0.5f, seed);
    const Visible covered = zbuffer(Surfaces(opaque), view);
    for (std::size_t i = 0; i < drawn.primitives.size(); ++i)
      seen_through += drawn.primitives[i] != covered.primitives[i];
  }
  EXPECT_GT(seen_through, 40u) << "the scenes have no holes any more";
  EXPECT_LT(differing, samples / 8) << "reasons have become the excuse";
}

TEST(Holes, AreInNoLayer) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    const Scene scene = cutout_scene(random_mesh(Kind::soup, 200, seed), Cut::half, 0.5f, seed);
    const Surfaces surfaces(scene);
    const Cutouts& cutouts = *placed_scene(surfaces).cutouts;
    const View view = random_view(random, 80, 60);
    const ScreenRays rays(view);
    std::size_t looked_at = 0;
    for (const Visible& layer : visible_layers(surfaces, view, 6, {0, 0.5f}))
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          const PrimitiveId id = layer.primitives[layer.index(x, y)];
          if (id == no_primitive || !cutouts.has(id)) continue;
          ++looked_at;
          const glm::ivec2 at = glm::ivec2(x, y) * kSubPixels + sample_offsets(1)[0];
          ASSERT_FALSE(ScreenCutout(cutouts[id], rays).is_hole(at.x, at.y));
        }
    EXPECT_GT(looked_at, 100u);
  }
}

TEST(Holes, LetRaysAndLinesOfSightPass) {
  const Scene scene = checkers();
  const RayIndex index{Surfaces(scene)};
  const glm::vec3 solid(-0.9f, 0.9f, 1), hole(-0.65f, 0.9f, 1);  // texels (0, 0) and (1, 0)
  EXPECT_FLOAT_EQ(float(closest_hit(index, Ray{solid, {0, 0, -2}}).t), 0.5f);
  EXPECT_FLOAT_EQ(float(closest_hit(index, Ray{hole, {0, 0, -2}}).t), 1.0f);
  EXPECT_EQ(all_hits(index, Ray{hole, {0, 0, -2}}).size(), 1u);
  EXPECT_FALSE(is_clear(index, {solid, solid - glm::vec3(0, 0, 1.5f)}));
  EXPECT_TRUE(is_clear(index, {hole, hole - glm::vec3(0, 0, 1.5f)}));
}

TEST(Holes, LetLightPass) {
  const Scene scene = checkers();
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  std::vector<TrianglePoint> points;
  for (int i = 0; i < 64; ++i) {
    // Rays to the middle of every texel, on the square behind.
    const float x = -1 + (float(i % 8) + 0.5f) / 4, y = 1 - (float(i / 8) + 0.5f) / 4;
    const PrimitiveId id = x >= y ? 2 : 3;
    const glm::vec3 weights = id == 2 ? glm::vec3(1 - x, x - y, y + 1) : glm::vec3(1 - y, x + 1, y - x);
    points.push_back({id, surfaces.corners(id), weights, glm::vec3(0)});
  }
  std::vector<std::uint8_t> is_lit(64);
  are_lit(index, points, {0, 0, 1}, is_lit);
  for (int i = 0; i < 64; ++i) ASSERT_EQ(is_lit[std::size_t(i)], (i + i / 8) % 2) << i;
}

TEST(Holes, MoveWithTheirTriangles) {
  Scene scene = checkers();
  const Ray ray{{-0.65f, 0.9f, 1}, {0, 0, -2}};
  RayIndex index{Surfaces(scene)};
  EXPECT_FLOAT_EQ(float(closest_hit(index, ray).t), 1.0f);
  scene.instances[0].world_from_mesh[3].x = 0.25;  // by a texel
  index.refit(Surfaces(scene));
  EXPECT_FLOAT_EQ(float(closest_hit(index, ray).t), 0.5f);
}

TEST(Holes, AreTakenOutOfCoverageMasks) {
  const Scene scene = checkers();
  const Surfaces surfaces(scene);
  View view = front_view(1);
  view.width = view.height = 4;  // 2 x 2 texels a pixel
  const FragmentLists lists = abuffer(surfaces, view, {8});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      ASSERT_EQ(lists.at(x, y).size(), 2u + unsigned(x == 3 - y) * 2) << "the diagonal has two triangles a square";
      std::uint64_t front = 0;
      for (const Fragment& f : lists.at(x, y)) front |= f.primitive < 2 ? f.mask : 0;
      ASSERT_EQ(front, 0xF0F0F0F00F0F0F0Fu);
    }
  // Half red over blue, independent of the order in which they came.
  const std::vector<glm::vec4> colors = {{1, 0, 0, 1}, {1, 0, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}};
  EXPECT_EQ(laid_over(lists, 0, 0, colors), glm::dvec4(0.5, 0, 0.5, 1));
  const FragmentLists plain = abuffer(surfaces, front_view(1));
  EXPECT_EQ(laid_over(plain, 0, 0, colors), glm::dvec4(1, 0, 0, 1));
  EXPECT_EQ(laid_over(plain, 2, 0, colors), glm::dvec4(0, 0, 1, 1));
}

TEST(Holes, AreTheSameForAnyThreadsAndInstructionSet) {
  const Scene scene = cutout_scene(random_mesh(Kind::soup, 400, 3), Cut::half, 0.5f, 3);
  const Surfaces surfaces(scene);
  Random random(3);
  View view = random_view(random, 150, 130);
  view.samples = 4;
  const std::uint64_t drawn = content_hash(zbuffer(surfaces, view)), cast = content_hash(raycast(surfaces, view));
  for (const Isa isa : available_isas())
    for (const int threads : {1, 3}) {
      Execution execution;
      execution.isa = isa;
      execution.threads = threads;
      EXPECT_EQ(content_hash(zbuffer(surfaces, view, execution)), drawn);
      EXPECT_EQ(content_hash(visible_layers(surfaces, view, 1, {}, execution)[0]), drawn);
      EXPECT_EQ(content_hash(raycast(surfaces, view, execution)), cast);
    }
}

}  // namespace
}  // namespace frontmost::test
