// SPDX-License-Identifier: Apache-2.0
// Lays out the fragments of a group side by side, finds the pixels in which two of them may change places, and
// composites these pixels by themselves.
//
// Lists are in the order of keys at the centre. Two fragments can have another order elsewhere in the pixel only if
// they share a sub-sample, the ranges of their keys overlap, and the difference of their slopes can make up for the
// difference of their keys at the centre. If two fragments may change places, they and all fragments between them form
// a run. So partners are looked for only beyond the end of the run so far. In long lists, the number of compared pairs
// is limited. Beyond the limit, the ranges of keys alone decide, which makes the runs longer and the picture no worse.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_CONFLICTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#undef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#else
#define FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#endif

#include "abuffer/composite/composite_kernel.h"
#include "abuffer/gather/fragment_sink-inl.h"
#include "view/steep_keys-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The halves of some words of a slot: the complements of numbers (`low`), and the bits of keys (`high`).
struct SlotHalves {
  VU low, high;
};
HWY_INLINE SlotHalves HalvesOf(const std::uint64_t* words) {
  const DU d;
  const auto* halves = reinterpret_cast<const std::uint32_t*>(words);
#if HWY_TARGET == HWY_SCALAR
  return {hn::Load(d, halves), hn::Load(d, halves + 1)};
#else
  const VU first = hn::Load(d, halves), second = hn::Load(d, halves + hn::Lanes(d));
  return {hn::ConcatEven(d, second, first), hn::ConcatOdd(d, second, first)};
#endif
}

/// Lays out a group and finds conflicts. kWide is true if there are more than 32 sub-samples.
template <bool kWide>
class GroupReader {
 public:
  /// `all` is the mask of all sub-samples.
  GroupReader(const GatherScratch& scratch, GroupFragments& fragments, std::uint64_t all)
      : s_(scratch), g_(fragments), all_(all) {}

