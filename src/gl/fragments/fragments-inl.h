// SPDX-License-Identifier: Apache-2.0
// The operations of a vector of fragments, no two of which share a pixel:
//
//    color, textures, fog --> alpha test --> stencil and depth tests --> blending or logic --> masks --> frame
//
// Without an alpha test, the tests come first, and fragments that fail are not colored.

// Included once for every target.
#if defined(FRONTMOST_GL_FRAGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_GL_FRAGMENTS_INL_H_
#undef FRONTMOST_GL_FRAGMENTS_INL_H_
#else
#define FRONTMOST_GL_FRAGMENTS_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "fragments/painter.h"
#include "fragments/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The weights of a triangle's vertices 1 and 2 in a vector of fragments. `x` and `y` are changes from pixel to pixel.
struct VertexWeights {
  VF of[2], x[2], y[2];
};

HWY_INLINE MI Compared(const TestFunction& pass, VI a, VI b) {
  const DI d;
  const MI less = hn::Lt(a, b), equal = hn::Eq(a, b);
  MI result = hn::Lt(hn::Zero(d), hn::Zero(d));
  if (pass.less) result = less;
  if (pass.equal) result = hn::Or(result, equal);
  if (pass.greater) result = hn::Or(result, hn::Not(hn::Or(less, equal)));
  return result;
}

/// A source of fragments holds a block of vectors of fragments: live[v] tells which lanes of vector v are fragments,
/// and depth[v] has their stored depths. It reads and writes planes of the frame at the fragments (Load, Store), and
/// knows their primitive (Id) and what smooth edges leave of alpha (Covered). Pixels() has colors, if they are not
/// those of vertices. ColorOfVertex(k) and Varying(k) give functions of v, and Changes(v, k, dx, dy) the changes from
/// pixel to pixel; Weigh(count, needs_change) is called before. Move(to, from) puts a vector in another one's place.
class FragmentStage {
 public:
  FragmentStage(const PaintTarget& target, const DrawState& draw) : target_(target), d_(draw), s_(draw.state) {
    for (const BoundTexture& t : d_.textures) {
      needs_change_ |= t.minifies_by_levels || t.is_linear_min != t.is_linear_mag;
      combines_ |= s_.texture.units[std::size_t(t.unit)].env_mode == GL_COMBINE;
      samplers_.emplace_back(t);
    }
    stencil_mask_ = s_.stencil.value_mask & 255;
    const ColorBufferState& c = s_.color;
    is_over_ = d_.blends && c.equation_rgb == GL_FUNC_ADD && c.equation_alpha == GL_FUNC_ADD &&
               c.source_rgb == GL_SRC_ALPHA && c.source_alpha == GL_SRC_ALPHA &&
               c.target_rgb == GL_ONE_MINUS_SRC_ALPHA && c.target_alpha == GL_ONE_MINUS_SRC_ALPHA;
  }

  /// Processes `count` vectors, which the source need not keep.
  template <class Source>
  HWY_INLINE void Process(Source& source, std::size_t count) {
    const DI d;
    const bool has_planes = d_.tests_depth || d_.tests_stencil;
    FragmentColor color[kBlock];
    if (target_.probe) Record(source);
    if (d_.tests_alpha) {
      source.Weigh(count, needs_change_);
      ColorFragments(source, count, color);
      for (std::size_t v = 0; v < count; ++v) source.live[v] = hn::And(source.live[v], PassesAlpha(color[v].c[3]));
      if (has_planes) Test(source, count);
    } else {
      if (has_planes) {
        Test(source, count);
        std::size_t kept = 0;
        for (std::size_t v = 0; v < count; ++v) {
          if (hn::AllFalse(d, source.live[v])) continue;
          if (kept != v) source.Move(kept, v);
          ++kept;
        }
        count = kept;
      }
      if (count == 0 || (d_.color_mask == 0 && !target_.passed)) return;
      source.Weigh(count, needs_change_);
      ColorFragments(source, count, color);
    }
    Finish(source, count, color);
  }

