// SPDX-License-Identifier: Apache-2.0
// Surfaces with moving instances, and structures that follow them, against new ones of the same scene.
#include <gtest/gtest.h>

#include "frontmost/files.h"
#include "frontmost/occlusion.h"
#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "occlusion/hidden_scene.h"
#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/refusal.h"
#include "support/same_visible.h"
#include "surfaces/cluster_set.h"

namespace frontmost {
namespace {

using namespace test;

/// Boxes that meet corner to corner, so that clusters hold vertices of many at one place; balls without normals, leaves
/// with holes, a pane of glass, and a mesh without finite triangles.
Scene moving_scene(std::uint64_t seed) {
  Scene scene = cutout_scene(random_mesh(Kind::soup, 40, seed), Cut::half, 0.5f, seed);
  Random random(seed);
  scene.meshes.push_back(tessellated_box({0.2f, 0.2f, 0.2f}, 1, 0));
  scene.meshes.push_back(bumpy_ball(4, 0.2f, seed));
  scene.meshes.push_back(tessellated_box({0.5f, 0.5f, 0.01f}, 1, 0));
  scene.meshes.back().material_ids = {std::uint32_t(scene.materials.size())};
  scene.materials.emplace_back().alpha = Material::Alpha::blend;
  scene.materials.back().base_color.a = 0.4f;
  for (int i = 0; i < 27; ++i) {
    glm::dmat4 place(1.0);
    place[3] = {0.4 * (i % 3 - 1), 0.4 * (i / 3 % 3 - 1), 0.4 * (i / 9 - 1), 1};
    scene.instances.push_back({"box", 1, place});
  }
  for (int i = 0; i < 12; ++i)
    scene.instances.push_back({"", std::uint32_t(random.below(4)), random_placement(random, 1, 0.3f)});
  return scene;
}

/// A placement that is turned, mirrored, flattened, carried away, or back at the origin.
glm::dmat4 next_placement(Random& random) {
  switch (random.below(8)) {
    case 0: return glm::dmat4(1.0);
    case 1: return glm::dmat4(0.0);
    case 2: {
      glm::dmat4 flat(1.0);
      flat[2] = {0, 0, 0, 0};
      return flat;
    }
    case 3: return random_placement(random, 20, 1);
    default: return random_placement(random, 1, 0.4f);
  }
}

/// Structures that are kept from move to move.
struct Kept {
  explicit Kept(const Scene& scene)
      : surfaces(scene), index(surfaces), occlusion(surfaces), parts(surfaces, ObjectUnit::parts) {}

  void move(Scene& scene, std::uint32_t instance, const glm::dmat4& to) {
    surfaces.move(scene, instance, to);
    index.follow(surfaces, instance);
  }

