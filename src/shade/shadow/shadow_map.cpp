// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

constexpr int kLeastSize = 256, kMostSize = 1024;
constexpr double kSpareTexels = 12;  ///< around what is seen: the filter, and what lies between the points looked at
constexpr int kStride = 4;           ///< every fourth pixel in x and y shows where the visible surfaces are

/// A rectangle across the light's direction, and a range along it.
struct LightExtent {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  void include(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void include(const LightExtent& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x); }
};

/// As many as make a texel about as small as a pixel: small pictures would not show more.
int texels_for(const View& picture) {
  const int wanted = std::max(picture.width, picture.height) * 8 / 5;
  return std::clamp((wanted + 63) / 64 * 64, kLeastSize, kMostSize);
}

/// Of the points that are seen, in the axes of `light` (x, y across; z towards the light), from the eye.
LightExtent extent_of_visible(const Visible& visible, const glm::dmat3& light_axes, const Execution& execution) {
  const ScreenRays rays(visible.view);
  const glm::dmat3 light_from_world = glm::transpose(light_axes);
  const int rows = (visible.view.height + kStride - 1) / kStride;
  LightExtent extent;
  std::mutex mutex;
  parallel_for(execution, std::size_t(rows), 16, [&](std::size_t begin, std::size_t end) {
    LightExtent part;
    for (int y = int(begin) * kStride; y < std::min(int(end) * kStride, visible.view.height); y += kStride)
      for (int x = 0; x < visible.view.width; x += kStride) {
        const std::size_t i = visible.index(x, y);
        if (visible.primitives[i] == no_primitive) continue;
        const double depth = double(depth_of_key(visible.view, visible.keys[i]));
        if (depth < 1e30) part.include(light_from_world * rays.point(x + 0.5, y + 0.5, depth));
      }
    const std::lock_guard lock(mutex);
    extent.include(part);  // in any order: minima and maxima do not round
  });
  return extent;
}

LightExtent extent_of_box(const Box& box, const glm::dvec3& eye, const glm::dmat3& light_axes) {
  LightExtent extent;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                            k & 4 ? box.high.z : box.low.z);
    extent.include(glm::transpose(light_axes) * (corner - eye));
  }
  return extent;
}

/// Two directions across `to_light`, and itself.
glm::dmat3 axes_of_light(const glm::dvec3& to_light, const View& view) {
  const glm::dvec3 side = glm::normalize(glm::cross(view.up(), to_light));
  return {side, glm::cross(to_light, side), to_light};
}

/// The window of the light's view: what is seen, but no more than there is, with room for the filter.
LightExtent window_of(const LightExtent& seen, const LightExtent& all, int texels) {
  LightExtent window = all;
  for (int k = 0; k < 2; ++k) {
    const double spare = 0.02 * (seen.high[k] - seen.low[k]);
    window.low[k] = std::max(all.low[k], seen.low[k] - spare);
    window.high[k] = std::min(all.high[k], seen.high[k] + spare);
  }
  const double side = std::max(
      {window.high.x - window.low.x, window.high.y - window.low.y, 1e-6 * (window.high.z - window.low.z), 1e-30});
  for (int k = 0; k < 2; ++k) {
    const double centre = 0.5 * (window.low[k] + window.high[k]);
    const double half = 0.5 * side * (1 + 2 * kSpareTexels / texels);
    window.low[k] = centre - half;
    window.high[k] = centre + half;
  }
  return window;
}

View view_of_window(const LightExtent& window, const glm::dmat3& axes, const glm::dvec3& eye, int texels) {
  View view;
  view.width = view.height = texels;
  const double depth = std::max(window.high.z - window.low.z, 1e-6 * (window.high.x - window.low.x));
  view.world_from_eye = glm::dmat4(axes);
  view.world_from_eye[3] = glm::dvec4(eye + axes * glm::dvec3(0, 0, window.high.z + 0.01 * depth), 1);
  view.projection = make_orthographic(window.low.x, window.high.x, window.low.y, window.high.y, {0.0, 1.02 * depth});
  return view;
}

}  // namespace

std::optional<View> view_of_light(const Visible& visible, const Box& bounds, const glm::dvec3& to_light,
                                  const Execution& execution) {
  const glm::dmat3 axes = axes_of_light(to_light, visible.view);
  const LightExtent seen = extent_of_visible(visible, axes, execution);
  if (seen.is_empty() || bounds.is_empty()) return std::nullopt;
  const glm::dvec3 eye = visible.view.eye();
  const int texels = texels_for(visible.view);
  return view_of_window(window_of(seen, extent_of_box(bounds, eye, axes), texels), axes, eye, texels);
}

void ShadowMap::draw(const Visible& seen_by_light, const Execution& execution) {
  clear();  // an error leaves everything lit
  light_ = seen_by_light.view;
  constexpr std::size_t block = ShadowGrid::block;
  const auto size = std::size_t(light_.width), blocks = size / block;
  if (nearest_.size() != blocks * blocks) nearest_ = Buffer<float>(blocks * blocks);
  const float* const keys = seen_by_light.keys.data();
  parallel_for(execution, blocks, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (std::size_t x = 0; x < blocks; ++x) {
        const float* row = keys + y * block * size + x * block;
        float columns[block];
        std::copy_n(row, block, columns);
        for (std::size_t j = 1; j < block; ++j)
          for (std::size_t i = 0; i < block; ++i) columns[i] = std::max(columns[i], row[j * size + i]);
        nearest_[y * blocks + x] = *std::max_element(columns, columns + block);
      }
  });
  grid_.keys = keys;
  grid_.nearest = nearest_.data();
  grid_.size = light_.width;
}

void ShadowMap::measure_from(const glm::dvec3& eye) {
  const glm::dmat3 axes(light_.world_from_eye);
  const Projection& window = light_.projection;
  const double texel = (window.right - window.left) / light_.width, depth = window.clip.far - window.clip.near;
  grid_.to_light = glm::vec3(axes[2]);
  grid_.texel_x = glm::vec3(axes[0] / texel);
  grid_.texel_y = glm::vec3(axes[1] * (-1 / texel));
  grid_.key = glm::vec3(axes[2] / depth);
  // The light's eye is before all that it sees; key 1 is there.
  grid_.at_eye = glm::vec3(-window.left / texel, window.top / texel, 1 - glm::dot(axes[2], light_.eye() - eye) / depth);
  grid_.key_bias = float(0.75 * texel / depth + 2e-6);
  grid_.key_slope_bias = float((0.5 * ShadowGrid::taps + 1) * texel / depth);
}

}  // namespace frontmost::shading
