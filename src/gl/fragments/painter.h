// SPDX-License-Identifier: Apache-2.0
// Draws batches and rectangles of pixels into one tile of a frame.
#pragma once

#include <atomic>
#include <cstdint>

#include "state/frame.h"
#include "vertex/batch.h"

namespace frontmost::gl_detail {

/// What happened to a fragment at the pixel of a probe.
struct FragmentEvent {
  enum class Verdict { culled, clipped, scissored, alpha_fails, stencil_fails, depth_fails, passes };

  std::uint32_t id;  ///< running number of the primitive
  Verdict verdict;
  std::uint32_t depth = 0, kept_depth = 0;  ///< stored depths of the fragment, and of the frame before it
  std::uint32_t kept_stencil = 0;           ///< of the frame before it
  float alpha = 1;
  bool is_back = false;  ///< for culled ones
  int planes = 0;        ///< out codes of the planes that cut it, for clipped ones
  const DrawState* state = nullptr;
};

/// A pixel whose fragments are recorded.
struct PixelProbe {
  int x, y;
  std::vector<FragmentEvent> events;
};

/// What is drawn into, and what is counted.
struct PaintTarget {
  Frame& frame;
  std::atomic<std::uint64_t>* passed;  ///< fragments that pass all tests; null if nobody counts them
  PixelProbe* probe = nullptr;         ///< if not null, only its pixel is drawn
};

/// Draws the primitives of a prepared batch that touch a tile, in the order of submission.
void paint_batch(const PaintTarget& target, const zbuffer_detail::Tile& tile, const Batch& batch, Isa isa);
/// Draws a rectangle of pixels, whose other values are those of the raster position.
void paint_rectangle(const PaintTarget& target, const zbuffer_detail::Tile& tile, const DrawState& state,
                     const PixelRectangle& rectangle, std::uint32_t id, Isa isa);

}  // namespace frontmost::gl_detail
