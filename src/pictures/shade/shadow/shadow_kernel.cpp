// SPDX-License-Identifier: Apache-2.0
// Points are mapped to texels, a vector of points at a time. Most points are nearer to the light than all texels around
// them, or farther, which two numbers per block tell. For the other points a window of 8 x 8 texels is compared, eight
// columns side by side. Sums are made row by row and added in a fixed order, so that every instruction set gives the
// same bits.

#include "shade/shadow/shadow_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/shadow/shadow_kernel.cpp"
#include <algorithm>
#include <cmath>

#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

constexpr int kTaps = ShadowGrid::taps, kBlock = ShadowGrid::block;
static_assert(kTaps == 8 && ShadowGrid::window >= kTaps + kBlock);
constexpr float kHalf = 0.5f * kTaps;
constexpr float kToFirst = kHalf - 0.5f;  ///< the filter of a point at x begins at texel int(x - kToFirst)

/// Points in the map: texel coordinates, and keys with the bias.
struct MapPoints {
  float x[ShadowPoints::most], y[ShadowPoints::most], key[ShadowPoints::most];
};

HWY_INLINE VF DotOf(const glm::vec3& v, const float* x, const float* y, const float* z) {
  const DF d;
  const VF xx = hn::Mul(hn::Set(d, v.x), hn::LoadU(d, x)), yy = hn::Mul(hn::Set(d, v.y), hn::LoadU(d, y));
  return hn::Add(hn::Add(xx, yy), hn::Mul(hn::Set(d, v.z), hn::LoadU(d, z)));
}

/// Returns the bias of a point. Within the filter's width a slanted surface comes nearer to the light, which must not
/// count as shadow.
HWY_INLINE VF BiasOf(const ShadowGrid& grid, VF cosine, VF sine) {
  const DF d;
  const VF steepest = hn::Set(d, 8.0f), one = hn::Set(d, 1.0f);
  const MF is_gentle = hn::Lt(sine, hn::Mul(steepest, cosine));
  const VF slope = hn::IfThenElse(is_gentle, hn::Div(sine, hn::IfThenElse(is_gentle, cosine, one)), steepest);
  return hn::Add(hn::Set(d, grid.key_bias), hn::Mul(slope, hn::Set(d, grid.key_slope_bias)));
}

/// A vector of points in the light's view: texels and keys before any division, and the surface's angle to the axis.
struct LightSpacePoints {
  VF x, y, key, cosine, sine;
};

HWY_INLINE LightSpacePoints InLightSpace(const ShadowGrid& grid, const ShadowPoints& points, int i) {
  const DF d;
  const auto place = [&](const glm::vec3& step, float at_eye) HWY_ATTR {
    return hn::Add(DotOf(step, points.x + i, points.y + i, points.z + i), hn::Set(d, at_eye));
  };
  LightSpacePoints p;
  p.cosine = hn::Abs(DotOf(grid.to_light, points.normal_x + i, points.normal_y + i, points.normal_z + i));
  p.sine = hn::Sqrt(hn::Max(hn::Sub(hn::Set(d, 1.0f), hn::Mul(p.cosine, p.cosine)), hn::Zero(d)));
  p.x = place(grid.texel_x, grid.at_eye.x);
  p.y = place(grid.texel_y, grid.at_eye.y);
  p.key = place(grid.key, grid.at_eye.z);
  return p;
}

void FindPlacesOfSun(const ShadowGrid& grid, const ShadowPoints& points, MapPoints& out) {
  const DF d;
  for (int i = 0; i < points.count; i += int(hn::Lanes(d))) {
    const LightSpacePoints p = InLightSpace(grid, points, i);
    hn::StoreU(p.x, d, out.x + i);
    hn::StoreU(p.y, d, out.y + i);
    hn::StoreU(hn::Add(p.key, BiasOf(grid, p.cosine, p.sine)), d, out.key + i);
  }
}