  /// Fills GroupFragments. \returns the pixels, as bits, in which fragments may change places: none at a single sample.
  /// `reach` is valid in these pixels only.
  HWY_NOINLINE std::uint64_t Read(std::size_t group) {
    group_ = group;
    length_ = s_.length(group);
    g_.reserve(length_);
    in_conflict_ = 0;
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(DF()))
      if (const std::uint64_t suspects = ReadLanes(lane); suspects != 0 && all_ != 1) FindPairs(lane, suspects);
    return in_conflict_;
  }

 private:
  static constexpr std::size_t kLastBit = 63;
  /// Lists longer than kLong are searched pixel by pixel, with at most kMostPairs pairs per fragment.
  static constexpr std::size_t kLong = 256, kMostPairs = 64;

  /// Reads slots from the last to the first. \returns, as bits, the slots whose ranges of keys overlap those of later
  /// slots. The bit kLastBit stands for all slots from there on.
  HWY_INLINE std::uint64_t ReadLanes(std::size_t lane) {
    const DI d;
    const DU du;
    const DF df;
    const auto* triangles = reinterpret_cast<const std::int32_t*>(s_.arrived.triangle.data());
    const auto* low_masks = reinterpret_cast<const std::int32_t*>(s_.arrived.mask_low.data());
    const auto* high_masks = reinterpret_cast<const std::int32_t*>(s_.arrived.mask_high.data());
    const VF nowhere = hn::Set(df, -std::numeric_limits<float>::max());
    VF behind = nowhere;
    std::uint64_t suspects = 0;
    for (std::size_t i = length_; i-- > 0;) {
      const std::size_t at = i * kGroup + lane;
      const SlotHalves words = HalvesOf(s_.slot(group_, i) + lane);
      const auto valid = hn::Ne(words.low, hn::Zero(du));
      const VI number = hn::BitCast(d, hn::IfThenElseZero(valid, hn::Not(words.low)));
      const VI triangle = hn::GatherIndex(d, triangles, number);
      const VF half = hn::GatherIndex(df, s_.triangles.half.data(), triangle);
      const VF key = hn::BitCast(df, words.high);
      const VF nearest = hn::IfThenElse(hn::RebindMask(df, valid), hn::Add(key, half), nowhere);
      const VF farthest = hn::Sub(key, half);
      const bool overlaps = !hn::AllTrue(df, hn::Lt(behind, farthest));
      suspects |= std::uint64_t(overlaps) << HWY_MIN(i, kLastBit);
      hn::Store(behind, df, g_.behind.data() + at);
      behind = hn::Max(behind, nearest);
      hn::Store(nearest, df, g_.nearest.data() + at);
      hn::Store(farthest, df, g_.farthest.data() + at);
      hn::Store(hn::BitCast(du, triangle), du, g_.triangle.data() + at);
      hn::Store(hn::BitCast(du, number), du, g_.number.data() + at);
      // An empty slot gets the full mask, so that it never counts as partly covering.
      const auto mask_of = [&](const std::int32_t* masks, std::uint32_t all) HWY_ATTR {
        return hn::IfThenElse(valid, hn::BitCast(du, hn::GatherIndex(d, masks, number)), hn::Set(du, all));
      };
      hn::Store(mask_of(low_masks, std::uint32_t(all_)), du, g_.mask_low.data() + at);
      if (kWide) hn::Store(mask_of(high_masks, std::uint32_t(all_ >> 32)), du, g_.mask_high.data() + at);
    }
    return suspects;
  }

  void FindPairs(std::size_t lane, std::uint64_t suspects) {
    const DI d;
    for (std::size_t i = 0; i < length_; ++i)
      hn::Store(hn::Set(d, std::int32_t(i)), d, g_.reach.data() + i * kGroup + lane);
    if (length_ > kLong) {
      for (std::size_t pixel = lane; pixel < lane + hn::Lanes(d); ++pixel)
        if (!FindLongPairs(pixel)) FindOverlaps(pixel);
      return;
    }
    hn::Store(hn::Zero(d), d, run_end_ + lane);
    ForEachBit(suspects, [&](std::size_t i) HWY_ATTR { FindPairsOf(i, lane); });
    if (suspects >> kLastBit != 0)
      for (std::size_t i = kLastBit + 1; i + 1 < length_; ++i) FindPairsOf(i, lane);
  }

  /// Finds the slots beyond the end of the run so far that slot i may change places with.
  HWY_INLINE void FindPairsOf(std::size_t i, std::size_t lane) {
    const DF d;
    const DU du;
    const DI di;
    const std::size_t first = i * kGroup + lane;
    const VF farthest = hn::Load(d, g_.farthest.data() + first);
    const VU low = hn::Load(du, g_.mask_low.data() + first);
    const VU high = kWide ? hn::Load(du, g_.mask_high.data() + first) : low;
    const VI last = hn::Max(hn::Load(di, run_end_ + lane), hn::Set(di, std::int32_t(i)));
    const VI at_last = hn::Add(hn::Mul(last, hn::Set(di, std::int32_t(kGroup))), hn::Iota(di, std::int32_t(lane)));
    auto open = hn::Ge(hn::GatherIndex(d, g_.behind.data(), at_last), farthest);
    if (hn::AllFalse(d, open)) return;
    const VI none = hn::Set(di, std::int32_t(length_));
    const VI from = hn::IfThenElse(hn::RebindMask(di, open), last, none);
    for (auto j = std::size_t(hn::GetLane(hn::MinOfLanes(di, from))) + 1; j < length_; ++j) {
      open = hn::And(open, hn::Ge(hn::Load(d, g_.behind.data() + (j - 1) * kGroup + lane), farthest));
      if (hn::AllFalse(d, open)) return;
      const std::size_t at = j * kGroup + lane;
      VU shared = hn::And(low, hn::Load(du, g_.mask_low.data() + at));
      if (kWide) shared = hn::Or(shared, hn::And(high, hn::Load(du, g_.mask_high.data() + at)));
      const auto beyond = hn::RebindMask(du, hn::Gt(hn::Set(di, std::int32_t(j)), last));
      const auto overlap = hn::And(open, hn::Ge(hn::Load(d, g_.nearest.data() + at), farthest));
      const auto both = hn::And(hn::And(hn::RebindMask(du, overlap), beyond), hn::Ne(shared, hn::Zero(du)));
      ForEachBit(BitsOf(du, both), [&](std::size_t p) HWY_ATTR {
        const std::size_t pixel = lane + p;
        if (MayChangePlaces(i * kGroup + pixel, j * kGroup + pixel)) Join(i, j, pixel);
      });
    }
  }

  void Join(std::size_t i, std::size_t j, std::size_t pixel) {
    g_.reach[i * kGroup + pixel] = run_end_[pixel] = std::int32_t(j);
    in_conflict_ |= std::uint64_t(1) << pixel;
  }

  /// Finds the pairs of a pixel with a long list. \returns false if there are too many pairs. Pairs are counted by
  /// pixel, so the result does not depend on the width of vectors.
  [[nodiscard]] bool FindLongPairs(std::size_t pixel) {
    std::size_t pairs = length_ * kMostPairs;
    for (std::size_t i = 0, end = 0; i < length_; ++i) {
      const std::size_t at = i * kGroup + pixel;
      end = std::max(end, i);
      for (std::size_t j = end + 1; j < length_ && g_.behind[(j - 1) * kGroup + pixel] >= g_.farthest[at]; ++j) {
        if (pairs-- == 0) return false;
        const std::size_t other = j * kGroup + pixel;
        if (!(g_.nearest[other] >= g_.farthest[at]) || !SharesSample(at, other) || !MayChangePlaces(at, other))
          continue;
        Join(i, j, pixel);
        end = j;
      }
    }
    return true;
  }

  [[nodiscard]] bool SharesSample(std::size_t a, std::size_t b) const {
    return (g_.mask_low[a] & g_.mask_low[b]) != 0 || (kWide && (g_.mask_high[a] & g_.mask_high[b]) != 0);
  }

  /// Finds runs by the overlaps of key ranges alone.
  void FindOverlaps(std::size_t pixel) {
    float farthest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i + 1 < length_; ++i) {
      const std::size_t at = i * kGroup + pixel;
      g_.reach[at] = std::int32_t(i);
      farthest = std::min(farthest, g_.farthest[at]);
      if (g_.behind[at] >= farthest) Join(i, i + 1, pixel);
    }
  }

  [[nodiscard]] HWY_INLINE bool MayChangePlaces(std::size_t a, std::size_t b) const {
    const LocalTriangles& t = s_.triangles;
    const std::size_t ta = g_.triangle[a], tb = g_.triangle[b];
    const bool is_affine = g_.nearest[a] < t.high[ta] && g_.farthest[a] > t.low[ta] && g_.nearest[b] < t.high[tb] &&
                           g_.farthest[b] > t.low[tb];
    if (!is_affine) return true;
    const float slope = std::abs(t.gx[ta] - t.gx[tb]) + std::abs(t.gy[ta] - t.gy[tb]);
    const float most = slope * kHalfPixel + (t.slack[ta] + t.slack[tb]);
    return KeyOf(a) - KeyOf(b) <= most;
  }

  [[nodiscard]] HWY_INLINE float KeyOf(std::size_t at) const {
    return bits_as<float>(std::uint32_t(s_.slot(group_, 0)[at] >> 32));
  }

  const GatherScratch& s_;
  GroupFragments& g_;
  const std::uint64_t all_;
  std::size_t group_ = 0, length_ = 0;
  std::uint64_t in_conflict_ = 0;
  HWY_ALIGN_MAX std::int32_t run_end_[kGroup] = {};  ///< by pixel, last slot of the current run
};

