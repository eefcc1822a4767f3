// SPDX-License-Identifier: Apache-2.0
// One pixel in which fragments change places: sub-samples side by side, each in its own order.
//
// Weights, their sums and the order of adding colours are those of group_composite-inl.h. So the bits are the same if
// fragments do not change places after all.
//
//    list        a   b   c   d            b and c cross in the pixel: they are a run, and each sub-sample sorts the run
//    run             [b   c]              by its own keys. Fragments before and behind a run have one order everywhere.
//    samples     b c | c b | b c ...

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#undef FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#else
#define FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#endif

#include "abuffer/composite/composite_kernel.h"
#include "abuffer/gather/fragment_sink-inl.h"
#include "view/steep_keys-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The sum of all lanes by halves: lanes half the count apart are added first.
template <class D>
HWY_INLINE float AddHalves(D /*tag*/, hn::Vec<D> v) {
#if HWY_TARGET == HWY_SCALAR
  return hn::GetLane(v);
#else
  if constexpr (hn::MaxLanes(D()) == 4) {
    v = hn::Add(v, hn::Shuffle1032(v));
    return hn::GetLane(hn::Add(v, hn::Shuffle2301(v)));
  } else {
    const hn::Half<D> half;
    return AddHalves(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  }
#endif
}

template <int kSamples>
class PixelCompositor {
 public:
  PixelCompositor(const CompositeInput& input, const GatherScratch& scratch, const GroupFragments& fragments,
                  const glm::vec4* colors)
      : pattern_(input.pattern), s_(scratch), g_(fragments), table_(colors), opacity_(input.opacity) {}

  /// The pixel, premultiplied. Precondition: GroupFragments belong to the group, with `reach` for this pixel.
  HWY_NOINLINE glm::vec4 Composite(std::size_t group, std::size_t pixel) {
    for (VF& left : left_) left = hn::Set(DF(), 1.0f);
    color_ = glm::vec3(0);
    pixel_ = pixel;
    origin_x_ = (std::int32_t(group % kBlocksAcross) * 4 + std::int32_t(pixel % 4)) * kSubPixels;
    origin_y_ = (std::int32_t(group / kBlocksAcross) * 4 + std::int32_t(pixel / 4)) * kSubPixels;
    const std::size_t length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0;) {
      std::size_t end = i + 1;
      // A run is closed under changing places: it contains every fragment that one of its fragments may change places
      // with.
      for (std::size_t k = i; k < end; ++k) end = HWY_MAX(end, std::size_t(g_.reach[At(k)]) + 1);
      if (end - i == 1)
        Add(i);
      else if (end - i <= kMostInRun)
        AddShortRun(i, end);
      else
        AddLongRun(i, end);
      i = end;
    }
    VF left[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) left[v] = hn::IfThenElseZero(LanesOf(pattern_.full(), v), left_[v]);
    return {color_, 1.0f - SumOf(left) * kScale};
  }

 private:
  static constexpr std::size_t kLanes = kMaxLanes < kSamples ? kMaxLanes : kSamples;
  static constexpr std::size_t kVectors = kSamples / kLanes;
  static constexpr float kScale = 1.0f / kSamples;
  /// Runs of up to so many fragments compare each fragment with each.
  static constexpr std::size_t kMostInRun = 16;

  [[nodiscard]] HWY_INLINE std::size_t At(std::size_t slot) const { return slot * kGroup + pixel_; }
  [[nodiscard]] HWY_INLINE std::uint64_t MaskAt(std::size_t slot) const {
    return kSamples > 32 ? std::uint64_t(g_.mask_high[At(slot)]) << 32 | g_.mask_low[At(slot)] : g_.mask_low[At(slot)];
  }
  [[nodiscard]] HWY_INLINE PrimitiveId IdAt(std::size_t slot) const { return s_.triangles.id[g_.triangle[At(slot)]]; }
  [[nodiscard]] HWY_INLINE const glm::vec4& ColorAt(std::size_t slot) const { return table_[g_.number[At(slot)]]; }

  static HWY_INLINE hn::Mask<DF> LanesOf(std::uint64_t mask, std::size_t v) {
    const std::uint64_t bits = mask >> (v * kLanes);
    std::uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bytes);
    return hn::LoadMaskBits(DF(), bytes);
  }

  static HWY_INLINE float SumOf(const VF (&values)[kVectors]) {
    VF sum[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) sum[v] = values[v];
    for (std::size_t half = kVectors / 2; half > 0; half /= 2)
      for (std::size_t v = 0; v < half; ++v) sum[v] = hn::Add(sum[v], sum[v + half]);
    return AddHalves(DF(), sum[0]);
  }

  HWY_INLINE void AddWeighted(const glm::vec4& color, const VF (&shown)[kVectors]) {
    color_ += SumOf(shown) * kScale * (color.a * opacity_) * glm::vec3(color);
  }

  HWY_INLINE void Add(std::size_t slot) {
    const DF d;
    const glm::vec4& color = ColorAt(slot);
    const VF passes = hn::Set(d, 1.0f - color.a * opacity_);
    VF shown[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto covered = LanesOf(MaskAt(slot), v);
      shown[v] = hn::IfThenElseZero(covered, left_[v]);
      left_[v] = hn::IfThenElse(covered, hn::Mul(left_[v], passes), left_[v]);
    }
    AddWeighted(color, shown);
  }

  /// Bits of the keys at a vector of sub-samples; -1, behind all keys, if the fragment does not cover the sub-sample.
  [[nodiscard]] HWY_INLINE VI KeysAt(std::size_t slot, std::size_t v) const {
    const DI d;
    const DF df;
    const LocalTriangles& t = s_.triangles;
    const std::size_t n = g_.triangle[At(slot)];
    const VI x = hn::ShiftLeft<4>(hn::LoadU(d, pattern_.x.data() + v * kLanes));
    const VI y = hn::ShiftLeft<4>(hn::LoadU(d, pattern_.y.data() + v * kLanes));
    const VF dx = hn::ConvertTo(df, hn::Add(x, hn::Set(d, origin_x_ - t.x0[n])));
    const VF dy = hn::ConvertTo(df, hn::Add(y, hn::Set(d, origin_y_ - t.y0[n])));
    VF key = hn::Add(hn::Set(df, t.k0[n]), hn::Mul(dx, hn::Set(df, t.gx[n])));
    key = hn::Add(key, hn::Mul(dy, hn::Set(df, t.gy[n])));
    key = hn::Min(hn::Max(key, hn::Set(df, t.low[n])), hn::Set(df, t.high[n]));
    if (t.steep[n] != no_index) {
      const SteepKeys& steep = t.steep_keys[t.steep[n]];
      view_detail::HWY_NAMESPACE::SteepColumns columns;
      columns.Set(steep, hn::Add(x, hn::Set(d, origin_x_)));
      key = columns.At(steep, hn::Add(y, hn::Set(d, origin_y_)));
    }
    const auto covered = hn::RebindMask(d, LanesOf(MaskAt(slot), v));
    return hn::IfThenElse(covered, hn::BitCast(d, key), hn::Set(d, -1));
  }

  /// Weights every fragment by the fragments before it at each sub-sample: nothing needs to be sorted.
  void AddShortRun(std::size_t begin, std::size_t end) {
    const DI d;
    const DF df;
    const std::size_t count = end - begin;
    VI key[kMostInRun][kVectors];
    VF passes[kMostInRun];
    for (std::size_t i = 0; i < count; ++i) {
      passes[i] = hn::Set(df, 1.0f - ColorAt(begin + i).a * opacity_);
      for (std::size_t v = 0; v < kVectors; ++v) key[i][v] = KeysAt(begin + i, v);
    }
    for (std::size_t i = 0; i < count; ++i) {
      VF shown[kVectors];
      for (std::size_t v = 0; v < kVectors; ++v) {
        const auto covered = hn::Gt(key[i][v], hn::Set(d, -1));
        shown[v] = hn::IfThenElseZero(hn::RebindMask(df, covered), left_[v]);
        for (std::size_t k = 0; k < count; ++k) {
          if (k == i) continue;
          const bool wins_ties = IdAt(begin + k) < IdAt(begin + i);
          const auto before = wins_ties ? hn::Not(hn::Gt(key[i][v], key[k][v])) : hn::Gt(key[k][v], key[i][v]);
          shown[v] = hn::IfThenElse(hn::RebindMask(df, before), hn::Mul(shown[v], passes[k]), shown[v]);
        }
      }
      AddWeighted(ColorAt(begin + i), shown);
    }
    for (std::size_t v = 0; v < kVectors; ++v)
      for (std::size_t i = 0; i < count; ++i) {
        const auto covered = hn::RebindMask(df, hn::Gt(key[i][v], hn::Set(d, -1)));
        left_[v] = hn::IfThenElse(covered, hn::Mul(left_[v], passes[i]), left_[v]);
      }
  }

  /// Sorts the run at every sub-sample.
  void AddLongRun(std::size_t begin, std::size_t end) {
    const DF d;
    HWY_ALIGN_MAX float left[kSamples + kMaxLanes];
    for (std::size_t v = 0; v < kVectors; ++v) hn::StoreU(left_[v], d, left + v * kLanes);
    glm::vec3 sum(0);
    for (std::size_t sample = 0; sample < std::size_t(kSamples); ++sample) {
      const std::int32_t x = origin_x_ + pattern_.x[sample] * SamplePattern::unit;
      const std::int32_t y = origin_y_ + pattern_.y[sample] * SamplePattern::unit;
      order_.clear();
      for (std::size_t slot = begin; slot < end; ++slot)
        if (MaskAt(slot) >> sample & 1)
          order_.push_back({-s_.triangles.key_at(g_.triangle[At(slot)], x, y), IdAt(slot), slot});
      // The order is mostly that of the list: copies of one triangle stay as they are.
      if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());
      for (const auto& [key, id, slot] : order_) {
        const glm::vec4& color = ColorAt(slot);
        const float alpha = color.a * opacity_;
        sum += left[sample] * alpha * glm::vec3(color);
        left[sample] *= 1.0f - alpha;
      }
    }
    color_ += sum * kScale;
    for (std::size_t v = 0; v < kVectors; ++v) left_[v] = hn::LoadU(d, left + v * kLanes);
  }

  const SamplePattern& pattern_;
  const GatherScratch& s_;
  const GroupFragments& g_;
  const glm::vec4* table_;
  const float opacity_;
  VF left_[kVectors];
  glm::vec3 color_;
  std::size_t pixel_ = 0;
  std::int32_t origin_x_ = 0, origin_y_ = 0;
  std::vector<std::tuple<float, PrimitiveId, std::size_t>> order_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
