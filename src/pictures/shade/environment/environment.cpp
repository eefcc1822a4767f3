// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "frontmost/pictures.h"
#include "scene/turn.h"
#include "shade/environment/prefiltered.h"

namespace frontmost {

const shading::PrefilteredEnvironment& shading::prefiltered(const Environment& environment) {
  return *environment.made_;
}

namespace {

using shading::PrefilteredEnvironment;

constexpr int kMostWidth = 16384;

/// Checks the picture of an environment. \throws Error as documented for the constructor of Environment.
void check_picture(const Image& picture) {
  validate(picture);
  const auto fail = [](ErrorCode code, const std::string& reason) { throw Error(code, "environment", reason); };
  const std::string size = std::to_string(picture.width) + " x " + std::to_string(picture.height);
  if (picture.width != 2 * picture.height)
    fail(ErrorCode::bad_argument, "must be twice as wide as high (equirectangular), not " + size);
  if (picture.width > kMostWidth) fail(ErrorCode::limit_exceeded, "at most 16384 x 8192 pixels, not " + size);
  for (const char* name : {"R", "G", "B"}) {
    const Channel* const channel = picture.find(name);
    if (!channel || channel->is_integer())
      fail(ErrorCode::bad_argument, std::string("needs a channel ") + name + " of floats");
    for (const float value : channel->floats())
      if (!(value >= 0 && value <= max_environment_value))
        fail(ErrorCode::bad_argument, std::string("channel ") + name + ": values must be 0 to 16777216");
  }
}

/// Returns a smooth step from 0 to 1 as t goes from 0 to 1, with slope 0 at both ends.
float eased(float t) {
  const float inside = std::clamp(t, 0.0f, 1.0f);
  return inside * inside * (3 - 2 * inside);
}

/// A rectangular lamp behind cloth, as photographers place them around a product.
class SoftBox {
 public:
  /// `middle` is the direction to the middle of the box, `extent` its half width and half height as tangents, and
  /// `softness` the width of its fading rim, also as a tangent.
  SoftBox(const glm::vec3& middle, const glm::vec2& extent, float softness, float radiance)
      : ahead_(glm::normalize(middle)),
        right_(glm::normalize(std::abs(ahead_.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(ahead_.z, 0, -ahead_.x))),
        up_(glm::cross(ahead_, right_)),
        extent_(extent),
        softness_(softness),
        radiance_(radiance) {}

  /// Returns the radiance from a direction, where `light` is the radiance behind the box.
  [[nodiscard]] float before(float light, const glm::vec3& towards) const {
    const float distance = glm::dot(towards, ahead_);
    if (distance <= 0) return light;
    const float across = extent_.x - std::abs(glm::dot(towards, right_)) / distance;
    const float along = extent_.y - std::abs(glm::dot(towards, up_)) / distance;
    return light + (radiance_ - light) * eased(across / softness_) * eased(along / softness_);
  }

 private:
  glm::vec3 ahead_, right_, up_;
  glm::vec2 extent_;
  float softness_, radiance_;
};

glm::vec3 studio_radiance(const glm::vec3& towards) {
  // The first box is beside the key light. Two boxes, one at each side, outline bottles and pipes. The fourth is
  // overhead. The last, large and dim, is behind the camera, for surfaces that face it.
  static const SoftBox boxes[] = {{{-0.48f, 0.68f, 0.72f}, {0.40f, 0.40f}, 0.14f, 1.25f},
                                  {{0.95f, 0.12f, 0.30f}, {0.20f, 0.85f}, 0.09f, 1.1f},
                                  {{-0.92f, 0.10f, -0.38f}, {0.16f, 0.85f}, 0.09f, 1.1f},
                                  {{0.10f, 1.0f, -0.25f}, {0.45f, 0.32f}, 0.14f, 0.7f},
                                  {{0.20f, 0.05f, 1.0f}, {0.45f, 0.40f}, 0.20f, 0.40f}};
  float light = 0.115f + 0.075f * eased(0.5f + 0.55f * towards.y);
  for (const SoftBox& box : boxes) light = box.before(light, towards);
  return glm::vec3(light);
}

glm::vec3 sky_radiance(const glm::vec3& towards) {
  constexpr glm::vec3 zenith(0.16f, 0.26f, 0.48f), horizon(0.52f, 0.56f, 0.60f), ground(0.14f, 0.13f, 0.115f);
  const float below = eased(0.5f - 10 * towards.y);  // the horizon is a few degrees wide
  const float height = std::sqrt(std::max(towards.y, 0.0f));
  const glm::vec3 sky = horizon + (zenith - horizon) * height;
  return sky + (ground - sky) * below;
}

/// Makes an environment from radiance(towards), the radiance from a direction of unit length.
template <class Radiance>
std::shared_ptr<const PrefilteredEnvironment> made_by_code(const Radiance& radiance, bool turns,
                                                           const Execution& execution) {
  const IeeeScope ieee;
  constexpr int size = 128;
  constexpr std::size_t rows_at_once = 8;
  shading::OctahedralMap map(size);
  parallel_for(execution, std::size_t(size), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < size; ++x) map.set(x, y, radiance(glm::normalize(shading::octahedron_point(size, x, y))));
  });
  map.close_border();
  auto made = std::make_shared<PrefilteredEnvironment>();
  made->turns_with_camera = turns;
  made->levels[0] = std::move(map);
  shading::prefilter(*made, execution);
  return made;
}

}  // namespace

Environment::Environment(Image equirectangular, const Execution& execution) {
  check_picture(equirectangular);
  const IeeeScope ieee;
  auto made = std::make_shared<PrefilteredEnvironment>();
  made->levels[0] = shading::draw_map(equirectangular, execution);
  shading::prefilter(*made, execution);
  made->picture = std::move(equirectangular);
  made_ = std::move(made);
}

Environment Environment::studio(const Execution& execution) {
  return Environment(made_by_code(studio_radiance, true, execution));
}

Environment Environment::sky(const Execution& execution) {
  return Environment(made_by_code(sky_radiance, false, execution));
}

Environment Environment::none() {
  auto made = std::make_shared<PrefilteredEnvironment>();
  made->is_dark = true;
  return Environment(std::move(made));
}

bool Environment::turns_with_camera() const { return made_->turns_with_camera; }

const Image* Environment::picture() const { return made_->picture.channels.empty() ? nullptr : &made_->picture; }

glm::vec3 Environment::radiance(const glm::vec3& towards, float roughness) const {
  if (made_->is_dark) return glm::vec3(0);
  constexpr int last = PrefilteredEnvironment::level_count - 1;
  const float level = (roughness > 0 ? std::min(roughness, 1.0f) : 0.0f) * float(last);  // 0 for NaN
  const int first = std::min(int(level), last - 1);
  const glm::vec3 ahead(unit(glm::dvec3(towards)));  // squares of large floats could overflow
  const glm::vec3 finer = made_->levels[std::size_t(first)].color(ahead);
  return finer + (made_->levels[std::size_t(first) + 1].color(ahead) - finer) * (level - float(first));
}

glm::vec3 Environment::irradiance(const glm::vec3& normal) const {
  const glm::dvec3 n(normal);
  glm::vec3 light(0);
  for (int k = 0; k < 3; ++k) {
    const auto& m = made_->irradiance.channels[std::size_t(k)];
    light[k] = float(std::max(0.0, m.mean + 2 * glm::dot(m.first, n) + 1.875 * glm::dot(n, m.second * n)));
  }
  return light;
}

}  // namespace frontmost
