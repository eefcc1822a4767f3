// SPDX-License-Identifier: Apache-2.0
// Points and cameras in the coordinates of the model's file, which users know; scenes and views use coordinates
// relative to the scene's origin. Also one camera in every convention.
//
//   file's zero o------- origin ------->o zero of the scene ---- in_scene ---->x
//               o--------------------------- in_file ------------------------->x
#pragma once

#include <frontmost/view.h>

#include <string>

#include "cli/json.h"

namespace frontmost::cli {

/// Returns a point in the file's coordinates. An origin of zero is not added, because that would turn -0 into 0.
[[nodiscard]] inline glm::dvec3 in_file(const glm::dvec3& in_scene, const glm::dvec3& origin) {
  return origin == glm::dvec3(0) ? in_scene : origin + in_scene;
}
[[nodiscard]] inline glm::dmat4 in_scene(glm::dmat4 world_from_eye, const glm::dvec3& origin) {
  world_from_eye[3] -= glm::dvec4(origin, 0);
  return world_from_eye;
}
[[nodiscard]] inline glm::dmat4 in_file(glm::dmat4 world_from_eye, const glm::dvec3& origin) {
  world_from_eye[3] += glm::dvec4(origin, 0);
  return world_from_eye;
}

/// Returns a point as text for people: six digits, or all digits of a double if the model lies far from zero.
[[nodiscard]] std::string place_text(const glm::dvec3& in_scene, const glm::dvec3& origin);

/// Returns the camera as JSON, in the coordinates of the model's file. `target` is the focal point of the look-at form.
/// `view` and `target` are relative to the scene's `origin`.
[[nodiscard]] Json camera_json(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
/// Returns options that reproduce this view.
[[nodiscard]] std::string camera_flags(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
[[nodiscard]] std::string camera_text(const View& view, const glm::dvec3& target, const glm::dvec3& origin);

}  // namespace frontmost::cli