 private:
  /// Records the fragments of the first vector, all of which are at the probe's pixel, before they change the frame.
  template <class Source>
  HWY_NOINLINE void Record(Source& source) const {
    using Verdict = FragmentEvent::Verdict;
    const DI d;
    HWY_ALIGN_MAX std::uint32_t ids[kMaxLanes];
    HWY_ALIGN_MAX std::int32_t depths[kMaxLanes];
    HWY_ALIGN_MAX float alphas[kMaxLanes];
    FragmentColor color[kBlock];
    source.Weigh(1, needs_change_);
    ColorFragments(source, 1, color);
    const MI live = source.live[0];
    const std::uint64_t alpha_passes = BitsOf(d, d_.tests_alpha ? PassesAlpha(color[0].c[3]) : live);
    hn::Store(source.Id(0), DU(), ids);
    hn::Store(source.depth[0], d, depths);
    hn::Store(color[0].c[3], DF(), alphas);
    const std::uint32_t word = target_.frame.depth[target_.frame.at(target_.probe->x, target_.probe->y)];
    const auto passes = [](GLenum func, std::uint32_t a, std::uint32_t b) {
      const TestFunction pass(func);
      return a < b ? pass.less : a == b ? pass.equal : pass.greater;
    };
    ForEachBit(BitsOf(d, live), [&](std::size_t lane) {
      FragmentEvent event{ids[lane], Verdict::passes, std::uint32_t(depths[lane]), word >> 8, word & 255, alphas[lane]};
      event.state = &d_;
      const std::uint32_t ref = std::uint32_t(std::clamp(s_.stencil.ref, 0, 255));
      if ((alpha_passes >> lane & 1) == 0)
        event.verdict = Verdict::alpha_fails;
      else if (d_.tests_stencil && !passes(s_.stencil.func, ref & stencil_mask_, word & stencil_mask_))
        event.verdict = Verdict::stencil_fails;
      else if (d_.tests_depth && !passes(s_.depth.func, event.depth, word >> 8))
        event.verdict = Verdict::depth_fails;
      target_.probe->events.push_back(event);
    });
  }

  [[nodiscard]] HWY_INLINE MI PassesAlpha(VF alpha) const {
    // Both sides are rounded to the 8 bits of the frame.
    const VI value = hn::NearestInt(hn::Mul(Saturated(alpha), All(255)));
    return Compared(TestFunction(s_.color.alpha_func), value, hn::NearestInt(All(s_.color.alpha_ref * 255)));
  }

  /// Makes the stencil and depth tests, and stores what they change.
  template <class Source>
  HWY_INLINE void Test(Source& source, std::size_t count) const {
    const DI d;
    std::uint32_t* const plane = target_.frame.depth.data();
    const TestFunction depth_function(s_.depth.func), stencil_function(s_.stencil.func);
    const bool tests_depth = d_.tests_depth, tests_stencil = d_.tests_stencil, writes_depth = d_.writes_depth;
    const VI low = hn::Set(d, 255);
    for (std::size_t v = 0; v < count; ++v) {
      const VI planes = hn::BitCast(d, source.Load(v, plane)), stencil = hn::And(planes, low);
      const VI depth = source.depth[v], kept = hn::BitCast(d, hn::ShiftRight<8>(hn::BitCast(DU(), planes)));
      MI live = source.live[v], pass = live;
      VI next = stencil;
      if (tests_depth) pass = hn::And(live, Compared(depth_function, depth, kept));
      if (tests_stencil) {
        const VI mask = hn::Set(d, std::int32_t(stencil_mask_)), ref = hn::Set(d, std::clamp(s_.stencil.ref, 0, 255));
        const MI right = hn::And(live, Compared(stencil_function, hn::And(ref, mask), hn::And(stencil, mask)));
        pass = hn::And(pass, right);
        next = hn::IfThenElse(right, Operated(s_.stencil.depth_fail, stencil, ref),
                              Operated(s_.stencil.fail, stencil, ref));
        next = hn::IfThenElse(pass, Operated(s_.stencil.pass, stencil, ref), next);
        const VI writes = hn::Set(d, std::int32_t(s_.stencil.write_mask & 255));
        next = hn::Or(hn::AndNot(writes, stencil), hn::And(writes, next));
      } else {
        live = pass;
      }
      source.live[v] = pass;
      if ((!writes_depth && !tests_stencil) || hn::AllFalse(d, live)) continue;
      const VI to = writes_depth ? hn::IfThenElse(pass, depth, kept) : kept;
      source.Store(v, plane, hn::BitCast(DU(), hn::Or(hn::ShiftLeft<8>(to), next)), live);
    }
  }

