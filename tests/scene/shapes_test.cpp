// SPDX-License-Identifier: Apache-2.0
#include "scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/compose.h"
#include "scene/topology.h"
#include "scene/turn.h"

namespace frontmost {
namespace {

TEST(Turn, IsTheCircleToTheLastBitsAndExactAtItsQuarters) {
  for (int whole = 1; whole <= 360; ++whole)
    for (int part = -whole; part <= 2 * whole; ++part) {
      const glm::dvec2 t = turn(part, whole);
      ASSERT_NEAR(t.x, std::cos(2 * std::numbers::pi * part / whole), 4e-15) << part << "/" << whole;
      ASSERT_NEAR(t.y, std::sin(2 * std::numbers::pi * part / whole), 4e-15) << part << "/" << whole;
    }
  EXPECT_EQ(turn(0, 7), glm::dvec2(1, 0));
  EXPECT_EQ(turn(1, 4), glm::dvec2(0, 1));
  EXPECT_EQ(turn(2, 4), glm::dvec2(-1, 0));
  EXPECT_EQ(turn(-1, 4), glm::dvec2(0, -1));
}

TEST(Turn, IsSymmetricToTheLastBit) {
  for (int part = 0; part <= 96; ++part) {
    const glm::dvec2 t = turn(part, 96);
    EXPECT_EQ(turn(96 - part, 96), glm::dvec2(t.x, -t.y));
    EXPECT_EQ(turn(48 - part, 96), glm::dvec2(-t.x, t.y));
    EXPECT_EQ(turn(24 - part, 96), glm::dvec2(t.y, t.x));
  }
}

TEST(Turn, ByDegreesIsTheSameForWholeOnes) {
  for (int degrees = -800; degrees <= 800; ++degrees)
    EXPECT_EQ(turn_of_degrees(degrees), turn(degrees, 360)) << degrees;
  for (const double degrees : {0.1, 44.999, 45.001, 359.9999, -1e-9, 123456.75}) {
    const double radians = std::fmod(degrees, 360) * 3.14159265358979323846 / 180;
    EXPECT_NEAR(turn_of_degrees(degrees).x, std::cos(radians), 1e-15) << degrees;
    EXPECT_NEAR(turn_of_degrees(degrees).y, std::sin(radians), 1e-15) << degrees;
  }
}

TEST(Turn, NoNegativeZeros) {
  for (int part = 0; part < 16; ++part)
    for (int k = 0; k < 2; ++k) EXPECT_FALSE(turn(part, 16)[k] == 0 && std::signbit(turn(part, 16)[k])) << part;
}

TEST(Shapes, SphereIsClosedRoundAndOutward) {
  for (const int rings : {2, 3, 16, 33}) {
    const Mesh mesh = sphere(rings);
    EXPECT_EQ(mesh.triangles.size(), std::size_t(4 * rings * (rings - 1)));
    EXPECT_TRUE(test::is_oriented_manifold(mesh)) << rings;
    EXPECT_EQ(test::boundary_count(mesh), 0) << rings;
    EXPECT_EQ(test::euler_characteristic(mesh), 2) << rings;
    EXPECT_EQ(mesh.positions, mesh.normals.values);
    EXPECT_EQ(mesh.positions.front(), glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.positions.back(), glm::vec3(0, -1, 0));
  }
  EXPECT_NEAR(test::signed_volume(sphere(128)) / 6, 4 * std::numbers::pi / 3, 0.004);
}

TEST(Shapes, TorusKnotIsAClosedTube) {
  const Mesh mesh = torus_knot({});
  EXPECT_TRUE(test::is_oriented_manifold(mesh));
  EXPECT_EQ(test::boundary_count(mesh), 0);
  EXPECT_EQ(test::euler_characteristic(mesh), 0) << "genus 1";
  EXPECT_GT(test::signed_volume(mesh), 0);
  EXPECT_GT(test::worst_normal(mesh), 0.9);
}

TEST(Shapes, BoxSidesFaceOutwardAndCarryTheTextureUpright) {
  const Mesh mesh = box({-1, 0, -2}, {3, 1, 2});
  EXPECT_TRUE(test::is_oriented_manifold(mesh));
  EXPECT_EQ(test::boundary_count(mesh), 0);
  EXPECT_EQ(test::signed_volume(mesh), 6 * 16.0);
  EXPECT_EQ(test::worst_normal(mesh), 1);
  for (std::uint32_t t = 0; t < 12; ++t)
    for (int k = 0; k < 3; ++k) {
      if (std::abs(mesh.normals.values[mesh.normals.triangles[t][k]].y) == 1) continue;
      const float v = mesh.texcoords.values[mesh.texcoords.triangles[t][k]].y;
      EXPECT_EQ(v, 1 - mesh.positions[mesh.triangles[t][k]].y) << "v runs down";
    }
}

TEST(Shapes, FloorFacesUp) {
  const Mesh mesh = floor(4, 2, 3);
  EXPECT_EQ(test::worst_normal(mesh), 1);
  EXPECT_EQ(mesh.normals.values[0], glm::vec3(0, 1, 0));
}

TEST(Shapes, RoundSlabIsClosedAndRoundedOnTop) {
  const Mesh mesh = round_slab({.radius = 2, .height = 1, .bevel = 0.25}, 32);
  Box bounds;
  for (const glm::vec3& p : mesh.positions) bounds.include(p);
  EXPECT_EQ(bounds.low, glm::vec3(-2, 0, -2));
  EXPECT_EQ(bounds.high, glm::vec3(2, 1, 2));
  EXPECT_GT(test::signed_volume(mesh) / 6, std::numbers::pi * 4 * 0.95);
  EXPECT_LT(test::signed_volume(mesh) / 6, std::numbers::pi * 4);
  EXPECT_GT(test::worst_normal(mesh), 0.97);
}

TEST(Shapes, AppendMovesTurnsAndPaintsAPart) {
  Mesh mesh;
  append(mesh, box({0, 0, 0}, {1, 1, 1}), 3);
  append(mesh, sphere(4), 5, moved({10, 0, 0}) * scaled(2) * turned(1, 3));
  EXPECT_EQ(mesh.triangles.size(), 12u + 48u);
  EXPECT_EQ(mesh.material_of(11), 3u);
  EXPECT_EQ(mesh.material_of(12), 5u);
  EXPECT_GT(test::worst_normal(mesh), 0.8);
  EXPECT_EQ(mesh.texcoords.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(test::signed_volume(mesh) / 6, 1 + 8 * test::signed_volume(sphere(4)) / 6, 1e-4);
}

}  // namespace
}  // namespace frontmost
