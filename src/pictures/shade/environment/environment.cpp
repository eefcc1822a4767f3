// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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

/// \throws Error as documented for the constructor.
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

std::shared_ptr<const PrefilteredEnvironment> made_by_code(int size, const shading::Radiance& radiance, bool turns,
                                                           const Execution& execution) {
  const IeeeScope ieee;
  auto made = std::make_shared<PrefilteredEnvironment>();
  made->turns_with_camera = turns;
  made->levels[0] = shading::draw_map(size, radiance, execution);
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
  constexpr int size = 128;
  return Environment(made_by_code(size, shading::studio_radiance, true, execution));
}

Environment Environment::sky(const Execution& execution) {
  constexpr int size = 128;
  return Environment(made_by_code(size, shading::sky_radiance, false, execution));
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
  const glm::vec3 ahead(unit(glm::dvec3(towards)));  // sums of floats could overflow
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
