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
HWY_INLINE FragmentColor ColorOf(VU word) {
  FragmentColor color;
  for (int k = 0; k < 4; ++k) {
    const VU byte = hn::And(hn::Shr(word, hn::Set(DU(), std::uint32_t(8 * k))), hn::Set(DU(), 255));
    color.c[k] = hn::ConvertTo(DF(), hn::BitCast(DI(), byte));
  }
  return color;
}
HWY_INLINE FragmentColor AllOf(const glm::vec4& c) { return {{All(c.r), All(c.g), All(c.b), All(c.a)}}; }

/// Texture coordinates of fragments, and the greater length of their change from pixel to pixel, squared, in
/// texels of the base level; `change` is 0 if no filter asks for it.
struct TexPlace {
  VF s, t, change;
};

class Sampler {
 public:
  explicit Sampler(const BoundTexture& bound) : b_(bound), t_(bound.texture), p_(*bound.packed) {
    reads_pairs_ =
        p_.border == 0 && (t_.wrap_s == GL_REPEAT || t_.wrap_s == GL_CLAMP_TO_EDGE || t_.wrap_s == GL_MIRRORED_REPEAT);
    // The border has the components of the base format, as texels do: luminance is red.
    const GLenum f = b_.base_format;
    for (int k = 0; k < 4; ++k) {
      const bool is_rgb = f == GL_RGB || f == GL_RGBA;
      const int from = f == GL_INTENSITY || (k < 3 && !is_rgb) ? 0 : k;
      const float part = HWY_MIN(HWY_MAX(t_.border_color[from], 0.0f), 1.0f);
      border_word_ |= std::uint32_t(part * 255 + 0.5f) << (8 * k);
    }
    if (f == GL_RGB || f == GL_LUMINANCE) border_word_ |= 0xFF000000;
    if (f == GL_ALPHA) border_word_ &= 0xFF000000;
  }

