// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

constexpr int kSize = 1024;
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
LightExtent window_of(const LightExtent& seen, const LightExtent& all) {
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
    const double half = 0.5 * side * (1 + 2 * kSpareTexels / kSize);
    window.low[k] = centre - half;
    window.high[k] = centre + half;
  }
  return window;
}

View view_of_window(const LightExtent& window, const glm::dmat3& axes, const glm::dvec3& eye) {
  View view;
  view.width = view.height = kSize;
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
  return view_of_window(window_of(seen, extent_of_box(bounds, eye, axes)), axes, eye);
}

void ShadowMap::draw(const Visible& seen_by_light, const Execution& execution) {
  clear();  // an error leaves everything lit
  filter_ = shadow_filter(execution.isa);
  light_ = seen_by_light.view;
  constexpr std::size_t texels = std::size_t(kSize) * kSize;
  if (keys_.size() != texels) keys_ = Buffer<float>(texels);
  if (nearest_.size() != texels) nearest_ = Buffer<float>(texels);
  find_nearest(seen_by_light.keys, execution);
  transpose(seen_by_light.keys, execution);
  size_ = kSize;
}

void ShadowMap::measure_from(const glm::dvec3& eye) {
  const glm::dmat3 axes(light_.world_from_eye);
  const Projection& window = light_.projection;
  const double texel = (window.right - window.left) / kSize, depth = window.clip.far - window.clip.near;
  to_light_ = glm::vec3(axes[2]);
  texel_x_ = glm::vec3(axes[0] / texel);
  texel_y_ = glm::vec3(axes[1] * (-1 / texel));
  key_ = glm::vec3(axes[2] / depth);
  // The light's eye is before all that it sees; key 1 is there.
  at_eye_ = glm::vec3(-window.left / texel, window.top / texel, 1 - glm::dot(axes[2], light_.eye() - eye) / depth);
  key_bias_ = float(0.75 * texel / depth + 2e-6);
  key_slope_bias_ = float((0.5 * taps + 1) * texel / depth);
}

void ShadowMap::find_nearest(const Buffer<float>& rows, const Execution& execution) {
  // Windows of 2, 4 and 8 texels, each from two of the size before; those past the last texel stay short and unused.
  static_assert(taps == 8);
  constexpr std::size_t size = kSize;
  parallel_for(execution, size, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* row = nearest_.data() + y * size;
      std::copy_n(rows.data() + y * size, size, row);
      for (const std::size_t step : {1, 2, 4})
        for (std::size_t x = 0; x + step < size; ++x) row[x] = std::max(row[x], row[x + step]);
    }
  });
  constexpr std::size_t columns_at_once = 64;
  parallel_for(execution, size / columns_at_once, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin * columns_at_once; first < end * columns_at_once; first += columns_at_once)
      for (const std::size_t step : {1, 2, 4})
        for (std::size_t y = 0; y + step < size; ++y) {
          float* row = nearest_.data() + y * size + first;
          const float* below = row + step * size;
          for (std::size_t x = 0; x < columns_at_once; ++x) row[x] = std::max(row[x], below[x]);
        }
  });
}

void ShadowMap::transpose(const Buffer<float>& rows, const Execution& execution) {
  // Squares of one cache line a row, by way of a copy: rows 4 KiB apart share the same few sets of the cache.
  constexpr std::size_t side = 16, size = kSize;
  parallel_for(execution, size / side, 1, [&](std::size_t begin, std::size_t end) {
    float square[side][side];
    for (std::size_t y = begin * side; y < end * side; y += side)
      for (std::size_t x = 0; x < size; x += side) {
        for (std::size_t j = 0; j < side; ++j) std::copy_n(rows.data() + (y + j) * size + x, side, square[j]);
        for (std::size_t j = 0; j < side; ++j)
          for (std::size_t i = 0; i < side; ++i) keys_[(x + j) * size + y + i] = square[i][j];
      }
  });
}

float ShadowMap::light_at(const glm::vec3& position, const glm::vec3& plane_normal) const {
  if (size_ == 0) return 1.0f;
  const glm::vec2 texel(glm::dot(texel_x_, position) + at_eye_.x, glm::dot(texel_y_, position) + at_eye_.y);
  // Over the filter's width a slanted surface itself comes nearer to the light by its slope: that is no shadow.
  constexpr float steepest = 8;
  const float cosine = std::abs(glm::dot(plane_normal, to_light_));
  const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
  const float slope = sine < steepest * cosine ? sine / cosine : steepest;
  const float key = glm::dot(key_, position) + at_eye_.z + key_bias_ + slope * key_slope_bias_;
  return filtered(texel, key);
}

float ShadowMap::filtered(const glm::vec2& texel, float key) const {
  constexpr float half = 0.5f * taps;
  const glm::vec2 first = texel - (half - 0.5f);  // the first texel whose centre is within the filter, plus a fraction
  const float end = float(size_ - taps);
  if (!(first.x >= 0 && first.y >= 0 && first.x < end && first.y < end)) return 1.0f;
  const int x0 = int(first.x), y0 = int(first.y);
  if (key >= nearest_[std::size_t(y0) * std::size_t(size_) + std::size_t(x0)]) return 1.0f;
  // A tent, so that edges fade without steps. Its weights at whole texels always sum to half * half.
  ShadowWindow window;
  window.keys = keys_.data() + std::size_t(x0) * std::size_t(size_) + std::size_t(y0);
  window.stride = std::size_t(size_);
  window.key = key;
  for (int i = 0; i < taps; ++i) {
    window.across[i] = std::max(0.0f, half - std::abs(float(x0 + i) + 0.5f - texel.x));
    window.down[i] = std::max(0.0f, half - std::abs(float(y0 + i) + 0.5f - texel.y));
  }
  return filter_(window) * (1.0f / (half * half * half * half));
}

}  // namespace frontmost::shading
