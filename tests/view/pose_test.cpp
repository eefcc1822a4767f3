// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "frontmost/view.h"

namespace frontmost::test {
namespace {

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

constexpr PoseConvention kConventions[] = {
    PoseConvention::opengl_camera_to_world, PoseConvention::opengl_world_to_camera,
    PoseConvention::opencv_camera_to_world, PoseConvention::opencv_world_to_camera};

TEST(LookAt, PutsTheTargetStraightAheadAndUpUp) {
  const glm::dmat4 pose = look_at({1, 2, 3}, {4, 2, 3}, {0, 0, 5});
  expect_near(glm::dvec3(pose * glm::dvec4(0, 0, -3, 1)), {4, 2, 3});
  expect_near(glm::dvec3(pose[1]), {0, 0, 1});
  expect_near(glm::dvec3(pose[0]), {0, -1, 0});
}

TEST(LookAt, AlongUpHasADefinedRoll) {
  for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)})
    for (const double sign : {-1.0, 1.0}) {
      const glm::dmat4 pose = look_at({0, 0, 0}, sign * up, up);
      EXPECT_NEAR(glm::determinant(glm::dmat3(pose)), 1, 1e-12);
      EXPECT_NO_THROW((void)world_from_eye(pose, PoseConvention::opengl_camera_to_world));
    }
}

TEST(LookAt, RefusesAnEyeInItsTarget) {
  EXPECT_THROW((void)look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0}), Error);
  EXPECT_THROW((void)look_at({1, 2, std::nan("")}, {1, 2, 3}, {0, 1, 0}), Error);
}

TEST(Pose, EveryConventionGoesThereAndBack) {
  const glm::dmat4 pose = look_at({1, 2, 3}, {-1, 0.5, 2}, {0, 1, 0});
  for (const PoseConvention convention : kConventions) {
    const glm::dmat4 back = world_from_eye(pose_of(pose, convention), convention);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) EXPECT_NEAR(back[i][j], pose[i][j], 1e-12);
  }
}

TEST(Pose, OpenCVLooksAlongPlusZWithYDown) {
  const glm::dmat4 pose = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  const glm::dmat4 camera_from_world = pose_of(pose, PoseConvention::opencv_world_to_camera);
  expect_near(glm::dvec3(camera_from_world * glm::dvec4(0, 0, 0, 1)), {0, 0, 5});
  expect_near(glm::dvec3(camera_from_world * glm::dvec4(1, 2, 0, 1)), {1, -2, 5});
}

TEST(Pose, RefusesWhatIsNotRigid) {
  glm::dmat4 scaled(2.0);
  scaled[3][3] = 1;
  EXPECT_THROW((void)world_from_eye(scaled, PoseConvention::opengl_camera_to_world), Error);
  glm::dmat4 mirrored(1.0);
  mirrored[0][0] = -1;
  EXPECT_THROW((void)world_from_eye(mirrored, PoseConvention::opengl_camera_to_world), Error);
  EXPECT_THROW((void)world_from_eye(glm::dmat4(0.0), PoseConvention::opencv_world_to_camera), Error);
}

}  // namespace
}  // namespace frontmost::test
