// SPDX-License-Identifier: Apache-2.0
// A model scaled by a power of two, which rounds nothing, has the same picture to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "frontmost/shade.h"
#include "frontmost/tessellate.h"
#include "frontmost/zbuffer.h"

namespace frontmost {
namespace {

constexpr int width = 96, height = 72;

Scene scaled(Scene scene, int exponent) {
  const double scale = std::ldexp(1.0, exponent);
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& p : mesh.positions) p *= float(scale);
    for (Sphere& sphere : mesh.spheres) {
      sphere.centre *= scale;
      sphere.radius *= scale;
    }
    for (BezierPatch& patch : mesh.patches)
      for (glm::dvec3& p : patch.points) p *= scale;
  }
  for (Instance& instance : scene.instances)
    for (int axis = 0; axis < 3; ++axis) instance.world_from_mesh[3][axis] *= scale;
  return scene;
}

/// How a picture is made.
struct Way {
  const char* scene;
  Shadows shadows = Shadows::map;
  bool orthographic = false;
  bool has_normals = true;      ///< else they are made smooth
  bool is_tessellated = false;  ///< for the view, where the scene is curved
};

Buffer<std::uint8_t> picture(const Way& way, int exponent) {
  Scene scene = scaled(builtin(way.scene), exponent);
  if (!way.has_normals)
    for (Mesh& mesh : scene.meshes) mesh.normals = {};
  FrameOptions framing;
  framing.orthographic = way.orthographic;
  std::optional<Scene> cut;
  if (way.is_tessellated) {
    const Surfaces coarse(scene);
    cut = tessellate(scene, frame(coarse, width, height, framing), 0.25);
  }
  const Surfaces surfaces(cut ? *cut : scene);
  const View view = frame(surfaces, width, height, framing);
  ShadeOptions options;
  options.shadows = way.shadows;
  return shade_bitmap(surfaces, zbuffer(surfaces, view), options).rgba;
}

TEST(Scale, PowersOfTwoChangeNoBitOfALitPicture) {
  const Way ways[] = {{"gallery"},
                      {"spheres"},
                      {.scene = "spheres", .is_tessellated = true},
                      {.scene = "teapot", .has_normals = false},
                      {.scene = "teapot", .orthographic = true},
                      {.scene = "cubes", .shadows = Shadows::rays},
                      {.scene = "teapot", .shadows = Shadows::rays, .has_normals = false}};
  for (const Way& way : ways) {
    const Buffer<std::uint8_t> expected = picture(way, 0);
    for (const int exponent : {-90, -70, -60, -33, -1, 1, 33, 60, 70, 90}) {
      const Buffer<std::uint8_t> found = picture(way, exponent);
      ASSERT_EQ(found.size(), expected.size());
      std::size_t different = 0;
      for (std::size_t i = 0; i < found.size(); ++i) different += found[i] != expected[i];
      EXPECT_EQ(different, 0u) << way.scene << (way.shadows == Shadows::rays ? " by rays" : "")
                               << (way.orthographic ? " in parallel" : "") << (way.has_normals ? "" : " smoothed")
                               << ", times 2^" << exponent;
    }
  }
}

}  // namespace
}  // namespace frontmost
