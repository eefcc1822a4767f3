// SPDX-License-Identifier: Apache-2.0
// Eyes at vertices, on edges, inside triangles and in their planes: a triangle seen edge-on covers nothing.

#include <gtest/gtest.h>

#include <algorithm>

#include "eye_oracle.h"
#include "frontmost/precision.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "indexed_scene.h"
#include "ray_oracle.h"
#include "support/effort.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

View view_from(const glm::dvec3& eye, const glm::dvec3& along, double near = 1e-3) {
  View view;
  view.width = 24, view.height = 18;
  view.world_from_eye = look_at(eye, eye + along, std::abs(along.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0));
  view.projection = make_projection(glm::radians(90.0), 4.0 / 3, {near, 100});
  return view;
}

/// A triangle in the plane z = 0, with a wall behind it at y = 4.
Scene triangle_before_a_wall() {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  add_triangle(mesh, {-90, 4, -90}, {90, 4, -90}, {0, 4, 90});
  return scene_of(mesh);
}

TEST(EyesOnSurfaces, SeeWhatIsBehindATriangleInTheirPlane) {
  const Scene scene = triangle_before_a_wall();
  const Surfaces surfaces(scene);
  const glm::dvec3 eyes[] = {{0, 0, 0},     {2, 0, 0}, {0, 2, 0},  {1, 0, 0},
                             {0.5, 0.5, 0}, {1, 1, 0}, {0, -1, 0}, {-3, 1, 0}};
  for (const glm::dvec3& eye : eyes)
    for (const glm::dvec3& along : {glm::dvec3(0, 1, 0), glm::dvec3(0.1, 1, 0), glm::dvec3(-0.3, 0.9, 0.2)})
      for (const Isa isa : available_isas()) {
        SCOPED_TRACE(testing::Message() << eye.x << " " << eye.y << " " << along.x << " " << int(isa));
        const Visible seen = raycast(surfaces, view_from(eye, along), {.isa = isa});
        for (const PrimitiveId id : seen.primitives) ASSERT_EQ(id, 1u);
      }
}

TEST(EyesOnSurfaces, LookAlongATriangleInParallel) {
  const Scene scene = triangle_before_a_wall();
  const Surfaces surfaces(scene);
  for (const glm::dvec3& eye :
       {glm::dvec3(0, 0, 0), glm::dvec3(1, -2, 0), glm::dvec3(0.5, 0.5, 0), glm::dvec3(1, 1, 1)})
    for (const glm::dvec3& along : {glm::dvec3(0, 1, 0), glm::dvec3(0.1, 1, 0), glm::dvec3(-0.25, 0.5, 0)})
      for (const Isa isa : available_isas()) {
        View view = view_from(eye, along);
        view.projection = make_orthographic(-3, 3, -2.25, 2.25, {1e-3, 100});
        const Visible seen = raycast(surfaces, view, {.isa = isa});
        for (const PrimitiveId id : seen.primitives) ASSERT_EQ(id, 1u);
      }
}

TEST(EyesOnSurfaces, SeeTheCityFromACornerOfIt) {
  const Scene scene = builtin("city");
  const Surfaces surfaces(scene);
  View view = view_from({8, 0, 25}, {1, 0, 0});
  view.width = 160, view.height = 90;
  view.projection = make_projection(glm::radians(30.0), 16.0 / 9, {0.04, 400});
  EXPECT_EQ(covered(raycast(surfaces, view)), 6413u);
  EXPECT_EQ(covered(zbuffer(surfaces, view)), 6413u);
}

/// Compares rays with another search: differences must be within rounding of an edge or of another depth. \returns
/// their number.
std::uint64_t expect_explained(const Surfaces& surfaces, const Visible& expected, const Visible& seen) {
  const View& view = seen.view;
  const Agreement answer = check_agreement(surfaces, expected, seen);
  const auto first = std::find(answer.differences.begin(), answer.differences.end(), Difference::unexplained);
  const auto pixel = std::size_t(first - answer.differences.begin()), width = std::size_t(view.width);
  EXPECT_EQ(answer.count(Difference::unexplained), 0u) << "first at pixel " << pixel % width << ", " << pixel / width;
  return answer.differing();
}

