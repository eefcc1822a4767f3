// SPDX-License-Identifier: Apache-2.0
// Rays against spheres and patches: answers known on paper, the bound that is stated, and a fine tessellation that
// another index is asked about.
#include "frontmost/curved.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/bezier_patch.h"
#include "scene/shapes.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

Scene scene_with(Mesh mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0)) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({"", 0, world_from_mesh});
  return scene;
}

Scene one_sphere(const Sphere& sphere, const glm::dmat4& world_from_mesh = glm::dmat4(1.0)) {
  Mesh mesh;
  mesh.spheres = {sphere};
  return scene_with(mesh, world_from_mesh);
}

/// The rectangle [0, 3] x [0, 3] of the plane z = height(x, y), control points at whole numbers. Its front looks
/// towards -z.
template <class Height>
BezierPatch sheet(const Height& height) {
  BezierPatch patch;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) patch.points[std::size_t(4 * i + j)] = {i, j, height(i, j)};
  return patch;
}

Scene one_patch(const BezierPatch& patch, const glm::dmat4& world_from_mesh = glm::dmat4(1.0)) {
  Mesh mesh;
  mesh.patches = {patch};
  return scene_with(mesh, world_from_mesh);
}

glm::vec3 unit_vector(Random& random) {
  for (;;) {
    const float x = random.unit(), y = random.unit(), z = random.unit();
    const glm::vec3 v = glm::vec3(x, y, z) * 2.0f - 1.0f;
    if (glm::dot(v, v) > 0.01f && glm::dot(v, v) < 1) return glm::normalize(v);
  }
}

