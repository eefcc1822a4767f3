// SPDX-License-Identifier: Apache-2.0
// OpenGL's depth test as a state machine: one fragment after another, every sample against every triangle.
#pragma once

#include <cmath>
#include <cstring>

#include "frontmost/zbuffer.h"
#include "support/oracle.h"

namespace frontmost::test {

class DepthOracle {
 public:
  DepthOracle(const View& view, DepthFormat format)
      : view_(view),
        transform_(view),
        format_(format),
        stored_(view.sample_count(), 0),
        visible_{view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())} {
    clear(1);
  }

  void clear(double depth) {
    for (std::size_t i = 0; i < stored_.size(); ++i) {
      stored_[i] = rounded(depth);
      visible_.primitives[i] = no_primitive;
      visible_.keys[i] = 0;
    }
  }

  void draw(const Surfaces& surfaces, const DepthDraw& call) {
    for_each_primitive(surfaces, call.begin, call.end, [&](PrimitiveId id, const std::array<glm::vec3, 3>& world) {
      draw(clip_triangle(transform_, world), id + call.id_offset, call.state);
    });
  }

  [[nodiscard]] const Buffer<std::uint32_t>& stored() const { return stored_; }
  [[nodiscard]] const Visible& visible() const { return visible_; }

 private:
  [[nodiscard]] double steps() const {
    return format_ == DepthFormat::d8 ? 255.0 : format_ == DepthFormat::d16 ? 65535.0 : 16777215.0;
  }

  [[nodiscard]] std::uint32_t rounded(double depth) const {
    if (format_ != DepthFormat::f32) {
      depth = depth < 0 ? 0 : depth > 1 ? 1 : depth;
      return std::uint32_t(std::nearbyint(depth * steps()));
    }
    const auto value = float(depth);
    std::uint32_t bits;
    std::memcpy(&bits, &value, 4);
    return bits;
  }

  [[nodiscard]] double value(std::uint32_t stored) const {
    if (format_ != DepthFormat::f32) return stored;
    float value;
    std::memcpy(&value, &stored, 4);
    return value;
  }

  /// Depth within the depth range, before any offset.
  [[nodiscard]] double window_depth(float key, const DepthState& state) const {
    const bool far_is_finite = !transform_.orthographic && std::isfinite(view_.projection.clip.far);
    const double far_key = far_is_finite ? double(transform_.near) / double(transform_.far) : 0.0;
    const double at_near = state.nearer_is_greater ? state.range_far : state.range_near;
    const double at_far = state.nearer_is_greater ? state.range_near : state.range_far;
    // The slope is rounded once, so that it has the same bits as in the library.
    const double slope = (at_near - at_far) * (1 / (1 - far_key));
    const double depth = (at_far - slope * far_key) + slope * double(key);
    return std::min(std::max(depth, std::min(at_near, at_far)), std::max(at_near, at_far));
  }

  [[nodiscard]] double offset(const OracleTriangle& t, double greatest, const DepthState& state) const {
    if (state.offset.factor == 0 && state.offset.units == 0) return 0;
    // The plane's gradient: edge functions from the farthest vertex, weighted by how much nearer the others are.
    int far = 0;
    for (int k = 1; k < 3; ++k)
      if (t.key[k] < t.key[far]) far = k;
    const int p = (far + 1) % 3, q = (far + 2) % 3;
    const double a = (double(t.key[p]) - double(t.key[far])) / double(oracle_area(t));
    const double b = (double(t.key[q]) - double(t.key[far])) / double(oracle_area(t));
    const double gx = -(double(t.y[far] - t.y[q]) * a + double(t.y[p] - t.y[far]) * b);
    const double gy = double(t.x[far] - t.x[q]) * a + double(t.x[p] - t.x[far]) * b;
    const double far_key = std::isfinite(view_.projection.clip.far) && !transform_.orthographic
                               ? double(transform_.near) / double(transform_.far)
                               : 0.0;
    const double slope = (state.range_far - state.range_near) * (1 / (1 - far_key));
    const double m = std::abs(slope) * 256 * std::max(std::abs(gx), std::abs(gy));
    double r = 1 / steps();
    if (format_ == DepthFormat::f32) {
      int exponent = 0;
      if (greatest > 0) std::frexp(greatest, &exponent);  // greatest = [0.5, 1) * 2^exponent
      r = greatest > 0 ? std::ldexp(1.0, std::max(exponent - 1 - 23, -149)) : std::ldexp(1.0, -149);
    }
    const double sum = m * state.offset.factor + r * state.offset.units;
    if (state.offset.clamp > 0) return std::min(sum, state.offset.clamp);
    if (state.offset.clamp < 0) return std::max(sum, state.offset.clamp);
    return sum;
  }

  void draw(const ClippedPolygon& polygon, PrimitiveId id, const DepthState& state) {
    double greatest = 0;
    for (int i = 0; i < polygon.count; ++i)
      greatest = std::max(greatest, window_depth(polygon.corners[std::size_t(i)].key, state));
    for_each_triangle(transform_, view_.culling, polygon, id, [&](const OracleTriangle& t) {
      const double o = offset(t, greatest, state);
      for_each_covered(visible_, t, [&](std::size_t at, float key) {
        const double depth = std::min(std::max(window_depth(key, state) + o, 0.0), 1.0);
        fragment(at, rounded(depth), key, t.id, state);
      });
    });
  }

  void fragment(std::size_t at, std::uint32_t depth, float key, PrimitiveId id, const DepthState& state) {
    if (!passes(state.func, value(depth), value(stored_[at]))) return;
    if (state.mask) stored_[at] = depth;
    visible_.primitives[at] = id;
    visible_.keys[at] = key;
  }

  static bool passes(DepthFunc func, double incoming, double kept) {
    switch (func) {
      case DepthFunc::never: return false;
      case DepthFunc::less: return incoming < kept;
      case DepthFunc::equal: return incoming == kept;
      case DepthFunc::less_equal: return incoming <= kept;
      case DepthFunc::greater: return incoming > kept;
      case DepthFunc::not_equal: return incoming != kept;
      case DepthFunc::greater_equal: return incoming >= kept;
      case DepthFunc::always: return true;
    }
    return false;
  }

  View view_;
  ScreenTransform transform_;
  DepthFormat format_;
  Buffer<std::uint32_t> stored_;
  Visible visible_;
};

}  // namespace frontmost::test
