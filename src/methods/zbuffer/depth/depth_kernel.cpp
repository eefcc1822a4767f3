// SPDX-License-Identifier: Apache-2.0
// The depth test of every fragment in order.
//
// Coverage and keys follow tile_kernel.cpp: edge values are shifted right by 8, so that a pixel's step is -dy or dx.

#include "zbuffer/depth/depth_call.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/depth/depth_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "zbuffer/depth/depth_packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {

void DrawDepths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch) {
  if (call.rules.format == DepthFormat::f32)
    DepthPackets<true>(call, tile).Draw(batch);
  else
    DepthPackets<false>(call, tile).Draw(batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawDepths);

void draw_depths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch, Isa isa) {
  kernel_for(DrawDepthsKernels, isa)(call, tile, batch);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