/// A direction in the triangle's plane, or any direction.
glm::dvec3 look_from(Random& random, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 ab = glm::dvec3(corners[1]) - glm::dvec3(corners[0]);
  const glm::dvec3 ac = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
  glm::dvec3 along = random.below(2) ? double(random.within(-1, 1)) * ab + double(random.within(-1, 1)) * ac
                                     : glm::dvec3(random.point(1));
  return glm::length(along) > 1e-9 ? glm::normalize(along) : glm::dvec3(0, 0, 1);
}

View eye_on(Random& random, const std::array<glm::vec3, 3>& corners, EyePlace place) {
  const glm::dvec3 along = look_from(random, corners);
  const double near = random.below(2) ? 1e-3 : 0.05;
  View view = view_from(eye_beside(random, corners, place), along, near);
  if (random.below(4) == 0) view.projection = make_orthographic(-0.9, 1.1, -0.8, 0.7, {near, 100});
  return view;
}

class EyesOnEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(EyesOnSurfaces, EyesOnEveryKind, testing::ValuesIn(all_kinds));

TEST_P(EyesOnEveryKind, SeeWhatAPlainSearchFinds) {
  std::uint64_t differing = 0, samples = 0;
  for (std::uint64_t seed = 0; seed < seeds(120); ++seed) {
    Random random(seed + 77);
    const Scene scene = scene_of(random_mesh(GetParam(), 40, seed));
    const Surfaces surfaces(scene);
    for (const EyePlace place : all_eye_places) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", place " << int(place));
      const auto id = PrimitiveId(random.below(int(surfaces.primitive_count())));
      const View view = eye_on(random, surfaces.corners(id), place);
      differing += expect_explained(surfaces, EyeOracle(surfaces, view).look(), raycast(surfaces, view));
      samples += view.sample_count();
    }
  }
  EXPECT_LT(differing, samples / 20) << "reasons have become the excuse";
}

TEST_P(EyesOnEveryKind, SeeTheSameOnEveryInstructionSet) {
  for (std::uint64_t seed = 0; seed < seeds(20); ++seed) {
    Random random(seed + 177);
    const Scene scene = scene_of(random_mesh(GetParam(), 40, seed));
    const Surfaces surfaces(scene);
    for (const EyePlace place : all_eye_places) {
      const auto id = PrimitiveId(random.below(int(surfaces.primitive_count())));
      const View view = eye_on(random, surfaces.corners(id), place);
      const Visible expected = ray_oracle(surfaces, view);
      for (const Isa isa : available_isas()) expect_same(expected, raycast(surfaces, view, {.isa = isa}));
    }
  }
}

/// First hits of single rays between the near and far planes.
Visible by_single_rays(const Indexed& in, const View& view) {
  Visible visible = nothing_visible(view);
  const Projection& p = view.projection;
  const double near = p.clip.near, far = p.clip.far;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 aside = (p.left + (x + 0.5) / view.width * (p.right - p.left)) * view.right() +
                               (p.top - (y + 0.5) / view.height * (p.top - p.bottom)) * view.up();
      const glm::vec3 along(view.forward() + aside);
      const double ahead = glm::dot(glm::dvec3(along), view.forward());
      for (const RayHit& hit : all_hits(in.index, Ray{glm::vec3(view.eye()), along})) {
        if (hit.t * ahead < near || hit.t * ahead > far) continue;
        visible.primitives[visible.index(x, y)] = hit.primitive;
        visible.keys[visible.index(x, y)] = float(double(float(near)) / (hit.t * ahead));
        break;
      }
    }
  return visible;
}

