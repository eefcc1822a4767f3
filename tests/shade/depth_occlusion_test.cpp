// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion on the depth map: planes and corners computed by hand, and pictures with it.
#include "shade/occlusion/depth_occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "frontmost/frontmost.h"
#include "shade/support.h"

namespace frontmost::test {
namespace {

using shading::DepthOcclusion;
using shading::FragmentBatch;

/// The faces x = 0, y = 0 and z = 0 of an octant, each from 0 to `size`.
Scene octant(int sides, float size) {
  Scene scene;
  for (int side = 0; side < sides; ++side) {
    Mesh mesh;
    glm::vec3 u(0), v(0);
    u[(side + 1) % 3] = v[(side + 2) % 3] = size;
    add_triangle(mesh, {0, 0, 0}, u, u + v);
    add_triangle(mesh, {0, 0, 0}, u + v, v);
    add(scene, mesh);
  }
  return scene;
}

View looking_into(const glm::dvec3& at, const glm::dvec3& from, double width, bool orthographic) {
  View view;
  view.width = view.height = 401;  // a pixel in the middle
  const double distance = glm::distance(at, from), half = width / 2;
  view.projection = orthographic ? make_orthographic(-half, half, -half, half, {0.01, 100})
                                 : make_projection(2 * std::atan(half / distance), 1, {0.01, 100});
  return view.looking(from, at, {0, 1, 0});
}

/// The unoccluded share of the surroundings at points of a plane within the picture; surfaces beyond `radius` do not
/// count.
std::vector<float> free_sky(const Visible& visible, std::span<const glm::dvec3> points, const glm::dvec3& normal,
                            double radius, Isa isa = Isa::best) {
  const View& view = visible.view;
  DepthOcclusion occlusion;
  occlusion.find(visible, 1, {radius, 1});
  auto batch = std::make_unique<FragmentBatch>();
  for (const glm::dvec3& point : points) {
    const int i = batch->coverage.count++;
    const glm::dvec3 d = point - view.eye();
    const bool is_parallel = view.projection.orthographic;
    const double reach = is_parallel ? 1 : glm::dot(d, view.forward());
    const glm::dvec2 at(glm::dot(d, view.right()) / reach, glm::dot(d, view.up()) / reach);
    const Projection& p = view.projection;
    batch->coverage.screen.set(i, glm::vec2((at.x - p.left) / (p.right - p.left) * view.width,
                                            (p.top - at.y) / (p.top - p.bottom) * view.height));
    batch->geometry.position.set(i, glm::vec3(d));
    batch->geometry.plane_normal.set(i, glm::vec3(normal));
    batch->geometry.to_viewer.set(i, glm::vec3(is_parallel ? -view.forward() : -glm::normalize(d)));
    batch->material.occlusion[i] = 1;
  }
  occlusion.darken(*batch, isa);
  return {batch->material.occlusion.values, batch->material.occlusion.values + points.size()};
}

float free_sky_at(const Scene& scene, const View& view, const glm::dvec3& point, double radius) {
  const Surfaces surfaces(scene);
  return free_sky(zbuffer(surfaces, view), {&point, 1}, {0, 0, 1}, radius)[0];
}

// The floor z = 0 is unoccluded from any viewpoint, as nothing is above it.
TEST(DepthOcclusion, APlaneIsFree) {
  const Scene floor = octant(3, 10);
  Scene alone;
  add(alone, floor.meshes[2]);
  for (const bool orthographic : {false, true})
    for (const glm::dvec3& from : {glm::dvec3(5, 5, 8), glm::dvec3(9, 7, 6), glm::dvec3(15, 9, 1.5)})
      for (const double radius : {0.2, 3.0, 1e30})
        EXPECT_GE(free_sky_at(alone, looking_into({5, 5, 0}, from, 6, orthographic), {5, 5, 0}, radius), 0.998)
            << from.x << " " << radius;
}

/// Cosine-weighted share of the hemisphere that a wall at this distance leaves free; hidden directions count 1 - t * t,
/// with t in units of the radius.
double left_by_wall(double distance) {
  constexpr int n = 1000;
  double hidden = 0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double sine = std::sqrt((i + 0.5) / n), across = sine * std::cos(6.283185307179586 * (k + 0.5) / n);
      const double t = across > 0 ? distance / across : 2;
      if (t < 1) hidden += (1 - t * t) / (double(n) * n);
    }
  return 1 - hidden;
}

// A wall x = 0 on the floor, seen from across. Near the edge it hides half of the sky. A rise that counts less is
// treated as a lower one, so farther away the answer is only close to the integral.
TEST(DepthOcclusion, AWallHidesHalfOfTheSkyAtItsFoot) {
  Scene corner = octant(3, 20);
  corner.instances.erase(corner.instances.begin() + 1);  // removes y = 0
  for (const bool orthographic : {false, true}) {
    const View view = looking_into({0, 10, 0}, {5, 10, 5}, 4, orthographic);
    for (const double d : {0.015, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8})
      EXPECT_NEAR(free_sky_at(corner, view, {d, 10, 0}, 1), left_by_wall(d), 0.06) << d;
    EXPECT_GE(free_sky_at(corner, view, {1.05, 10, 0}, 1), 0.998);
  }
}

TEST(DepthOcclusion, TwoWallsLeaveAQuarterInTheirCorner) {
  for (const bool orthographic : {false, true}) {
    const View view = looking_into({0, 0, 0}, {5, 5, 5}, 4, orthographic);
    EXPECT_NEAR(free_sky_at(octant(3, 20), view, {0.02, 0.02, 0}, 1.5), 0.25, 0.04);
  }
}

// Inside a room, the middle of the floor is unoccluded if the radius is less than the distance to the walls; the
// corners are dark.
TEST(DepthOcclusion, ARoomIsDarkInItsCorners) {
  Scene room = octant(3, 4);
  const glm::dmat4 opposite = glm::rotate(glm::dmat4(1), 3.14159265358979, glm::dvec3(0, 0, 1));
  Scene others = octant(2, 4);
  for (Instance& wall : others.instances) {
    wall.world_from_mesh = opposite;
    wall.world_from_mesh[3] = {4, 4, 0, 1};
  }
  add(room, std::move(others));
  const View view = looking_into({2, 2, 0}, {2, 2, 3.9}, 5, false);
  EXPECT_GE(free_sky_at(room, view, {2, 2, 0}, 1.5), 0.998);
  const float middle = free_sky_at(room, view, {2, 2, 0}, 6), edge = free_sky_at(room, view, {0.05, 2, 0}, 6),
              corner = free_sky_at(room, view, {0.05, 0.05, 0}, 6);
  EXPECT_LT(edge, middle - 0.3);
  EXPECT_LT(corner, edge - 0.15);
  EXPECT_NEAR(corner, 0.25, 0.06);
}

TEST(DepthOcclusion, EveryInstructionSetGivesTheSameBits) {
  const Scene scene = octant(3, 20);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, looking_into({0, 0, 0}, {5, 4, 6}, 4, false));
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 101; ++i) points.emplace_back(0.013 * i, 0.9 - 0.007 * i, 0);
  for (const double radius : {1e-30, 0.7, 1e30}) {
    const std::vector<float> expected = free_sky(visible, points, {0, 0, 1}, radius);
    for (const float value : expected) EXPECT_TRUE(value >= 0 && value <= 1) << value;
    for (const Isa isa : available_isas())
      EXPECT_EQ(free_sky(visible, points, {0, 0, 1}, radius, isa), expected) << name(isa);
  }
}