  Surfaces surfaces;
  RayIndex index;
  ZBuffer buffer;
  Occlusion occlusion, parts;
};

void expect_same_sights(Occlusion& kept, Occlusion& anew, const View& view) {
  const auto a = kept.cull(view, {.cell = 1}), b = anew.cull(view, {.cell = 1});
  ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

void expect_same_image(const Image& a, const Image& b) {
  for (std::size_t c = 0; c < 4; ++c)
    ASSERT_TRUE(
        std::equal(a.channels[c].floats().begin(), a.channels[c].floats().end(), b.channels[c].floats().begin()))
        << a.channels[c].name;
}

void expect_same_boxes(const Surfaces& kept, const Surfaces& anew) {
  EXPECT_EQ(kept.bounds().low, anew.bounds().low);
  EXPECT_EQ(kept.bounds().high, anew.bounds().high);
  for (std::uint32_t i = 0; i < anew.scene().instances.size(); ++i) {
    EXPECT_EQ(kept.is_mirrored(i), anew.is_mirrored(i));
    EXPECT_EQ(kept.bounds(i).low, anew.bounds(i).low);
    EXPECT_EQ(kept.bounds(i).high, anew.bounds(i).high);
  }
}

void expect_as_made_anew(Kept& kept, const Scene& scene, const View& view) {
  const Surfaces anew(scene);
  ASSERT_NO_FATAL_FAILURE(expect_same_boxes(kept.surfaces, anew));
  const Visible expected = draw_both_ways(anew, view);
  ASSERT_NO_FATAL_FAILURE(expect_same(expected, kept.buffer.draw(kept.surfaces, view)));
  ASSERT_NO_FATAL_FAILURE(expect_same(expected, draw_both_ways(kept.surfaces, view)));
  const Visible by_rays = raycast(anew, view);
  ASSERT_NO_FATAL_FAILURE(expect_same(by_rays, raycast(kept.index, view)));
  Occlusion occlusion(anew), parts(anew, ObjectUnit::parts);
  ASSERT_NO_FATAL_FAILURE(expect_same_sights(kept.occlusion, occlusion, view));
  ASSERT_NO_FATAL_FAILURE(expect_same_sights(kept.parts, parts, view));
}

TEST(Move, EverythingAnswersAsIfMadeAnew) {
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = moving_scene(seed);
    Kept kept(scene);
    Random random(seed + 50);
    for (int step = 0; step < 12; ++step) {
      for (int moves = 1 + random.below(4); moves > 0; --moves)
        kept.move(scene, std::uint32_t(random.below(scene.instances.size())), next_placement(random));
      View view = test::random_view(80, 60, seed + 13 * std::uint64_t(step));
      view.culling = step % 3 == 0 ? Culling::back : Culling::none;
      ASSERT_NO_FATAL_FAILURE(expect_as_made_anew(kept, scene, view)) << step;
    }
  }
}

TEST(Move, PicturesAreThoseOfSurfacesMadeAnew) {
  for (std::uint64_t seed = 0; seed < seeds(4); ++seed)
    for (const Shadows shadows : {Shadows::off, Shadows::map, Shadows::rays}) {
      SCOPED_TRACE(testing::Message() << seed << " " << int(shadows));
      Scene scene = moving_scene(seed);
      Surfaces surfaces(scene);
      Shader shader(surfaces);
      Random random(seed + 80);
      const ShadeOptions options{.light = {.shadows = shadows}};
      for (int step = 0; step < 4; ++step) {
        const View view = test::random_view(64, 48, seed + 7 * std::uint64_t(step));
        const Visible visible = zbuffer(surfaces, view);
        const Image& kept = shader.shade({.visible = &visible}, options);
        const Surfaces anew(scene);
        ASSERT_NO_FATAL_FAILURE(expect_same_image(shade(anew, visible, options), kept)) << step;
        for (int moves = 0; moves < 3; ++moves)
          surfaces.move(scene, std::uint32_t(random.below(scene.instances.size())), next_placement(random));
      }
    }
}

TEST(Move, CornersThatLeaveTheFloatsAndComeBackAreFollowed) {
  Scene scene = moving_scene(3);
  Kept kept(scene);
  const View view = test::random_view(80, 60, 3);
  const glm::dmat4 home = scene.instances[5].world_from_mesh;
  glm::dmat4 away = home;
  away[0] *= 1e300;
  for (const glm::dmat4& to : {home, away, home, away, away, home}) {
    kept.move(scene, 5, to);
    ASSERT_NO_FATAL_FAILURE(expect_as_made_anew(kept, scene, view));
  }
}

TEST(Move, WhoLooksSeldomFollowsAllTheSame) {
  Scene scene = moving_scene(4);
  Kept kept(scene);
  Random random(4);
  const View view = test::random_view(80, 60, 4);
  // The number of moves exceeds the log.
  for (std::size_t i = 0; i < 5 * scene.instances.size() + 3; ++i)
    kept.move(scene, std::uint32_t(random.below(scene.instances.size())), next_placement(random));
  ASSERT_NO_FATAL_FAILURE(expect_as_made_anew(kept, scene, view));
}

TEST(Move, ClustersStayWhereTheyCanAndKeepTheirCones) {
  Scene scene = moving_scene(5);
  Surfaces surfaces(scene);
  const ClusterSet* const before = &cluster_set(surfaces);
  static_cast<void>(before->cones.get(*before, {}));
  Random random(5);
  for (int i = 0; i < 40; ++i)
    surfaces.move(scene, std::uint32_t(random.below(scene.instances.size())), random_placement(random, 1, 0.4f));
  ASSERT_EQ(made_cluster_set(surfaces), before);
  const ConeArrays& kept = before->cones.get(*before, {});
  const ConeArrays anew = make_cones(*before, {});
  for (std::size_t c = 0; c < before->clusters.size(); ++c) {
    EXPECT_EQ(kept.cosine[c], anew.cosine[c]);
    EXPECT_EQ(kept.altitude[c], anew.altitude[c]);
    EXPECT_EQ(kept.x[c], anew.x[c]);
  }
}

TEST(Move, WhatAnIndexSeesThroughStaysUntilItFollows) {
  Scene scene = moving_scene(6);
  Surfaces surfaces(scene);
  RayIndex index(surfaces);
  const View view = test::random_view(80, 60, 6);
  const Visible before = raycast(index, view);
  Random random(6);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) surfaces.move(scene, i, random_placement(random, 1, 0.4f));
  ASSERT_NO_FATAL_FAILURE(expect_same(before, raycast(index, view)));
}

TEST(Move, OfManyIsThatOfEach) {
  for (const std::size_t count : {1, 2, 16, 17, 300}) {
    Scene scene = moving_scene(3);
    scene.instances.resize(count, scene.instances[0]);
    Surfaces surfaces(scene);
    Random random(count);
    for (int step = 0; step < 20; ++step) {
      std::vector<Surfaces::Placement> placements;
      for (int i = 0; i < 5; ++i) placements.push_back({std::uint32_t(random.below(count)), next_placement(random)});
      surfaces.move(scene, placements);
      ASSERT_NO_FATAL_FAILURE(expect_same_boxes(surfaces, Surfaces(scene))) << count << ' ' << step;
    }
    // A list of moves applies as a whole or not at all.
    const Box before = surfaces.bounds();
    const std::vector<Surfaces::Placement> wrong{{0, glm::dmat4(3.0)}, {std::uint32_t(count), glm::dmat4(1.0)}};
    EXPECT_EQ(code_of([&] { surfaces.move(scene, wrong); }), ErrorCode::bad_argument);
    EXPECT_EQ(surfaces.bounds().low, before.low);
    EXPECT_NE(scene.instances[0].world_from_mesh, glm::dmat4(3.0));
  }
}

TEST(Move, OtherScenesInstancesAndTransformsAreRefused) {
  Scene scene = moving_scene(1), other = scene;
  Surfaces surfaces(scene);
  const glm::dmat4 before = scene.instances[0].world_from_mesh;
  EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { surfaces.move(other, 0, glm::dmat4(2.0)); }),
            "move: the surfaces were made for another scene");
  EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { surfaces.move(scene, 40, glm::dmat4(2.0)); }),
            "move: there is no instance 40");
  glm::dmat4 broken(1.0);
  broken[3].x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code_of([&] { surfaces.move(scene, 0, broken); }), ErrorCode::bad_argument);
  EXPECT_EQ(scene.instances[0].world_from_mesh, before);
  RayIndex index(surfaces);
  EXPECT_EQ(refusal_of(ErrorCode::bad_argument, [&] { index.follow(surfaces, 40); }),
            "follow: there is no instance 40");
}

}  // namespace
}  // namespace frontmost