TEST(CurvedSphere, IsMetWhereItIs) {
  const CurvedIndex index(one_sphere({}));
  const CurvedHit hit = closest_hit(index, Ray{{0, 0, 5}, {0, 0, -2}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_DOUBLE_EQ(hit.t, 2);
  EXPECT_TRUE(hit.is_front);
  EXPECT_EQ(hit.normal, glm::dvec3(0, 0, 1));
  EXPECT_DOUBLE_EQ(hit.parameters.x, 0.75);  // from +x by -z, -x to +z
  EXPECT_DOUBLE_EQ(hit.parameters.y, 0.5);
  const CurvedHit inside = closest_hit(index, Ray{{0, 0, 0}, {0, 0.5, 0}});
  EXPECT_DOUBLE_EQ(inside.t, 2);
  EXPECT_FALSE(inside.is_front);
  EXPECT_FALSE(closest_hit(index, Ray{{0, 0, -5}, {0, 0, -1}}));  // behind
  EXPECT_TRUE(closest_hit(index, Ray{{1, 0, 5}, {0, 0, -1}}));    // touches
  EXPECT_FALSE(closest_hit(index, Ray{{1.000001f, 0, 5}, {0, 0, -1}}));
}

TEST(CurvedSphere, IsAnEllipsoidUnderATransform) {
  glm::dmat4 stretched(1.0);
  stretched[0][0] = -3;  // mirrored as well: what was outside stays outside
  stretched[3] = {10, 0, 0, 1};
  const CurvedIndex index(one_sphere({{0, 0, 0}, 2}, stretched));
  const CurvedHit hit = closest_hit(index, Ray{{0, 0, 0}, {1, 0, 0}});
  EXPECT_NEAR(hit.t, 4, 1e-12);
  EXPECT_TRUE(hit.is_front);
  EXPECT_NEAR(hit.normal.x, -1, 1e-12);
  EXPECT_FALSE(closest_hit(index, Ray{{10, 2.001f, 9}, {0, 0, -1}}));
  EXPECT_TRUE(closest_hit(index, Ray{{15.99f, 0, 9}, {0, 0, -1}}));
}

TEST(CurvedSphere, IsMetWithinTheStatedBound) {
  Random random(7);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const double radius = std::pow(2.0, -10 + 20 * double(random.unit()));
    const glm::dvec3 centre = glm::dvec3(unit_vector(random)) * 1000.0;
    const double away = radius * (1 + 1000 * double(random.unit()));
    const glm::vec3 origin(centre + glm::dvec3(unit_vector(random)) * away);
    const glm::dvec3 aim = centre + glm::dvec3(unit_vector(random)) * radius * 1.2;
    const Ray ray{origin, glm::vec3(aim - glm::dvec3(origin))};
    const CurvedHit hit = closest_hit(CurvedIndex(one_sphere({centre, radius})), ray);
    // How near the line passes, in long doubles.
    using Vector = glm::tvec3<long double>;
    const Vector from = Vector(ray.origin) - Vector(centre), along(ray.direction);
    const Vector moment = glm::cross(from, along);
    const long double nearest = std::sqrt(glm::dot(moment, moment) / glm::dot(along, along));
    const double bound = 0x1p-30 * 2 * radius + 0x1p-44 * (glm::length(glm::dvec3(from)) + radius);
    const bool ahead = glm::dot(from, along) < 0 || glm::dot(from, from) < radius * radius;
    if (double(std::abs(nearest - radius)) > bound) {
      EXPECT_EQ(bool(hit), nearest < radius && ahead) << i;
    }
    if (!hit) continue;
    ++met;
    const Vector point = from + along * static_cast<long double>(hit.t);
    EXPECT_LE(double(std::abs(std::sqrt(glm::dot(point, point)) - radius)), bound) << i;
  }
  EXPECT_GT(met, 5000);
}

// Of the way from the centre to where it is met, rounding leaves nothing.
TEST(CurvedSphere, ThatIsSmallerThanARoundingHasANormal) {
  const CurvedIndex index(one_sphere({{0, 0, 0}, 0x1p-200}));
  const float far = 0x1p117f;
  const CurvedHit hit = closest_hit(index, Ray{{-far, -far, 3}, {far, far, -3}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 1);
  EXPECT_TRUE(hit.is_front);
  EXPECT_NEAR(glm::dot(hit.normal, glm::dvec3(1, 1, 0)), -std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(hit.parameters.x >= 0 && hit.parameters.x <= 1 && hit.parameters.y >= 0 && hit.parameters.y <= 1);
}

TEST(CurvedPatch, ThatIsFlatIsMetWhereItIs) {
  const CurvedIndex index(one_patch(sheet([](int, int) { return 2.0; })));
  const CurvedHit hit = closest_hit(index, Ray{{0.75f, 1.5f, -1}, {0, 0, 2}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 1.5, 1e-9);
  EXPECT_NEAR(hit.parameters.x, 0.25, 1e-9);
  EXPECT_NEAR(hit.parameters.y, 0.5, 1e-9);
  EXPECT_NEAR(hit.normal.z, -1, 1e-12);
  EXPECT_TRUE(hit.is_front);
  EXPECT_FALSE(closest_hit(index, Ray{{0.75f, 1.5f, 4}, {0, 0, -1}}).is_front);
  // Its rim and corners belong to it.
  for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(3, 0), glm::vec2(0, 3), glm::vec2(3, 3), glm::vec2(0, 1)})
    EXPECT_TRUE(closest_hit(index, Ray{{at, -1}, {0, 0, 1}})) << at.x << ", " << at.y;
  EXPECT_FALSE(closest_hit(index, Ray{{-0.00001f, 1, -1}, {0, 0, 1}}));
  EXPECT_FALSE(closest_hit(index, Ray{{3.00001f, 1, -1}, {0, 0, 1}}));
}

// z = the cubic Bezier function of x with heights 0, 8, -8, 0: it has roots at 0, 1/2 and 1. A ray along x at height 0
// through the middle comes in at the rim, where it counts as met; a little above it meets both sides of the first hill.
TEST(CurvedPatch, IsMetAtItsNearestOfThreePoints) {
  const CurvedIndex index(one_patch(sheet([](int i, int) { return i == 1 ? 8.0 : i == 2 ? -8.0 : 0.0; })));
  const auto height = [](double u) { return 24 * u * (1 - u) * (1 - u) - 24 * u * u * (1 - u); };
  const CurvedHit left = closest_hit(index, Ray{{-1, 1.5f, 0.5f}, {1, 0, 0}});
  ASSERT_TRUE(left);
  EXPECT_LT(left.parameters.x, 0.1);
  EXPECT_NEAR(height(left.parameters.x), 0.5, 1e-8);
  EXPECT_NEAR(left.t, 1 + 3 * left.parameters.x, 1e-8);
  const CurvedHit right = closest_hit(index, Ray{{4, 1.5f, 0.5f}, {-1, 0, 0}});
  ASSERT_TRUE(right);
  EXPECT_GT(right.parameters.x, 0.4);
  EXPECT_LT(right.parameters.x, 0.5);
  EXPECT_NEAR(height(right.parameters.x), 0.5, 1e-8);
  EXPECT_FALSE(left.is_front);  // both come from above
  EXPECT_FALSE(right.is_front);
  // The top of the hill is at u = (3 - sqrt 3) / 6, where 24 u (1 - u) (1 - 2u) = 4 / sqrt 3.
  EXPECT_TRUE(closest_hit(index, Ray{{-1, 1.5f, 2.309400f}, {1, 0, 0}}));
  EXPECT_FALSE(closest_hit(index, Ray{{-1, 1.5f, 2.309402f}, {1, 0, 0}}));
}

TEST(CurvedPatch, IsMetWithinTheStatedBoundAndWhereItSays) {
  const std::vector<BezierPatch> patches = teapot_patches();
  const CurvedIndex index(builtin("teapot"));
  Random random(11);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 origin = glm::vec3(0, 1.5f, 0) + unit_vector(random) * 9.0f;
    const glm::vec3 aim = glm::vec3(0.2f, 1.3f, 0) + unit_vector(random) * 2.2f;
    const Ray ray{origin, aim - origin};
    const CurvedHit hit = closest_hit(index, ray);
    if (!hit) continue;
    ++met;
    const BezierPatch& patch = patches[hit.primitive];
    const glm::dvec2 uv = hit.parameters;
    const PatchPoint point = evaluate(patch, {uv.x, 1 - uv.x}, {uv.y, 1 - uv.y});
    const glm::dvec3 on_ray = glm::dvec3(ray.origin) + hit.t * glm::dvec3(ray.direction);
    ASSERT_LT(glm::length(point.position - on_ray), 0x1p-30 * 4 + 0x1p-44 * 14) << i << ", patch " << hit.primitive;
    EXPECT_GT(glm::dot(point.normal, hit.normal), 1 - 1e-6) << i;
    EXPECT_EQ(hit.is_front, glm::dot(hit.normal, glm::dvec3(ray.direction)) <= 0);
  }
  EXPECT_GT(met, 8000);
}

// Whatever the tessellation shows surely, the patches show, and nothing nearer.
TEST(CurvedPatch, AgreesWithAFineTessellation) {
  const Scene fine = scene_with(teapot(64));
  const Surfaces surfaces(fine);
  const RayIndex triangles(surfaces);
  const CurvedIndex index(fine);
  constexpr double chord = 0.0015;  // of 64 steps a patch, measured below
  Random random(13);
  int compared = 0, outline = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 origin = glm::vec3(0, 1.5f, 0) + unit_vector(random) * 9.0f;
    const Ray ray{origin, glm::normalize(glm::vec3(0.2f, 1.3f, 0) + unit_vector(random) * 2.2f - origin)};
    const RayHit flat = closest_hit(triangles, ray);
    const CurvedHit curved = closest_hit(index, ray);
    const double slope = curved ? std::abs(glm::dot(curved.normal, glm::dvec3(ray.direction))) : 0;
    // Near an outline either may miss what the other meets.
    if (flat && curved && slope > 0.1 && std::abs(flat.t - curved.t) < chord / slope) {
      ++compared;
      continue;
    }
    if (!flat && !curved) continue;
    ++outline;
    bool is_doubtful = slope <= 0.1;
    for (int k = 0; k < 16 && !is_doubtful; ++k) {
      Ray beside = ray;
      beside.direction += unit_vector(random) * float(3 * chord / 9);
      const RayHit other = closest_hit(triangles, beside);
      is_doubtful = bool(other) != bool(flat) || std::abs(other.t - flat.t) > 0.05;
    }
    EXPECT_TRUE(is_doubtful) << i << ": " << flat.t << " or " << curved.t;
  }
  EXPECT_GT(compared, 8000);
  EXPECT_LT(outline, compared / 10);
}

