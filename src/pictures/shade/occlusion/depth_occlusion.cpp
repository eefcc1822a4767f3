// SPDX-License-Identifier: Apache-2.0
#include "shade/occlusion/depth_occlusion.h"

#include <cmath>

namespace frontmost::shading {

void check_ambient_occlusion(const ShadeOptions& options) {
  if (!options.light.ambient_occlusion) return;
  const auto [strength, radius] = *options.light.ambient_occlusion;
  if (!(strength >= 0 && strength <= 1))
    throw Error(ErrorCode::bad_argument, "ambient occlusion", "the strength must be from 0 to 1");
  if (radius && !(*radius > 0 && std::isfinite(*radius)))
    throw Error(ErrorCode::bad_argument, "ambient occlusion", "the radius must be above 0");
}

double default_occlusion_radius(const Surfaces& surfaces) {
  constexpr double part = 0.1;  // share of the subject's size: covers corners of a room, not the whole room
  const Box subject = find_subject(surfaces).bounds;
  return subject.is_empty() ? 1.0 : std::max(part * double(subject.diagonal()), 1e-30);
}

void DepthOcclusion::find(const Visible& visible, int samples, const OcclusionReach& reach) {
  const View& view = visible.view;
  const std::size_t count = view.pixel_count();
  if (depths_.size() != count) depths_ = Buffer<float>(count);
  for (std::size_t i = 0; i < count; ++i)
    depths_[i] = visible.primitives[i] == no_primitive ? std::numeric_limits<float>::infinity()
                                                       : depth_of_key(view, visible.keys[i]);
  const Projection& sides = view.projection;
  const glm::dvec2 step((sides.right - sides.left) / view.width, (sides.bottom - sides.top) / view.height);
  const glm::dvec2 sample = glm::dvec2(sample_offsets(samples)[0]) / 256.0;
  grid_ = {view.width,
           view.height,
           depths_.data(),
           sides.orthographic,
           glm::vec3(view.right()),
           glm::vec3(view.up()),
           glm::vec3(-view.forward()),
           glm::vec2(glm::dvec2(sides.left, sides.top) + step * sample),
           glm::vec2(step),
           float(reach.radius),
           float(reach.strength)};
}

}  // namespace frontmost::shading
