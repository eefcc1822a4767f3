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

/// A source of fragments has their pixels and their values: Load(plane), Store(plane, words, lanes), Id(),
/// ColorOfVertex(k), Varying(k), Changes(k, dx, dy) and Covered(alpha), which takes off what smooth edges leave out.
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

  [[nodiscard]] bool needs_change() const { return needs_change_; }

  /// `depth` is the stored depth of each fragment.
  template <class Source>
  HWY_INLINE void Process(const Source& source, MI live, VI depth) {
    const DI d;
    VU planes{};
    const bool has_planes = d_.tests_depth || d_.tests_stencil;
    if (target_.probe) Record(source, live, depth);
    if (has_planes) planes = source.Load(target_.frame.depth.data());
    if (!d_.tests_alpha) {
      if (has_planes) live = Tested(source, live, depth, planes);
      if (hn::AllFalse(d, live)) return;
      if (d_.color_mask == 0 && !target_.passed) return;
      Finish(source, live, ColorOfFragments(source));
      return;
    }
    const FragmentColor color = ColorOfFragments(source);
    live = hn::And(live, PassesAlpha(color.c[3]));
    if (has_planes) live = Tested(source, live, depth, planes);
    if (hn::AllFalse(d, live)) return;
    Finish(source, live, color);
  }

 private:
  /// Records the fragments, all of which are at the probe's pixel, before they change the frame.
  template <class Source>
  HWY_NOINLINE void Record(const Source& source, MI live, VI depth) const {
    using Verdict = FragmentEvent::Verdict;
    const DI d;
    HWY_ALIGN_MAX std::uint32_t ids[kMaxLanes];
    HWY_ALIGN_MAX std::int32_t depths[kMaxLanes];
    HWY_ALIGN_MAX float alphas[kMaxLanes];
    const VF alpha = ColorOfFragments(source).c[3];
    const std::uint64_t alpha_passes = BitsOf(d, d_.tests_alpha ? PassesAlpha(alpha) : live);
    hn::Store(source.Id(), DU(), ids);
    hn::Store(depth, d, depths);
    hn::Store(alpha, DF(), alphas);
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
  [[nodiscard]] HWY_INLINE MI Tested(const Source& source, MI live, VI depth, VU planes) {
    const DI d;
    const VI kept = hn::BitCast(d, hn::ShiftRight<8>(planes));
    MI pass = live;
    if (d_.tests_depth) pass = hn::And(live, Compared(TestFunction(s_.depth.func), depth, kept));
    if (!d_.tests_stencil) {
      if (!d_.writes_depth || hn::AllFalse(d, pass)) return pass;
      const VI word = hn::Or(hn::ShiftLeft<8>(depth), hn::And(hn::BitCast(d, planes), hn::Set(d, 255)));
      source.Store(target_.frame.depth.data(), hn::BitCast(DU(), word), pass);
      return pass;
    }
    const VI stencil = hn::And(hn::BitCast(d, planes), hn::Set(d, 255));
    const VI mask = hn::Set(d, std::int32_t(stencil_mask_));
    const VI ref = hn::Set(d, std::clamp(s_.stencil.ref, 0, 255));
    const MI right = hn::And(live, Compared(TestFunction(s_.stencil.func), hn::And(ref, mask), hn::And(stencil, mask)));
    pass = hn::And(pass, right);
    VI next =
        hn::IfThenElse(right, Operated(s_.stencil.depth_fail, stencil, ref), Operated(s_.stencil.fail, stencil, ref));
    next = hn::IfThenElse(pass, Operated(s_.stencil.pass, stencil, ref), next);
    const VI writes = hn::Set(d, std::int32_t(s_.stencil.write_mask & 255));
    next = hn::Or(hn::AndNot(writes, stencil), hn::And(writes, next));
    VI to = kept;
    if (d_.writes_depth) to = hn::IfThenElse(pass, depth, kept);
    source.Store(target_.frame.depth.data(), hn::BitCast(DU(), hn::Or(hn::ShiftLeft<8>(to), next)), live);
    return pass;
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
  [[nodiscard]] HWY_INLINE FragmentColor ColorOfFragments(const Source& source) const {
    FragmentColor color;
    for (int k = 0; k < 4; ++k) color.c[k] = source.ColorOfVertex(k);
    if (!samplers_.empty()) color = WithTextures(source, color);
    if (d_.adds_secondary)
      for (int k = 0; k < 3; ++k) color.c[k] = hn::Min(hn::Add(color.c[k], source.ColorOfVertex(4 + k)), All(1));
    if (d_.has_fog) {
      const VF factor = FogOf(source.Varying(kOutFog));
      for (int k = 0; k < 3; ++k) color.c[k] = Mixed(All(s_.fog.color[k]), color.c[k], factor);
    }
    color.c[3] = source.Covered(color.c[3]);
    return color;
  }

  template <class Source>
  [[nodiscard]] HWY_NOINLINE FragmentColor WithTextures(const Source& source, const FragmentColor& primary) const {
    FragmentColor texels[kTextureUnits], color = primary;
    // A combiner may name a unit without a texture; it reads black.
    if (combines_)
      for (FragmentColor& texel : texels) texel = AllOf(glm::vec4(0, 0, 0, 1));
    for (std::size_t i = 0; i < samplers_.size(); ++i) {
      const int unit = d_.textures[i].unit;
      texels[unit] = samplers_[i].Sample(PlaceIn(source, d_.textures[i]));
      for (VF& v : texels[unit].c) v = hn::Mul(v, All(1.0f / 255));
    }
    for (const BoundTexture& t : d_.textures) color = Textured(d_, t, primary, color, texels);
    return color;
  }

  template <class Source>
  [[nodiscard]] HWY_INLINE TexPlace PlaceIn(const Source& source, const BoundTexture& t) const {
    const int at = kOutTexCoord + 3 * t.unit;
    TexPlace place{source.Varying(at), source.Varying(at + 1), hn::Zero(DF())};
    const VF q = source.Varying(at + 2);
    VF inverse = All(1);
    if (!hn::AllTrue(DF(), hn::Eq(q, inverse))) {
      inverse = hn::Div(inverse, q);
      place.s = hn::Mul(place.s, inverse);
      place.t = hn::Mul(place.t, inverse);
    }
    if (!t.minifies_by_levels && t.is_linear_min == t.is_linear_mag) return place;
    const float size[2] = {float(t.packed->width[0]), t.is_1d ? 0.0f : float(t.packed->height[0])};
    VF across = hn::Zero(DF()), up = across;
    for (int k = 0; k < 2; ++k) {
      VF dx, dy;
      source.Changes(at + k, dx, dy);
      VF qx, qy;
      source.Changes(at + 2, qx, qy);
      const VF v = k == 0 ? place.s : place.t;
      dx = hn::Mul(hn::Sub(dx, hn::Mul(v, qx)), inverse);
      dy = hn::Mul(hn::Sub(dy, hn::Mul(v, qy)), inverse);
      dx = hn::Mul(dx, All(size[k]));
      dy = hn::Mul(dy, All(size[k]));
      across = hn::Add(across, hn::Mul(dx, dx));
      up = hn::Add(up, hn::Mul(dy, dy));
    }
    place.change = hn::Min(hn::Max(across, up), All(1e30f));
    return place;
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
  HWY_INLINE void Finish(const Source& source, MI live, FragmentColor color) {
    const DU du;
    if (target_.passed) passed_ += hn::CountTrue(DI(), live);
    if (d_.color_mask == 0) return;
    if (!target_.frame.ids.empty()) source.Store(target_.frame.ids.data(), source.Id(), live);
    const bool has_logic = s_.capabilities.has(Capability::color_logic_op);
    VU kept{};
    if (d_.blends || has_logic || d_.color_mask != 0xFFFFFFFF) kept = source.Load(target_.frame.color.data());
    if (d_.blends && !is_over_) color = Blended(color, ColorOf(kept));
    for (VF& v : color.c) v = Saturated(v);
    const VF alpha = color.c[3];
    const FragmentColor below = is_over_ ? ColorOf(kept) : FragmentColor();
    VU word = hn::Zero(du);
    for (int k = 0; k < 4; ++k) {
      VF value = hn::Mul(color.c[k], All(255));
      if (is_over_) value = Mixed(below.c[k], value, alpha);
      const VI byte = hn::NearestInt(value);
      word = hn::Or(word, hn::Shl(hn::BitCast(du, byte), hn::Set(du, std::uint32_t(8 * k))));
    }
    if (has_logic) word = Logic(s_.color.logic_op, word, kept);
    if (d_.color_mask != 0xFFFFFFFF) {
      const VU mask = hn::Set(du, d_.color_mask);
      word = hn::Or(hn::And(word, mask), hn::AndNot(mask, kept));
    }
    source.Store(target_.frame.color.data(), word, live);
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

  [[nodiscard]] HWY_INLINE VF Factor(GLenum name, int k, const FragmentColor& from, const FragmentColor& kept) const {
    const VF one = All(1);
    const glm::vec4& constant = s_.color.blend_color;
    switch (name) {
      case GL_ZERO: return hn::Zero(DF());
      case GL_SRC_COLOR: return from.c[k];
      case GL_ONE_MINUS_SRC_COLOR: return hn::Sub(one, from.c[k]);
      case GL_DST_COLOR: return kept.c[k];
      case GL_ONE_MINUS_DST_COLOR: return hn::Sub(one, kept.c[k]);
      case GL_SRC_ALPHA: return from.c[3];
      case GL_ONE_MINUS_SRC_ALPHA: return hn::Sub(one, from.c[3]);
      case GL_DST_ALPHA: return kept.c[3];
      case GL_ONE_MINUS_DST_ALPHA: return hn::Sub(one, kept.c[3]);
      case GL_SRC_ALPHA_SATURATE: return k == 3 ? one : hn::Min(from.c[3], hn::Sub(one, kept.c[3]));
      case GL_CONSTANT_COLOR: return All(constant[k]);
      case GL_ONE_MINUS_CONSTANT_COLOR: return All(1 - constant[k]);
      case GL_CONSTANT_ALPHA: return All(constant.a);
      case GL_ONE_MINUS_CONSTANT_ALPHA: return All(1 - constant.a);
      default: return one;
    }
  }

  [[nodiscard]] static HWY_NOINLINE VU Logic(GLenum operation, VU s, VU t) {
    const VU all = hn::Set(DU(), 0xFFFFFFFF);
    switch (operation) {
      case GL_CLEAR: return hn::Zero(DU());
      case GL_AND: return hn::And(s, t);
      case GL_AND_REVERSE: return hn::AndNot(t, s);
      case GL_AND_INVERTED: return hn::AndNot(s, t);
      case GL_NOOP: return t;
      case GL_XOR: return hn::Xor(s, t);
      case GL_OR: return hn::Or(s, t);
      case GL_NOR: return hn::Not(hn::Or(s, t));
      case GL_EQUIV: return hn::Not(hn::Xor(s, t));
      case GL_INVERT: return hn::Not(t);
      case GL_OR_REVERSE: return hn::Or(s, hn::Not(t));
      case GL_COPY_INVERTED: return hn::Not(s);
      case GL_OR_INVERTED: return hn::Or(hn::Not(s), t);
      case GL_NAND: return hn::Not(hn::And(s, t));
      case GL_SET: return all;
      default: return s;  // GL_COPY
    }
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
