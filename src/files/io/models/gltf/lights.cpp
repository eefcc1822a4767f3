// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual: suns, points and spots that nodes place. A node gives a light only its place and direction:
// intensity, range and cone do not change with the node's scale.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/models/gltf/nodes.h"

namespace frontmost::gltf {
namespace {

constexpr double quarter_turn = 0.5 * std::numbers::pi;

/// Reads one light. Values out of range cause a warning and become the nearest sensible value.
class LightReader {
 public:
  LightReader(const JsonValue& json, std::vector<std::string>& warnings) : json_(json), warnings_(warnings) {}

  /// Empty for unknown kinds and for kinds whose light cannot be computed.
  std::optional<Light> read() {
    Light light;
    light.name = json_.name();
    const std::string type = json_.require("type").to_string();
    if (type != "directional" && type != "point" && type != "spot")
      return leave_out("lights of the type " + printable(type) + " are unknown");
    light.kind = type == "directional" ? Light::Kind::sun : type == "point" ? Light::Kind::point : Light::Kind::spot;
    light.intensity = json_.number_or("intensity", 1);
    if (!(light.intensity >= 0)) return leave_out("its intensity is negative");
    double color[3];
    if (json_.read_numbers("color", color))
      for (int c = 0; c < 3; ++c) {
        light.color[c] = float(color[c]);
        if (!(color[c] >= 0 && std::isfinite(light.color[c]))) return leave_out("its colour is out of range");
      }
    if (light.kind != Light::Kind::sun) read_range(light);
    if (light.kind == Light::Kind::spot) read_cones(light);
    return light;
  }

 private:
  std::optional<Light> leave_out(const std::string& reason) {
    warnings_.push_back(json_.place() + ": " + reason + ", the light is left out");
    return std::nullopt;
  }

  void read_range(Light& light) {
    const std::optional<JsonValue> range = json_.find("range");
    if (!range) return;
    if (range->to_number() > 0)
      light.range = range->to_number();
    else
      warnings_.push_back(range->place() + ": is not positive, the light reaches everywhere");
  }

  void read_cones(Light& light) {
    const std::optional<JsonValue> spot = json_.find("spot");
    if (!spot) return;
    const double inner = spot->number_or("innerConeAngle", light.inner_cone);
    const double outer = spot->number_or("outerConeAngle", light.outer_cone);
    // Exporters that use floats write angles slightly beyond a quarter turn, and cones without a soft edge.
    constexpr double tolerance = 1e-6, narrow = 1e-3;
    if (!(outer > 0 && outer <= quarter_turn + tolerance))
      warnings_.push_back(spot->place() + ".outerConeAngle: is not between 0 and a quarter turn, the nearest is taken");
    light.outer_cone = outer > 0 ? std::min(outer, quarter_turn) : narrow;
    if (!(inner >= 0 && inner <= outer + tolerance))
      warnings_.push_back(spot->place() + ".innerConeAngle: is not between 0 and outerConeAngle, the nearest is taken");
    light.inner_cone = std::clamp(inner, 0.0, light.outer_cone);
  }

  const JsonValue& json_;
  std::vector<std::string>& warnings_;
};

/// Whether the light's kind uses a direction.
bool has_direction(const Light& light) { return light.kind != Light::Kind::point; }

/// A rigid transform at the node's place whose -z is the node's direction of -z, whatever its scale or shear. Empty if
/// the node has no such direction.
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

std::optional<JsonValue> find_lights(const JsonValue& root) {
  const std::optional<JsonValue> extension = root.extension("KHR_lights_punctual");
  return extension ? extension->find("lights") : std::nullopt;
}

void place_lights(const JsonValue& root, const NodeTree& tree, Scene& scene) {
  const std::optional<JsonValue> array = find_lights(root);
  std::vector<std::optional<Light>> lights;
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    const JsonValue json = (*array)[i];
    lights.push_back(LightReader(json, scene.warnings).read());
  }
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
