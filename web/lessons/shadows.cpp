// SPDX-License-Identifier: Apache-2.0
// Shadows: a map of depths seen from the light, with texels and a bias, compared with exact rays to the light.
#include <frontmost/raycast.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// The view from a distant light.
struct LightMap {
  View view;
  Visible visible;
  Buffer<float> depths;

  LightMap(const Surfaces& surfaces, const glm::dvec3& to_light, int size) {
    FrameOptions options;
    options.orthographic = true;
    options.forward = -to_light;
    options.margin = 0.02;
    view = frame(surfaces, size, size, options);
    visible = zbuffer(surfaces, view);
    depths = depths_of(visible);
  }
};

/// A visible point, judged by the map and by a ray.
struct Judged {
  bool faces_light = false;
  bool lit_by_map = false, lit_by_ray = false;
  double cosine = 0;    ///< cosine of the angle between normal and light
  double distance = 0;  ///< from the light's plane
  float stored = 0;     ///< depth in the map
  glm::ivec2 texel{0};
};

/// Barycentric coordinates of a point in a triangle's plane.
glm::vec3 weights_of(const std::array<glm::vec3, 3>& corners, const glm::dvec3& point) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]), normal = glm::cross(b - a, c - a);
  const double u = glm::dot(glm::cross(c - b, point - b), normal);
  const double v = glm::dot(glm::cross(a - c, point - c), normal);
  const double w = glm::dot(normal, normal) - u - v;
  return glm::max(glm::vec3(u, v, w), glm::vec3(0));
}

class ShadowJudge {
 public:
  ShadowJudge(const Surfaces& surfaces, const glm::dvec3& to_light, int size, double bias)
      : surfaces_(surfaces), to_light_(glm::normalize(to_light)), bias_(bias), map_(surfaces, to_light_, size) {}

  [[nodiscard]] const LightMap& map() const { return map_; }

  /// Judges each pixel that sees something; others keep default values.
  [[nodiscard]] std::vector<Judged> judge(const Visible& visible) const {
    const Buffer<float> depths = depths_of(visible);
    std::vector<Judged> all(visible.primitives.size());
    std::vector<TrianglePoint> points;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const PrimitiveId id = visible.primitives[i];
      if (id == no_primitive) continue;
      const int width = visible.view.width;
      const SightLine sight = sight_through(visible.view, int(i) % width, int(i) / width);
      const glm::dvec3 point = sight.origin + sight.direction * double(depths[i]);
      const std::array<glm::vec3, 3> corners = surfaces_.corners(id);
      all[i] = by_map(corners, point, sight.direction);
      points.push_back({id, corners, weights_of(corners, point)});
      places.push_back(i);
    }
    std::vector<std::uint8_t> lit(points.size());
    are_lit(RayIndex(surfaces_), points, glm::vec3(to_light_), lit);
    for (std::size_t k = 0; k < places.size(); ++k) all[places[k]].lit_by_ray = lit[k] != 0;
    return all;
  }

 private:
  [[nodiscard]] Judged by_map(const std::array<glm::vec3, 3>& corners, const glm::dvec3& point,
                              const glm::dvec3& sight) const {
    Judged judged;
    glm::dvec3 normal = glm::cross(glm::dvec3(corners[1] - corners[0]), glm::dvec3(corners[2] - corners[0]));
    if (glm::dot(normal, sight) > 0) normal = -normal;
    judged.cosine = glm::dot(normal, to_light_) / std::max(glm::length(normal), 1e-30);
    judged.faces_light = judged.cosine > 1e-6;
    const glm::dvec2 at = pixel_of_point(map_.view, point);
    const int most = map_.view.width - 1;
    judged.texel = {std::clamp(int(at.x), 0, most), std::clamp(int(at.y), 0, most)};
    judged.stored = map_.depths[map_.visible.index(judged.texel.x, judged.texel.y)];
    judged.distance = from_eye(map_.view, point).z;
    judged.lit_by_map = judged.distance <= double(judged.stored) + bias_;
    return judged;
  }

  const Surfaces& surfaces_;
  glm::dvec3 to_light_;
  double bias_;
  LightMap map_;
};