  /// Colors from 0 to 255.
  [[nodiscard]] HWY_INLINE FragmentColor Sample(const TexPlace& place) const {
    const DF df;
    const VF s = Wrapped(place.s, t_.wrap_s), t = Wrapped(place.t, t_.wrap_t);
    if (!b_.minifies_by_levels && b_.is_linear_min == b_.is_linear_mag)
      return InlineAt(hn::Zero(DI()), s, t, b_.is_linear_mag);
    // log2(sqrt(x)), far below any level where nothing changes.
    VF lod = hn::Mul(All(0.5f), Log2(hn::Max(place.change, All(1e-30f))));
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

 private:
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

  /// A coordinate of finite size, by the mode of wrapping.
  [[nodiscard]] static HWY_INLINE VF Wrapped(VF v, GLenum mode) {
    v = hn::IfThenElseZero(hn::Lt(hn::Abs(v), All(1e30f)), v);  // also where it is not a number
    switch (mode) {
      case GL_CLAMP: return Saturated(v);
      case GL_CLAMP_TO_EDGE:
      case GL_CLAMP_TO_BORDER: return hn::Min(hn::Max(v, All(-2)), All(3));
      case GL_MIRRORED_REPEAT: {
        const VF twice = hn::Sub(v, hn::Mul(All(2), hn::Floor(hn::Mul(v, All(0.5f)))));
        return hn::Min(twice, hn::Sub(All(2), twice));
      }
      default: return hn::Sub(v, hn::Floor(v));
    }
  }

  /// Texel numbers along one axis, and the lanes that see the border color.
  struct Texels {
    VI index;
    MI is_border;
  };
  [[nodiscard]] HWY_INLINE Texels Index(VI i, VI size, GLenum mode) const {
    const DI d;
    const VI zero = hn::Zero(d), last = hn::Sub(size, hn::Set(d, 1));
    const VI inside = hn::Min(hn::Max(i, zero), last);
    MI is_border = hn::Lt(zero, zero);
    if (mode == GL_REPEAT) return {hn::And(i, last), is_border};
    if (mode == GL_CLAMP || mode == GL_CLAMP_TO_BORDER) {
      if (p_.border != 0) return {hn::Min(hn::Max(i, hn::Set(d, -1)), size), is_border};
      is_border = hn::Ne(i, inside);
    }
    return {inside, is_border};
  }

  /// InlineAt() for textures with mip-maps, which call it several times.
  [[nodiscard]] HWY_NOINLINE FragmentColor At(VI level, VF s, VF t, bool is_linear) const {
    return InlineAt(level, s, t, is_linear);
  }
  [[nodiscard]] HWY_INLINE FragmentColor InlineAt(VI level, VF s, VF t, bool is_linear) const {
    const DI d;
    const DF df;
    const bool is_one = b_.levels == 1;
    const auto of_level = [&](const std::int32_t* table)
                              HWY_ATTR { return is_one ? hn::Set(d, table[0]) : hn::GatherIndex(d, table, level); };
    const VI width = of_level(p_.width), height = of_level(p_.height), first = of_level(p_.first);
    VF u = hn::Mul(s, hn::ConvertTo(df, width)), v = hn::Mul(t, hn::ConvertTo(df, height));
    if (!is_linear) {
      const Texels x = Index(hn::ConvertTo(d, hn::Floor(u)), width, Nearest(t_.wrap_s));
      const Texels y = Index(hn::ConvertTo(d, hn::Floor(v)), height, Nearest(t_.wrap_t));
      return ColorOf(Fetch(first, width, x, y));
    }
    u = hn::Sub(u, All(0.5f));
    v = hn::Sub(v, All(0.5f));
    if (reads_pairs_ && t_.wrap_s != GL_REPEAT)
      u = hn::Min(hn::Max(u, hn::Zero(df)), hn::ConvertTo(df, hn::Sub(width, hn::Set(d, 1))));
    const VF left = hn::Floor(u), low = hn::Floor(v);
    const VI i = hn::ConvertTo(d, left), j = hn::ConvertTo(d, low), one = hn::Set(d, 1);
    const Texels x0 = Index(i, width, t_.wrap_s);
    const VU across = Weight(hn::Sub(u, left));
    const auto row = [&](const Texels& y) HWY_ATTR __attribute__((always_inline)) {
      if (!reads_pairs_)
        return Between(Fetch(first, width, x0, y), Fetch(first, width, Index(hn::Add(i, one), width, t_.wrap_s), y),
                       across);
      const TexelPair pair = PairFrom(PlaceOf(first, width, x0, y));
      const VU value = Between(pair.left, pair.right, across);
      return b_.is_1d ? value : hn::IfThenElse(hn::RebindMask(DU(), y.is_border), hn::Set(DU(), border_word_), value);
    };
    const VU lower = row(Index(j, height, t_.wrap_t));
    if (b_.is_1d) return ColorOf(lower);
    return ColorOf(Between(lower, row(Index(hn::Add(j, one), height, t_.wrap_t)), Weight(hn::Sub(v, low))));
  }

  /// A fraction in 1/256, twice in a word.
  [[nodiscard]] static HWY_INLINE VU Weight(VF fraction) {
    const VU w = hn::BitCast(DU(), hn::NearestInt(hn::Mul(fraction, All(256))));
    return hn::Or(w, hn::ShiftLeft<16>(w));
  }
  /// Colors between two, rounded to 8 bits a channel. Two channels at a time have 16 bits each, which their weighted
  /// sum does not exceed.
  [[nodiscard]] static HWY_INLINE VU Between(VU a, VU b, VU weight) {
    const DU du;
    const VU even = hn::Set(du, 0x00FF00FF), half = hn::Set(du, 0x00800080),
             rest = hn::Sub(hn::Set(du, 0x01000100), weight);
    const auto mixed = [&](VU from, VU to)
                           HWY_ATTR { return hn::Add(hn::Add(Times16(from, rest), Times16(to, weight)), half); };
    const VU low = hn::And(hn::ShiftRight<8>(mixed(hn::And(a, even), hn::And(b, even))), even);
    const VU high = hn::AndNot(even, mixed(hn::And(hn::ShiftRight<8>(a), even), hn::And(hn::ShiftRight<8>(b), even)));
    return hn::Or(low, high);
  }
  /// Products of the two halves of each word, which fit into 16 bits.
  [[nodiscard]] static HWY_INLINE VU Times16(VU a, VU b) {
#if HWY_TARGET == HWY_SCALAR  // has no vectors of two halves
    return hn::Set(DU(), (a.raw & 0xFFFF) * (b.raw & 0xFFFF) + ((a.raw >> 16) * (b.raw >> 16) << 16));
#else
    const hn::Repartition<std::uint16_t, DU> d16;
    return hn::BitCast(DU(), hn::Mul(hn::BitCast(d16, a), hn::BitCast(d16, b)));
#endif
  }
  /// The nearest texel of GL_CLAMP is never the border.
  [[nodiscard]] static GLenum Nearest(GLenum mode) { return mode == GL_CLAMP ? GLenum(GL_CLAMP_TO_EDGE) : mode; }

  /// Numbers of texels in the packed texture.
  [[nodiscard]] HWY_INLINE VI PlaceOf(VI first, VI width, const Texels& x, const Texels& y) const {
    const DI d;
    const VI border = hn::Set(d, p_.border);
    const VI stride = hn::Add(width, hn::Set(d, p_.border != 0 ? 2 * p_.border : 1));
    const VI row = b_.is_1d ? hn::Zero(d) : hn::Mul(hn::Add(y.index, border), stride);
    return hn::Add(hn::Add(first, row), hn::Add(x.index, border));
  }
  /// Texels, and those to the right of them.
  struct TexelPair {
    VU left, right;
  };
  [[nodiscard]] HWY_INLINE TexelPair PairFrom(VI at) const {
    const std::uint32_t* const texels = p_.texels.data();
#if HWY_TARGET == HWY_SCALAR
    return {hn::GatherIndex(DU(), texels, at), hn::GatherIndex(DU(), texels + 1, at)};
#else
    const DU d;
    HWY_ALIGN_MAX std::int32_t place[kMaxLanes];
    HWY_ALIGN_MAX std::uint32_t pairs[2 * kMaxLanes];
    hn::Store(at, DI(), place);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) std::memcpy(pairs + 2 * k, texels + place[k], 8);
    const VU low = hn::Load(d, pairs), high = hn::Load(d, pairs + hn::Lanes(d));
    return {hn::ConcatEven(d, high, low), hn::ConcatOdd(d, high, low)};
#endif
  }
  [[nodiscard]] HWY_INLINE VU Fetch(VI first, VI width, const Texels& x, const Texels& y) const {
    const VU word = hn::GatherIndex(DU(), p_.texels.data(), PlaceOf(first, width, x, y));
    const MI is_border = b_.is_1d ? x.is_border : hn::Or(x.is_border, y.is_border);
    return hn::IfThenElse(hn::RebindMask(DU(), is_border), hn::Set(DU(), border_word_), word);
  }