  [[nodiscard]] static HWY_INLINE VI Operated(GLenum operation, VI v, VI ref) {
    const DI d;
    const VI one = hn::Set(d, 1), most = hn::Set(d, 255);
    switch (operation) {
      case GL_ZERO: return hn::Zero(d);
      case GL_REPLACE: return ref;
      case GL_INCR: return hn::Min(hn::Add(v, one), most);
      case GL_DECR: return hn::Max(hn::Sub(v, one), hn::Zero(d));
      case GL_INCR_WRAP: return hn::And(hn::Add(v, one), most);
      case GL_DECR_WRAP: return hn::And(hn::Sub(v, one), most);
      case GL_INVERT: return hn::Xor(v, most);
      default: return v;  // GL_KEEP
    }
  }

  template <class Source>
  HWY_INLINE void ColorFragments(const Source& source, std::size_t count, FragmentColor* color) const {
    if (const FragmentColor* const pixels = source.Pixels()) std::copy_n(pixels, count, color);
    for (int k = 0; k < 4 && !source.Pixels(); ++k) {
      const auto of = source.ColorOfVertex(k);
      for (std::size_t v = 0; v < count; ++v) color[v].c[k] = of(v);
    }
    if (!samplers_.empty()) ApplyTextures(source, count, color);
    for (int k = 0; k < 3 && d_.adds_secondary; ++k) {
      const auto of = source.ColorOfVertex(4 + k);
      for (std::size_t v = 0; v < count; ++v) color[v].c[k] = hn::Min(hn::Add(color[v].c[k], of(v)), All(1));
    }
    if (d_.has_fog) {
      const auto of = source.Varying(kOutFog);
      for (std::size_t v = 0; v < count; ++v) {
        const VF factor = FogOf(of(v));
        for (int k = 0; k < 3; ++k) color[v].c[k] = Mixed(All(s_.fog.color[k]), color[v].c[k], factor);
      }
    }
    for (std::size_t v = 0; v < count; ++v) color[v].c[3] = source.Covered(v, color[v].c[3]);
  }

  template <class Source>
  HWY_NOINLINE void ApplyTextures(const Source& source, std::size_t count, FragmentColor* color) const {
    FragmentColor primary[kBlock], texels[kTextureUnits][kBlock];
    if (combines_)
      for (std::size_t v = 0; v < count; ++v) {
        primary[v] = color[v];
        // A combiner may name a unit without a texture; it reads black.
        for (auto& of_unit : texels) of_unit[v] = AllOf(glm::vec4(0, 0, 0, 1));
      }
    for (std::size_t i = 0; i < samplers_.size(); ++i) {
      TexPlaces at;
      FindPlaces(source, count, d_.textures[i], at);
      samplers_[i].Sample(count, at, texels[d_.textures[i].unit]);
    }
    for (const BoundTexture& t : d_.textures) {
      const TextureUnitState& unit = s_.texture.units[std::size_t(t.unit)];
      if (unit.env_mode != GL_COMBINE) {
        ApplyTexture(unit, t.base_format, count, texels[t.unit], color);
        continue;
      }
      for (std::size_t v = 0; v < count; ++v) {
        FragmentColor of_units[kTextureUnits];
        for (int k = 0; k < kTextureUnits; ++k) of_units[k] = texels[k][v];
        color[v] = Combined(unit, t.unit, primary[v], color[v], of_units);
      }
    }
  }

