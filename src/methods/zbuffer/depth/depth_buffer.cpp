// SPDX-License-Identifier: Apache-2.0
// The depth buffer: planes that outlive draw calls. A draw call has three steps: the state becomes rules for this view
// and format, the triangles become batches in the order of their ids, and every batch is drawn into its tiles. Tiles
// are independent, so threads share no sample. Within a tile all batches come in order.
//
//    key      0 ............................ 1          0: at infinity, or at the far plane in parallel projection
//    depth    at_far ................. at_near          the depth range, in either direction; depths are limited to it
//
// Depths are affine in keys, computed in double and rounded once, so that every machine stores the same.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frontmost/zbuffer.h"
#include "zbuffer/depth/depth_call.h"

namespace frontmost {
namespace {

double steps(DepthFormat format) { return double((std::uint32_t(1) << integer_bits(format)) - 1); }

void check(bool is_good, const char* place, const char* complaint) {
  if (!is_good) throw Error(ErrorCode::bad_argument, place, complaint);
}

void check_state(const DepthState& state) {
  const auto is_depth = [](double value) { return value >= 0 && value <= 1; };
  check(is_depth(state.range_near) && is_depth(state.range_far), "depth range", "both ends must be from 0 to 1");
  for (const double value : {state.offset.factor, state.offset.units, state.offset.clamp})
    check(std::abs(value) <= 1e30, "polygon offset", "must be within 1e30");
  check(state.func <= DepthFunc::always, "depth function", "there are eight");
}

/// Returns the step between floats at a depth: 2^(e - 23) for 2^e <= depth < 2^(e + 1), but no less than the least
/// float.
double float_step(double depth) {
  constexpr int kLeast = -149, kFractionBits = 23;
  return std::ldexp(1.0, depth > 0 ? std::max(std::ilogb(depth) - kFractionBits, kLeast) : kLeast);
}

/// Validates size and samples. \returns the number of samples in all pixels. The rest of the view is arbitrary but
/// valid.
std::size_t checked_sample_count(int width, int height, int samples) {
  View view;
  view.width = width;
  view.height = height;
  view.samples = samples;
  view.projection.clip.near = 1;
  validate(view);
  return view.sample_count();
}

}  // namespace

int integer_bits(DepthFormat format) {
  switch (format) {
    case DepthFormat::d8: return 8;
    case DepthFormat::d16: return 16;
    case DepthFormat::d24: return 24;
    case DepthFormat::f32: break;
  }
  return 0;
}

std::uint32_t stored_depth(DepthFormat format, double depth) {
  if (format == DepthFormat::f32) {
    return bits_as<std::uint32_t>(float(depth) + 0.0f);  // -0 becomes +0: its bits would compare differently
  }
  // The product is rounded to a double and then to an integer, with ties to even in IeeeScope.
  return std::uint32_t(std::nearbyint(std::clamp(depth, 0.0, 1.0) * steps(format)));
}

double depth_of_stored(DepthFormat format, std::uint32_t stored) {
  if (format == DepthFormat::f32) return bits_as<float>(stored);
  return double(stored) / steps(format);
}

namespace zbuffer_detail {

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

using namespace zbuffer_detail;

DepthBuffer::DepthBuffer(int width, int height, int samples, DepthFormat format)
    : width_(width),
      height_(height),
      samples_(samples),
      format_(format),
      stored_(checked_sample_count(width, height, samples)),
      primitives_(stored_.size()),
      keys_(stored_.size()) {
  clear();
}

void DepthBuffer::clear(double depth) {
  if (!std::isfinite(depth)) throw Error(ErrorCode::bad_argument, "clear", "the depth must be a finite number");
  const IeeeScope ieee;
  std::fill(stored_.begin(), stored_.end(), stored_depth(format_, depth));
  std::fill(primitives_.begin(), primitives_.end(), no_primitive);
  std::fill(keys_.begin(), keys_.end(), 0.0f);
}

void DepthBuffer::draw(const Surfaces& surfaces, const View& view, const DepthDraw& call, const Execution& execution) {
  validate(view);
  if (view.width != width_ || view.height != height_ || view.samples != samples_)
    throw Error(ErrorCode::bad_argument, "view", "width, height and samples must be those of the depth buffer");
  const PrimitiveId end = std::min(call.end, surfaces.primitive_count());
  if (end > call.begin && call.id_offset > no_primitive - end)
    throw Error(ErrorCode::bad_argument, "id offset", "ids would exceed 4294967294");
  const IeeeScope ieee;
  const DepthRules rules = rules_for(call.state, format_, ScreenTransform(view));
  if (!rules.passes_less && !rules.passes_equal && !rules.passes_greater) return;  // never
  const DepthPlanes planes{stored_.data(), primitives_.data(), keys_.data(), width_, height_, sample_offsets(samples_)};
  const ScreenRays rays(view);
  const DepthCall target{planes, rules, call.id_offset, placed_scene(surfaces).cutouts.get(), rays};
  submit(surfaces, view, {call.begin, end}, execution,
         [&](const Tile& tile, const OrderedBatch& batch) { draw_depths(target, tile, batch, execution.isa); });
}

Buffer<float> DepthBuffer::depths() const {
  Buffer<float> depths(stored_.size());
  for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = float(depth_of_stored(format_, stored_[i]));
  return depths;
}

Visible DepthBuffer::visible(const View& view) const& { return {view, primitives_, keys_}; }

Visible DepthBuffer::visible(const View& view) && { return {view, std::move(primitives_), std::move(keys_)}; }

}  // namespace frontmost
