// SPDX-License-Identifier: Apache-2.0
// One pixel whose sub-samples see different things: what shows through and what was seen, for every sub-sample.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#undef FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#else
#define FRONTMOST_ABUFFER_PIXEL_COMPOSITE_INL_H_
#endif

#include "abuffer/composite_kernel.h"
#include "abuffer/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <int kSamples>
class PixelCompositor {
 public:
  PixelCompositor(const FrameInput& frame, const TileJob& job, TileScratch& scratch, const FragmentColors& colors)
      : frame_(frame), job_(job), s_(scratch), colors_(colors) {}

  /// Premultiplied, the mean over the sub-samples. Precondition: FindSpecial() was called for the group.
  glm::vec4 Composite(std::size_t group, std::size_t pixel, bool in_conflict) {
    Clear();
    const std::size_t length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0;) {
      std::size_t end = i + 1;
      if (in_conflict)
        for (std::size_t k = i; k < end; ++k) end = HWY_MAX(end, std::size_t(s_.reach[k * kGroup + pixel]) + 1);
      if (end - i == 1) {
        if (Add(Number(words[i * kGroup]))) break;
      } else {
        AddRun(words + i * kGroup, end - i, group, pixel);
      }
      i = end;
    }
    return Mean();
  }

 private:
  static constexpr std::size_t kLanes = kMaxLanes < kSamples ? kMaxLanes : kSamples;
  static constexpr std::size_t kVectors = kSamples / kLanes;
  /// Up to so many fragments are sorted side by side.
  static constexpr std::size_t kMostInRun = 16;

  static HWY_INLINE std::uint32_t Number(std::uint64_t word) { return ~std::uint32_t(word); }

  HWY_INLINE const glm::vec4& ColorOf(std::uint32_t number) const {
    return colors_.table[colors_.by_fragment ? number : s_.triangles.id[s_.arrived.triangle[number]]];
  }

  HWY_INLINE void Clear() {
    const DF d;
    for (std::size_t v = 0; v < kVectors; ++v) {
      left_[v] = hn::Set(d, 1.0f);
      red_[v] = green_[v] = blue_[v] = hn::Zero(d);
    }
  }

  static HWY_INLINE hn::Mask<DF> LanesOf(std::uint64_t mask, std::size_t v) {
    const std::uint64_t bits = mask >> (v * kLanes);
    std::uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bytes);
    return hn::LoadMaskBits(DF(), bytes);
  }

  /// \returns true when nothing behind can be seen.
  HWY_INLINE bool Add(std::uint32_t number) {
    const DF d;
    const glm::vec4& color = ColorOf(number);
    const std::uint64_t mask = s_.arrived.mask[number];
    const float alpha = color.a * colors_.opacity;
    const VF red = hn::Set(d, color.r), green = hn::Set(d, color.g), blue = hn::Set(d, color.b);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const VF shows = hn::IfThenElseZero(LanesOf(mask, v), hn::Set(d, alpha));
      AddVector(v, shows, red, green, blue);
    }
    return alpha == 1.0f && mask == frame_.pattern.full();
  }

  HWY_INLINE void AddVector(std::size_t v, VF shows, VF red, VF green, VF blue) {
    const DF d;
    const VF weight = hn::Mul(left_[v], shows);
    red_[v] = hn::Add(red_[v], hn::Mul(weight, red));
    green_[v] = hn::Add(green_[v], hn::Mul(weight, green));
    blue_[v] = hn::Add(blue_[v], hn::Mul(weight, blue));
    left_[v] = hn::Mul(left_[v], hn::Sub(hn::Set(d, 1.0f), shows));
  }

  /// Fragments that may change places: sorted at every sub-sample.
  void AddRun(const std::uint64_t* words, std::size_t count, std::size_t group, std::size_t pixel) {
    run_.clear();
    for (std::size_t i = 0; i < count; ++i) run_.push_back(Number(words[i * kGroup]));
    // By id: equal keys go to the lower one.
    std::sort(run_.begin(), run_.end(), [this](std::uint32_t a, std::uint32_t b) {
      const PrimitiveId ia = IdOf(a), ib = IdOf(b);
      return ia != ib ? ia < ib : s_.arrived.mask[a] < s_.arrived.mask[b];
    });
    origin_x_ = (std::int32_t(group % kBlocksAcross) * 4 + std::int32_t(pixel % 4)) * kSubPixels;
    origin_y_ = (std::int32_t(group / kBlocksAcross) * 4 + std::int32_t(pixel / 4)) * kSubPixels;
    if (count <= kMostInRun)
      AddShortRun(count);
    else
      AddLongRun(count);
  }
  HWY_INLINE PrimitiveId IdOf(std::uint32_t number) const { return s_.triangles.id[s_.arrived.triangle[number]]; }

  /// Bits of the keys at a vector of sub-samples; -1, behind all, where the fragment is not.
  HWY_INLINE VI KeysAt(std::uint32_t number, std::size_t v) const {
    const DI d;
    const DF df;
    const LocalTriangles& t = s_.triangles;
    const std::size_t n = s_.arrived.triangle[number];
    const SamplePattern& p = frame_.pattern;
    const VI x = hn::ShiftLeft<4>(hn::LoadU(d, p.x.data() + v * kLanes));
    const VI y = hn::ShiftLeft<4>(hn::LoadU(d, p.y.data() + v * kLanes));
    const VF dx = hn::ConvertTo(df, hn::Add(x, hn::Set(d, origin_x_ - t.x0[n])));
    const VF dy = hn::ConvertTo(df, hn::Add(y, hn::Set(d, origin_y_ - t.y0[n])));
    VF key = hn::Add(hn::Set(df, t.k0[n]), hn::Mul(dx, hn::Set(df, t.gx[n])));
    key = hn::Add(key, hn::Mul(dy, hn::Set(df, t.gy[n])));
    key = hn::Min(hn::Max(key, hn::Set(df, t.low[n])), hn::Set(df, t.high[n]));
    const auto covered = hn::RebindMask(d, LanesOf(s_.arrived.mask[number], v));
    return hn::IfThenElse(covered, hn::BitCast(d, key), hn::Set(d, -1));
  }

  void AddShortRun(std::size_t count) {
    const DI d;
    const DF df;
    HWY_ALIGN_MAX float red[kMostInRun], green[kMostInRun], blue[kMostInRun], alpha[kMostInRun];
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec4& color = ColorOf(run_[i]);
      red[i] = color.r;
      green[i] = color.g;
      blue[i] = color.b;
      alpha[i] = color.a * colors_.opacity;
    }
    for (std::size_t v = 0; v < kVectors; ++v) {
      VI key[kMostInRun], which[kMostInRun];
      for (std::size_t i = 0; i < count; ++i) {
        key[i] = KeysAt(run_[i], v);
        which[i] = hn::Set(d, std::int32_t(i));
      }
      SortLanes(key, which, count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto seen = hn::RebindMask(df, hn::Gt(key[i], hn::Set(d, -1)));
        const VF shows = hn::IfThenElseZero(seen, hn::GatherIndex(df, alpha, which[i]));
        AddVector(v, shows, hn::GatherIndex(df, red, which[i]), hn::GatherIndex(df, green, which[i]),
                  hn::GatherIndex(df, blue, which[i]));
      }
    }
  }

  /// Odd-even transposition until nothing moves: runs are short and nearly in order.
  static HWY_INLINE void SortLanes(VI* key, VI* which, std::size_t count) {
    const DI d;
    std::size_t quiet = 0;
    for (std::size_t pass = 0; quiet < 2; ++pass) {
      bool moved = false;
      for (std::size_t i = pass % 2; i + 1 < count; i += 2) {
        const MI before =
            hn::Or(hn::Gt(key[i + 1], key[i]), hn::And(hn::Eq(key[i + 1], key[i]), hn::Lt(which[i + 1], which[i])));
        if (hn::AllFalse(d, before)) continue;
        moved = true;
        const VI k = hn::IfThenElse(before, key[i + 1], key[i]), w = hn::IfThenElse(before, which[i + 1], which[i]);
        key[i + 1] = hn::IfThenElse(before, key[i], key[i + 1]);
        which[i + 1] = hn::IfThenElse(before, which[i], which[i + 1]);
        key[i] = k;
        which[i] = w;
      }
      quiet = moved ? 0 : quiet + 1;
    }
  }

  void AddLongRun(std::size_t count) {
    const DF d;
    const SamplePattern& p = frame_.pattern;
    HWY_ALIGN_MAX float left[kSamples + kMaxLanes], red[kSamples + kMaxLanes], green[kSamples + kMaxLanes],
        blue[kSamples + kMaxLanes];
    for (std::size_t v = 0; v < kVectors; ++v) {
      hn::StoreU(left_[v], d, left + v * kLanes);
      hn::StoreU(red_[v], d, red + v * kLanes);
      hn::StoreU(green_[v], d, green + v * kLanes);
      hn::StoreU(blue_[v], d, blue + v * kLanes);
    }
    std::vector<std::pair<float, std::uint32_t>> order;
    for (std::size_t s = 0; s < std::size_t(kSamples); ++s) {
      order.clear();
      for (std::size_t i = 0; i < count; ++i)
        if (s_.arrived.mask[run_[i]] >> s & 1)
          order.push_back({-s_.triangles.key_at(s_.arrived.triangle[run_[i]], origin_x_ + p.x[s] * SamplePattern::unit,
                                                origin_y_ + p.y[s] * SamplePattern::unit),
                           std::uint32_t(i)});
      std::sort(order.begin(), order.end());
      for (const auto& [key, i] : order) {
        const glm::vec4& color = ColorOf(run_[i]);
        const float alpha = color.a * colors_.opacity, weight = left[s] * alpha;
        red[s] = red[s] + weight * color.r;
        green[s] = green[s] + weight * color.g;
        blue[s] = blue[s] + weight * color.b;
        left[s] = left[s] * (1.0f - alpha);
      }
    }
    for (std::size_t v = 0; v < kVectors; ++v) {
      left_[v] = hn::LoadU(d, left + v * kLanes);
      red_[v] = hn::LoadU(d, red + v * kLanes);
      green_[v] = hn::LoadU(d, green + v * kLanes);
      blue_[v] = hn::LoadU(d, blue + v * kLanes);
    }
  }

  /// A sum in the order of a tree that does not depend on the width of vectors.
  static HWY_INLINE float SumOf(const VF* values) {
    const DF d;
    VF sum[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) sum[v] = values[v];
    for (std::size_t half = kVectors / 2; half > 0; half /= 2)
      for (std::size_t v = 0; v < half; ++v) sum[v] = hn::Add(sum[v], sum[v + half]);
    HWY_ALIGN_MAX float lane[kMaxLanes];
    hn::Store(sum[0], d, lane);
    for (std::size_t half = kLanes / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) lane[i] += lane[i + half];
    return lane[0];
  }

  HWY_INLINE glm::vec4 Mean() const {
    constexpr float scale = 1.0f / kSamples;
    return {SumOf(red_) * scale, SumOf(green_) * scale, SumOf(blue_) * scale, 1.0f - SumOf(left_) * scale};
  }

  const FrameInput& frame_;
  const TileJob& job_;
  TileScratch& s_;
  const FragmentColors& colors_;
  VF left_[kVectors], red_[kVectors], green_[kVectors], blue_[kVectors];
  std::vector<std::uint32_t> run_;
  std::int32_t origin_x_ = 0, origin_y_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
