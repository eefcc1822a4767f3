// SPDX-License-Identifier: Apache-2.0
// Samples textures and combines their colors with a fragment's, a vector of fragments at a time.

// Included once for every target.
#if defined(FRONTMOST_GL_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_GL_TEXTURE_INL_H_
#undef FRONTMOST_GL_TEXTURE_INL_H_
#else
#define FRONTMOST_GL_TEXTURE_INL_H_
#endif

#include <cstring>

#include "base/highway-inl.h"
#include "base/lane_types-inl.h"
#include "state/draw_state.h"
#include "vertex/powers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

/// Red, green, blue and alpha.
struct FragmentColor {
  VF c[4];
};
HWY_INLINE VF Saturated(VF v) { return hn::Min(hn::Max(v, hn::Zero(DF())), All(1)); }
HWY_INLINE VF Mixed(VF a, VF b, VF t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), t)); }
/// Whole numbers from 0 to 255 of a word, red lowest, as floats.
HWY_INLINE FragmentColor ColorOf(VU word) {
  const VU byte = hn::Set(DU(), 255);
  const auto of = [](VU v) HWY_ATTR { return hn::ConvertTo(DF(), hn::BitCast(DI(), v)); };
  return {{of(hn::And(word, byte)), of(hn::And(hn::ShiftRight<8>(word), byte)),
           of(hn::And(hn::ShiftRight<16>(word), byte)), of(hn::ShiftRight<24>(word))}};
}
HWY_INLINE FragmentColor AllOf(const glm::vec4& c) { return {{All(c.r), All(c.g), All(c.b), All(c.a)}}; }

/// Red and blue, and green and alpha: bytes in 16 bits each.
struct Halves {
  VU even, odd;
};
#if HWY_TARGET == HWY_SCALAR  // has no vectors of two halves
/// Products of the two halves of each word, which fit into 16 bits.
HWY_INLINE VU Times16(VU a, VU b) {
  return hn::Set(DU(), (a.raw & 0xFFFF) * (b.raw & 0xFFFF) + ((a.raw >> 16) * (b.raw >> 16) << 16));
}
/// The upper bytes of the two halves of each word.
HWY_INLINE VU HighBytes(VU a) { return hn::Set(DU(), a.raw >> 8 & 0x00FF00FF); }
#else
using D16 = hn::Repartition<std::uint16_t, DU>;
HWY_INLINE VU Times16(VU a, VU b) { return hn::BitCast(DU(), hn::Mul(hn::BitCast(D16(), a), hn::BitCast(D16(), b))); }
HWY_INLINE VU HighBytes(VU a) { return hn::BitCast(DU(), hn::ShiftRight<8>(hn::BitCast(D16(), a))); }
#endif
HWY_INLINE Halves HalvesOf(VU word) { return {hn::And(word, hn::Set(DU(), 0x00FF00FF)), HighBytes(word)}; }
HWY_INLINE FragmentColor ColorOf(const Halves& h) {
  const VU low = hn::Set(DU(), 0xFFFF);
  const auto of = [](VU v) HWY_ATTR { return hn::ConvertTo(DF(), hn::BitCast(DI(), v)); };
  return {{of(hn::And(h.even, low)), of(hn::And(h.odd, low)), of(hn::ShiftRight<16>(h.even)),
           of(hn::ShiftRight<16>(h.odd))}};
}
/// Scales a color from 0..255 to 0..1.
HWY_INLINE FragmentColor Unit(FragmentColor color) {
  for (VF& v : color.c) v = hn::Mul(v, All(1.0f / 255));
  return color;
}
/// Colors between two, rounded to 8 bits a channel: 16 bits hold their weighted sum. `weight` has 1/256 of `b` twice.
HWY_INLINE Halves Between(const Halves& a, const Halves& b, VU weight) {
  const DU du;
  const VU half = hn::Set(du, 0x00800080), rest = hn::Sub(hn::Set(du, 0x01000100), weight);
  const auto mixed = [&](VU from, VU to) HWY_ATTR {
    return HighBytes(hn::Add(hn::Add(Times16(from, rest), Times16(to, weight)), half));
  };
  return {mixed(a.even, b.even), mixed(a.odd, b.odd)};
}

