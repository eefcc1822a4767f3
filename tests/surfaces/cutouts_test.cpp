// SPDX-License-Identifier: Apache-2.0
// Holes in triangles of alpha mode MASK.
#include "surfaces/cutouts.h"

#include <gtest/gtest.h>

#include "frontmost/scene.h"
#include "support/cutout_scene.h"
#include "surfaces/cluster_set.h"

namespace frontmost::test {
namespace {

/// The triangle (0,0,0), (1,0,0), (0,1,0), whose texture coordinates are its x and y.
Scene one_triangle(std::vector<std::uint8_t> alphas, int width) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.texcoords.values = {{0, 0}, {1, 0}, {0, 1}};
  mesh.material_ids = {0};
  Scene scene = scene_of(std::move(mesh));
  scene.materials.emplace_back();
  scene.materials[0].alpha = Material::Alpha::mask;
  if (alphas.empty()) return scene;
  scene.materials[0].base_color_texture.texture = 0;
  Texture& texture = scene.textures.emplace_back();
  texture.width = width;
  texture.height = int(alphas.size()) / width;
  for (const std::uint8_t a : alphas) texture.pixels.emplace_back(0, 0, 0, a);
  texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
  texture.nearest = true;
  return scene;
}

bool is_hole(const Scene& scene, const glm::dvec3& point) {
  const Surfaces surfaces(scene);
  return (*placed_scene(surfaces).cutouts)[0].is_hole_at(point);
}

TEST(Cutouts, FollowTheTexels) {
  Scene scene = one_triangle({255, 0, 0, 255}, 2);
  EXPECT_FALSE(is_hole(scene, {0.2, 0.2, 0}));
  EXPECT_TRUE(is_hole(scene, {0.6, 0.2, 0}));
  EXPECT_TRUE(is_hole(scene, {0.2, 0.6, 0}));
  // A point off the plane or outside counts as the nearest point of the triangle.
  EXPECT_FALSE(is_hole(scene, {0.2, 0.2, 0.5}));
  EXPECT_TRUE(is_hole(scene, {3, -1, 0}));
}

TEST(Cutouts, AreFilteredLikeTheTexture) {
  // Between the centres of the texels, at 1/4 and 3/4, alpha falls from 1 to 0.
  Scene scene = one_triangle({255, 0}, 2);
  scene.textures[0].nearest = false;
  EXPECT_FALSE(is_hole(scene, {0.49, 0.1, 0}));
  EXPECT_TRUE(is_hole(scene, {0.51, 0.1, 0}));
  scene.materials[0].alpha_cutoff = 0.25f;
  EXPECT_FALSE(is_hole(scene, {0.6, 0.1, 0}));
  EXPECT_TRUE(is_hole(scene, {0.65, 0.1, 0}));
}

TEST(Cutouts, AreLookedUpByTheSetOfTheirTexture) {
  Scene scene = one_triangle({255, 0, 0, 255}, 2);
  // The second set is mirrored from left to right.
  scene.meshes[0].further_texcoords = {{}, {{{1, 0}, {0, 0}, {1, 1}}, {}}};
  scene.materials[0].base_color_texture.set = 2;
  EXPECT_TRUE(is_hole(scene, {0.2, 0.2, 0}));
  EXPECT_FALSE(is_hole(scene, {0.6, 0.2, 0}));
  // For a missing or empty set, lookups are at the origin.
  for (const std::uint32_t set : {1u, 3u}) {
    scene.materials[0].base_color_texture.set = set;
    EXPECT_FALSE(is_hole(scene, {0.6, 0.2, 0}));
  }
}

TEST(Cutouts, MultiplyAllThatHasAlpha) {
  Scene scene = one_triangle({204}, 1);  // 0.8
  EXPECT_FALSE(is_hole(scene, {0.3, 0.3, 0}));
  scene.materials[0].base_color.a = 0.6f;
  EXPECT_TRUE(is_hole(scene, {0.3, 0.3, 0}));
  scene.materials[0].base_color.a = 0.9f;
  EXPECT_FALSE(is_hole(scene, {0.3, 0.3, 0}));
  scene.meshes[0].colors.values = {glm::vec4(1), glm::vec4(1, 1, 1, 0), glm::vec4(1)};
  EXPECT_FALSE(is_hole(scene, {0.1, 0.1, 0}));
  EXPECT_TRUE(is_hole(scene, {0.5, 0.1, 0}));
}

TEST(Cutouts, TurnWithTheTexture) {
  Scene scene = one_triangle({255, 0}, 2);
  scene.textures[0].wrap_u = Texture::Wrap::repeat;
  scene.materials[0].base_color_texture.offset = {0.5f, 0};
  EXPECT_TRUE(is_hole(scene, {0.2, 0.2, 0}));
  EXPECT_FALSE(is_hole(scene, {0.6, 0.2, 0}));
}

TEST(Cutouts, AreFoundByTheirId) {
  const Scene scene = cutout_scene(random_mesh(Kind::soup, 300, 4), Cut::half, 0.5f, 4);
  const Surfaces surfaces(scene);
  const ClusterSet& set = cluster_set(surfaces);
  ASSERT_NE(set.cutouts, nullptr);
  EXPECT_EQ(set.cutouts->count(), 150u);
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    ASSERT_EQ(set.cutouts->has(id), id % 2 == 0);
    if (id % 2 == 0) {
      ASSERT_EQ((*set.cutouts)[id].corner, surfaces.corners(id));
    }
  }
}

TEST(Cutouts, HaveClustersOfTheirOwn) {
  for (const Cut cut : {Cut::all, Cut::half, Cut::none}) {
    const Scene scene = cutout_scene(random_mesh(Kind::soup, 1000, 5), cut, 0.5f, 5);
    const Surfaces surfaces(scene);
    const ClusterSet& set = cluster_set(surfaces);
    std::size_t triangles = 0;
    for (std::size_t c = 0; c < set.clusters.size(); ++c)
      for (std::size_t i = 0; i < set.clusters[c].triangle_count; ++i, ++triangles) {
        const PrimitiveId id = set.id[set.clusters[c].first_triangle + i];
        ASSERT_EQ(set.cutouts && set.cutouts->has(id), c >= set.first_cutout);
      }
    EXPECT_EQ(triangles, 1000u);
    EXPECT_EQ(set.cutouts == nullptr, cut == Cut::none);
  }
}

TEST(Cutouts, SurviveHostileValues) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e38f};
  for (const float value : bad) {
    Scene scene = one_triangle({255, 0, 255, 0}, 2);
    scene.meshes[0].texcoords.values[1] = {value, value};
    (void)is_hole(scene, {0.3, 0.3, 0});
    (void)is_hole(scene, {double(value), 0, 0});
    scene.materials[0].base_color.a = value;
    EXPECT_EQ(is_hole(scene, {0.1, 0.1, 0}), !(value > 1));
    scene.meshes[0].positions[2] = scene.meshes[0].positions[1];
    (void)is_hole(scene, {0.1, 0.1, 0});
  }
  Scene nothing = one_triangle({255}, 1);
  nothing.textures[0] = Texture();  // unreadable: no texel, no hole
  EXPECT_FALSE(is_hole(nothing, {0.1, 0.1, 0}));
}

}  // namespace
}  // namespace frontmost::test
