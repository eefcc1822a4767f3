// SPDX-License-Identifier: Apache-2.0
// Texels are read one by one, four channels to a vector or those of two levels side by side: a load brings all channels
// of a texel, where a gather of many fragments' texels would bring one of each. Where to read is found for many taps at
// a time.

#include "shade/texture_sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/texture_kernel.cpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

inline float Log2(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  const float exponent = float(int(bits >> 23) - 127);
  bits = (bits & 0x007FFFFFu) | 0x3F800000u;
  float mantissa;
  std::memcpy(&mantissa, &bits, sizeof mantissa);
  // A parabola through the exact values at 1 and 2, so that there is no step between octaves.
  const float t = mantissa - 1.0f;
  return exponent + t * (1.3465f - 0.3465f * t);
}

inline float Length(float x, float y) { return std::sqrt(x * x + y * y); }

/// Places of fragments in a texture, the axis along which their footprints reach farthest, and how far.
struct Footprints {
  float u[sampled_at_once], v[sampled_at_once];
  float axis_u[sampled_at_once], axis_v[sampled_at_once];
  float level[sampled_at_once];
  std::int32_t count[sampled_at_once];
};

void FindFootprints(const TapRequest& request, Footprints& out) {
  const Geometry& g = request.geometry;
  const glm::vec2 across = request.transform.across(), down = request.transform.down();
  const glm::vec2 offset = request.transform.offset();
  const Pyramid::Level& finest = request.pyramid.levels().front();
  const float width = float(finest.width), height = float(finest.height);
  const float last = float(request.pyramid.levels().size() - 1);
  const bool is_nearest = request.pyramid.texture().nearest;
  for (int k = 0; k < request.count; ++k) {
    const int i = request.begin + k;
    const float s = g.texcoord.x[i], t = g.texcoord.y[i];
    const float sx = g.texcoord_dx.x[i], tx = g.texcoord_dx.y[i], sy = g.texcoord_dy.x[i], ty = g.texcoord_dy.y[i];
    out.u[k] = (across.x * s + down.x * t) + offset.x;
    out.v[k] = (across.y * s + down.y * t) + offset.y;
    const float ux = across.x * sx + down.x * tx, vx = across.y * sx + down.y * tx;
    const float uy = across.x * sy + down.x * ty, vy = across.y * sy + down.y * ty;
    const float along_x = Length(ux * width, vx * height), along_y = Length(uy * width, vy * height);
    const bool is_x = along_x > along_y;
    const float longer = is_x ? along_x : along_y, least = is_x ? along_y : along_x;
    const float shorter = least > 1.0f ? least : 1.0f;
    const bool is_small = !(longer > 1.0f), is_huge = !is_small && !(longer < 1e30f);
    const bool is_plain = is_small || is_huge || is_nearest;
    const float ratio = is_plain ? 1.0f : longer / shorter;
    const int count = ratio < float(most_taps) ? int(ratio + 0.999f) : most_taps;
    const float widest = longer * (1.0f / most_taps);
    const float wanted = Log2(is_plain ? 1.0f : (shorter > widest ? shorter : widest));
    const float level = is_huge ? last : (wanted > 0.0f ? (wanted < last ? wanted : last) : 0.0f);
    const bool is_spread = count > 1;
    out.count[k] = count;
    out.level[k] = level;
    out.axis_u[k] = is_spread ? (is_x ? ux : uy) : 0.0f;
    out.axis_v[k] = is_spread ? (is_x ? vx : vy) : 0.0f;
  }
}