/// Vectors in a block of fragments. Each step is done with a whole block, so that it asks for the state once.
constexpr std::size_t kBlock = 64 / kMaxLanes;

/// Texture coordinates of a block, and where a filter asks for it the square of the change to the next pixel, in
/// texels.
struct TexPlaces {
  VF s[kBlock], t[kBlock], change[kBlock];
};

class Sampler {
 public:
  explicit Sampler(const BoundTexture& bound) : b_(bound), t_(bound.texture), p_(*bound.packed) {}

  /// Colors from 0 to 1 of the first `count` vectors of a block.
  HWY_INLINE void Sample(std::size_t count, TexPlaces& at, FragmentColor* to) const {
    Wrap(count, at.s, t_.wrap_s);
    Wrap(count, at.t, t_.wrap_t);
    if (b_.minifies_by_levels || b_.is_linear_min != b_.is_linear_mag) {
      for (std::size_t v = 0; v < count; ++v) to[v] = Unit(OfLevels(at.s[v], at.t[v], at.change[v]));
      return;
    }
    SampleLevel<false>(count, nullptr, at.s, at.t, b_.is_linear_mag, to);
    for (std::size_t v = 0; v < count; ++v) to[v] = Unit(to[v]);
  }

 private:
  [[nodiscard]] HWY_NOINLINE FragmentColor OfLevels(VF s, VF t, VF change) const {
    const DF df;
    // log2(sqrt(x)), far below any level where nothing changes.
    VF lod = hn::Mul(All(0.5f), Log2(hn::Max(change, All(1e-30f))));
    const float bias = t_.lod_bias + b_.lod_bias;
    lod = hn::Min(hn::Max(hn::Add(lod, All(bias)), All(t_.min_lod)), All(t_.max_lod));
    // GL_LINEAR magnifies up to half a level longer if minification takes the nearest texel.
    const float limit = b_.is_linear_mag && !b_.is_linear_min && b_.minifies_by_levels ? 0.5f : 0.0f;
    const auto magnified = hn::Le(lod, All(limit));
    if (hn::AllTrue(df, magnified)) return At(hn::Zero(DI()), s, t, b_.is_linear_mag);
    FragmentColor color = Minified(lod, s, t);
    if (hn::AllFalse(df, magnified)) return color;
    const FragmentColor large = At(hn::Zero(DI()), s, t, b_.is_linear_mag);
    for (int k = 0; k < 4; ++k) color.c[k] = hn::IfThenElse(magnified, large.c[k], color.c[k]);
    return color;
  }

  [[nodiscard]] HWY_INLINE FragmentColor Minified(VF lod, VF s, VF t) const {
    const DI di;
    if (!b_.minifies_by_levels) return At(hn::Zero(di), s, t, b_.is_linear_min);
    const VF deepest = All(float(b_.levels - 1));
    lod = hn::Min(hn::Max(lod, hn::Zero(DF())), deepest);
    if (!b_.is_linear_between) {
      // ceil(lod + 1/2) - 1, so that halves go to the lower level.
      const VF level = hn::Max(hn::Sub(hn::Ceil(hn::Add(lod, All(0.5f))), All(1)), hn::Zero(DF()));
      return At(hn::ConvertTo(di, hn::Min(level, deepest)), s, t, b_.is_linear_min);
    }
    const VF whole = hn::Floor(lod);
    const VI level = hn::ConvertTo(di, whole);
    FragmentColor color = At(level, s, t, b_.is_linear_min);
    const FragmentColor next =
        At(hn::Min(hn::Add(level, hn::Set(di, 1)), hn::Set(di, b_.levels - 1)), s, t, b_.is_linear_min);
    for (int k = 0; k < 4; ++k) color.c[k] = Mixed(color.c[k], next.c[k], hn::Sub(lod, whole));
    return color;
  }

