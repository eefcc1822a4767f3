// SPDX-License-Identifier: Apache-2.0
// Points and cameras as users know them, in the coordinates of the model's file, where scenes and views have them about
// the scene's origin; and one camera in every convention.
//
//   file's zero o------- origin ------->o zero of the scene ---- in_scene ---->x
//               o--------------------------- in_file ------------------------->x
#pragma once

#include <frontmost/view.h>

#include <string>

#include "cli/json.h"

namespace frontmost::cli {

/// Adding zero would turn -0 into 0, and reports of models that lie near zero are to stay as they are.
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

/// For people: six digits, and all that a double holds where the model lies far from zero.
[[nodiscard]] std::string place_text(const glm::dvec3& in_scene, const glm::dvec3& origin);

/// `target` is the focal point that the look-at form names. The view and it are about the scene's `origin`; what is
/// reported is in the coordinates of the model's file.
[[nodiscard]] Json camera_json(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
/// The options that make this view again.
[[nodiscard]] std::string camera_flags(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
[[nodiscard]] std::string camera_text(const View& view, const glm::dvec3& target, const glm::dvec3& origin);

}  // namespace frontmost::cli