/// Writes down the taps of all fragments.
void SpreadTaps(const TapRequest& request, const Footprints& footprints, Taps& taps) {
  int n = 0;
  for (int k = 0; k < request.count; ++k) {
    const int count = footprints.count[k], level = int(footprints.level[k]);
    taps.count[k] = std::uint8_t(count);
    taps.level[k] = std::uint8_t(level);
    taps.blend[k] = footprints.level[k] - float(level);
    const std::array<float, 4> sizes = request.pyramid.sizes_from(level);
    for (int t = 0; t < count; ++t, ++n) {
      const float at = (float(t) + 0.5f) / float(count) - 0.5f;
      const float u = footprints.u[k] + footprints.axis_u[k] * at, v = footprints.v[k] + footprints.axis_v[k] * at;
      float* const place = taps.place.values + 4 * n;
      place[0] = place[2] = u;
      place[1] = place[3] = v;
      std::memcpy(taps.size.values + 4 * n, sizes.data(), sizeof sizes);
    }
  }
  taps.fragments = request.count;
  taps.taps = n;
}

/// u, v, u, v of as many taps as there is room for.
using DPlaces = hn::CappedTag<float, 16>;
using VPlaces = hn::Vec<DPlaces>;
using MPlaces = hn::Mask<DPlaces>;

/// Which lanes wrap so, for vectors that begin at u or at v.
class WrappingLanes {
 public:
  WrappingLanes(const Texture& texture, Texture::Wrap wrap) {
    for (std::size_t i = 0; i < std::size(lanes_); ++i)
      lanes_[i] = (i % 2 == 0 ? texture.wrap_u : texture.wrap_v) == wrap ? 1.0f : 0.0f;
  }
  [[nodiscard]] HWY_INLINE MPlaces at(int lane) const {
    return hn::Gt(hn::LoadU(DPlaces(), lanes_ + lane % 2), hn::Zero(DPlaces()));
  }

 private:
  float lanes_[18];
};

/// As wrapped() of texture_lookup.h.
struct Wrapping {
  MPlaces repeats, mirrors;

  HWY_INLINE VPlaces operator()(VPlaces t) const {
    const DPlaces d;
    const auto one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const auto sane = hn::IfThenElseZero(hn::Lt(hn::Abs(t), hn::Set(d, 1e6f)), t);
    const auto clamped = hn::Min(hn::Max(sane, hn::Zero(d)), one);
    const auto repeated = hn::Sub(sane, hn::Floor(sane));
    const auto twice = hn::Sub(sane, hn::Mul(two, hn::Floor(hn::Mul(sane, hn::Set(d, 0.5f)))));
    const auto mirrored = hn::IfThenElse(hn::Gt(twice, one), hn::Sub(two, twice), twice);
    return hn::IfThenElse(repeats, repeated, hn::IfThenElse(mirrors, mirrored, clamped));
  }
};

/// As texel_pair() of texture_lookup.h, and as texel_of() for textures that are not filtered.
void PlaceTaps(const Texture& texture, Taps& taps) {
  const DPlaces d;
  const hn::RebindToSigned<DPlaces> di;
  const WrappingLanes repeats(texture, Texture::Wrap::repeat), mirrors(texture, Texture::Wrap::mirror);
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  for (int i = 0; i < 4 * taps.taps; i += int(hn::Lanes(d))) {
    const Wrapping wrap{repeats.at(i), mirrors.at(i)};
    const auto size = hn::Load(d, taps.size.values + i);
    const auto scaled = hn::Mul(wrap(hn::Load(d, taps.place.values + i)), size);
    const auto end = hn::Sub(size, one);
    if (texture.nearest) {
      const auto texel = hn::ConvertTo(di, hn::Min(hn::Floor(scaled), end));
      hn::Store(texel, di, taps.first.values + i);
      hn::Store(texel, di, taps.second.values + i);
      hn::Store(zero, d, taps.place.values + i);
      continue;
    }
    const auto at = hn::Sub(scaled, hn::Set(d, 0.5f));
    const auto low = hn::Floor(at), high = hn::Add(low, one);
    const auto first = hn::IfThenElse(hn::Lt(low, zero), hn::IfThenElseZero(wrap.repeats, end), low);
    const auto second = hn::IfThenElse(hn::Ge(high, size), hn::IfThenZeroElse(wrap.repeats, end), high);
    hn::Store(hn::ConvertTo(di, first), di, taps.first.values + i);
    hn::Store(hn::ConvertTo(di, second), di, taps.second.values + i);
    hn::Store(hn::Sub(at, low), d, taps.place.values + i);
  }
}

