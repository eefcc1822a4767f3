// SPDX-License-Identifier: Apache-2.0
// Look-ups in octahedral maps for many directions. Addresses are computed in plain loops over lanes. One read brings
// the four channels of two neighbouring texels.

// This file is included once for every target.
#if defined(FRONTMOST_SHADE_ENVIRONMENT_OCTAHEDRAL_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_SHADE_ENVIRONMENT_OCTAHEDRAL_LOOKUP_INL_H_
#undef FRONTMOST_SHADE_ENVIRONMENT_OCTAHEDRAL_LOOKUP_INL_H_
#else
#define FRONTMOST_SHADE_ENVIRONMENT_OCTAHEDRAL_LOOKUP_INL_H_
#endif

#include <cmath>
#include <cstdint>

#include "base/highway-inl.h"
// After Highway: a block of its own.
#include "shade/light/fragment_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A place on the unfolded octahedron. Both coordinates are 0 to 1, and 0 for NaN.
struct OctahedralPlace {
  float u, v;
};

inline float signed_as(float value, float sign) { return sign < 0 ? -value : value; }

inline OctahedralPlace octahedral_place(const Direction& d) {
  const float scale = 1.0f / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  const float x = d.x * scale, z = d.z * scale;
  const float below_x = signed_as(1.0f - std::abs(z), x), below_z = signed_as(1.0f - std::abs(x), z);
  const float u = d.y < 0 ? below_x : x, v = d.y < 0 ? below_z : z;
  return {clamp01(0.5f + 0.5f * u), clamp01(0.5f + 0.5f * v)};
}

/// The square of four texels around a place. `first` is the offset of its first texel in floats, from the beginning of
/// a map with border. (x, y) is the position of the place in the square, 0 to 1.
struct TexelSquare {
  std::int32_t first;
  float x, y;
};

inline TexelSquare texel_square(const OctahedralPlace& place, std::int32_t size) {
  const float x = place.u * float(size) + 0.5f, y = place.v * float(size) + 0.5f;
  const auto column = std::int32_t(x), row = std::int32_t(y);
  return {4 * (row * (size + 2) + column), x - float(column), y - float(row)};
}

/// Texel squares, indexed by fragment or by texel of another map.
template <int capacity>
struct TexelSquares {
  std::int32_t first[capacity];
  float x[capacity], y[capacity];

  HWY_INLINE void set(int i, const TexelSquare& square) {
    first[i] = square.first;
    x[i] = square.x;
    y[i] = square.y;
  }
  [[nodiscard]] HWY_INLINE TexelSquare at(int i) const { return {first[i], x[i], y[i]}; }
};

/// The four channels of two adjacent texels, in one vector or in several parts.
constexpr int kPairLanes = 8;
using DTexels = hn::CappedTag<float, kPairLanes>;
using VTexels = hn::Vec<DTexels>;
constexpr int kTexelLanes = int(hn::MaxLanes(DTexels())), kTexelParts = kPairLanes / kTexelLanes;
constexpr float kSecondTexel[kPairLanes] = {0, 0, 0, 0, 1, 1, 1, 1};

/// Adds `weight` times the bilinear interpolation in a square of texels. The sums of the two columns stay separate.
HWY_INLINE void AddSquare(const float* texels, std::int32_t floats_per_row, const TexelSquare& square, float weight,
                          VTexels* sums) {
  const DTexels d;
  const float* const upper = texels + square.first;
  const float* const lower = upper + floats_per_row;
  const auto part_y = hn::Set(d, square.y);
  const auto first = hn::Set(d, (1.0f - square.x) * weight), second = hn::Set(d, square.x * weight);
  for (int part = 0; part < kTexelParts; ++part) {
    const int lane = part * kTexelLanes;
    const auto is_second = hn::Gt(hn::LoadU(d, kSecondTexel + lane), hn::Zero(d));
    const auto above = hn::LoadU(d, upper + lane), below = hn::LoadU(d, lower + lane);
    const auto column = hn::Add(above, hn::Mul(hn::Sub(below, above), part_y));
    sums[part] = hn::Add(sums[part], hn::Mul(column, hn::IfThenElse(is_second, second, first)));
  }
}

/// Adds the sums of the two columns, and stores the four channels.
HWY_INLINE void StoreSum(const VTexels* sums, float* out) {
  const DTexels d;
#if HWY_TARGET != HWY_SCALAR  // the scalar target has no halves
  if constexpr (kTexelParts == 1) {
    const hn::Half<DTexels> half;
    return hn::StoreU(hn::Add(hn::LowerHalf(half, sums[0]), hn::UpperHalf(half, sums[0])), half, out);
  }
#endif
  if constexpr (kTexelParts > 1) {
    constexpr int half = kTexelParts / 2;
    for (int part = 0; part < half; ++part)
      hn::StoreU(hn::Add(sums[part], sums[part + half]), d, out + part * kTexelLanes);
  }
}

}  // namespace frontmost::shading::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
