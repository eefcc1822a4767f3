// SPDX-License-Identifier: Apache-2.0
// The depth test of every fragment in order.
//
// Coverage and keys as in tile_kernel.cpp: edge values shifted right by 8, so that a pixel's step is -dy or dx.

#include "zbuffer/depth/depth_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/depth/depth_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "zbuffer/depth/depth_batches-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {

void DrawDepths(const DepthCall& call, const PixelRect& tile, const PlacedTriangles& triangles,
                std::span<const std::uint32_t> items) {
  if (call.rules.format == DepthFormat::f32)
    DepthBatches<true>(call, tile).Draw(triangles, items);
  else
    DepthBatches<false>(call, tile).Draw(triangles, items);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawDepths);

void draw_depths(const DepthCall& call, const PixelRect& tile, const PlacedTriangles& triangles,
                 std::span<const std::uint32_t> items, Isa isa) {
  kernel_for(DrawDepthsKernels, isa)(call, tile, triangles, items);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