/// Returns the sum of all lanes by halves: lanes half the count apart are added first.
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

/// Composites one pixel in which fragments change places: sub-samples side by side, each in its own order. Weights,
/// their sums and the order of adding colours are those of GroupCompositor. So the bits are the same if fragments do
/// not change places after all.
///
///    list       a   b   c   d        b and c cross in the pixel, so they are a run: each sub-sample sorts them by its
///    run            [b   c]          own keys. Fragments before and behind a run have one order everywhere.
///    samples    b c | c b | b c
template <int kSamples>
class PixelCompositor {
 public:
  PixelCompositor(const CompositeInput& input, const GatherScratch& scratch, const GroupFragments& fragments,
                  const glm::vec4* colors)
      : pattern_(input.pattern), s_(scratch), g_(fragments), table_(colors), opacity_(input.opacity) {}

  /// Returns the pixel, premultiplied. Precondition: GroupFragments holds the group, with `reach` for this pixel.
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
  /// In runs of up to so many fragments, each fragment is compared with all others.
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

  /// Returns the bits of the keys at a vector of sub-samples; -1, behind all keys, if the fragment does not cover the
  /// sub-sample.
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

  /// Adds a run without sorting it: weights every fragment by the fragments before it at each sub-sample.
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

  /// Adds a run that is sorted at every sub-sample.
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
      // The order is mostly that of the list, for example in copies of one triangle, so sorting is seldom needed.
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