/// R, G, B, A of a texel in the finer level and in the next: in one vector, or in as many parts as it takes.
using DPart = hn::CappedTag<float, 8>;
using VPart = hn::Vec<DPart>;
using MPart = hn::Mask<DPart>;
constexpr int kPartLanes = int(hn::MaxLanes(DPart())), kParts = 8 / kPartLanes;

/// Lanes of the part that begins at lane `first` of the eight where `pattern` is 1.
HWY_INLINE MPart LanesOf(const float (&pattern)[8], int first) {
  return hn::Gt(hn::LoadU(DPart(), pattern + first), hn::Zero(DPart()));
}
constexpr float kAlpha[8] = {0, 0, 0, 1, 0, 0, 0, 1}, kFiner[8] = {1, 1, 1, 1, 0, 0, 0, 0};

/// Bytes to light: as sRGB but for alpha, or all in proportion.
template <Encoding encoding>
HWY_INLINE VPart Light(VPart bytes, MPart is_alpha) {
  const DPart d;
  const auto x = hn::Mul(bytes, hn::Set(d, 1.0f / 255));
  if constexpr (encoding == Encoding::linear) return x;
  // Fitted to the 245 bytes above the straight part, by steps of the byte.
  auto curve = hn::Set(d, 0.08137072720290678f);
  curve = hn::Add(hn::Mul(curve, x), hn::Set(d, -0.29497277940558636f));
  curve = hn::Add(hn::Mul(curve, x), hn::Set(d, 0.6581674908340178f));
  curve = hn::Add(hn::Mul(curve, x), hn::Set(d, 0.5220791693039427f));
  curve = hn::Add(hn::Mul(curve, x), hn::Set(d, 0.03242692474211127f));
  curve = hn::Add(hn::Mul(curve, x), hn::Set(d, 0.00092852696f));
  const auto color = hn::IfThenElse(hn::Gt(x, hn::Set(d, 0.04045f)), curve, hn::Mul(x, hn::Set(d, 1.0f / 12.92f)));
  return hn::IfThenElse(is_alpha, x, color);
}

HWY_INLINE VPart Mix(VPart a, VPart b, VPart t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), t)); }

/// The four texels around a tap, those of the finer level in the lower halves.
struct Quad {
  std::uint64_t a, b, c, d;
};

HWY_INLINE std::uint64_t Bits(const glm::u8vec4& texel) {
  std::uint32_t bits;
  std::memcpy(&bits, &texel, sizeof bits);
  return bits;
}

HWY_INLINE Quad QuadAt(const Pyramid::Level& level, const std::int32_t* first, const std::int32_t* second) {
  const glm::u8vec4* const upper = level.texels + std::size_t(first[1]) * std::size_t(level.width);
  const glm::u8vec4* const lower = level.texels + std::size_t(second[1]) * std::size_t(level.width);
  return {Bits(upper[first[0]]), Bits(upper[second[0]]), Bits(lower[first[0]]), Bits(lower[second[0]])};
}

HWY_INLINE Quad Joined(const Quad& fine, const Quad& coarse) {
  return {fine.a | coarse.a << 32, fine.b | coarse.b << 32, fine.c | coarse.c << 32, fine.d | coarse.d << 32};
}

/// Eight bytes' part that begins at byte `first`.
HWY_INLINE VPart PartOf(std::uint64_t bytes, int first) {
  using Word = std::conditional_t<kPartLanes == 8, std::uint64_t,
                                  std::conditional_t<kPartLanes == 4, std::uint32_t, std::uint8_t>>;
  const hn::Rebind<std::uint8_t, DPart> d8;
  const hn::RebindToSigned<DPart> di;
  const auto word = hn::Set(hn::CappedTag<Word, 1>(), Word(bytes >> (8 * first)));
  return hn::ConvertTo(DPart(), hn::PromoteTo(di, hn::BitCast(d8, word)));
}