/// Finds the places of points in the map of a spot. The slope for the bias uses the cosine between normal and ray,
/// times the ray's length per unit along the axis.
void FindPlacesOfSpot(const ShadowGrid& grid, const ShadowPoints& points, MapPoints& out) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), nowhere = hn::Set(d, -1.0f);
  const float per_near = std::abs(glm::dot(grid.key, grid.to_light));
  for (int i = 0; i < points.count; i += int(hn::Lanes(d))) {
    const LightSpacePoints p = InLightSpace(grid, points, i);
    const auto towards = [&](const float* normal, const float* at, float lamp) HWY_ATTR {
      return hn::Mul(hn::LoadU(d, normal + i), hn::Sub(hn::LoadU(d, at + i), hn::Set(d, lamp)));
    };
    const VF ray = hn::Add(
        hn::Add(towards(points.normal_x, points.x, grid.lamp.x), towards(points.normal_y, points.y, grid.lamp.y)),
        towards(points.normal_z, points.z, grid.lamp.z));
    const MF is_before = hn::Gt(p.key, hn::Zero(d));
    const VF key = hn::Div(one, hn::IfThenElse(is_before, p.key, one));
    const VF cosine = hn::Mul(hn::Mul(hn::Abs(ray), hn::Set(d, per_near)), key);
    hn::StoreU(hn::IfThenElse(is_before, hn::Mul(p.x, key), nowhere), d, out.x + i);
    hn::StoreU(hn::IfThenElse(is_before, hn::Mul(p.y, key), nowhere), d, out.y + i);
    hn::StoreU(hn::Mul(key, hn::Add(one, BiasOf(grid, cosine, p.sine))), d, out.key + i);
  }
}

/// The light of a vector of points, by their blocks.
struct LightOfBlocks {
  VF light;              ///< 1 for points that are wholly lit, else 0
  std::uint64_t partly;  ///< bits of the points that need the filter
};

/// Decides the points from i on by their blocks. Points whose filter reaches out of the map are lit.
HWY_INLINE LightOfBlocks AskBlocks(const ShadowGrid& grid, const MapPoints& points, int i) {
  const DF d;
  const DI di;
  const VF x = hn::Sub(hn::LoadU(d, points.x + i), All(kToFirst));
  const VF y = hn::Sub(hn::LoadU(d, points.y + i), All(kToFirst));
  const VF zero = hn::Zero(d), end = All(float(grid.size - kTaps));
  const MF is_within = hn::And(hn::And(hn::Ge(x, zero), hn::Ge(y, zero)), hn::And(hn::Lt(x, end), hn::Lt(y, end)));
  static_assert(kBlock == 1 << 2);
  const auto block = [&](VF texel) HWY_ATTR {
    return hn::ShiftRight<2>(hn::ConvertTo(di, hn::IfThenElseZero(is_within, texel)));
  };
  const VI number = hn::Add(hn::Mul(block(y), hn::Set(di, grid.size / kBlock)), block(x));
  const VF key = hn::LoadU(d, points.key + i);
  const MF is_before = hn::Ge(key, hn::GatherIndex(d, grid.nearest, number));
  const MF is_behind = hn::Lt(key, hn::GatherIndex(d, grid.farthest, number));
  return {hn::IfThenElseZero(hn::Or(is_before, hn::Not(is_within)), All(1.0f)),
          BitsOf(d, hn::AndNot(hn::Or(is_before, is_behind), is_within))};
}

/// Returns the lanes whose answer is yes, of `count` answers. The room behind the answers holds a vector.
HWY_INLINE MF AskedAt(const bool* answers, int count) {
  const hn::Rebind<std::uint8_t, DF> bytes;
  const VU asked = hn::PromoteTo(DU(), hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(answers)));
  return hn::And(hn::RebindMask(DF(), hn::Ne(asked, hn::Zero(DU()))), hn::FirstN(DF(), std::size_t(count)));
}

/// The columns of a window that fit into a vector.
using DColumns = hn::CappedTag<float, kTaps>;
using VColumns = hn::Vec<DColumns>;

/// Returns the weights of the texels from `first` on for a point at `at`. A tent filter makes edges fade without steps.
/// Its weights at whole texels always sum to kHalf * kHalf.
HWY_INLINE VColumns WeightsFrom(int first, float at) {
  const DColumns d;
  const auto texel = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, float(first) + 0.5f));
  return hn::Max(hn::Sub(hn::Set(d, kHalf), hn::Abs(hn::Sub(texel, hn::Set(d, at)))), hn::Zero(d));
}

float FilterWindow(const ShadowGrid& grid, const glm::vec3& place) {
  const DColumns d;
  const int x0 = int(place.x - kToFirst), y0 = int(place.y - kToFirst);
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
  const int lanes = int(hn::Lanes(DF()));
  MapPoints places;
  grid.is_spot ? FindPlacesOfSpot(grid, points, places) : FindPlacesOfSun(grid, points, places);
  for (int i = 0; i < points.count; i += lanes) {
    const MF asked = AskedAt(is_asked + i, points.count - i);
    const LightOfBlocks blocks = AskBlocks(grid, places, i);
    hn::BlendedStore(blocks.light, asked, DF(), light + i);
    ForEachBit(BitsOf(DF(), asked) & blocks.partly, [&](std::size_t k) {
      const std::size_t p = std::size_t(i) + k;
      light[p] = FilterWindow(grid, {places.x[p], places.y[p], places.key[p]});
    });
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
