// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/random_scene.h"
#include "surfaces/cluster_set.h"

namespace frontmost::test {
namespace {

using LeftOut = std::vector<std::uint32_t>;

/// A grid of n x n squares from `low` to `high`, which may be flat.
Mesh sheet_of(const glm::vec3& low, const glm::vec3& high, int n) {
  Mesh mesh;
  const auto at = [&](int x, int z) {
    return glm::vec3(low.x + (high.x - low.x) * float(x) / float(n), (x + z) % 2 ? low.y : high.y,
                     low.z + (high.z - low.z) * float(z) / float(n));
  };
  for (int x = 0; x < n; ++x)
    for (int z = 0; z < n; ++z) {
      add_triangle(mesh, at(x, z), at(x, z + 1), at(x + 1, z));
      add_triangle(mesh, at(x + 1, z), at(x, z + 1), at(x + 1, z + 1));
    }
  return mesh;
}

Mesh box_of(const glm::vec3& middle, float half, int n = 3) {
  return sheet_of(middle - glm::vec3(half), middle + glm::vec3(half), n);
}

/// Nine houses of size 10 within 100.
Scene village() {
  Scene scene;
  for (int x = -1; x <= 1; ++x)
    for (int z = -1; z <= 1; ++z) add(scene, box_of({45.0f * float(x), 5, 45.0f * float(z)}, 5));
  return scene;
}

Subject subject_of(const Scene& scene) {
  const Surfaces surfaces(scene);
  return find_subject(surfaces);
}

LeftOut left_out_of(const Scene& scene) { return subject_of(scene).left_out; }

TEST(Subject, IsTheVillageOnItsPlane) {
  for (const int n : {1, 100}) {  // also with a finely divided plane
    Scene scene = village();
    const Box houses = Surfaces(scene).bounds();
    add(scene, sheet_of({-1000, 0, -1000}, {1000, 0, 1000}, n));
    const Subject subject = subject_of(scene);
    EXPECT_EQ(subject.left_out, LeftOut{9});
    EXPECT_EQ(subject.bounds.low, houses.low);
    EXPECT_EQ(subject.bounds.high, houses.high);
  }
}

TEST(Subject, IsWhatADomeIsAround) {
  Scene scene = village();
  add(scene, box_of({0, 0, 0}, 5000, 16));
  add(scene, sheet_of({-1000, 0, -1000}, {1000, 0, 1000}, 1));
  EXPECT_EQ(left_out_of(scene), (LeftOut{9, 10}));
}

TEST(Subject, IsNotWhatWasLostFarAway) {
  Scene scene = village();
  add(scene, box_of({1e6f, 3, 20}, 0.01f, 6));
  add(scene, box_of({1e6f, 3, 21}, 0.01f, 6));  // two at one place; removing one alone does not shrink the bounds
  Mesh point;
  add_triangle(point, {0, -1e7f, 0}, {0, -1e7f, 0}, {0, -1e7f, 0});
  add(scene, point);
  EXPECT_EQ(left_out_of(scene), (LeftOut{9, 10, 11}));
  // The result is the same wherever the village stands, and in any order.
  Scene other;
  add(other, box_of({1e6f + 500, 3, 20}, 0.01f, 6));
  Scene moved = village();
  for (Instance& house : moved.instances) house.world_from_mesh[3] = {500, 40, -70, 1};
  add(other, std::move(moved));
  EXPECT_EQ(left_out_of(other), LeftOut{0});
}

// A gap of exactly eight counts; one a bit smaller does not.
TEST(Subject, NeedsAGapOfEight) {
  for (const float far : {7.99f, 8.0f}) {
    Scene scene;
    for (int i = 0; i < 4; ++i) add(scene, sheet_of({-1, 0, -1}, {1, 0, 1}, 3));
    add(scene, sheet_of({-far, 0, -far}, {far, 0, far}, 1));
    EXPECT_EQ(left_out_of(scene), far < 8 ? LeftOut{} : LeftOut{4});
  }
}

// Interest grows with the square root of the number of triangles: n for a sheet of 2 n * n. The subject needs 3 of 5.
TEST(Subject, NeedsThreeFifthsOfTheInterest) {
  for (const int n : {15, 16, 17}) {
    Scene scene;
    add(scene, sheet_of({-1, 0, -1}, {1, 0, 1}, 36));
    add(scene, sheet_of({-50, 0, -50}, {50, 0, 50}, n));
    EXPECT_EQ(left_out_of(scene), n <= 16 ? LeftOut{1} : LeftOut{}) << n;
  }
}

TEST(Subject, IsAllWhereNothingStandsOut) {
  EXPECT_EQ(left_out_of({}), LeftOut{});
  EXPECT_EQ(left_out_of(village()), LeftOut{});
  Scene single;
  add(single, box_of({0, 0, 0}, 1));
  single.meshes[0].positions[0] = {1e6f, 0, 0};  // an unused vertex is no object
  EXPECT_EQ(left_out_of(single), LeftOut{});
  Scene furniture;  // on a floor five times as large
  for (const float x : {-0.5f, 0.5f}) add(furniture, box_of({x, 0.4f, 0}, 0.4f));
  add(furniture, sheet_of({-5, 0, -5}, {5, 0, 5}, 1));
  EXPECT_EQ(left_out_of(furniture), LeftOut{});
  Scene plate;  // with holes, and with one bolt in it
  add(plate, sheet_of({-50, 0, -50}, {50, 1, 50}, 10));
  add(plate, box_of({30, 1, 20}, 1, 16));
  EXPECT_EQ(left_out_of(plate), LeftOut{});
  Scene street;  // every house twice as far as the previous one
  for (float x = 10; x < 5000; x *= 2) add(street, box_of({x, 0, 0}, 4));
  EXPECT_EQ(left_out_of(street), LeftOut{});
}

TEST(Subject, HasNoUseForObjectsThatCannotBeSeen) {
  Scene scene = village();
  Mesh broken = box_of({0, 0, 0}, 1, 200);
  for (glm::vec3& p : broken.positions) p.x = std::numeric_limits<float>::quiet_NaN();
  add(scene, broken);
  add(scene, Mesh());
  EXPECT_EQ(left_out_of(scene), LeftOut{});
  Scene points;  // one point has all of the interest, and no extent
  Mesh point;
  for (int i = 0; i < 1000; ++i) add_triangle(point, {1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  add(points, point);
  add(points, box_of({0, 0, 0}, 1, 2));
  EXPECT_EQ(left_out_of(points), LeftOut{});
}

/// Compares the views of two scenes, one with more objects.
void expect_same_place(const View& one, const View& other) {
  EXPECT_EQ(one.world_from_eye, other.world_from_eye);
  EXPECT_EQ(one.projection.left, other.projection.left);
  EXPECT_EQ(one.projection.top, other.projection.top);
}

TEST(Subject, IsFramedAsIfItWereAlone) {
  const Scene alone = village();
  Scene scene = village();
  add(scene, sheet_of({-1000, 0, -1000}, {1000, 0, 1000}, 1));
  add(scene, box_of({0, 0, 0}, 1e6f, 4));
  const Surfaces houses(alone), surfaces(scene);
  const View view = frame(surfaces, 320, 200);
  expect_same_place(view, frame(houses, 320, 200));
  (void)cluster_set(surfaces);
  expect_same_place(view, frame(surfaces, 320, 200));
  // The planes include objects outside the subject, but not at the subject's expense.
  EXPECT_GT(view.projection.clip.far, 9e5);
  const double near = frame(houses, 320, 200).projection.clip.near;
  EXPECT_LE(view.projection.clip.near, near);
  EXPECT_GT(frame(surfaces, 320, 200, {.objects = FramedObjects::all}).projection.clip.far, 3e6);
  expect_same_place(frame(houses, 320, 200, {.objects = FramedObjects::all}), frame(houses, 320, 200));
}

// The eye of the parallel projection stands inside the dome, which would hide everything from farther away.
TEST(Subject, IsNotHiddenInParallelProjection) {
  Scene scene = village();
  const Box houses = Surfaces(scene).bounds();
  add(scene, box_of({0, 0, 0}, 2000, 4));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 200, {.orthographic = true});
  EXPECT_EQ(view.projection.clip.near, 0);
  EXPECT_LT(glm::length(view.eye()), 1000);
  const ClipDistances planes = fit_clip(houses, view.world_from_eye, true);
  EXPECT_GT(planes.near, 0);
  EXPECT_LT(planes.far, view.projection.clip.far);
  const Scene without = village();
  const View alone = frame(Surfaces(without), 320, 200, {.orthographic = true});
  EXPECT_EQ(view.projection.top, alone.projection.top);
  EXPECT_EQ(view.projection.right, alone.projection.right);
}

}  // namespace
}  // namespace frontmost::test
