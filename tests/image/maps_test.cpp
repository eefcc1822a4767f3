// SPDX-License-Identifier: Apache-2.0
// Depth, distance and id maps of hand-made answers.
#include <cmath>

#include "frontmost/image.h"
#include "frontmost/scene.h"
#include "frontmost/zbuffer.h"
#include "support/odd_numbers.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

/// A picture of four by two pixels; near 1, 90 degrees high.
Visible some_visible(int samples = 1) {
  Visible visible;
  visible.view.width = 4;
  visible.view.height = 2;
  visible.view.samples = samples;
  visible.view.projection = make_projection(1.5707963267948966, 2.0, {1, 100});
  visible.primitives = Buffer<PrimitiveId>(visible.view.sample_count(), no_primitive);
  visible.keys = Buffer<float>(visible.view.sample_count(), 0.0f);
  return visible;
}

std::vector<float> values(const Image& image) {
  const Buffer<float>& plane = image.channels.at(0).floats();
  return {plane.begin(), plane.end()};
}

std::vector<std::uint32_t> ids(const Image& image) {
  const Buffer<std::uint32_t>& plane = image.channels.at(0).integers();
  return {plane.begin(), plane.end()};
}

TEST(Maps, DepthIsPlanarAndInfiniteWhereNothingIsSeen) {
  Visible visible = some_visible();
  visible.primitives[2] = 7;
  visible.keys[2] = 0.25f;  // near / distance
  const Image map = depth_image(visible);
  EXPECT_EQ(map.width, 4);
  EXPECT_EQ(map.height, 2);
  EXPECT_EQ(map.channels.at(0).name, "Z");
  EXPECT_THAT(values(map), testing::ElementsAre(kFloatInfinity, kFloatInfinity, 4, kFloatInfinity, kFloatInfinity,
                                                kFloatInfinity, kFloatInfinity, kFloatInfinity));
  EXPECT_THAT(values(depth_image(visible, -1)), testing::ElementsAre(-1, -1, 4, -1, -1, -1, -1, -1));
}

TEST(Maps, OfManySamplesTheFirstCounts) {
  Visible visible = some_visible(4);
  for (std::size_t i = 0; i < visible.keys.size(); ++i) {
    visible.primitives[i] = 0;
    visible.keys[i] = i < 8 ? 0.5f : 0.25f;
  }
  EXPECT_THAT(values(depth_image(visible)), testing::Each(2.0f));
}

TEST(Maps, RayDistanceIsLongerTowardsTheCorners) {
  Visible visible = some_visible();
  for (std::size_t i = 0; i < 8; ++i) {
    visible.primitives[i] = 0;
    visible.keys[i] = 0.5f;  // a plane at distance 2
  }
  // Half the height at distance 1 is 1, so pixel centres lie at x = +-0.5, +-1.5 and y = +-0.5.
  const float near = 2 * std::sqrt(1.5f), far = 2 * std::sqrt(1 + 2.25f + 0.25f);
  const std::vector<float> distances = values(ray_distance_image(visible));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(distances[i], i % 4 == 1 || i % 4 == 2 ? near : far, 1e-6) << i;
  visible.primitives[5] = no_primitive;
  EXPECT_EQ(values(ray_distance_image(visible))[5], kFloatInfinity);
  EXPECT_EQ(values(ray_distance_image(visible, 0))[5], 0.0f);
}

TEST(Maps, RayDistanceIsThroughTheFirstSample) {
  Visible visible = some_visible(4);
  for (std::size_t i = 0; i < visible.keys.size(); ++i) {
    visible.primitives[i] = 0;
    visible.keys[i] = 1.0f;
  }
  const glm::dvec2 offset = glm::dvec2(sample_offsets(4)[0]) / 256.0;
  const double x = -2 + offset.x, y = 1 - offset.y;
  EXPECT_NEAR(values(ray_distance_image(visible))[0], std::sqrt(1 + x * x + y * y), 1e-6);
}

TEST(Maps, ParallelRaysAreAsLongAsDepths) {
  Visible visible = some_visible();
  visible.view.projection = make_orthographic(-2, 2, -1, 1, {1, 5});
  for (std::size_t i = 0; i < 8; ++i) {
    visible.primitives[i] = 0;
    visible.keys[i] = float(i) / 8;
  }
  EXPECT_EQ(values(ray_distance_image(visible)), values(depth_image(visible)));
  EXPECT_EQ(values(depth_image(visible))[4], 3.0f);  // (far - distance) / (far - near) = 1/2
}

/// Two instances of a mesh of two triangles; the second triangle has a material.
Scene two_squares() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material_ids = {no_index, 0};
  scene.meshes.push_back(mesh);
  scene.materials.resize(1);
  scene.instances.resize(2);
  return scene;
}

TEST(Maps, IdsAreThoseOfTheSource) {
  const Scene scene = two_squares();
  const Surfaces surfaces(scene);
  Visible visible = some_visible();
  const PrimitiveId seen[] = {0, 1, 2, 3, no_primitive, 3, 3, 0};
  std::copy(std::begin(seen), std::end(seen), visible.primitives.begin());
  const Image primitive = id_image(surfaces, visible, IdKind::primitive);
  EXPECT_EQ(primitive.channels.at(0).name, "primitive");
  EXPECT_THAT(ids(primitive), testing::ElementsAreArray(seen));
  EXPECT_THAT(ids(id_image(surfaces, visible, IdKind::object)), testing::ElementsAre(0, 0, 1, 1, no_index, 1, 1, 0));
  EXPECT_THAT(ids(id_image(surfaces, visible, IdKind::material)),
              testing::ElementsAre(no_index, 0, no_index, 0, no_index, 0, 0, no_index));
  visible.primitives[0] = 4;
  EXPECT_EQ(error_of([&] { (void)id_image(surfaces, visible, IdKind::object); }), ErrorCode::bad_argument);
}

TEST(Maps, OfARealPictureAgree) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, frame(surfaces, 120, 90));
  const std::vector<float> depth = values(depth_image(visible)), distance = values(ray_distance_image(visible));
  const auto objects = ids(id_image(surfaces, visible, IdKind::object));
  std::size_t seen = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    ASSERT_EQ(std::isfinite(depth[i]), objects[i] != no_index);
    if (!std::isfinite(depth[i])) continue;
    ++seen;
    ASSERT_GE(distance[i], depth[i]);
    ASSERT_LE(distance[i], depth[i] * 1.2f);
  }
  EXPECT_GT(seen, 2000u);
}

TEST(Maps, PixelsAreCountedById) {
  Image ids{4, 1, {}};
  ids.channels.push_back({"object", Buffer<std::uint32_t>(4)});
  std::uint32_t next = 0;
  for (std::uint32_t& id : ids.channels[0].integers()) id = std::array{2u, 0u, no_index, 2u}[next++];
  EXPECT_THAT(count_pixels(ids, 3), testing::ElementsAre(1, 0, 2));
  EXPECT_THAT(count_pixels(ids, 1), testing::ElementsAre(1));
  EXPECT_TRUE(count_pixels(ids, 0).empty());
  EXPECT_THROW((void)count_pixels(depth_image(some_visible()), 3), Error);
}

}  // namespace
}  // namespace frontmost::test