TEST(CurvedPatch, LeaksNeitherBetweenPatchesNorAtCornersAndPoles) {
  const std::vector<BezierPatch> patches = teapot_patches();
  const CurvedIndex index(builtin("teapot"));
  Random random(17);
  // Body and bottom, patches 4 to 11 and 20 to 23: from within, whatever is below the rim is wall.
  for (int i = 0; i < 6000; ++i) {
    const std::size_t number = random.below(12);
    const BezierPatch& patch = patches[number < 8 ? 4 + number : 12 + number];
    const int side = int(random.below(5));
    const double along = double(random.below(65)) / 64;
    const glm::dvec2 uv = side == 0   ? glm::dvec2(0, along)
                          : side == 1 ? glm::dvec2(1, along)
                          : side == 2 ? glm::dvec2(along, 0)
                          : side == 3 ? glm::dvec2(along, 1)
                                      : glm::dvec2(std::round(along), std::round(along * 3) / 3);
    const glm::dvec3 aim = evaluate(patch, {uv.x, 1 - uv.x}, {uv.y, 1 - uv.y}).position;
    const glm::vec3 origin = glm::vec3(0, 1, 0) + unit_vector(random) * 0.5f;
    if (aim.y > 2.3) continue;  // the open top
    const glm::vec3 direction(aim - glm::dvec3(origin));
    EXPECT_TRUE(closest_hit(index, Ray{origin, direction})) << i;
  }
}

