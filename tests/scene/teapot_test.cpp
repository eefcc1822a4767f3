// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "scene/bezier_patch.h"
#include "scene/shapes.h"
#include "scene/topology.h"

namespace frontmost {
namespace {

TEST(TeapotPatches, AreNewellsInNumberAndExtent) {
  const std::vector<BezierPatch> patches = teapot_patches();
  ASSERT_EQ(patches.size(), 32u);
  glm::dvec3 low(9), high(-9);
  for (const BezierPatch& patch : patches)
    for (const glm::dvec3& p : patch.points) low = glm::min(low, p), high = glm::max(high, p);
  // The bounds of the published points, with height along y.
  EXPECT_EQ(low, glm::dvec3(-3, 0, -2));
  EXPECT_EQ(high, glm::dvec3(3.525, 3.15, 2));
}

// A few of the published points, by patch and index: corners of the rim, the body's belly, handle and spout.
TEST(TeapotPatches, HoldPublishedPoints) {
  const std::vector<BezierPatch> patches = teapot_patches();
  EXPECT_EQ(patches[0].points[0], glm::dvec3(1.4, 2.4, 0));
  EXPECT_EQ(patches[0].points[5], glm::dvec3(1.3375, 2.53125, 0.749));
  EXPECT_EQ(patches[4].points[15], glm::dvec3(0, 0.9, 2));
  EXPECT_EQ(patches[12].points[0], glm::dvec3(0, 3.15, 0));
  EXPECT_EQ(patches[24].points[1], glm::dvec3(-1.6, 2.025, 0.3));
  EXPECT_EQ(patches[30].points[7], glm::dvec3(3.525, 2.49375, 0));
}

TEST(TeapotPatches, MeetInBitEqualPointsFromBothSides) {
  const BezierPatch patch = teapot_patches()[4];
  BezierPatch reversed = patch;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) reversed.points[4 * i + j] = patch.points[4 * i + 3 - j];
  for (int whole = 1; whole <= 40; ++whole)
    for (int part = 0; part <= whole; ++part) {
      const glm::dvec3 a = evaluate(patch, fraction(0, 1), fraction(part, whole)).position;
      const glm::dvec3 b = evaluate(reversed, fraction(0, 1), fraction(whole - part, whole)).position;
      ASSERT_EQ(a, b) << part << "/" << whole;
    }
}

TEST(TeapotPatches, SlopesAreThoseOfThePositions) {
  for (const BezierPatch& patch : teapot_patches()) {
    constexpr int kWhole = 100000;
    const PatchPoint at = evaluate(patch, fraction(30000, kWhole), fraction(60000, kWhole));
    const glm::dvec3 u = evaluate(patch, fraction(30001, kWhole), fraction(60000, kWhole)).position -
                         evaluate(patch, fraction(29999, kWhole), fraction(60000, kWhole)).position;
    const glm::dvec3 v = evaluate(patch, fraction(30000, kWhole), fraction(60001, kWhole)).position -
                         evaluate(patch, fraction(30000, kWhole), fraction(59999, kWhole)).position;
    EXPECT_LT(glm::length(u * (kWhole / 2.0) - at.along_u), 1e-6);
    EXPECT_LT(glm::length(v * (kWhole / 2.0) - at.along_v), 1e-6);
    EXPECT_NEAR(glm::dot(at.normal, at.along_u), 0, 1e-12);
    EXPECT_NEAR(glm::dot(at.normal, at.along_v), 0, 1e-12);
  }
}

TEST(TeapotPatches, NormalsAtPolesLookStraightUpAndDown) {
  const std::vector<BezierPatch> patches = teapot_patches();
  for (std::size_t quarter = 0; quarter < 4; ++quarter)
    for (const int part : {0, 1, 3}) {
      const glm::dvec3 top = evaluate(patches[12 + quarter], fraction(0, 1), fraction(part, 3)).normal;
      const glm::dvec3 bottom = evaluate(patches[20 + quarter], fraction(1, 1), fraction(part, 3)).normal;
      EXPECT_NEAR(top.y, 1, 1e-12);
      EXPECT_NEAR(bottom.y, -1, 1e-12);
    }
}

class Teapot : public testing::TestWithParam<int> {};

TEST_P(Teapot, IsFourPiecesWithSixRimsAndNoCracks) {
  const int n = GetParam();
  const Mesh mesh = teapot(n);
  EXPECT_EQ(mesh.triangles.size(), std::size_t(32 * 2 * n * n - 2 * 4 * n));  // a pole costs a triangle a column
  EXPECT_TRUE(test::is_oriented_manifold(mesh));
  // The mesh is open at the ends of rim and lid (four quarters) and at both ends of handle and spout (two halves each).
  EXPECT_EQ(test::boundary_count(mesh), 2 * 4 * n + 4 * 2 * n);
  // Body: disc, lid: disc, handle and spout: tubes.
  EXPECT_EQ(test::euler_characteristic(mesh), 1 + 1 + 0 + 0);
}
INSTANTIATE_TEST_SUITE_P(Steps, Teapot, testing::Values(2, 3, 7, 10, 16));

TEST(TeapotMesh, NormalsLookOutwardsAndFollowTheFacesMoreCloselyTheFinerTheyAre) {
  EXPECT_GT(test::signed_volume(teapot(10)), 0);
  const double coarse = test::worst_normal(teapot(10)), fine = test::worst_normal(teapot(40));
  EXPECT_GT(coarse, 0.3);  // the lip of the spout bends most
  EXPECT_GT(fine, 0.9);
}

TEST(TeapotMesh, StandsOnTheGround) {
  const Mesh mesh = teapot(10);
  Box box;
  for (const glm::vec3& p : mesh.positions) box.include(p);
  EXPECT_EQ(box.low.y, 0.0f);
  EXPECT_EQ(box.high.y, 3.15f);
  EXPECT_EQ(box.low.z, -box.high.z);
  EXPECT_NEAR(box.high.z, 2, 0.01);
}

}  // namespace
}  // namespace frontmost
