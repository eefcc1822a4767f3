// SPDX-License-Identifier: Apache-2.0
// Points are taken to the map's texels a vector at a time. Most are nearer to the light than everything around them,
// which nine numbers say; for the others a window of eight by eight texels is compared, eight columns side by side.
// Their sums are made row by row and then added up in one order, so that every instruction set gives the same bits.

#include "shade/shadow/shadow_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/shadow/shadow_kernel.cpp"
#include <algorithm>
#include <cmath>

#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

constexpr int kTaps = ShadowGrid::taps, kBlock = ShadowGrid::block;
static_assert(kTaps == 8 && kBlock == 4);
constexpr float kHalf = 0.5f * kTaps;

/// Points in the map: texels, and keys with the bias.
struct MapPoints {
  float x[ShadowPoints::most], y[ShadowPoints::most], key[ShadowPoints::most];
};

HWY_INLINE VF DotOf(const glm::vec3& v, const float* x, const float* y, const float* z) {
  const DF d;
  const VF xx = hn::Mul(hn::Set(d, v.x), hn::LoadU(d, x)), yy = hn::Mul(hn::Set(d, v.y), hn::LoadU(d, y));
  return hn::Add(hn::Add(xx, yy), hn::Mul(hn::Set(d, v.z), hn::LoadU(d, z)));
}

void FindPlaces(const ShadowGrid& grid, const ShadowPoints& points, MapPoints& out) {
  const DF d;
  // Over the filter's width a slanted surface itself comes nearer to the light by its slope: that is no shadow.
  const VF steepest = hn::Set(d, 8.0f), one = hn::Set(d, 1.0f);
  for (int i = 0; i < points.count; i += int(hn::Lanes(d))) {
    const auto place = [&](const glm::vec3& step, float at_eye) {
      return hn::Add(DotOf(step, points.x + i, points.y + i, points.z + i), hn::Set(d, at_eye));
    };
    const VF cosine = hn::Abs(DotOf(grid.to_light, points.normal_x + i, points.normal_y + i, points.normal_z + i));
    const VF sine = hn::Sqrt(hn::Max(hn::Sub(one, hn::Mul(cosine, cosine)), hn::Zero(d)));
    const MF is_gentle = hn::Lt(sine, hn::Mul(steepest, cosine));
    const VF slope = hn::IfThenElse(is_gentle, hn::Div(sine, hn::IfThenElse(is_gentle, cosine, one)), steepest);
    const VF bias = hn::Add(hn::Set(d, grid.key_bias), hn::Mul(slope, hn::Set(d, grid.key_slope_bias)));
    hn::StoreU(place(grid.texel_x, grid.at_eye.x), d, out.x + i);
    hn::StoreU(place(grid.texel_y, grid.at_eye.y), d, out.y + i);
    hn::StoreU(hn::Add(place(grid.key, grid.at_eye.z), bias), d, out.key + i);
  }
}

/// Whether no texel of the window is nearer to the light.
bool IsBeforeAll(const ShadowGrid& grid, int x, int y, float key) {
  const int blocks = grid.size / kBlock;
  const float* const nearest = grid.nearest + (y / kBlock) * blocks + x / kBlock;
  float most = nearest[0];
  for (int v = 0; v < 3; ++v)
    for (int u = 0; u < 3; ++u) most = std::max(most, nearest[v * blocks + u]);
  return key >= most;
}

/// As many columns of a window as there is room for.
using DColumns = hn::CappedTag<float, kTaps>;
using VColumns = hn::Vec<DColumns>;

/// A tent, so that edges fade without steps. Its weights at whole texels always sum to kHalf * kHalf. Of the texels
/// from `first` on, for a point at `at`.
HWY_INLINE VColumns WeightsFrom(int first, float at) {
  const DColumns d;
  const auto texel = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, float(first) + 0.5f));
  return hn::Max(hn::Sub(hn::Set(d, kHalf), hn::Abs(hn::Sub(texel, hn::Set(d, at)))), hn::Zero(d));
}

float FilterWindow(const ShadowGrid& grid, int x0, int y0, const glm::vec3& place) {
  const DColumns d;
  const float* const window = grid.keys + std::size_t(y0) * std::size_t(grid.size) + std::size_t(x0);
  HWY_ALIGN float down[kTaps];
  for (int j = 0; j < kTaps; j += int(hn::Lanes(d))) hn::Store(WeightsFrom(y0 + j, place.y), d, down + j);
  const auto key = hn::Set(d, place.z);
  HWY_ALIGN float lit[kTaps];
  for (int i = 0; i < kTaps; i += int(hn::Lanes(d))) {
    auto sum = hn::Zero(d);
    for (int j = 0; j < kTaps; ++j) {
      const auto is_lit = hn::Le(hn::LoadU(d, window + std::size_t(j) * std::size_t(grid.size) + i), key);
      sum = hn::Add(sum, hn::IfThenElseZero(is_lit, hn::Set(d, down[j])));
    }
    hn::Store(hn::Mul(sum, WeightsFrom(x0 + i, place.x)), d, lit + i);
  }
  const float sum = ((lit[0] + lit[1]) + (lit[2] + lit[3])) + ((lit[4] + lit[5]) + (lit[6] + lit[7]));
  return sum * (1.0f / (kHalf * kHalf * kHalf * kHalf));
}

}  // namespace

void FindLight(const ShadowGrid& grid, const ShadowPoints& points, const bool* is_asked, float* light) {
  MapPoints places;
  FindPlaces(grid, points, places);
  const float end = float(grid.size - kTaps);
  for (int i = 0; i < points.count; ++i) {
    if (!is_asked[i]) continue;
    light[i] = 1.0f;
    // The first texel whose centre is within the filter, plus a fraction.
    const float x = places.x[i] - (kHalf - 0.5f), y = places.y[i] - (kHalf - 0.5f);
    if (!(x >= 0 && y >= 0 && x < end && y < end)) continue;
    const int x0 = int(x), y0 = int(y);
    if (!IsBeforeAll(grid, x0, y0, places.key[i]))
      light[i] = FilterWindow(grid, x0, y0, {places.x[i], places.y[i], places.key[i]});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FindLight);

void ShadowMap::find_light(const ShadowPoints& points, const bool* is_asked, float* light, Isa isa) const {
  if (grid_.size > 0) return kernel_for(FindLightKernels, isa)(grid_, points, is_asked, light);
  for (int i = 0; i < points.count; ++i)
    if (is_asked[i]) light[i] = 1.0f;
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