/// The sum of a pixel's colour channels.
float brightness(const Image& image, int x, int y) {
  const std::size_t i = std::size_t(y * image.width + x);
  return image.channels[0].floats()[i] + image.channels[1].floats()[i] + image.channels[2].floats()[i];
}

constexpr AmbientOcclusion kNear{1, 1.0};

ShadeOptions options_with(std::optional<AmbientOcclusion> occlusion) {
  return {.light = {.shadows = Shadows::off, .ambient_occlusion = occlusion}};
}

TEST(DepthOcclusion, DarkensAPictureWhereSomethingIsNear) {
  const Scene scene = octant(3, 20);
  const Surfaces surfaces(scene);
  for (const int samples : {1, 4}) {
    View view = looking_into({0, 0, 0}, {5, 5, 5}, 4, false);
    view.samples = samples;
    const Visible visible = zbuffer(surfaces, view);
    const Image plain = shade(surfaces, visible, options_with({})),
                dark = shade(surfaces, visible, options_with(kNear)),
                half = shade(surfaces, visible, options_with(AmbientOcclusion{0.5, 1.0}));
    EXPECT_LT(brightness(dark, 200, 190), brightness(plain, 200, 190) - 0.1f);
    EXPECT_NEAR(brightness(half, 200, 190), (brightness(dark, 200, 190) + brightness(plain, 200, 190)) / 2, 1e-4);
    EXPECT_NEAR(brightness(dark, 20, 100), brightness(plain, 20, 100), 2e-3);
    EXPECT_EQ(content_hash(shade(surfaces, pixels_of(visible), options_with(kNear))), content_hash(dark));
    for (const int threads : {1, 3})
      for (const Isa isa : available_isas())
        EXPECT_EQ(content_hash(shade(surfaces, visible, options_with(kNear), {.threads = threads, .isa = isa})),
                  content_hash(dark));
  }
}