TEST(CurvedPatch, IsCulledByTheSideThatIsMet) {
  const Scene scene = one_sphere({});
  const CurvedIndex index(scene);
  View view;
  view.width = view.height = 33;
  view.world_from_eye = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(glm::radians(40.0), 1, {1, 100});
  const std::size_t middle = 16 * 33 + 16;
  EXPECT_EQ(raycast(index, view).visible.keys[middle], 0.25f);
  view.culling = Culling::back;
  EXPECT_EQ(raycast(index, view).visible.keys[middle], 0.25f);
  view.culling = Culling::front;
  EXPECT_EQ(raycast(index, view).visible.keys[middle], float(1.0 / 6));
  view.culling = Culling::both;
  EXPECT_EQ(raycast(index, view).visible.primitives[middle], no_primitive);
  view.culling = Culling::none;
  view.projection.clip.near = 4.5;  // within the sphere
  EXPECT_EQ(raycast(index, view).visible.keys[middle], 0.75f);
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 9});
  EXPECT_EQ(raycast(index, view).visible.keys[middle], 0.625f);
}

TEST(CurvedIndex, NumbersElementsOverInstances) {
  Scene scene = builtin("cubes");
  Mesh balls;
  balls.spheres = {{{0, 0, 0}, 0.1}, {{0, 4, 0}, 1}};
  balls.patches = {sheet([](int, int) { return 0.0; })};
  scene.meshes.push_back(balls);
  scene.instances.insert(scene.instances.begin() + 1, {"balls", 2, glm::dmat4(1.0)});
  const CurvedIndex index(scene);
  ASSERT_EQ(index.element_count(), 12u + 3 + 12);
  EXPECT_EQ(index.source(11).instance, 0u);
  EXPECT_EQ(index.source(13).instance, 1u);
  EXPECT_EQ(index.source(13).triangle, 1u);
  EXPECT_EQ(index.source(15).instance, 2u);
  EXPECT_EQ(index.source(26).triangle, 11u);
  EXPECT_EQ(closest_hit(index, Ray{{0, 4, 9}, {0, 0, -1}}).primitive, 13u);
  // Triangles keep what their own index says of them.
  const Scene cubes = builtin("cubes");
  const Surfaces surfaces(cubes);
  const RayIndex triangles(surfaces);
  const Ray ray{{0.75f, 1.7f, 9}, {0, 0, -1}};
  const CurvedHit hit = closest_hit(index, ray);
  EXPECT_EQ(hit.t, closest_hit(triangles, ray).t);
  EXPECT_EQ(hit.primitive >= 15 ? hit.primitive - 3 : hit.primitive, closest_hit(triangles, ray).primitive);
}

