// SPDX-License-Identifier: Apache-2.0
// A teapot whose outline and depth others have drawn (daniilidis-group/neural_renderer, tests/data): compares every
// pixel of the outline, and every depth to the eight bits in which it is stored.

#include <algorithm>
#include <fstream>
#include <iterator>

#include "frontmost/frontmost.h"
#include "io/images/formats.h"
#include "support/models.h"

namespace frontmost::test {
namespace {

Texture picture(const std::string& relative) {
  std::ifstream file(model(relative), std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  return decode_texture(std::as_bytes(std::span(bytes)), relative);
}

/// The model, scaled as the references' notes say, and mirrored, as their camera is left-handed.
Scene scaled_teapot() {
  Scene scene = load(model("reference/teapot/teapot.obj"));
  const Surfaces surfaces(scene);
  const glm::dvec3 low(surfaces.bounds().low), size = glm::dvec3(surfaces.bounds().high) - low;
  const double scale = 2 / std::max({size.x, size.y, size.z});
  for (Instance& instance : scene.instances) {
    const glm::dvec3 move = -low * scale - size * scale / 2.0;
    instance.world_from_mesh = glm::dmat4(-scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, -move.x, move.y, move.z, 1);
  }
  return scene;
}

TEST(TeapotReference, OutlineAndDepthAreTheirs) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = scaled_teapot();
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 256;
  view.world_from_eye = look_at({0, 0, -2.7320508}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(1.0471975511965976, 1, {0.1, 100});
  const Visible visible = zbuffer(surfaces, view);
  const Buffer<float> depth = depths_of(visible);
  const Texture outline = picture("reference/teapot/teapot_blender.png");
  const Texture stored = picture("reference/teapot/teapot_depth.png");
  ASSERT_EQ(outline.pixels.size(), depth.size());
  ASSERT_EQ(stored.pixels.size(), depth.size());

  float nearest = 1e9f, farthest = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (visible.primitives[i] == no_primitive) continue;
    nearest = std::min(nearest, depth[i]);
    farthest = std::max(farthest, depth[i]);
  }
  // Half a step of eight bits is 0.00196; an independent rasteriser without snapping differs by up to 0.0028.
  constexpr double kStoredPrecision = 0.0029;
  std::size_t outline_differs = 0, depth_differs = 0, covered = 0;
  double worst = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const bool seen = visible.primitives[i] != no_primitive;
    const glm::u8vec4& p = outline.pixels[i];
    outline_differs += seen != !(p.r == 255 && p.g == 255 && p.b == 255);
    covered += seen;
    if (!seen) continue;
    const double error = std::abs(double(stored.pixels[i].r) / 255 - (depth[i] - nearest) / (farthest - nearest));
    worst = std::max(worst, error);
    depth_differs += error > kStoredPrecision;
  }
  EXPECT_GT(covered, 5000u);
  EXPECT_EQ(outline_differs, 0u);
  // At pixel (79, 161) the surface is so steep that a shift of 1/128 pixel is three steps of eight bits.
  EXPECT_LE(depth_differs, 1u);
  EXPECT_LT(worst, 0.008);
}

}  // namespace
}  // namespace frontmost::test