  template <class Source>
  HWY_INLINE void FindPlaces(const Source& source, std::size_t count, const BoundTexture& t, TexPlaces& to) const {
    const int first = kOutTexCoord + 3 * t.unit;
    const bool needs_change = t.minifies_by_levels || t.is_linear_min != t.is_linear_mag;
    const float size[2] = {float(t.packed->width[0]), t.is_1d ? 0.0f : float(t.packed->height[0])};
    const auto of_s = source.Varying(first), of_t = source.Varying(first + 1), of_q = source.Varying(first + 2);
    for (std::size_t v = 0; v < count; ++v) {
      VF place[2] = {of_s(v), of_t(v)}, inverse = All(1);
      const VF q = of_q(v);
      if (!hn::AllTrue(DF(), hn::Eq(q, inverse))) {
        inverse = hn::Div(inverse, q);
        for (VF& along : place) along = hn::Mul(along, inverse);
      }
      to.s[v] = place[0];
      to.t[v] = place[1];
      if (!needs_change) continue;
      VF across = hn::Zero(DF()), up = across, qx, qy;
      source.Changes(v, first + 2, qx, qy);
      for (int k = 0; k < 2; ++k) {
        VF dx, dy;
        source.Changes(v, first + k, dx, dy);
        dx = hn::Mul(hn::Mul(hn::Sub(dx, hn::Mul(place[k], qx)), inverse), All(size[k]));
        dy = hn::Mul(hn::Mul(hn::Sub(dy, hn::Mul(place[k], qy)), inverse), All(size[k]));
        across = hn::Add(across, hn::Mul(dx, dx));
        up = hn::Add(up, hn::Mul(dy, dy));
      }
      to.change[v] = hn::Min(hn::Max(across, up), All(1e30f));
    }
  }

  [[nodiscard]] HWY_INLINE VF FogOf(VF distance) const {
    const FogState& fog = s_.fog;
    if (fog.mode == GL_LINEAR) {
      const float length = fog.end - fog.start;
      return Saturated(hn::Mul(hn::Sub(All(fog.end), distance), All(length != 0 ? 1 / length : 0)));
    }
    VF power = hn::Mul(distance, All(fog.density));
    if (fog.mode == GL_EXP2) power = hn::Mul(power, power);
    return Saturated(Exp2(hn::Mul(power, All(-1.4426950409f))));
  }

  /// Blends and writes.
  template <class Source>
  HWY_INLINE void Finish(Source& source, std::size_t count, const FragmentColor* color) {
    const DU du;
    for (std::size_t v = 0; v < count && target_.passed; ++v) passed_ += hn::CountTrue(DI(), source.live[v]);
    if (d_.color_mask == 0) return;
    for (std::size_t v = 0; v < count && !target_.frame.ids.empty(); ++v)
      source.Store(v, target_.frame.ids.data(), source.Id(v), source.live[v]);
    std::uint32_t* const plane = target_.frame.color.data();
    const bool has_logic = s_.capabilities.has(Capability::color_logic_op), is_over = is_over_,
               blends = d_.blends && !is_over, is_masked = d_.color_mask != 0xFFFFFFFF;
    for (std::size_t v = 0; v < count; ++v) {
      FragmentColor c = color[v], below;
      VU kept{};
      if (d_.blends || has_logic || is_masked) kept = source.Load(v, plane);
      if (blends) c = Blended(c, ColorOf(kept));
      if (is_over) below = ColorOf(kept);
      const VF alpha = Saturated(c.c[3]);
      VU bytes[4];
      for (int k = 0; k < 4; ++k) {
        VF value = hn::Mul(Saturated(c.c[k]), All(255));
        if (is_over) value = Mixed(below.c[k], value, alpha);
        // The sum has no room for fractions: it is rounded to the whole number in its lowest bits.
        bytes[k] = hn::BitCast(du, hn::Add(value, All(8388608)));
      }
      VU word = hn::Or(hn::Or(hn::ShiftLeft<8>(bytes[1]), hn::ShiftLeft<16>(bytes[2])), hn::ShiftLeft<24>(bytes[3]));
      word = hn::Or(word, hn::And(bytes[0], hn::Set(du, 255)));
      if (has_logic) word = Logic(s_.color.logic_op, word, kept);
      if (is_masked) {
        const VU mask = hn::Set(du, d_.color_mask);
        word = hn::Or(hn::And(word, mask), hn::AndNot(mask, kept));
      }
      source.Store(v, plane, word, source.live[v]);
    }
  }

