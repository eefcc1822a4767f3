// SPDX-License-Identifier: Apache-2.0
// Texels are read one by one, because one load brings all channels of a texel, whereas a gather over many fragments
// would bring one channel of each. A vector holds the four channels of one or more texels of two levels. Addresses are
// computed for many taps at a time.

#include "shade/texture/texture_sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/texture/texture_kernel.cpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "base/highway-inl.h"
#include "base/isa.h"
#include "base/memory.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

/// Returns log2 of positive numbers to 0.01, by operations that every machine rounds alike.
HWY_INLINE VF Log2(VF value) {
  const DF d;
  const DI di;
  const VI bits = hn::BitCast(di, value);
  const VF exponent = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 127)));
  const VI mantissa = hn::Or(hn::And(bits, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F800000));
  // A parabola through the exact values at 1 and 2 has no step between octaves.
  const VF t = hn::Sub(hn::BitCast(d, mantissa), All(1.0f));
  return hn::Add(exponent, hn::Mul(t, hn::Sub(All(1.3465f), hn::Mul(All(0.3465f), t))));
}

HWY_INLINE VF Length(VF x, VF y) { return hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y))); }

/// Texture coordinates, or steps of them.
struct UV {
  VF u, v;
};
HWY_INLINE UV Turned(const TexcoordTransform& transform, const Lane2& lanes, int i) {
  const DF d;
  const VF x = hn::LoadU(d, &lanes.x[i]), y = hn::LoadU(d, &lanes.y[i]);
  const glm::vec2 across = transform.across(), down = transform.down();
  return {hn::Add(hn::Mul(All(across.x), x), hn::Mul(All(down.x), y)),
          hn::Add(hn::Mul(All(across.y), x), hn::Mul(All(down.y), y))};
}

/// For each fragment: its place in a texture, the longest axis of its footprint, the level, and the number of taps.
struct Footprints {
  float u[sampled_at_once], v[sampled_at_once];
  float axis_u[sampled_at_once], axis_v[sampled_at_once];
  float level[sampled_at_once];
  std::int32_t count[sampled_at_once];
};

void FindFootprints(const TapRequest& request, Footprints& out) {
  const DF d;
  const Pyramid::Level& finest = request.pyramid.levels().front();
  const VF width = All(float(finest.width)), height = All(float(finest.height));
  const VF last = All(float(request.pyramid.levels().size() - 1)), one = All(1.0f), zero = hn::Zero(d);
  const MF is_filtered = hn::Gt(All(request.pyramid.texture().nearest ? 0.0f : 1.0f), zero);
  for (int k = 0; k < request.count; k += int(hn::Lanes(d))) {
    const int i = request.begin + k;
    const UV at = Turned(request.transform, request.texcoord.value, i);
    const UV dx = Turned(request.transform, request.texcoord.dx, i);
    const UV dy = Turned(request.transform, request.texcoord.dy, i);
    const VF along_x = Length(hn::Mul(dx.u, width), hn::Mul(dx.v, height));
    const VF along_y = Length(hn::Mul(dy.u, width), hn::Mul(dy.v, height));
    const MF is_x = hn::Gt(along_x, along_y);
    const VF longer = hn::IfThenElse(is_x, along_x, along_y), least = hn::IfThenElse(is_x, along_y, along_x);
    const VF shorter = hn::IfThenElse(hn::Gt(least, one), least, one);
    // Magnified fragments have one tap in the finest level. Infinite footprints get the average, which is the last
    // level.
    const MF is_minified = hn::And(is_filtered, hn::Gt(longer, one)), is_finite = hn::Lt(longer, All(1e30f));
    const MF is_plain = hn::Not(hn::And(is_minified, is_finite));
    const VF ratio = hn::IfThenElse(is_plain, one, hn::Div(longer, shorter));
    const VF count = hn::IfThenElse(hn::Lt(ratio, All(float(most_taps))), hn::Floor(hn::Add(ratio, All(0.999f))),
                                    All(float(most_taps)));
    const VF widest = hn::Mul(longer, All(1.0f / most_taps));
    const VF reach = hn::IfThenElse(hn::Gt(shorter, widest), shorter, widest);
    const VF wanted = Log2(hn::IfThenElse(is_plain, one, reach));
    const VF within = hn::IfThenElse(hn::Lt(wanted, last), hn::IfThenElseZero(hn::Gt(wanted, zero), wanted), last);
    const MF is_spread = hn::Gt(count, one);
    hn::StoreU(hn::Add(at.u, All(request.transform.offset().x)), d, out.u + k);
    hn::StoreU(hn::Add(at.v, All(request.transform.offset().y)), d, out.v + k);
    hn::StoreU(hn::IfThenElseZero(is_spread, hn::IfThenElse(is_x, dx.u, dy.u)), d, out.axis_u + k);
    hn::StoreU(hn::IfThenElseZero(is_spread, hn::IfThenElse(is_x, dx.v, dy.v)), d, out.axis_v + k);
    hn::StoreU(hn::IfThenElse(hn::And(is_minified, hn::Not(is_finite)), last, within), d, out.level + k);
    hn::StoreU(hn::ConvertTo(DI(), count), DI(), out.count + k);
  }
}

