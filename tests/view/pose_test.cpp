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
    PoseConvention::opencv_camera_to_world, PoseConvention::opencv_world_to_camera,
    PoseConvention::robot_camera_to_world,  PoseConvention::robot_world_to_camera};

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

TEST(Pose, ARobotHasXAheadYLeftAndZUp) {
  const glm::dmat4 eye = world_from_eye(glm::dmat4(1.0), PoseConvention::robot_camera_to_world);
  EXPECT_EQ(-glm::dvec3(eye[2]), glm::dvec3(1, 0, 0)) << "ahead";
  EXPECT_EQ(-glm::dvec3(eye[0]), glm::dvec3(0, 1, 0)) << "left";
  EXPECT_EQ(glm::dvec3(eye[1]), glm::dvec3(0, 0, 1)) << "up";
  // A camera at (0, 0, 5) looks at zero, y up: the origin is 5 ahead, and points at +x are on the right.
  const glm::dmat4 robot_from_world =
      pose_of(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), PoseConvention::robot_world_to_camera);
  expect_near(glm::dvec3(robot_from_world * glm::dvec4(0, 0, 0, 1)), {5, 0, 0});
  expect_near(glm::dvec3(robot_from_world * glm::dvec4(1, 2, 0, 1)), {5, -1, 2});
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

TEST(View, IsMadeByASentence) {
  const Intrinsics intrinsics{.fx = 572.4, .fy = 573.6, .cx = 325.3, .cy = 242.0};
  const glm::dmat4 pose = pose_of(look_at({1, 2, 3}, {4, 5, 7}, {0, 1, 0}), PoseConvention::opencv_world_to_camera);
  const View view =
      make_view(intrinsics, 640, 480).placed(pose, PoseConvention::opencv_world_to_camera).between(0.5, 20);
  EXPECT_EQ(view.width, 640);
  EXPECT_EQ(view.height, 480);
  expect_near(view.eye(), {1, 2, 3});
  expect_near(view.forward(), glm::normalize(glm::dvec3(3, 3, 4)));
  EXPECT_EQ(view.projection.clip.near, 0.5);
  EXPECT_EQ(view.projection.clip.far, 20);
  const Intrinsics back = intrinsics_of(view.projection, 640, 480, intrinsics.rule);
  EXPECT_NEAR(back.fx, intrinsics.fx, 1e-9);
  EXPECT_NEAR(back.cy, intrinsics.cy, 1e-9);
  EXPECT_NO_THROW(validate(view));
}

TEST(View, LooksFromAPointAtAnother) {
  const View view = make_view(1.0, 200, 100).looking({100, 0, 5}, {100, 0, 0}, {0, 1, 0}).about({100, 0, 0});
  expect_near(view.eye(), {0, 0, 5});
  expect_near(view.forward(), {0, 0, -1});
  EXPECT_NEAR(view.projection.top, std::tan(0.5), 1e-12);
  EXPECT_NEAR(view.projection.right, 2 * std::tan(0.5), 1e-12);
  const View fitted = view.enclosing({glm::vec3(-1), glm::vec3(1)});
  EXPECT_LT(fitted.projection.clip.near, 4);
  EXPECT_GT(fitted.projection.clip.far, 6);
  EXPECT_LT(fitted.projection.clip.far, 6.1);
}

TEST(View, RefusesWhatIsNoCamera) {
  EXPECT_THROW((void)make_view(1.0, 0, 100), Error);
  EXPECT_THROW((void)make_view(4.0, 100, 100), Error);
  EXPECT_THROW((void)make_view(Intrinsics{}, 100, 100), Error);
  EXPECT_THROW((void)View{}.looking({1, 1, 1}, {1, 1, 1}, {0, 1, 0}), Error);
  EXPECT_THROW((void)View{}.placed(glm::dmat4(2.0), PoseConvention::opengl_camera_to_world), Error);
}

}  // namespace
}  // namespace frontmost::test
