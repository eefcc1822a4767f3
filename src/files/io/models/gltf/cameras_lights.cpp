// SPDX-License-Identifier: Apache-2.0
// Cameras and lights (KHR_lights_punctual) that nodes place. A node gives them only a place and a direction: the
// intensity, range and cone of a light do not change with the node's scale.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/models/gltf/nodes.h"

namespace frontmost::gltf {
namespace {

constexpr double quarter_turn = 0.5 * std::numbers::pi;

/// Returns the pose of a camera, which looks along its node's -z with y up, or nothing if the node has no such axes.
/// Cameras have no scale, so the axes are made orthonormal again.
std::optional<glm::dmat4> rigid(const glm::dmat4& world) {
  const glm::dvec3 back(world[2]), up(world[1]);
  // The viewing direction is kept exactly and up is adjusted, because a sheared parent leaves them at an angle.
  const glm::dvec3 right = glm::cross(up, back);
  const double back_length = glm::length(back), right_length = glm::length(right);
  if (!(back_length > 0) || !(right_length > 0)) return std::nullopt;
  const glm::dvec3 z = back / back_length, x = right / right_length;
  return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), world[3]);
}

std::optional<double> positive(const JsonValue& json, const char* key) {
  const double value = json.number_or(key, 0);
  return value > 0 ? std::optional(value) : std::nullopt;
}

/// Returns the lens of a camera, or nothing for unknown types and for sizes that are not positive.
std::optional<Camera> read_camera(const JsonValue& json) {
  Camera camera;
  camera.name = json.name();
  camera.orthographic = json.require("type").to_string() == "orthographic";
  const std::optional<JsonValue> lens = json.find(camera.orthographic ? "orthographic" : "perspective");
  if (!lens) return std::nullopt;
  camera.near = positive(*lens, "znear");
  camera.far = positive(*lens, "zfar");
  if (camera.orthographic) {
    const auto half_width = positive(*lens, "xmag"), half_height = positive(*lens, "ymag");
    if (!half_width || !half_height) return std::nullopt;
    camera.vertical = 2 * *half_height;
    camera.aspect = *half_width / *half_height;
    return camera;
  }
  const auto angle = positive(*lens, "yfov");
  constexpr double straight = 3.14159265358979;
  if (!angle || *angle >= straight) return std::nullopt;
  camera.vertical = *angle;
  camera.aspect = positive(*lens, "aspectRatio");
  return camera;
}

void read_range(const JsonValue& json, Light& light, std::vector<std::string>& warnings) {
  const std::optional<JsonValue> range = json.find("range");
  if (!range) return;
  if (range->to_number() > 0)
    light.range = range->to_number();
  else
    warnings.push_back(range->place() + ": is not positive; the light reaches everywhere");
}

void read_cones(const JsonValue& json, Light& light, std::vector<std::string>& warnings) {
  const std::optional<JsonValue> spot = json.find("spot");
  if (!spot) return;
  const double inner = spot->number_or("innerConeAngle", light.inner_cone);
  const double outer = spot->number_or("outerConeAngle", light.outer_cone);
  // Exporters that use floats write angles slightly beyond a quarter turn, and cones without a soft edge.
  constexpr double tolerance = 1e-6, narrow = 1e-3;
  if (!(outer > 0 && outer <= quarter_turn + tolerance))
    warnings.push_back(spot->place() +
                       ".outerConeAngle: is not between 0 and 90 degrees; the nearest such angle is used");
  light.outer_cone = outer > 0 ? std::min(outer, quarter_turn) : narrow;
  if (!(inner >= 0 && inner <= outer + tolerance))
    warnings.push_back(spot->place() +
                       ".innerConeAngle: is not between 0 and outerConeAngle; the nearest such angle is used");
  light.inner_cone = std::clamp(inner, 0.0, light.outer_cone);
}