// Panes are ignored: the corner behind them is as dark as without them.
TEST(DepthOcclusion, IsThatOfWhatIsOpaque) {
  const Scene corner = octant(3, 20);
  Scene behind_glass = corner;
  Material glass = colored({1, 1, 1, 0});
  glass.alpha = Material::Alpha::blend;
  behind_glass.materials = {Material{}, glass};
  Mesh pane = square();
  pane.material_ids = {1};
  add(behind_glass, pane, glm::translate(glm::dmat4(1), glm::dvec3(2, 2, 2)));
  const Surfaces plain(corner), seen(behind_glass);
  const View view = looking_into({0, 0, 0}, {5, 5, 5}, 4, false);
  const Image one = shade(plain, zbuffer(plain, view), options_with(kNear)),
              other = shade(seen, zbuffer(seen, view), options_with(kNear));
  for (const glm::ivec2& at : {glm::ivec2(200, 190), glm::ivec2(200, 230), glm::ivec2(180, 210)})
    EXPECT_NEAR(brightness(one, at.x, at.y), brightness(other, at.x, at.y), 1e-3);
}

TEST(DepthOcclusion, FiguresHaveIt) {
  const Scene scene = octant(3, 20);
  const Surfaces surfaces(scene);
  View view = looking_into({0, 0, 0}, {5, 5, 5}, 4, false);
  const Visible visible = zbuffer(surfaces, view);
  const Figure plain = draw_figure(surfaces, visible, {.shade = options_with({})}),
               dark = draw_figure(surfaces, visible, {.shade = options_with(kNear)});
  EXPECT_GT(dark.shapes.size(), plain.shapes.size());  // cut where it gets darker
}

TEST(DepthOcclusion, OptionsOutOfRangeAreRefused) {
  const Scene scene = octant(1, 1);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, frame(surfaces, 8, 8));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const AmbientOcclusion& wrong : {AmbientOcclusion{-0.1}, AmbientOcclusion{1.1}, AmbientOcclusion{nan},
                                        AmbientOcclusion{1, 0.0}, AmbientOcclusion{1, nan}}) {
    EXPECT_THROW((void)shade(surfaces, visible, options_with(wrong)), Error);
    EXPECT_THROW((void)draw_figure(surfaces, visible, {.shade = options_with(wrong)}), Error);
  }
}

}  // namespace
}  // namespace frontmost::test