  /// Makes coordinates of a block finite, by the mode of wrapping.
  static HWY_INLINE void Wrap(std::size_t count, VF* at, GLenum mode) {
    const auto each = [&](const auto& wrapped) HWY_ATTR {
      for (std::size_t v = 0; v < count; ++v)
        at[v] = wrapped(hn::IfThenElseZero(hn::Lt(hn::Abs(at[v]), All(1e30f)), at[v]));  // also where it is no number
    };
    switch (mode) {
      case GL_CLAMP:
      case GL_CLAMP_TO_EDGE: return each([](VF v) HWY_ATTR { return Saturated(v); });
      case GL_CLAMP_TO_BORDER: return each([](VF v) HWY_ATTR { return hn::Min(hn::Max(v, All(-2)), All(3)); });
      case GL_MIRRORED_REPEAT:
        return each([](VF v) HWY_ATTR {
          const VF twice = hn::Sub(v, hn::Mul(All(2), hn::Floor(hn::Mul(v, All(0.5f)))));
          return hn::Min(twice, hn::Sub(All(2), twice));
        });
      default: return each([](VF v) HWY_ATTR { return hn::Sub(v, hn::Floor(v)); });
    }
  }

  [[nodiscard]] HWY_NOINLINE FragmentColor At(VI level, VF s, VF t, bool is_linear) const {
    FragmentColor color;
    SampleLevel<true>(1, &level, &s, &t, is_linear, &color);
    return color;
  }

  /// Samples one level of each fragment; without `has_levels`, the first one. Colors are from 0 to 255. With
  /// `has_levels`, `count` is 1.
  template <bool has_levels>
  HWY_INLINE void SampleLevel(std::size_t count, const VI* level, const VF* s, const VF* t, bool is_linear,
                              FragmentColor* to) const {
    const DI d;
    const auto of_level = [&](const std::int32_t* table, [[maybe_unused]] std::size_t v) HWY_ATTR {
      if constexpr (has_levels)
        return hn::GatherIndex(d, table, level[v]);
      else
        return hn::Set(d, table[0]);
    };
    const GLenum wrap_s = t_.wrap_s, wrap_t = t_.wrap_t;
    HWY_ALIGN_MAX std::int32_t lower[kBlock * kMaxLanes], upper[has_levels ? kMaxLanes : 1];
    VU across[kBlock], up[kBlock];
    for (std::size_t v = 0; v < count; ++v) {
      const VI width = of_level(p_.width, v), stride = hn::Add(width, hn::Set(d, 2));
      const Steps x = StepsAlong(s[v], width, wrap_s, is_linear);
      const Steps y = StepsAlong(t[v], of_level(p_.height, v), wrap_t, is_linear);
      const VI at = hn::Add(of_level(p_.first, v), hn::Add(hn::Mul(y.texel, stride), x.texel));
      hn::Store(at, d, lower + v * kMaxLanes);
      if constexpr (has_levels) hn::Store(hn::Add(at, stride), d, upper);
      across[v] = x.weight;
      up[v] = y.weight;
    }
    const std::uint32_t *const texels = p_.texels.data(), *const above = texels + (has_levels ? 0 : p_.width[0] + 2);
    for (std::size_t v = 0; v < count; ++v) {
      const std::int32_t *const below = lower + v * kMaxLanes, *const next = has_levels ? upper : below;
      to[v] = is_linear ? ColorOf(Between(RowFrom(texels, below, across[v]), RowFrom(above, next, across[v]), up[v]))
                        : ColorOf(hn::GatherIndex(DU(), texels, hn::Load(d, below)));
    }
  }

