// SPDX-License-Identifier: Apache-2.0
#include "web/camera.h"

namespace frontmost::web {
namespace {

// Same values as in cli/values.h, so that products are equal to the last bit.
constexpr double kRadiansPerDegree = 0.017453292519943295, kDegreesPerRadian = 57.29577951308232;

PlainJson intrinsics_json(const View& view, PixelRule rule) {
  const Intrinsics k = intrinsics_of(view.projection, view.width, view.height, rule);
  return {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}};
}

}  // namespace

View view_of(const PlainJson& camera, const Box& bounds) {
  View view;
  view.width = camera.at("width");
  view.height = camera.at("height");
  view.samples = camera.value("samples", 1);
  const glm::dvec3 eye = vector_of(camera.at("eye")), target = vector_of(camera.at("target"));
  view.world_from_eye = look_at(eye, eye + glm::normalize(target - eye), vector_of(camera.at("up")));
  Projection& p = view.projection;
  p.orthographic = camera.value("orthographic", false);
  const double scale = p.orthographic ? glm::distance(target, eye) : 1;
  p.top = std::tan(camera.at("angle").get<double>() * 0.5 * kRadiansPerDegree);
  p.bottom = -p.top;
  p.right = p.top * (double(view.width) / view.height);
  p.left = -p.right;
  for (double* const side : {&p.left, &p.right, &p.bottom, &p.top}) *side *= scale;
  if (camera.contains("near") && camera.contains("far"))
    p.clip = {camera.at("near"), camera.at("far")};
  else
    p.clip = fit_clip(bounds.is_empty() ? Box{glm::vec3(-0.5f), glm::vec3(0.5f)} : bounds, view.world_from_eye,
                      p.orthographic);
  constexpr Culling cullings[] = {Culling::none, Culling::back, Culling::front, Culling::both};
  view.culling = cullings[camera.value("culling", 0) & 3];
  validate(view);
  return view;
}

SightLine sight_through(const View& view, int x, int y) {
  const Projection& p = view.projection;
  const double right = p.left + (p.right - p.left) * ((x + 0.5) / view.width);
  const double up = p.top - (p.top - p.bottom) * ((y + 0.5) / view.height);
  const glm::dvec3 aside = view.right() * right + view.up() * up;
  if (p.orthographic) return {view.eye() + aside, view.forward()};
  return {view.eye(), view.forward() + aside};
}

PlainJson camera_json(const View& view, const glm::dvec3& centre) {
  const double along = std::max(glm::dot(centre - view.eye(), view.forward()), 1e-6);
  return {
      {"width", view.width},
      {"height", view.height},
      {"eye", to_json(view.eye())},
      {"target", to_json(view.eye() + view.forward() * along)},
      {"up", to_json(view.up())},
      {"angle", 2 * std::atan(view.projection.top / (view.projection.orthographic ? along : 1)) * kDegreesPerRadian},
      {"orthographic", view.projection.orthographic}};
}

PlainJson conventions_json(const View& view, const glm::dvec3& origin) {
  glm::dmat4 pose = view.world_from_eye;
  pose[3] += glm::dvec4(origin, 0);
  PlainJson json = {{"resolution", {view.width, view.height}},
                    {"projection", view.projection.orthographic ? "orthographic" : "perspective"},
                    {"near", view.projection.clip.near},
                    {"far", finite_or_null(view.projection.clip.far)}};
  json["poses"]["opengl"]["world_from_camera"] = to_json(pose);
  json["poses"]["opengl"]["camera_from_world"] = to_json(pose_of(pose, PoseConvention::opengl_world_to_camera));
  json["poses"]["opencv"]["world_from_camera"] = to_json(pose_of(pose, PoseConvention::opencv_camera_to_world));
  json["poses"]["opencv"]["camera_from_world"] = to_json(pose_of(pose, PoseConvention::opencv_world_to_camera));
  if (!view.projection.orthographic)
    json["intrinsics"] = {{"pixel_center_half", intrinsics_json(view, PixelRule::centre_at_half)},
                          {"pixel_center_integer", intrinsics_json(view, PixelRule::centre_at_integer)}};
  constexpr std::pair<const char*, DepthConvention> depths[] = {{"opengl", opengl_depth},
                                                                {"zero_to_one", zero_to_one_depth},
                                                                {"reversed", reversed_depth},
                                                                {"gortler", gortler_depth}};
  for (const auto& [name, depth] : depths)
    json["projection_matrices"][name] = to_json(clip_from_eye(view.projection, depth));
  return json;
}

}  // namespace frontmost::web