  const BoundTexture& b_;
  const TextureObject& t_;
  const PackedTexture& p_;
  std::uint32_t border_word_ = 0;
  bool reads_pairs_;  ///< whether every texel's right neighbour follows it
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

/// Applies one unit's texture environment to a fragment's color. Colors are from 0 to 1.
HWY_INLINE FragmentColor Textured(const DrawState& d, const BoundTexture& bound, const FragmentColor& primary,
                                  const FragmentColor& previous, const FragmentColor* textures) {
  const TextureUnitState& unit = d.state.texture.units[std::size_t(bound.unit)];
  if (unit.env_mode == GL_COMBINE) return Combined(unit, bound.unit, primary, previous, textures);
  const FragmentColor& texel = textures[bound.unit];
  const GLenum format = bound.base_format;
  const bool has_color = format != GL_ALPHA, has_alpha = format != GL_LUMINANCE && format != GL_RGB;
  const VF one = All(1);
  FragmentColor to = previous;
  switch (unit.env_mode) {
    case GL_REPLACE:
      for (int k = 0; k < 3 && has_color; ++k) to.c[k] = texel.c[k];
      if (has_alpha) to.c[3] = texel.c[3];
      return to;
    case GL_DECAL:
      // Undefined for other formats: nothing changes.
      for (int k = 0; k < 3 && (format == GL_RGB || format == GL_RGBA); ++k)
        to.c[k] = format == GL_RGB ? texel.c[k] : Mixed(previous.c[k], texel.c[k], texel.c[3]);
      return to;
    case GL_BLEND:
      for (int k = 0; k < 3 && has_color; ++k) to.c[k] = Mixed(previous.c[k], All(unit.env_color[k]), texel.c[k]);
      if (format == GL_INTENSITY)
        to.c[3] = Mixed(previous.c[3], All(unit.env_color.a), texel.c[3]);
      else if (has_alpha)
        to.c[3] = hn::Mul(previous.c[3], texel.c[3]);
      return to;
    case GL_ADD:
      for (int k = 0; k < 3 && has_color; ++k) to.c[k] = hn::Min(hn::Add(previous.c[k], texel.c[k]), one);
      if (format == GL_INTENSITY)
        to.c[3] = hn::Min(hn::Add(previous.c[3], texel.c[3]), one);
      else if (has_alpha)
        to.c[3] = hn::Mul(previous.c[3], texel.c[3]);
      return to;
    default:  // GL_MODULATE
      for (int k = 0; k < 3 && has_color; ++k) to.c[k] = hn::Mul(previous.c[k], texel.c[k]);
      if (has_alpha) to.c[3] = hn::Mul(previous.c[3], texel.c[3]);
      return to;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