void color(const Judged& judged, bool is_lit, std::uint8_t* rgba) {
  const double light = 0.3 + (judged.faces_light && is_lit ? 0.7 * judged.cosine : 0);
  const double warm[3] = {244, 236, 222};
  for (std::size_t c = 0; c < 3; ++c) rgba[c] = std::uint8_t(warm[c] * light);
  rgba[3] = 255;
}

/// Greys of the map's depths; near is bright.
std::vector<std::uint8_t> greys_of(const LightMap& map) {
  float low = std::numeric_limits<float>::infinity(), high = 0;
  for (const float depth : map.depths)
    if (std::isfinite(depth)) low = std::min(low, depth), high = std::max(high, depth);
  std::vector<std::uint8_t> rgba(4 * map.depths.size());
  for (std::size_t i = 0; i < map.depths.size(); ++i) {
    if (!std::isfinite(map.depths[i])) continue;
    const float share = high > low ? (map.depths[i] - low) / (high - low) : 0;
    for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = std::uint8_t(245 - 190 * share);
    rgba[4 * i + 3] = 255;
  }
  return rgba;
}

}  // namespace

PlainJson shadows_lesson(const PlainJson& question) {
  static std::vector<std::uint8_t> by_map, by_ray, seen_by_light, wrong;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const int size = std::clamp(question.value("size", 128), 8, 2048);
  const double bias = question.value("bias", 0.0);
  const ShadowJudge judge(stage.surfaces, vector_of(question.at("light")), size, bias);
  const Visible visible = zbuffer(stage.surfaces, view);
  const std::vector<Judged> all = judge.judge(visible);
  by_map.assign(4 * all.size(), 0);
  by_ray = wrong = by_map;
  std::size_t acne = 0, leaks = 0, facing = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (visible.primitives[i] == no_primitive) continue;
    const Judged& judged = all[i];
    color(judged, judged.lit_by_map, &by_map[4 * i]);
    color(judged, judged.lit_by_ray, &by_ray[4 * i]);
    color(judged, judged.lit_by_ray, &wrong[4 * i]);
    wrong[4 * i + 3] = 90;
    if (!judged.faces_light) continue;
    ++facing;
    if (judged.lit_by_map == judged.lit_by_ray) continue;
    ++(judged.lit_by_ray ? acne : leaks);
    const std::array<std::uint8_t, 4> mark = judged.lit_by_ray ? std::array<std::uint8_t, 4>{214, 40, 66, 255}
                                                               : std::array<std::uint8_t, 4>{47, 111, 190, 255};
    std::copy(mark.begin(), mark.end(), wrong.begin() + std::ptrdiff_t(4 * i));
  }
  seen_by_light = greys_of(judge.map());
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"pixels", place_of(by_map.data(), by_map.size())},
                      {"rays", place_of(by_ray.data(), by_ray.size())},
                      {"wrong", place_of(wrong.data(), wrong.size())},
                      {"map", place_of(seen_by_light.data(), seen_by_light.size())},
                      {"size", size},
                      {"facing", facing},
                      {"acne", acne},
                      {"leaks", leaks}};
  const int x = std::clamp(question.value("x", view.width / 2), 0, view.width - 1);
  const int y = std::clamp(question.value("y", view.height / 2), 0, view.height - 1);
  const std::size_t i = visible.index(x, y);
  if (visible.primitives[i] != no_primitive)
    answer["point"] = {{"texel", {all[i].texel.x, all[i].texel.y}},
                       {"stored", finite_or_null(double(all[i].stored))},
                       {"distance", all[i].distance},
                       {"faces_light", all[i].faces_light},
                       {"lit_by_map", all[i].lit_by_map},
                       {"lit_by_ray", all[i].lit_by_ray}};
  return answer;
}

}  // namespace frontmost::web
