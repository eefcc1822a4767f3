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

/// Finds the texels of all taps, as texel_pair() of texture_lookup.h does, or texel_of() for textures without filter.
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
    const auto first = hn::IfThenElse(hn::Lt(low, zero), hn::IfThenElseZero(wrap.repeats, end), hn::Min(low, end));
    const auto second = hn::IfThenElse(hn::Ge(high, size), hn::IfThenZeroElse(wrap.repeats, end), high);
    hn::Store(hn::ConvertTo(di, first), di, taps.first.values + i);
    hn::Store(hn::ConvertTo(di, second), di, taps.second.values + i);
    hn::Store(hn::Sub(at, low), d, taps.place.values + i);
  }
}

/// Two adjacent texels of the finer level and two of the next, with four channels each, in one vector or in several
/// parts. Sums of both levels are half as long.
constexpr int kLanes = 16;
using DPart = hn::CappedTag<float, kLanes>;
using VPart = hn::Vec<DPart>;
using MPart = hn::Mask<DPart>;
constexpr int kPartLanes = int(hn::MaxLanes(DPart()));
using DSum = hn::CappedTag<float, kLanes / 2>;
using VSum = hn::Vec<DSum>;
constexpr int kSumLanes = int(hn::MaxLanes(DSum())), kSums = kLanes / 2 / kSumLanes;

/// Returns the lanes where `pattern` is 1, in a vector that begins at lane `first`.
template <class D>
HWY_INLINE hn::Mask<D> LanesOf(D d, const float* pattern, int first) {
  return hn::Gt(hn::LoadU(d, pattern + first), hn::Zero(d));
}
constexpr float kAlpha[kLanes] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr float kFiner[kLanes] = {1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0};

/// Converts bytes to linear light. sRGB bytes follow the curve, except for alpha; linear bytes are divided by 255.
template <Encoding encoding>
HWY_INLINE VPart Light(VPart bytes, MPart is_alpha) {
  const DPart d;
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

/// The four texels around a tap: two adjacent ones in the upper row, and the two below them. A single level fills the
/// lower half of each number.
struct Quad {
  std::uint64_t upper[2], lower[2];
};

HWY_INLINE std::uint64_t Bits(const glm::u8vec4& texel) {
  std::uint32_t bits;
  std::memcpy(&bits, &texel, sizeof bits);
  return bits;
}

HWY_INLINE Quad QuadAt(const Pyramid::Level& level, const std::int32_t* first, const std::int32_t* second) {
  const glm::u8vec4* const upper = level.texels + std::size_t(first[1]) * std::size_t(level.width);
  const glm::u8vec4* const lower = level.texels + std::size_t(second[1]) * std::size_t(level.width);
  return {{Bits(upper[first[0]]), Bits(upper[second[0]])}, {Bits(lower[first[0]]), Bits(lower[second[0]])}};
}

HWY_INLINE Quad Joined(const Quad& fine, const Quad& coarse) {
  return {{fine.upper[0] | coarse.upper[0] << 32, fine.upper[1] | coarse.upper[1] << 32},
          {fine.lower[0] | coarse.lower[0] << 32, fine.lower[1] | coarse.lower[1] << 32}};
}

/// Returns the floats of sixteen bytes from byte `first` on, as many as a vector has.
template <class D>
HWY_INLINE hn::Vec<D> PartOf(D d, const std::uint64_t (&bytes)[2], int first) {
  constexpr std::size_t lanes = hn::MaxLanes(D());
  const hn::Rebind<std::uint8_t, D> d8;
  const hn::RebindToSigned<D> di;
  const auto floats = [&](auto part) { return hn::ConvertTo(d, hn::PromoteTo(di, hn::BitCast(d8, part))); };
#if HWY_TARGET != HWY_SCALAR  // the scalar target lacks this function
  if constexpr (lanes == 16) {
    const hn::Repartition<std::uint64_t, decltype(d8)> d64;
    return floats(hn::InterleaveLower(d64, hn::Set(d64, bytes[0]), hn::Set(d64, bytes[1])));
  } else
#endif
  {
    using Word =
        std::conditional_t<lanes == 8, std::uint64_t, std::conditional_t<lanes == 4, std::uint32_t, std::uint8_t>>;
    return floats(hn::Set(hn::CappedTag<Word, 1>(), Word(bytes[first / 8] >> (8 * (first % 8)))));
  }
}

/// Adds the bilinear value of both levels to eight lanes of sums.
template <Encoding encoding>
HWY_INLINE void AddFiltered(const Quad& quad, const float* fraction, VSum* sums) {
  const DPart d;
  const DSum ds;
  alignas(64) float columns[kLanes];
  for (int first = 0; first < kLanes; first += kPartLanes) {
    const MPart is_alpha = LanesOf(d, kAlpha, first);
    const auto y = hn::IfThenElse(LanesOf(d, kFiner, first), hn::Set(d, fraction[1]), hn::Set(d, fraction[3]));
    const auto upper = Light<encoding>(PartOf(d, quad.upper, first), is_alpha);
    const auto lower = Light<encoding>(PartOf(d, quad.lower, first), is_alpha);
    hn::Store(Mix(upper, lower, y), d, columns + first);
  }
  for (int s = 0; s < kSums; ++s) {
    const int first = s * kSumLanes;
    const auto x = hn::IfThenElse(LanesOf(ds, kFiner, first), hn::Set(ds, fraction[0]), hn::Set(ds, fraction[2]));
    const auto left = hn::Load(ds, columns + first), right = hn::Load(ds, columns + kLanes / 2 + first);
    sums[s] = hn::Add(sums[s], Mix(left, right, x));
  }
}

template <Encoding encoding>
void FilterAs(const Pyramid& pyramid, const Taps& taps, glm::vec4* out) {
  const DSum d;
  const Pyramid::Level* const levels = pyramid.levels().data();
  int at = 0;
  for (int k = 0; k < taps.fragments; ++k) {
    const float blend = taps.blend[k];
    const bool is_blended = blend > 0;  // never in the last level
    const Pyramid::Level &fine = levels[taps.level[k]], &coarse = (&fine)[int(is_blended)];
    VSum sums[kSums];
    for (VSum& sum : sums) sum = hn::Zero(d);
    for (int t = 0; t < taps.count[k]; ++t, at += 4) {
      const std::int32_t *first = taps.first.values + at, *second = taps.second.values + at;
      Quad quad = QuadAt(fine, first, second);
      if (is_blended) quad = Joined(quad, QuadAt(coarse, first + 2, second + 2));
      AddFiltered<encoding>(quad, taps.place.values + at, sums);
    }
    alignas(64) float mean[8];
    for (int s = 0; s < kSums; ++s) hn::Store(sums[s], d, mean + s * kSumLanes);
    const float scale = 1.0f / float(taps.count[k]);
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
