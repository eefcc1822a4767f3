// SPDX-License-Identifier: Apache-2.0
// Models bring their cameras and lights along. A transform may stretch and shear, but cameras and lights must stay
// rigid. So their axes are made orthonormal again: the viewing direction is kept exactly, and up is adjusted.
#include "io/scenes/transformed.h"

namespace frontmost {
namespace {

struct RigidPlace {
  glm::dmat4 world_from_thing;
  double growth;  ///< factor of lengths along the direction of view or of the light
};

/// Precondition: the transform is not singular.
RigidPlace rigid_place(const glm::dmat4& placed) {
  const glm::dvec3 back(placed[2]), right = glm::cross(glm::dvec3(placed[1]), back);
  const double length = glm::length(back);
  const glm::dvec3 z = back / length, x = glm::normalize(right);
  return {glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), placed[3]), length};
}

}  // namespace

Camera transformed(Camera camera, const glm::dmat4& scene_from_model) {
  const RigidPlace place = rigid_place(scene_from_model * camera.world_from_eye);
  camera.world_from_eye = place.world_from_thing;
  if (camera.near) *camera.near *= place.growth;
  if (camera.far) *camera.far *= place.growth;
  if (camera.orthographic) camera.vertical *= place.growth;
  return camera;
}

Light transformed(Light light, const glm::dmat4& scene_from_model) {
  const RigidPlace place = rigid_place(scene_from_model * light.world_from_light);
  light.world_from_light = place.world_from_thing;
  if (light.range) *light.range *= place.growth;
  // The light of a point or spot falls off with the square of the distance.
  if (light.kind != Light::Kind::sun) light.intensity *= place.growth * place.growth;
  return light;
}

}  // namespace frontmost