  /// The first of two texels along an axis, and the weight of the other one.
  struct Steps {
    VI texel;
    VU weight;
  };
  [[nodiscard]] static HWY_INLINE Steps StepsAlong(VF at, VI size, GLenum mode, bool is_linear) {
    const DI d;
    const VF most = hn::ConvertTo(DF(), size);
    VF place = hn::Mul(at, most);
    if (mode == GL_CLAMP_TO_BORDER) place = hn::Min(hn::Max(place, All(-0.5f)), hn::Add(most, All(0.5f)));
    // The nearest texel of GL_CLAMP is never the border.
    if (mode == GL_CLAMP && !is_linear) place = hn::Min(place, hn::Sub(most, All(1)));
    place = is_linear ? hn::Sub(hn::Mul(place, All(256)), All(128)) : hn::Mul(hn::Floor(place), All(256));
    // The sum has no room for fractions: it is rounded to the whole number that its lowest bits are.
    const VI steps = hn::Sub(hn::BitCast(d, hn::Add(place, All(12582912))), hn::Set(d, 0x4B400000));
    const VU weight = hn::BitCast(DU(), hn::And(steps, hn::Set(d, 255)));
    return {hn::ShiftRight<8>(steps), hn::Or(weight, hn::ShiftLeft<16>(weight))};
  }

  /// Mixes the texel at each place with its right neighbour.
  [[nodiscard]] static HWY_INLINE Halves RowFrom(const std::uint32_t* texels, const std::int32_t* at, VU weight) {
#if HWY_TARGET == HWY_SCALAR
    return Between(HalvesOf(hn::Set(DU(), texels[*at])), HalvesOf(hn::Set(DU(), texels[*at + 1])), weight);
#else
    const DU d;
    // Pairs of texels of even fragments, then those of odd ones.
    HWY_ALIGN_MAX std::uint32_t pairs[2 * kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(d); ++k)
      std::memcpy(pairs + k / 2 * 2 + k % 2 * hn::Lanes(d), texels + at[k], 8);
    const VU even = hn::Load(d, pairs), odd = hn::Load(d, pairs + hn::Lanes(d));
    return Between(HalvesOf(hn::OddEven(hn::DupEven(odd), even)), HalvesOf(hn::OddEven(odd, hn::DupOdd(even))), weight);
#endif
  }

  const BoundTexture& b_;
  const TextureObject& t_;
  const PackedTexture& p_;
};

