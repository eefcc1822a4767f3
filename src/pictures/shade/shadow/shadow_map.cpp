// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

constexpr int kLeastSize = 256, kMostSize = 1024;
constexpr double kSpareTexels = 12;  ///< margin: for the filter, and for surfaces between the sampled points
constexpr int kStride = 4;           ///< every fourth pixel in x and y is sampled

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

/// Returns the side length, in texels, of a map whose texels are about as small as the pixels of the picture. The
/// picture would not show smaller texels.
int texels_for(const View& picture) {
  const int wanted = std::max(picture.width, picture.height) * 8 / 5;
  return std::clamp((wanted + 63) / 64 * 64, kLeastSize, kMostSize);
}

/// Returns the extent of the visible points, relative to the eye, in the axes of the light: x and y across it, z
/// towards it.
LightExtent extent_of_visible(const SeenPoints& visible, const glm::dmat3& light_axes, const Execution& execution) {
  const glm::dmat3 light_from_world = glm::transpose(light_axes);
  const int rows = (visible.view.height + kStride - 1) / kStride;
  LightExtent extent;
  std::mutex mutex;
  parallel_for(execution, std::size_t(rows), 16, [&](std::size_t begin, std::size_t end) {
    LightExtent part;
    for (int y = int(begin) * kStride; y < std::min(int(end) * kStride, visible.view.height); y += kStride)
      visible.visit_row(y, kStride, [&](const glm::dvec3& point) { part.include(light_from_world * point); });
    const std::lock_guard lock(mutex);
    extent.include(part);  // the order does not matter: minima and maxima do not round
  });
  return extent;
}

LightExtent extent_of_box(const Box& box, const glm::dvec3& zero, const glm::dmat3& light_axes) {
  LightExtent extent;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                            k & 4 ? box.high.z : box.low.z);
    extent.include(glm::transpose(light_axes) * (corner - zero));
  }
  return extent;
}

/// Returns two axes across `to_light`, and `to_light` itself. The two are upright in the picture; if the light is
/// straight above or below, they follow the view direction.
glm::dmat3 axes_of_light(const glm::dvec3& to_light, const View& view) {
  constexpr double parallel = 1e-12;
  const glm::dvec3 upright = glm::cross(view.up(), to_light);
  const bool is_upright = glm::dot(upright, upright) > parallel;
  const glm::dvec3 side = glm::normalize(is_upright ? upright : glm::cross(view.forward(), to_light));
  return {side, glm::cross(to_light, side), to_light};
}

/// Returns the window of the light's view: around the visible points, clipped to the scene, with a margin for the
/// filter.
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

/// Returns the culling of the light's view. Light passes through one-sided triangles from behind if the eye sees
/// through them. Other culling is for the eye alone.
Culling culling_of_light(const View& picture) {
  return picture.culling == Culling::material ? Culling::material : Culling::none;
}

/// Returns the view of a window whose coordinates are relative to `zero`.
View view_of_window(const LightExtent& window, const glm::dmat3& axes, const glm::dvec3& zero, const View& picture) {
  View view;
  view.width = view.height = texels_for(picture);
  view.culling = culling_of_light(picture);
  const double depth = std::max(window.high.z - window.low.z, 1e-6 * (window.high.x - window.low.x));
  view.world_from_eye = glm::dmat4(axes);
  view.world_from_eye[3] = glm::dvec4(zero + axes * glm::dvec3(0, 0, window.high.z + 0.01 * depth), 1);
  view.projection = make_orthographic(window.low.x, window.high.x, window.low.y, window.high.y, {0.0, 1.02 * depth});
  return view;
}

/// Returns the least number of the form (8 + k) * 2^n that is not below a positive value. It is at most an eighth
/// greater.
double rounded_up(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);  // from a half to below one
  return std::ldexp(std::ceil(16 * mantissa) / 16, exponent);
}

/// Enlarges a window, so that its side length is one of a few and its centre is on a grid of an eighth of that length.
void snap(LightExtent& window) {
  constexpr double steps = 8;
  const double side = rounded_up((window.high.x - window.low.x) * steps / (steps - 1)), step = side / steps;
  for (int k = 0; k < 2; ++k) {
    const double centre = std::round(0.5 * (window.low[k] + window.high[k]) / step) * step;
    window.low[k] = centre - 0.5 * side;
    window.high[k] = centre + 0.5 * side;
  }
}

struct KeyRange {
  float least, greatest;
};

/// Replaces each number of a square by the least or the greatest of the 3 x 3 numbers that begin with it. `choose`
/// returns the lesser or the greater of two.
template <class Choose>
void spread(float* numbers, std::size_t size, const Choose& choose) {
  static_assert(ShadowGrid::window == 3 * ShadowGrid::block);
  for (std::size_t y = 0; y < size; ++y) {
    float* const row = numbers + y * size;
    for (std::size_t x = 0; x + 2 < size; ++x) row[x] = choose(row[x], choose(row[x + 1], row[x + 2]));
    row[size - 2] = choose(row[size - 2], row[size - 1]);
  }
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t next = y + 1; next < std::min(y + 3, size); ++next)
      for (std::size_t x = 0; x < size; ++x)
        numbers[y * size + x] = choose(numbers[y * size + x], numbers[next * size + x]);
}

