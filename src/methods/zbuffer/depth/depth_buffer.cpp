// SPDX-License-Identifier: Apache-2.0
// The depth buffer: planes that outlive draw calls.
//
// A draw call has three steps: the state becomes rules for this view and format, the triangles become batches in the
// order of their ids, and every batch is drawn into its tiles. Tiles are independent, so threads share no sample.
// Within a tile all batches come in order.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frontmost/zbuffer.h"
#include "zbuffer/depth/depth_call.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

/// Validates size and samples; the rest of the view is arbitrary but valid.
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
    throw Error(ErrorCode::bad_argument, "id offset", "ids would pass 4294967294");
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