/// Reads one light. Values out of range cause a warning and become the nearest sensible value. Returns nothing for
/// unknown kinds and for kinds whose light cannot be computed.
std::optional<Light> read_light(const JsonValue& json, std::vector<std::string>& warnings) {
  const auto leave_out = [&](const std::string& reason) {
    warnings.push_back(json.place() + ": " + reason + ", the light is left out");
    return std::nullopt;
  };
  Light light;
  light.name = json.name();
  const std::string type = json.require("type").to_string();
  if (type != "directional" && type != "point" && type != "spot")
    return leave_out("lights of the type " + printable(type) + " are unknown");
  light.kind = type == "directional" ? Light::Kind::sun : type == "point" ? Light::Kind::point : Light::Kind::spot;
  light.intensity = json.number_or("intensity", 1);
  if (!(light.intensity >= 0)) return leave_out("its intensity is negative");
  double color[3];
  if (json.read_numbers("color", color))
    for (int c = 0; c < 3; ++c) {
      light.color[c] = float(color[c]);
      if (!(color[c] >= 0 && std::isfinite(light.color[c]))) return leave_out("its colour is out of range");
    }
  if (light.kind != Light::Kind::sun) read_range(json, light, warnings);
  if (light.kind == Light::Kind::spot) read_cones(json, light, warnings);
  return light;
}

/// Whether the light's kind uses a direction.
bool has_direction(const Light& light) { return light.kind != Light::Kind::point; }

/// Returns a rigid transform at the node's place, or nothing if the light needs a direction and the node has none. Its
/// -z is the node's direction of -z, whatever the node's scale or shear.
std::optional<glm::dmat4> placement(const Light& light, const glm::dmat4& world) {
  const double length = glm::length(glm::dvec3(world[2]));
  if (!has_direction(light) || !(length > 0 && std::isfinite(length))) {
    if (has_direction(light)) return std::nullopt;
    glm::dmat4 moved(1.0);
    moved[3] = world[3];
    return moved;
  }
  const glm::dvec3 back = glm::dvec3(world[2]) / length;
  // The rotation about the light's axis has no effect. The world axis farthest from that axis completes the frame.
  const glm::dvec3 size = glm::abs(back);
  const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(other, back));
  return glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0), world[3]);
}

}  // namespace

void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene) {
  for (const std::uint32_t id : tree.shown) {
    const Node& node = tree.nodes[id];
    if (node.camera == no_index) continue;
    const JsonValue json = root.require("cameras")[node.camera];
    std::optional<Camera> camera = read_camera(json);
    const std::optional<glm::dmat4> pose = rigid(node.world);
    if (!camera || !pose) {
      scene.warnings.push_back((camera ? node.place : json.place()) + ": a camera whose picture is empty is left out");
      continue;
    }
    camera->world_from_eye = *pose;
    if (!node.name.empty()) camera->name = node.name;
    scene.cameras.push_back(*std::move(camera));
  }
}

std::optional<JsonValue> find_lights(const JsonValue& root) {
  const std::optional<JsonValue> extension = root.extension("KHR_lights_punctual");
  return extension ? extension->find("lights") : std::nullopt;
}

void place_lights(const JsonValue& root, const NodeTree& tree, Scene& scene) {
  std::vector<std::optional<Light>> lights;
  if (const auto extension = root.extension("KHR_lights_punctual"))
    extension->each("lights", [&](const JsonValue& json) { lights.push_back(read_light(json, scene.warnings)); });
  for (const std::uint32_t id : tree.shown) {
    const Node& node = tree.nodes[id];
    if (node.light == no_index || !lights[node.light] || node.is_hidden) continue;
    Light light = *lights[node.light];
    const std::optional<glm::dmat4> placed = placement(light, node.world);
    if (!placed) {
      scene.warnings.push_back(node.place + ": a light that shines in no direction is left out");
      continue;
    }
    light.world_from_light = *placed;
    if (!node.name.empty()) light.name = node.name;
    scene.lights.push_back(std::move(light));
  }
}

}  // namespace frontmost::gltf