  /// `kept` is from 0 to 255.
  [[nodiscard]] HWY_NOINLINE FragmentColor Blended(FragmentColor from, FragmentColor kept) const {
    const ColorBufferState& c = s_.color;
    for (int k = 0; k < 4; ++k) {
      from.c[k] = Saturated(from.c[k]);
      kept.c[k] = hn::Mul(kept.c[k], All(1.0f / 255));
    }
    FragmentColor to;
    for (int k = 0; k < 4; ++k) {
      const GLenum equation = k < 3 ? c.equation_rgb : c.equation_alpha;
      if (equation == GL_MIN || equation == GL_MAX) {
        to.c[k] = equation == GL_MIN ? hn::Min(from.c[k], kept.c[k]) : hn::Max(from.c[k], kept.c[k]);
        continue;
      }
      const VF a = hn::Mul(from.c[k], Factor(k < 3 ? c.source_rgb : c.source_alpha, k, from, kept));
      const VF b = hn::Mul(kept.c[k], Factor(k < 3 ? c.target_rgb : c.target_alpha, k, from, kept));
      to.c[k] = equation == GL_FUNC_SUBTRACT           ? hn::Sub(a, b)
                : equation == GL_FUNC_REVERSE_SUBTRACT ? hn::Sub(b, a)
                                                       : hn::Add(a, b);
    }
    return to;
  }

  [[nodiscard]] VF Factor(GLenum name, int k, const FragmentColor& from, const FragmentColor& kept) const {
    const VF one = All(1);
    // The name of one minus a factor follows the factor's.
    for (const int plain :
         {GL_SRC_COLOR, GL_DST_COLOR, GL_SRC_ALPHA, GL_DST_ALPHA, GL_CONSTANT_COLOR, GL_CONSTANT_ALPHA})
      if (name == GLenum(plain) + 1) return hn::Sub(one, Factor(GLenum(plain), k, from, kept));
    switch (name) {
      case GL_ZERO: return hn::Zero(DF());
      case GL_SRC_COLOR: return from.c[k];
      case GL_DST_COLOR: return kept.c[k];
      case GL_SRC_ALPHA: return from.c[3];
      case GL_DST_ALPHA: return kept.c[3];
      case GL_SRC_ALPHA_SATURATE: return k == 3 ? one : hn::Min(from.c[3], hn::Sub(one, kept.c[3]));
      case GL_CONSTANT_COLOR: return All(s_.color.blend_color[k]);
      case GL_CONSTANT_ALPHA: return All(s_.color.blend_color.a);
      default: return one;
    }
  }

  /// The lowest bits of the operation's name say for which pairs of bits the result is 1.
  [[nodiscard]] static HWY_NOINLINE VU Logic(GLenum operation, VU s, VU t) {
    VU word = hn::Zero(DU());
    if ((operation & 1) != 0) word = hn::And(s, t);
    if ((operation & 2) != 0) word = hn::Or(word, hn::AndNot(t, s));
    if ((operation & 4) != 0) word = hn::Or(word, hn::AndNot(s, t));
    if ((operation & 8) != 0) word = hn::Or(word, hn::Not(hn::Or(s, t)));
    return word;
  }

 public:
  /// Fragments that passed all tests, if someone counts them.
  [[nodiscard]] std::uint64_t passed() const { return passed_; }

 private:
  const PaintTarget& target_;
  const DrawState& d_;
  const State& s_;
  std::vector<Sampler> samplers_;
  bool needs_change_ = false, combines_ = false;
  bool is_over_;  ///< blends as usual: source alpha, and one minus source alpha
  std::uint32_t stencil_mask_;
  std::uint64_t passed_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