/// Returns the range of a block of keys whose rows are `size` apart.
KeyRange range_of_block(const float* keys, std::size_t size) {
  constexpr std::size_t block = ShadowGrid::block;
  float least[block], greatest[block];
  std::copy_n(keys, block, least);
  std::copy_n(keys, block, greatest);
  for (std::size_t j = 1; j < block; ++j)
    for (std::size_t i = 0; i < block; ++i) {
      const float key = keys[j * size + i];
      least[i] = std::min(least[i], key);
      greatest[i] = std::max(greatest[i], key);
    }
  return {*std::min_element(least, least + block), *std::max_element(greatest, greatest + block)};
}

}  // namespace

std::optional<View> view_of_light(const SeenPoints& visible, const Box& bounds, const glm::dvec3& to_light,
                                  const Execution& execution) {
  const glm::dmat3 axes = axes_of_light(to_light, visible.view);
  const LightExtent seen = extent_of_visible(visible, axes, execution);
  if (seen.is_empty() || bounds.is_empty()) return std::nullopt;
  const glm::dvec3 eye = visible.view.eye();
  const int texels = texels_for(visible.view);
  return view_of_window(window_of(seen, extent_of_box(bounds, eye, axes), texels), axes, eye, visible.view);
}

std::optional<View> view_of_sun(const SeenPoints& visible, const Box& bounds, const Light& sun,
                                const Execution& execution) {
  const glm::dmat3 axes(sun.world_from_light);
  LightExtent seen = extent_of_visible(visible, axes, execution);
  if (seen.is_empty() || bounds.is_empty()) return std::nullopt;
  const int texels = texels_for(visible.view);
  // The window is relative to a point that does not move with the camera.
  const glm::dvec3 zero(bounds.centre()), eye = glm::transpose(axes) * (visible.view.eye() - zero);
  seen.low += eye;
  seen.high += eye;
  LightExtent window = window_of(seen, extent_of_box(bounds, zero, axes), texels);
  snap(window);
  return view_of_window(window, axes, zero, visible.view);
}

std::optional<View> view_of_spot(const View& picture, const Box& bounds, const Light& spot) {
  if (bounds.is_empty()) return std::nullopt;
  constexpr double widest = 1.3089969389957472;  // 75 degrees
  View view;
  view.width = view.height = texels_for(picture);
  view.culling = culling_of_light(picture);
  view.world_from_eye = spot.world_from_light;
  // The tangent is rounded to a float, because its last bit differs between machines.
  const double half = double(float(std::tan(std::min(spot.outer_cone, widest)))) * (1 + 2 * kSpareTexels / view.width);
  const double near = std::max(1e-4 * double(bounds.diagonal()), 1e-30);
  view.projection = make_frustum(-half * near, half * near, -half * near, half * near,
                                 {near, std::numeric_limits<double>::infinity()});
  return view;
}

void ShadowMap::draw(const Visible& seen_by_light, const Execution& execution) {
  clear();  // if the rest throws, everything is lit
  light_ = seen_by_light.view;
  constexpr std::size_t block = ShadowGrid::block;
  const auto size = std::size_t(light_.width), blocks = size / block;
  for (Buffer<float>* keys_of_blocks : {&farthest_, &nearest_})
    if (keys_of_blocks->size() != blocks * blocks) *keys_of_blocks = Buffer<float>(blocks * blocks);
  const float* const keys = seen_by_light.keys.data();
  parallel_for(execution, blocks, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (std::size_t x = 0; x < blocks; ++x) {
        const KeyRange range = range_of_block(keys + y * block * size + x * block, size);
        farthest_[y * blocks + x] = range.least;
        nearest_[y * blocks + x] = range.greatest;
      }
  });
  spread(farthest_.data(), blocks, [](float a, float b) { return std::min(a, b); });
  spread(nearest_.data(), blocks, [](float a, float b) { return std::max(a, b); });
  grid_.keys = keys;
  grid_.farthest = farthest_.data();
  grid_.nearest = nearest_.data();
  grid_.size = light_.width;
}

void ShadowMap::measure_from(const glm::dvec3& eye) {
  const glm::dmat3 axes(light_.world_from_eye);
  const Projection& window = light_.projection;
  const glm::dvec3 from_light = eye - light_.eye();
  const double texel = (window.right - window.left) / light_.width;  // of a spot, at a depth of 1
  double depth = 1;
  grid_.is_spot = !window.orthographic;
  grid_.to_light = glm::vec3(axes[2]);
  if (grid_.is_spot) {
    const double per_near = 1 / window.clip.near;
    const glm::dvec3 x = (axes[0] + axes[2] * window.left) * (per_near / texel);
    const glm::dvec3 y = (-axes[1] - axes[2] * window.top) * (per_near / texel), key = axes[2] * -per_near;
    grid_.texel_x = glm::vec3(x);
    grid_.texel_y = glm::vec3(y);
    grid_.key = glm::vec3(key);
    grid_.at_eye = glm::vec3(glm::dot(x, from_light), glm::dot(y, from_light), glm::dot(key, from_light));
    grid_.lamp = glm::vec3(-from_light);
  } else {
    depth = window.clip.far - window.clip.near;
    grid_.texel_x = glm::vec3(axes[0] / texel);
    grid_.texel_y = glm::vec3(axes[1] * (-1 / texel));
    grid_.key = glm::vec3(axes[2] / depth);
    // The light's eye is before everything that it sees and has key 1.
    grid_.at_eye =
        glm::vec3((glm::dot(axes[0], from_light) - window.left) / texel,
                  (window.top - glm::dot(axes[1], from_light)) / texel, 1 + glm::dot(axes[2], from_light) / depth);
  }
  grid_.key_bias = float(0.75 * texel / depth + 2e-6);
  grid_.key_slope_bias = float((0.5 * ShadowGrid::taps + 1) * texel / depth);
}

}  // namespace frontmost::shading
