// SPDX-License-Identifier: Apache-2.0
// Camera poses: looking at a point, and the conventions of other programs.
//
//        y                            z (forward)
//        |                           /
//        |     x                    o------ x
//        o------                    |
//       /                           |
//      z (backward)                 y
//
//    OpenGL, and this library       OpenCV
//
// They differ by the signs of y and z, and each may be given from camera to world or from world to camera.

#include <cmath>

#include "frontmost/view.h"

namespace frontmost {
namespace {

// y and z change sign between OpenGL's camera axes (y up, z back) and OpenCV's (y down, z forward).
const glm::dmat4 kFlipYZ(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
// Eye space from a robot's axes: x is ahead (-z of the eye), y left (-x), z up (y).
const glm::dmat4 kEyeFromRobot(0, 0, -1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1);

/// The transpose inverts a rotation exactly; a general inverse would round once more.
glm::dmat4 inverse_rigid(const glm::dmat4& pose) {
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(pose));
  glm::dmat4 inverse(rotation);
  inverse[3] = glm::dvec4(-(rotation * glm::dvec3(pose[3])), 1.0);
  return inverse;
}

void check_rigid(const glm::dmat4& pose) {
  constexpr double kTolerance = 1e-4;  // poses come from text files with few digits
  const glm::dmat3 r(pose);
  const glm::dmat3 product = glm::transpose(r) * r;
  bool good = is_finite(glm::dvec3(pose[3])) && std::abs(glm::determinant(r) - 1) < kTolerance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) good = good && std::abs(product[i][j] - (i == j ? 1 : 0)) < kTolerance;
    good = good && std::abs(pose[i][3]) < kTolerance;
  }
  if (!(good && std::abs(pose[3][3] - 1) < kTolerance))
    throw Error(ErrorCode::singular_camera, "pose", "must be a rotation and a translation, last row 0 0 0 1");
}

bool is_world_to_camera(PoseConvention convention) {
  return convention == PoseConvention::opengl_world_to_camera || convention == PoseConvention::opencv_world_to_camera ||
         convention == PoseConvention::robot_world_to_camera;
}

bool is_opencv(PoseConvention convention) {
  return convention == PoseConvention::opencv_camera_to_world || convention == PoseConvention::opencv_world_to_camera;
}

bool is_robot(PoseConvention convention) {
  return convention == PoseConvention::robot_camera_to_world || convention == PoseConvention::robot_world_to_camera;
}

}  // namespace

glm::dmat4 look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
  const glm::dvec3 direction = target - eye;
  const double distance = glm::length(direction);
  if (!is_finite(eye) || !is_finite(target) || !std::isfinite(distance) || !(distance > 0))
    throw Error(ErrorCode::singular_camera, "camera", "eye and target must be finite and apart");
  const glm::dvec3 back = -direction / distance;
  const double up_length = glm::length(up);
  const glm::dvec3 wanted = is_finite(up) && up_length > 0 ? up / up_length : glm::dvec3(0, 1, 0);
  glm::dvec3 right = glm::cross(wanted, back);
  // The roll is undefined along "up", so the axis farthest from the viewing direction replaces "up". The limit is the
  // sine of the angle between both: below it the roll would consist of rounding errors.
  if (glm::length(right) < 1e-9) {
    const glm::dvec3 other = std::abs(back.z) < 0.9 ? glm::dvec3(0, 0, back.y > 0 ? -1 : 1) : glm::dvec3(0, 1, 0);
    right = glm::cross(other, back);
  }
  right = glm::normalize(right);
  const glm::dvec3 true_up = glm::cross(back, right);
  return {glm::dvec4(right, 0), glm::dvec4(true_up, 0), glm::dvec4(back, 0), glm::dvec4(eye, 1)};
}

glm::dmat4 world_from_eye(const glm::dmat4& pose, PoseConvention convention) {
  // A scale in a pose would silently change the meaning of distances; a mirror would reverse every face.
  check_rigid(pose);
  const glm::dmat4 world_from_camera = is_world_to_camera(convention) ? inverse_rigid(pose) : pose;
  if (is_robot(convention)) return world_from_camera * glm::transpose(kEyeFromRobot);
  return is_opencv(convention) ? world_from_camera * kFlipYZ : world_from_camera;
}

glm::dmat4 pose_of(const glm::dmat4& world_from_eye, PoseConvention convention) {
  const glm::dmat4 world_from_camera = is_robot(convention)    ? world_from_eye * kEyeFromRobot
                                       : is_opencv(convention) ? world_from_eye * kFlipYZ
                                                               : world_from_eye;
  return is_world_to_camera(convention) ? inverse_rigid(world_from_camera) : world_from_camera;
}

View View::placed(const glm::dmat4& pose, PoseConvention convention) const {
  View view = *this;
  view.world_from_eye = frontmost::world_from_eye(pose, convention);
  return view;
}

View View::looking(const glm::dvec3& from, const glm::dvec3& target, const glm::dvec3& up) const {
  View view = *this;
  view.world_from_eye = look_at(from, target, up);
  return view;
}

View View::about(const glm::dvec3& origin) const {
  View view = *this;
  view.world_from_eye[3] -= glm::dvec4(origin, 0);
  return view;
}

}  // namespace frontmost