/// Bilinear, of both levels.
template <Encoding encoding>
HWY_INLINE VPart Filtered(const Quad& q, const float* fraction, int first) {
  const DPart d;
  const MPart is_alpha = LanesOf(kAlpha, first), is_finer = LanesOf(kFiner, first);
  const auto load = [&](std::uint64_t bytes) { return Light<encoding>(PartOf(bytes, first), is_alpha); };
  const auto x = hn::IfThenElse(is_finer, hn::Set(d, fraction[0]), hn::Set(d, fraction[2]));
  const auto y = hn::IfThenElse(is_finer, hn::Set(d, fraction[1]), hn::Set(d, fraction[3]));
  return Mix(Mix(load(q.a), load(q.b), x), Mix(load(q.c), load(q.d), x), y);
}

template <Encoding encoding>
void FilterAs(const Pyramid& pyramid, const Taps& taps, glm::vec4* out) {
  const DPart d;
  const Pyramid::Level* const levels = pyramid.levels().data();
  int tap = 0;
  for (int k = 0; k < taps.fragments; ++k) {
    const int count = taps.count[k];
    const float blend = taps.blend[k];
    const bool is_blended = blend > 0;  // never in the last level
    const Pyramid::Level &fine = levels[taps.level[k]], &coarse = (&fine)[int(is_blended)];
    const int parts = is_blended || kParts == 1 ? kParts : kParts / 2;
    VPart sums[kParts];
    for (int p = 0; p < kParts; ++p) sums[p] = hn::Zero(d);
    for (int t = 0; t < count; ++t, ++tap) {
      const int at = 4 * tap;
      const std::int32_t *first = taps.first.values + at, *second = taps.second.values + at;
      Quad quad = QuadAt(fine, first, second);
      if (is_blended) quad = Joined(quad, QuadAt(coarse, first + 2, second + 2));
      for (int p = 0; p < parts; ++p)
        sums[p] = hn::Add(sums[p], Filtered<encoding>(quad, taps.place.values + at, p * kPartLanes));
    }
    alignas(64) float mean[8];
    for (int p = 0; p < kParts; ++p) hn::StoreU(sums[p], d, mean + p * kPartLanes);
    const float scale = 1.0f / float(count);
    for (int c = 0; c < 4; ++c) out[k][c] = (mean[c] + (mean[c + 4] - mean[c]) * blend) * scale;
  }
}

}  // namespace

void FindTaps(const TapRequest& request, Taps& taps) {
  Footprints footprints;
  FindFootprints(request, footprints);
  SpreadTaps(request, footprints, taps);
  PlaceTaps(request.pyramid.texture(), taps);
}

void FilterTaps(const Pyramid& pyramid, const Taps& taps, glm::vec4* out) {
  pyramid.encoding() == Encoding::srgb ? FilterAs<Encoding::srgb>(pyramid, taps, out)
                                       : FilterAs<Encoding::linear>(pyramid, taps, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FindTaps);
FRONTMOST_KERNELS(FilterTaps);

void TextureSampler::begin(const Geometry& geometry, int begin, int end) {
  geometry_ = &geometry;
  begin_ = begin;
  end_ = end;
  places_.reset();
}

void TextureSampler::sample(const Pyramid& pyramid, const TexcoordTransform& transform, glm::vec4* out) {
  if (pyramid.levels().empty()) {
    std::fill(out, out + (end_ - begin_), glm::vec4(1));
    return;
  }
  const Places places{pyramid.texture().width,  pyramid.texture().height,  pyramid.texture().wrap_u,
                      pyramid.texture().wrap_v, pyramid.texture().nearest, transform};
  if (!(places_ == places)) {
    kernel_for(FindTapsKernels, isa_)({*geometry_, begin_, end_ - begin_, transform, pyramid}, taps_);
    places_ = places;
  }
  kernel_for(FilterTapsKernels, isa_)(pyramid, taps_, out);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
