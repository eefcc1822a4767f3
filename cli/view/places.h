// SPDX-License-Identifier: Apache-2.0
// Points as users know them, in the coordinates of the model's file, and as scenes have them, about their origin.
#pragma once

#include <frontmost/view.h>

#include <string>

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

}  // namespace frontmost::cli