TEST(CurvedIndex, AnswersAlikeForAnyNumberOfThreads) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 200, 150);
  const CurvedIndex index(scene);
  const CurvedVisible one = raycast(index, view, {.threads = 1}), four = raycast(index, view, {.threads = 4});
  EXPECT_EQ(content_hash(one.visible), content_hash(four.visible));
}

TEST(CurvedIndex, SurvivesWhatIsNoSurface) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double bad : {inf, nan, 1e300}) {
    BezierPatch patch = sheet([](int, int) { return 0.0; });
    patch.points[6].y = bad;
    const CurvedIndex index(one_patch(patch));
    EXPECT_EQ(index.element_count(), 1u);
    (void)closest_hit(index, Ray{{1, 1, 5}, {0, 0, -1}});
    EXPECT_FALSE(closest_hit(CurvedIndex(one_sphere({{0, bad, 0}, 1})), Ray{{0, 0, 5}, {0, 0, -1}}));
  }
  for (const double radius : {0.0, -1.0, inf, nan})
    EXPECT_FALSE(closest_hit(CurvedIndex(one_sphere({{0, 0, 0}, radius})), Ray{{0, 0, 5}, {0, 0, -1}}));
  const glm::dmat4 flattened(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1);
  EXPECT_FALSE(closest_hit(CurvedIndex(one_sphere({}, flattened)), Ray{{0, 0, 5}, {0, 0, -1}}));
  // A patch that a transform flattens is still there.
  EXPECT_TRUE(closest_hit(CurvedIndex(one_patch(teapot_patches()[4], flattened)), Ray{{1.2f, 1.5f, 5}, {0, 0, -1}}));
  const CurvedIndex empty{Scene()};
  EXPECT_FALSE(closest_hit(empty, Ray{}));
  const CurvedIndex sphere(one_sphere({}));
  EXPECT_FALSE(closest_hit(sphere, Ray{{0, 0, 5}, {0, 0, 0}}));
  EXPECT_FALSE(closest_hit(sphere, Ray{{0, 0, 5}, {0, float(nan), 0}}));
}

TEST(CurvedIndex, AnswersForSegmentsBetweenTheirEnds) {
  const CurvedIndex index(one_sphere({{0, 0, 0}, 1}));
  EXPECT_FALSE(closest_hit(index, Segment{{0, 0, 5}, {0, 0, 1.001f}}));
  EXPECT_FALSE(closest_hit(index, Segment{{0, 0, -0.9f}, {0, 0, 0.9f}}));
  const CurvedHit hit = closest_hit(index, Segment{{0, 0, 5}, {0, 0, -3}});
  EXPECT_EQ(hit.t, 0.5);
  EXPECT_FALSE(closest_hit(index, Segment{{0, 0, 5}, {0, 0, 5}}));
  EXPECT_FALSE(closest_hit(index, Segment{{0, 0, 5}, {0, 0, std::numeric_limits<float>::infinity()}}));
  std::vector<CurvedHit> answers(1);
  EXPECT_THROW(closest_hits(index, {}, answers), Error);
}

TEST(CurvedIndex, SegmentsMeetTrianglesToo) {
  Scene scene = one_sphere({{0, 0, 0}, 1});
  scene.meshes.push_back(floor(4, 1));
  scene.instances.push_back({"", 1, glm::translate(glm::dmat4(1.0), {0, 2, 0})});
  const CurvedIndex index(scene);
  std::vector<CurvedHit> answers(2);
  const std::vector<Segment> segments{{{0.25f, 5, 0.5f}, {0.25f, 0, 0.5f}}, {{0.25f, 0, 0.5f}, {0.25f, 1.9f, 0.5f}}};
  closest_hits(index, segments, answers);
  EXPECT_GT(answers[0].primitive, 0u);
  EXPECT_NEAR(answers[0].t, 0.6, 1e-6);
  EXPECT_EQ(answers[1].primitive, 0u);
}