/// GL_COMBINE of one unit. `textures` holds the colors of all units, for GL_TEXTUREi.
HWY_NOINLINE inline FragmentColor Combined(const TextureUnitState& unit, int number, const FragmentColor& primary,
                                           const FragmentColor& previous, const FragmentColor* textures) {
  const CombineState& c = unit.combine;
  const FragmentColor constant = AllOf(unit.env_color);
  const auto source = [&](GLenum name) HWY_ATTR -> const FragmentColor& {
    switch (name) {
      case GL_TEXTURE: return textures[number];
      case GL_CONSTANT: return constant;
      case GL_PRIMARY_COLOR: return primary;
      case GL_PREVIOUS: return previous;
      default: return textures[name - GL_TEXTURE0];
    }
  };
  const auto argument = [&](GLenum name, GLenum operand, int k) HWY_ATTR {
    const FragmentColor& color = source(name);
    switch (operand) {
      case GL_SRC_COLOR: return color.c[k];
      case GL_ONE_MINUS_SRC_COLOR: return hn::Sub(All(1), color.c[k]);
      case GL_SRC_ALPHA: return color.c[3];
      default: return hn::Sub(All(1), color.c[3]);
    }
  };
  const auto combine = [&](GLenum mode, VF a, VF b, VF t) HWY_ATTR {
    switch (mode) {
      case GL_REPLACE: return a;
      case GL_MODULATE: return hn::Mul(a, b);
      case GL_ADD: return hn::Add(a, b);
      case GL_ADD_SIGNED: return hn::Sub(hn::Add(a, b), All(0.5f));
      case GL_SUBTRACT: return hn::Sub(a, b);
      default: return hn::Add(hn::Mul(a, t), hn::Mul(b, hn::Sub(All(1), t)));  // GL_INTERPOLATE
    }
  };
  FragmentColor result;
  const auto is_dot = [](GLenum mode) { return mode == GL_DOT3_RGB || mode == GL_DOT3_RGBA; };
  for (int k = 0; k < 4; ++k) {
    const bool is_alpha = k == 3;
    const GLenum* sources = is_alpha ? c.source_alpha : c.source_rgb;
    const GLenum* operands = is_alpha ? c.operand_alpha : c.operand_rgb;
    VF a[3];
    for (int i = 0; i < 3; ++i) a[i] = argument(sources[i], operands[i], k);
    result.c[k] = combine(is_alpha ? c.alpha : is_dot(c.rgb) ? GLenum(GL_REPLACE) : c.rgb, a[0], a[1], a[2]);
  }
  if (is_dot(c.rgb)) {
    VF dot = hn::Zero(DF());
    for (int k = 0; k < 3; ++k) {
      const VF a = hn::Sub(argument(c.source_rgb[0], c.operand_rgb[0], k), All(0.5f));
      const VF b = hn::Sub(argument(c.source_rgb[1], c.operand_rgb[1], k), All(0.5f));
      dot = hn::Add(dot, hn::Mul(a, b));
    }
    dot = hn::Mul(All(4), dot);
    for (int k = 0; k < (c.rgb == GL_DOT3_RGBA ? 4 : 3); ++k) result.c[k] = dot;
  }
  for (int k = 0; k < 4; ++k) {
    const bool by_dot = k == 3 && c.rgb == GL_DOT3_RGBA;
    result.c[k] = Saturated(hn::Mul(result.c[k], All(k == 3 && !by_dot ? c.alpha_scale : c.rgb_scale)));
  }
  return result;
}

/// Applies one unit's texture environment, which is not GL_COMBINE, to a block of fragments. Colors are from 0 to 1.
HWY_INLINE void ApplyTexture(const TextureUnitState& unit, GLenum format, std::size_t count,
                             const FragmentColor* texels, FragmentColor* colors) {
  const int first = format != GL_ALPHA ? 0 : 3, last = format != GL_LUMINANCE && format != GL_RGB ? 3 : 2;
  const auto each = [&](const auto& apply) HWY_ATTR {
    for (std::size_t v = 0; v < count; ++v)
      for (int k = first; k <= last; ++k) colors[v].c[k] = apply(colors[v].c[k], texels[v].c[k], k);
  };
  const bool is_intensity = format == GL_INTENSITY;
  switch (unit.env_mode) {
    case GL_REPLACE: return each([](VF, VF texel, int) HWY_ATTR { return texel; });
    case GL_DECAL:
      for (std::size_t v = 0; v < count; ++v)
        for (int k = 0; k < 3 && (format == GL_RGB || format == GL_RGBA); ++k)  // undefined for others: nothing changes
          colors[v].c[k] = Mixed(colors[v].c[k], texels[v].c[k], texels[v].c[3]);
      return;
    case GL_BLEND:
      return each([&](VF color, VF texel, int k) HWY_ATTR {
        return k < 3 || is_intensity ? Mixed(color, All(unit.env_color[k]), texel) : hn::Mul(color, texel);
      });
    case GL_ADD:
      return each([&](VF color, VF texel, int k) HWY_ATTR {
        return k < 3 || is_intensity ? hn::Min(hn::Add(color, texel), All(1)) : hn::Mul(color, texel);
      });
    default: return each([](VF color, VF texel, int) HWY_ATTR { return hn::Mul(color, texel); });  // GL_MODULATE
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