TEST(EyesOnSurfaces, SeeWhatSingleRaysMeetInBuiltInScenes) {
  for (const std::string_view name : builtin_names()) {
    const Indexed in(builtin(name));
    const std::size_t triangles = in.surfaces.primitive_count();
    if (triangles > 200'000) continue;
    const Box bounds = in.surfaces.bounds();
    const double size = glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
    std::uint64_t differing = 0, samples = 0;
    for (std::uint64_t seed = 0; seed < seeds(triangles > 50'000 ? 20 : 60); ++seed) {
      Random random(seed + 31);
      for (const EyePlace place : all_eye_places) {
        SCOPED_TRACE(testing::Message() << name << ", seed " << seed << ", place " << int(place));
        const auto corners = in.surfaces.corners(PrimitiveId(random.below(int(triangles))));
        // Ray origins are floats.
        const glm::dvec3 eye(glm::vec3(eye_beside(random, corners, place)));
        View view = view_from(eye, look_from(random, corners));
        view.projection = make_projection(glm::radians(70.0), 4.0 / 3, {1e-4 * size, 2 * size});
        differing += expect_explained(in.surfaces, by_single_rays(in, view), raycast(in.index, view));
        samples += view.sample_count();
      }
    }
    EXPECT_LT(differing, samples / 20) << name << ": reasons have become the excuse";
  }
}

TEST(EyesOnSurfaces, NoRayMeetsATriangleInItsPlane) {
  const Indexed in(triangle_before_a_wall());
  const glm::vec3 origins[] = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0.5f, 0.5f, 0}, {1, 1, 0}, {0, -1, 0}, {-3, 1, 0}};
  for (const glm::vec3& origin : origins) {
    SCOPED_TRACE(testing::Message() << origin.x << " " << origin.y);
    for (const glm::vec3& along : {glm::vec3(0, 1, 0), glm::vec3(0.1f, 1, 0), glm::vec3(-0.3f, 0.9f, 0)}) {
      EXPECT_EQ(closest_hit(in.index, Ray{origin, along}).primitive, 1u);
      EXPECT_EQ(all_hits(in.index, Ray{origin, along}).size(), 1u);
      EXPECT_TRUE(is_clear(in.index, Segment{origin, origin + along}));
    }
    for (const glm::vec3& along : {glm::vec3(1, -0.5f, 0), glm::vec3(0, 0, 1), glm::vec3(0.5f, -0.5f, -1)})
      EXPECT_FALSE(closest_hit(in.index, Ray{origin, along})) << "a triangle that the origin lies in is not met";
  }
}

TEST(EyesOnSurfaces, AroundThemIsWhatIsNotInTheirPlane) {
  const Indexed in(triangle_before_a_wall());
  for (const glm::dvec3& eye :
       {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0.5, 0.5, 0), glm::dvec3(0, -1, 0)})
    for (const RayCamera& camera : {RayCamera{Panorama{16, 9}}, RayCamera{Fisheye{15, 15, glm::radians(180.0)}},
                                    RayCamera{Lidar{{0.0, 0.1, -0.2}, 32}}}) {
      RayCamera placed = camera;
      placed.world_from_eye = look_at(eye, eye + glm::dvec3(0, 1, 0), {0, 0, 1});
      const RangeScan around = scan(in.index, placed);
      EXPECT_EQ(std::count(around.primitives.begin(), around.primitives.end(), 0u), 0);
      EXPECT_GT(std::count(around.primitives.begin(), around.primitives.end(), 1u), 0);
    }
}

TEST(EyesOnSurfaces, ALightInTheirPlaneThrowsNoShadowOfThem) {
  const Indexed in(triangle_before_a_wall());
  TrianglePoint beside;
  beside.corners = {glm::vec3(0, -1, 0), glm::vec3(0, -1, 0.5f), glm::vec3(0.5f, -1, 0)};
  std::vector<TrianglePoint> points;
  for (const glm::vec3& weights : {glm::vec3(1, 0, 0), glm::vec3(1, 0, 1), glm::vec3(1, 1, 0)}) {
    points.push_back(beside);
    points.back().weights = weights;
  }
  std::vector<std::uint8_t> lit(points.size());
  are_lit(in.index, points, {0, 1, 0}, lit);
  // The wall shades all points, whatever lies in their plane; towards the other side nothing shades them.
  EXPECT_EQ(std::count(lit.begin(), lit.end(), 0), 3);
  are_lit(in.index, points, {1, 0, 0}, lit);
  EXPECT_EQ(std::count(lit.begin(), lit.end(), 1), 3);
  for (TrianglePoint& point : points) point.corners = {glm::vec3(0, 0, 0), glm::vec3(2, 0, 0), glm::vec3(1, -3, 1)};
  are_lit(in.index, points, {0.25f, 1, 0}, lit);
  EXPECT_EQ(std::count(lit.begin(), lit.end(), 0), 3);
}

}  // namespace
}  // namespace frontmost::test