// From the middle of a sphere every ray is as long as the radius, to half an ulp of float.
TEST(CurvedIndex, AScanFromWithinASphereMeetsItAllAround) {
  const CurvedIndex index(one_sphere({{1, 2, 3}, 2}));
  RayCamera camera{Panorama{64, 32}};
  camera.world_from_eye[3] = glm::dvec4(1, 2, 3, 1);
  const CurvedScan met = scan(index, camera), single = scan(index, camera, {.threads = 1});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const std::size_t i = met.scan.index(x, y);
      EXPECT_EQ(met.scan.primitives[i], 0u);
      EXPECT_EQ(met.scan.ranges[i], 2.0f);
      EXPECT_EQ(met.scan.ranges[i], single.scan.ranges[i]);
      EXPECT_LT(glm::length(met.normals[i] - ray_of(camera, x, y).direction), 1e-6f);
    }
}

// Whole curves of roots, or surfaces of them: a bounded search all the same.
TEST(CurvedPatch, ThatDegeneratesEndsTheSearch) {
  const auto flat = [](int, int) { return 0.0; };
  const CurvedIndex sheet_index(one_patch(sheet(flat)));
  (void)closest_hit(sheet_index, Ray{{-1, 1, 0}, {1, 0.25f, 0}});  // along the surface
  (void)closest_hit(sheet_index, Ray{{-1, 1, 0}, {1, 0, 1e-7f}});
  BezierPatch point, line;
  for (std::size_t i = 0; i < 16; ++i) point.points[i] = {1, 1, 1}, line.points[i] = {double(i % 4), 0, 0};
  (void)closest_hit(CurvedIndex(one_patch(point)), Ray{{1, 1, 5}, {0, 0, -1}});
  (void)closest_hit(CurvedIndex(one_patch(line)), Ray{{1, 0, 5}, {0, 0, -1}});
  (void)closest_hit(CurvedIndex(one_patch(line)), Ray{{-5, 0, 0}, {1, 0, 0}});
  // So small that halves round to what they are halves of.
  const glm::dmat4 tiny = glm::scale(glm::dmat4(1.0), glm::dvec3(0x1p-1070));
  (void)closest_hit(CurvedIndex(one_patch(teapot_patches()[4], tiny)), Ray{{0, 0, 0}, {0, 0, -1}});
  // A curve of 2^104, which rays meet for whole curves of parameters.
  for (std::size_t i = 0; i < 16; ++i) line.points[i] = glm::dvec3(double(i % 7) - 3, 0, 0) * 0x1p104;
  (void)closest_hit(CurvedIndex(one_patch(line)), Ray{{0, 0, 3}, {0.1f, 0, -1}});
  // Random nets, folded and self-intersecting, from near and far.
  Random random(23);
  for (int i = 0; i < 300; ++i) {
    BezierPatch wild;
    for (glm::dvec3& p : wild.points) p = unit_vector(random);
    const CurvedIndex index(one_patch(wild));
    for (int k = 0; k < 20; ++k) {
      const glm::vec3 origin = unit_vector(random) * (k < 10 ? 3.0f : 1000.0f);
      const Ray ray{origin, unit_vector(random) * 0.5f - origin};
      const CurvedHit hit = closest_hit(index, ray);
      if (!hit) continue;
      const glm::dvec3 on_ray = glm::dvec3(ray.origin) + hit.t * glm::dvec3(ray.direction);
      const PatchPoint at =
          evaluate(wild, {hit.parameters.x, 1 - hit.parameters.x}, {hit.parameters.y, 1 - hit.parameters.y});
      EXPECT_LT(glm::length(at.position - on_ray), 0x1p-30 * 2 + 0x1p-44 * 1002) << i;
    }
  }
}

}  // namespace
}  // namespace frontmost::test
