// SPDX-License-Identifier: Apache-2.0
// Pictures of scans: colours that can be worked out, and those of a Visible where both mean the same.
#include <gmock/gmock.h>

#include <cmath>

#include "frontmost/raycast.h"
#include "frontmost/shade.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// A wall of one colour at z = -1, wide enough for everything ahead.
Scene wall(const glm::vec4& color) {
  Mesh mesh;
  add_triangle(mesh, {-1000, -1000, -1}, {1000, -1000, -1}, {0, 2000, -1});
  Scene scene = scene_of(mesh);
  scene.materials.emplace_back().base_color = color;
  scene.meshes[0].material_ids = {0};
  return scene;
}

glm::vec4 pixel(const Image& image, std::size_t i) {
  glm::vec4 color;
  for (int k = 0; k < 4; ++k) color[k] = image.channels[std::size_t(k)].floats()[i];
  return color;
}

class ShadeScan : public testing::Test {
 protected:
  [[nodiscard]] Image picture(const ShadeOptions& options, const Execution& execution = {}) const {
    return shade(surfaces_, scan_, options, execution);
  }
  void expect_pixel(const Image& image, int x, int y, const glm::vec4& expected) const {
    const glm::vec4 color = pixel(image, scan_.index(x, y));
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(color[k], expected[k], 1e-6) << "channel " << k;
  }

  Scene scene_ = wall({0.5f, 0.25f, 0.75f, 1});
  Surfaces surfaces_{scene_};
  // The middle looks at the wall straight on; pixel 6 at 60 degrees; the corners lie beyond the circle.
  RangeScan scan_ = scan(RayIndex(surfaces_), {Fisheye{9, 9, glm::radians(180.0)}});
};

TEST_F(ShadeScan, LightComesFromTheEye) {
  const Image lit = picture({});
  expect_pixel(lit, 4, 4, {0.5f, 0.25f, 0.75f, 1});
  // Three of 4.5 pixels from the middle: 60 degrees, whose cosine is a half, above a fifth that is always there.
  expect_pixel(lit, 7, 4, glm::vec4(0.6f * glm::vec3(0.5f, 0.25f, 0.75f), 1));
  expect_pixel(lit, 0, 0, {1, 1, 1, 1});
  expect_pixel(picture({.background = std::nullopt}), 0, 0, {0, 0, 0, 0});
}

TEST_F(ShadeScan, FlatAndNormals) {
  expect_pixel(picture({.shading = Shading::flat}), 7, 4, {0.5f, 0.25f, 0.75f, 1});
  // The wall's normal is +z, which is shown as (0.5, 0.5, 1) in sRGB: 0.2140 in linear light.
  const glm::vec4 normal = pixel(picture({.shading = Shading::normals}), scan_.index(7, 4));
  EXPECT_NEAR(normal.x, 0.2140f, 1e-3);
  EXPECT_NEAR(normal.z, 1, 1e-6);
}

TEST_F(ShadeScan, NearIsBrighterThanFar) {
  const Image depth = picture({.shading = Shading::depth});
  EXPECT_GT(pixel(depth, scan_.index(4, 4)).x, pixel(depth, scan_.index(6, 4)).x);
}

TEST_F(ShadeScan, ObjectsHaveTheColoursOfOtherPictures) {
  View view;
  view.width = view.height = 9;
  view.projection = make_projection(1, 1, {0.1, 10});
  const Image other = shade(surfaces_, raycast(surfaces_, view), {.shading = Shading::ids});
  expect_pixel(picture({.shading = Shading::ids}), 4, 4, pixel(other, 4 * 9 + 4));
}

TEST_F(ShadeScan, ThreadsChangeNothing) {
  EXPECT_EQ(content_hash(picture({}, {.threads = 1})), content_hash(picture({}, {.threads = 4})));
}

TEST_F(ShadeScan, TextureCoordinatesAreNotForScans) { EXPECT_THROW((void)picture({.shading = Shading::uv}), Error); }

TEST_F(ShadeScan, IdsOfAnyGrid) {
  const std::vector<PrimitiveId> ids = {0, no_primitive};
  const Image image = id_image(surfaces_, {2, 1}, ids, IdKind::material);
  EXPECT_EQ(image.channels[0].integers()[0], 0u);
  EXPECT_EQ(image.channels[0].integers()[1], no_index);
  EXPECT_THROW((void)id_image(surfaces_, {3, 1}, ids, IdKind::object), Error);
}

}  // namespace
}  // namespace frontmost::test
