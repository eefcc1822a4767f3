// SPDX-License-Identifier: Apache-2.0
// Settings of scanners besides rings: a part of a turn, limits of range, and the angle of incidence on a surface.
#include <gmock/gmock.h>

#include <cmath>

#include "indexed_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

constexpr double scanner_pi = 3.14159265358979323846;
constexpr float nothing_met = std::numeric_limits<float>::infinity();

std::vector<glm::vec3> directions_of(const Lidar& lidar) {
  std::vector<glm::vec3> directions;
  for (int x = 0; x < lidar.steps; ++x) directions.push_back(ray_of({lidar}, x, 0).direction);
  return directions;
}

using testing::ElementsAre;
const glm::vec3 to_ahead(0, 0, -1), to_right(1, 0, 0), to_behind(0, 0, 1), to_left(-1, 0, 0);

TEST(Scanner, APartOfATurnHasBothItsEnds) {
  EXPECT_THAT(directions_of({{0}, 3, -scanner_pi / 2, scanner_pi / 2}), ElementsAre(to_left, to_ahead, to_right));
  EXPECT_THAT(directions_of({{0}, 3, 0, -scanner_pi}), ElementsAre(to_ahead, to_left, to_behind)) << "to the left";
  EXPECT_THAT(directions_of({{0}, 1, scanner_pi / 2, scanner_pi}), ElementsAre(to_right)) << "one ray is the first";
  EXPECT_THAT(directions_of({{0}, 2, scanner_pi / 2, scanner_pi / 2}), ElementsAre(to_right, to_right));
}

TEST(Scanner, AWholeTurnRepeatsNoRay) {
  EXPECT_THAT(directions_of({{0}, 4}), ElementsAre(to_ahead, to_right, to_behind, to_left));
  EXPECT_THAT(directions_of({{0}, 4, -scanner_pi, scanner_pi}), ElementsAre(to_behind, to_left, to_ahead, to_right));
  EXPECT_THAT(directions_of({{0}, 4, 2 * scanner_pi, 0}), ElementsAre(to_ahead, to_left, to_behind, to_right));
  // In degrees the ends may be off by a rounding error.
  EXPECT_THAT(directions_of({{0}, 4, glm::radians(-90.0), glm::radians(270.0)}),
              ElementsAre(to_left, to_ahead, to_right, to_behind));
}

/// A wall of 2 by 2, one unit ahead of a scanner, and another behind it at three units.
struct Walls : Indexed {
  Walls() : Indexed(floors({0, -2})) {}
  static constexpr double third = scanner_pi / 6;  // 30 degrees
  RayCamera camera{Lidar{{0, -third, -scanner_pi / 2}, 3, -third, third}, look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0})};
};

TEST(Scanner, IncidenceIsTheAngleToTheNormal) {
  const Walls walls;
  const RangeScan met = scan(walls.index, walls.camera);
  const Buffer<float> angles = incidence_angles(met, walls.surfaces);
  ASSERT_EQ(angles.size(), 9u);
  EXPECT_EQ(met.ranges[1], 1.0f);
  EXPECT_EQ(angles[1], 0.0f) << "head-on";
  for (const std::size_t side : {0u, 2u}) {
    EXPECT_NEAR(met.ranges[side], 2 / std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(angles[side], 30, 1e-5);
  }
  // Azimuth and elevation of 30 degrees: the cosine to the wall is cos 30 * cos 30 = 3 / 4.
  EXPECT_NEAR(angles[3], glm::degrees(std::acos(0.75)), 1e-5);
  EXPECT_TRUE(std::isnan(angles[7])) << "straight down nothing is met";
}

TEST(Scanner, IncidenceIsTheSameFromBehind) {
  const Walls walls;
  RayCamera camera = walls.camera;
  camera.world_from_eye = look_at({0, 0, -3}, {0, 0, 0}, {0, 1, 0});
  const Buffer<float> angles = incidence_angles(scan(walls.index, camera), walls.surfaces);
  EXPECT_EQ(angles[1], 0.0f);
  EXPECT_NEAR(angles[0], 30, 1e-5);
}

TEST(Scanner, RangesOutsideOfTheLimitsAreNothingMet) {
  const Walls walls;
  RayCamera camera = walls.camera;
  camera.nearest = 1;
  camera.farthest = 1.1;
  const RangeScan met = scan(walls.index, camera);
  EXPECT_EQ(met.ranges[1], 1.0f) << "the limits themselves are in";
  for (const std::size_t i : {0u, 2u, 3u, 7u}) {
    EXPECT_EQ(met.ranges[i], nothing_met);
    EXPECT_EQ(met.primitives[i], no_primitive);
  }
  EXPECT_TRUE(std::isnan(incidence_angles(met, walls.surfaces)[0]));
  camera.nearest = 1.5;
  camera.farthest = 9;
  EXPECT_EQ(scan(walls.index, camera).ranges[1], nothing_met) << "what is too near hides the wall behind it";
}

TEST(Scanner, RefusesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal_of = [](const RayCamera& camera) { return code_of([&] { validate(camera); }); };
  EXPECT_EQ(refusal_of({Lidar{{0}, 4, 0, 2 * scanner_pi + 0.001}}), ErrorCode::bad_argument);
  EXPECT_EQ(refusal_of({Lidar{{0}, 4, -scanner_pi, scanner_pi + 0.001}}), ErrorCode::bad_argument);
  EXPECT_EQ(refusal_of({Lidar{{0}, 4, nan, 1}}), ErrorCode::bad_argument);
  for (const auto& [nearest, farthest] :
       {std::pair(-1.0, 2.0), std::pair(2.0, 1.0), std::pair(nan, 1.0), std::pair(0.0, nan)}) {
    RayCamera camera{Lidar{{0}, 4}};
    camera.nearest = nearest;
    camera.farthest = farthest;
    EXPECT_EQ(refusal_of(camera), ErrorCode::bad_argument) << nearest << " " << farthest;
  }
}

}  // namespace
}  // namespace frontmost::test
