// SPDX-License-Identifier: Apache-2.0
// Converts finished pixels to bytes, a whole vector at a time. The pixels are composited over the background, and the
// table of base/srgb.h converts them to sRGB, one entry per lane. A pixel with an alpha between 0 and 1 must be divided
// by its alpha. Such pixels occur at edges if there is no background; a vector that contains one is stored pixel by
// pixel.

#include "shade/canvas/canvas.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/canvas/canvas_kernel.cpp"
#include <algorithm>
#include <cstring>

#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"
#include "image/srgb_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

/// Returns what srgb8_of_linear() returns, for a vector of values.
HWY_INLINE VU SrgbOf(VF linear) {
  const DU du;
  const VF least = All(detail::least_srgb8), one = All(1.0f);
  const VF above = hn::IfThenElse(hn::Gt(linear, least), linear, least);  // NaN becomes the least
  const VU bits = hn::BitCast(du, hn::IfThenElse(hn::Lt(above, one), above, one));
  const VI bucket = hn::BitCast(DI(), hn::ShiftRight<16>(hn::Sub(bits, hn::Set(du, detail::least_srgb8_bits))));
  const VU entry = hn::GatherIndex(du, detail::srgb8_buckets.data(), bucket);
  return hn::ShiftRight<16>(hn::Add(entry, hn::And(bits, hn::Set(du, 0xFFFF))));
}

/// A vector of premultiplied pixels.
struct PixelVector {
  VF r, g, b, a;

  void LayOver(const glm::vec4& ground) {
    const VF rest = hn::Sub(All(1.0f), a);
    r = hn::Add(r, hn::Mul(All(ground.r), rest));
    g = hn::Add(g, hn::Mul(All(ground.g), rest));
    b = hn::Add(b, hn::Mul(All(ground.b), rest));
    a = hn::Add(a, hn::Mul(All(ground.a), rest));
  }
};

void StoreOneByOne(const PixelVector& colors, std::uint8_t* out) {
  const DF d;
  alignas(64) float r[kMaxLanes], g[kMaxLanes], b[kMaxLanes], a[kMaxLanes];
  hn::Store(colors.r, d, r);
  hn::Store(colors.g, d, g);
  hn::Store(colors.b, d, b);
  hn::Store(colors.a, d, a);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) store_rgba8({r[i], g[i], b[i], a[i]}, out + 4 * i);
}

/// Stores one pixel per lane, composited over the background.
HWY_INLINE void StoreVector(const glm::vec4* pixels, const glm::vec4& background, std::uint8_t* out) {
  const DF d;
  const DU du;
  PixelVector colors;
  hn::LoadInterleaved4(d, &pixels->x, colors.r, colors.g, colors.b, colors.a);
  colors.LayOver(background);
  const MF is_solid = hn::Ge(colors.a, All(1.0f));
  const MF is_whole = hn::Or(is_solid, hn::Le(colors.a, hn::Zero(d)));
  if (!hn::AllTrue(d, is_whole)) return StoreOneByOne(colors, out);
  const VU red = SrgbOf(colors.r), green = hn::ShiftLeft<8>(SrgbOf(colors.g));
  const VU blue = hn::ShiftLeft<16>(SrgbOf(colors.b)), alpha = hn::Set(du, 0xFF000000u);
  const VU bytes = hn::Or(hn::Or(red, green), hn::Or(blue, alpha));
  hn::StoreU(hn::IfThenElseZero(hn::RebindMask(du, is_solid), bytes), du, reinterpret_cast<std::uint32_t*>(out));
}

}  // namespace

void StoreRow(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out) {
  const int lanes = int(hn::Lanes(DF()));
  int x = 0;
  for (; x + lanes <= count; x += lanes) StoreVector(pixels + x, background, out + 4 * x);
  if (x >= count) return;
  glm::vec4 last[kMaxLanes] = {};
  alignas(64) std::uint8_t bytes[4 * kMaxLanes];
  std::copy(pixels + x, pixels + count, last);
  StoreVector(last, background, bytes);
  std::memcpy(out + 4 * x, bytes, 4 * std::size_t(count - x));
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(StoreRow);

void store_row(const glm::vec4* pixels, int count, const glm::vec4& background, std::uint8_t* out, Isa isa) {
  kernel_for(StoreRowKernels, isa)(pixels, count, background, out);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