/// Lists the taps of all fragments.
void SpreadTaps(const TapRequest& request, const Footprints& footprints, Taps& taps) {
  int n = 0;
  for (int k = 0; k < request.count; ++k) {
    const int count = footprints.count[k], level = int(footprints.level[k]);
    taps.count[k] = std::uint8_t(count);
    taps.level[k] = std::uint8_t(level);
    taps.blend[k] = footprints.level[k] - float(level);
    const std::array<float, 4> sizes = request.pyramid.sizes_from(level);
    const float step = 1.0f / float(count);
    for (int t = 0; t < count; ++t, ++n) {
      const float at = (float(t) + 0.5f) * step - 0.5f;
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

/// A vector of u, v, u, v and so on, for as many taps as fit.
using DPlaces = hn::CappedTag<float, 16>;
using VPlaces = hn::Vec<DPlaces>;
using MPlaces = hn::Mask<DPlaces>;

/// The lanes with this wrap mode, for vectors that begin at u or at v.
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

/// Returns what wrapped() of texture_lookup.h returns, for a vector of coordinates.
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

/// Columns and rows of the texels on either side of each tap, four numbers for a tap as in Taps::place.
struct TexelPlaces {
  alignas(64) std::int32_t first[4 * most_taps * sampled_at_once], second[4 * most_taps * sampled_at_once];
};

/// Finds the texels of all taps, as texel_pair() of texture_lookup.h does, or texel_of() for textures without filter.
void PlaceTaps(const Texture& texture, Taps& taps, TexelPlaces& out) {
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
      hn::Store(texel, di, out.first + i);
      hn::Store(texel, di, out.second + i);
      hn::Store(zero, d, taps.place.values + i);
      continue;
    }
    const auto at = hn::Sub(scaled, hn::Set(d, 0.5f));
    const auto low = hn::Floor(at), high = hn::Add(low, one);
    const auto first = hn::IfThenElse(hn::Lt(low, zero), hn::IfThenElseZero(wrap.repeats, end), hn::Min(low, end));
    const auto second = hn::IfThenElse(hn::Ge(high, size), hn::IfThenZeroElse(wrap.repeats, end), high);
    hn::Store(hn::ConvertTo(di, first), di, out.first + i);
    hn::Store(hn::ConvertTo(di, second), di, out.second + i);
    hn::Store(hn::Sub(at, low), d, taps.place.values + i);
  }
}

/// Turns columns and rows into offsets from the beginning of the level.
void FindOffsets(const TexelPlaces& places, Taps& taps) {
  for (int n = 0; n < 2 * taps.taps; ++n) {
    const auto width = std::uint32_t(std::int32_t(taps.size.values[2 * n]));
    const std::int32_t left = places.first[2 * n];
    taps.upper[n] = std::uint32_t(places.first[2 * n + 1]) * width + std::uint32_t(left);
    taps.lower[n] = std::uint32_t(places.second[2 * n + 1]) * width + std::uint32_t(left);
    taps.beside[n] = places.second[2 * n] - left;
  }
}

/// Two adjacent texels with four channels each, in one vector or in several parts.
constexpr int kChannels = 4, kPairLanes = 2 * kChannels;
using DPair = hn::CappedTag<float, kPairLanes>;
using VPair = hn::Vec<DPair>;
using MPair = hn::Mask<DPair>;
constexpr int kPartLanes = int(hn::MaxLanes(DPair())), kParts = kPairLanes / kPartLanes;
/// One texel, likewise.
using DTexel = hn::CappedTag<float, kChannels>;
using VTexel = hn::Vec<DTexel>;
constexpr int kTexelLanes = int(hn::MaxLanes(DTexel())), kTexelParts = kChannels / kTexelLanes;

constexpr float kAlpha[kPairLanes] = {0, 0, 0, 1, 0, 0, 0, 1};

/// Converts bytes to linear light. sRGB bytes follow the curve, except for alpha; linear bytes are divided by 255.
template <Encoding encoding>
HWY_INLINE VPair Light(VPair bytes, MPair is_alpha) {
  const DPair d;
  const auto x = hn::Mul(bytes, hn::Set(d, 1.0f / 255));
  if constexpr (encoding == Encoding::linear) return x;
  // The polynomial is fitted to the 245 bytes above the straight part, in steps of a byte. Its pairs of terms do not
  // depend on each other.
  const auto pair = [&](float constant, float slope) {
    return hn::Add(hn::Mul(x, hn::Set(d, slope)), hn::Set(d, constant));
  };
  const auto x2 = hn::Mul(x, x);
  const auto upper = hn::Add(hn::Mul(pair(-0.29497277940558636f, 0.08137072720290678f), x2),
                             pair(0.5220791693039427f, 0.6581674908340178f));
  const auto curve = hn::Add(hn::Mul(upper, x2), pair(0.00092852696f, 0.03242692474211127f));
  const auto color = hn::IfThenElse(hn::Gt(x, hn::Set(d, 0.04045f)), curve, hn::Mul(x, hn::Set(d, 1.0f / 12.92f)));
  return hn::IfThenElse(is_alpha, x, color);
}

template <class V>
HWY_INLINE V Mix(V a, V b, V t) {
  return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

HWY_INLINE std::uint64_t Bits(const glm::u8vec4& texel) {
  std::uint32_t bits;
  std::memcpy(&bits, &texel, sizeof bits);
  return bits;
}

/// Returns a texel and the one `beside` texels further on, in memory order.
HWY_INLINE std::uint64_t PairAt(const glm::u8vec4* texel, std::int32_t beside) {
  if (beside != 1) return Bits(texel[0]) | Bits(texel[beside]) << 32;
  std::uint64_t pair;
  std::memcpy(&pair, texel, sizeof pair);
  return pair;
}

/// Returns the floats of a part of a pair.
HWY_INLINE VPair PartOf(std::uint64_t pair, int part) {
  const DPair d;
  const hn::Rebind<std::uint8_t, DPair> d8;
  const hn::RebindToSigned<DPair> di;
  using Word = std::conditional_t<kPartLanes == 8, std::uint64_t,
                                  std::conditional_t<kPartLanes == 4, std::uint32_t, std::uint8_t>>;
  const auto bytes = hn::Set(hn::CappedTag<Word, 1>(), Word(pair >> (8 * kPartLanes % 64 * part)));
  return hn::ConvertTo(d, hn::PromoteTo(di, hn::BitCast(d8, bytes)));
}

/// Returns a part of the first (0) or second (1) texel of a pair.
template <int texel, class V>
HWY_INLINE VTexel TexelPart(const V* pair, int part) {
  if constexpr (sizeof(V) == sizeof(VTexel)) {
    return pair[texel * kTexelParts + part];
#if HWY_TARGET != HWY_SCALAR  // the scalar target has no halves
  } else {
    const DTexel d;
    return texel == 0 ? hn::LowerHalf(d, *pair) : hn::UpperHalf(d, *pair);
#endif
  }
}

/// The two levels of a pyramid that a fragment reads, one at a time.
struct LevelTaps {
  const glm::u8vec4* texels;
  const Taps& taps;
  int next;  ///< 1 for the next level, 0 for the finer one

  /// Adds the bilinear values of the taps [begin, begin + count) to the sums of the channels.
  template <Encoding encoding>
  HWY_INLINE void Add(int begin, int count, VTexel* sums) const {
    const DPair d;
    const DTexel dt;
    for (int n = 2 * begin + next; n < 2 * (begin + count); n += 2) {
      const std::int32_t beside = taps.beside[n];
      const std::uint64_t upper = PairAt(texels + taps.upper[n], beside),
                          lower = PairAt(texels + taps.lower[n], beside);
      const auto y = hn::Set(d, taps.place.values[2 * n + 1]);
      VPair columns[kParts];
      for (int part = 0; part < kParts; ++part) {
        const MPair is_alpha = hn::Gt(hn::LoadU(d, kAlpha + part * kPartLanes), hn::Zero(d));
        columns[part] =
            Mix(Light<encoding>(PartOf(upper, part), is_alpha), Light<encoding>(PartOf(lower, part), is_alpha), y);
      }
      const auto x = hn::Set(dt, taps.place.values[2 * n]);
      for (int part = 0; part < kTexelParts; ++part)
        sums[part] = hn::Add(sums[part], Mix(TexelPart<0>(columns, part), TexelPart<1>(columns, part), x));
    }
  }
};

/// Fetches the texels of all taps ahead, because large textures are in no cache.
void Prefetch(const Pyramid::Level* levels, const Taps& taps) {
  for (int k = 0, n = 0; k < taps.fragments; ++k) {
    const Pyramid::Level* const level = levels + taps.level[k];
    const int next = taps.blend[k] > 0 ? 1 : 0;
    for (const int end = n + 2 * taps.count[k]; n < end; n += 2) {
      prefetch_line(level[0].texels + taps.upper[n]);
      prefetch_line(level[0].texels + taps.lower[n]);
      prefetch_line(level[next].texels + taps.upper[n + next]);
      prefetch_line(level[next].texels + taps.lower[n + next]);
    }
  }
}

template <Encoding encoding>
void FilterAs(const Pyramid& pyramid, const Taps& taps, glm::vec4* out) {
  const DTexel d;
  const Pyramid::Level* const levels = pyramid.levels().data();
  Prefetch(levels, taps);
  int at = 0;
  for (int k = 0; k < taps.fragments; ++k) {
    const float blend = taps.blend[k];
    const Pyramid::Level* const level = levels + taps.level[k];
    VTexel fine[kTexelParts], coarse[kTexelParts];
    for (int part = 0; part < kTexelParts; ++part) fine[part] = coarse[part] = hn::Zero(d);
    LevelTaps{level[0].texels, taps, 0}.Add<encoding>(at, taps.count[k], fine);
    if (blend > 0) {  // never in the last level
      LevelTaps{level[1].texels, taps, 1}.Add<encoding>(at, taps.count[k], coarse);
      for (int part = 0; part < kTexelParts; ++part) fine[part] = Mix(fine[part], coarse[part], hn::Set(d, blend));
    }
    const auto scale = hn::Set(d, 1.0f / float(taps.count[k]));
    for (int part = 0; part < kTexelParts; ++part)
      hn::StoreU(hn::Mul(fine[part], scale), d, &out[k].x + part * kTexelLanes);
    at += taps.count[k];
  }
}

}  // namespace

void FindTaps(const TapRequest& request, Taps& taps) {
  Footprints footprints;
  FindFootprints(request, footprints);
  SpreadTaps(request, footprints, taps);
  TexelPlaces places;
  PlaceTaps(request.pyramid.texture(), taps, places);
  FindOffsets(places, taps);
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

void TextureSampler::begin(const TexcoordLanes& texcoord, int begin, int end) {
  texcoord_ = &texcoord;
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
    kernel_for(FindTapsKernels, isa_)({*texcoord_, begin_, end_ - begin_, transform, pyramid}, taps_);
    places_ = places;
  }
  kernel_for(FilterTapsKernels, isa_)(pyramid, taps_, out);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
