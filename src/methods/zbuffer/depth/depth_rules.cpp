// SPDX-License-Identifier: Apache-2.0
// Constants of a draw call from its state, and the formats' roundings.
//
//    key      0 ............................ 1          0: at infinity, or at the far plane in parallel projection
//    depth    at_far ................. at_near          the depth range, in either direction; depths are limited to it
//
// Keys are affine over the screen, and depths are affine in keys, so depths are affine over the screen too. Depths are
// computed in double and rounded once, to 8, 16 or 24 bits or to a float, so that every machine stores the same.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "zbuffer/depth/depth_call.h"

namespace frontmost {

int integer_bits(DepthFormat format) {
  switch (format) {
    case DepthFormat::d8: return 8;
    case DepthFormat::d16: return 16;
    case DepthFormat::d24: return 24;
    case DepthFormat::f32: break;
  }
  return 0;
}

namespace {

double steps(DepthFormat format) { return double((std::uint32_t(1) << integer_bits(format)) - 1); }

}  // namespace

std::uint32_t stored_depth(DepthFormat format, double depth) {
  if (format == DepthFormat::f32) {
    const float rounded = float(depth) + 0.0f;  // -0 becomes +0: its bits would compare differently
    std::uint32_t bits;
    std::memcpy(&bits, &rounded, sizeof bits);
    return bits;
  }
  // 24 bits times a double are exact but for the rounding itself, whose ties go to even in IeeeScope.
  return std::uint32_t(std::nearbyint(std::clamp(depth, 0.0, 1.0) * steps(format)));
}

double depth_of_stored(DepthFormat format, std::uint32_t stored) {
  if (format == DepthFormat::f32) {
    float depth;
    std::memcpy(&depth, &stored, sizeof depth);
    return depth;
  }
  return double(stored) / steps(format);
}

namespace zbuffer_detail {
namespace {

void check(bool is_good, const char* place, const char* complaint) {
  if (!is_good) throw Error(ErrorCode::bad_argument, place, complaint);
}

void check_state(const DepthState& state) {
  const auto is_depth = [](double value) { return value >= 0 && value <= 1; };
  check(is_depth(state.range_near) && is_depth(state.range_far), "depth range", "both ends must be 0 to 1");
  for (const double value : {state.offset.factor, state.offset.units, state.offset.clamp})
    check(std::abs(value) <= 1e30, "polygon offset", "must be within 1e30");
  check(state.func <= DepthFunc::always, "depth function", "there are eight");
}

/// 2^(e - 23) for 2^e <= depth < 2^(e + 1), and never less than the least float.
double float_step(double depth) {
  constexpr int kLeast = -149, kFractionBits = 23;
  return std::ldexp(1.0, depth > 0 ? std::max(std::ilogb(depth) - kFractionBits, kLeast) : kLeast);
}

}  // namespace

DepthRules rules_for(const DepthState& state, DepthFormat format, const ScreenTransform& t) {
  check_state(state);
  // Nearness is 1 at the near plane and 0 at the far plane, affine in the key. The key is 0 at infinity in perspective,
  // and at the far plane in parallel projection.
  const bool has_far_key = !t.orthographic && t.far < ScreenTransform::farthest;
  const double far_key = has_far_key ? double(t.near) / double(t.far) : 0;
  const double scale = 1 / (1 - far_key);
  const double at_near = state.nearer_is_greater ? state.range_far : state.range_near;
  const double at_far = state.nearer_is_greater ? state.range_near : state.range_far;

  DepthRules rules;
  rules.map.slope = (at_near - at_far) * scale;
  rules.map.at_zero = at_far - rules.map.slope * far_key + 0.0;  // + 0.0 turns -0 into +0, so no depth is -0
  rules.map.low = std::min(state.range_near, state.range_far) + 0.0;
  rules.map.high = std::max(state.range_near, state.range_far) + 0.0;
  rules.format = format;
  using enum DepthFunc;
  const DepthFunc f = state.func;
  rules.passes_less = f == less || f == less_equal || f == not_equal || f == always;
  rules.passes_equal = f == equal || f == less_equal || f == greater_equal || f == always;
  rules.passes_greater = f == greater || f == greater_equal || f == not_equal || f == always;
  rules.mask = state.mask;
  rules.offset = state.offset;
  return rules;
}

double DepthRules::offset_of(double gx, double gy, float key_low, float key_high) const {
  // Gradients are per 1/256 pixel, but OpenGL's m is per pixel. OpenGL allows the greater component instead of the
  // length.
  const double m = std::abs(map.slope) * kSubPixels * std::max(std::abs(gx), std::abs(gy));
  const double r =
      format == DepthFormat::f32 ? float_step(std::max(map.of(key_low), map.of(key_high))) : 1 / steps(format);
  const double sum = m * offset.factor + r * offset.units;
  if (offset.clamp > 0) return std::min(sum, offset.clamp);
  if (offset.clamp < 0) return std::max(sum, offset.clamp);
  return sum;
}

}  // namespace zbuffer_detail
}  // namespace frontmost
