// SPDX-License-Identifier: Apache-2.0
// Lays out the fragments of a group side by side, and finds the pixels in which two of them may change places.
//
// Lists are in the order of keys at the centre. Two fragments can have another order elsewhere in the pixel only if
// they share a sub-sample, the ranges of their keys overlap, and the difference of their slopes can make up for the
// difference of their keys at the centre. The last condition needs planes that are not clamped within the pixel. On
// finely tessellated models it leaves a seventh of the pixels that ranges alone would.
//
// A fragment between two that may change places is in their run (pixel_composite-inl.h). So partners are only looked
// for beyond the end of the run so far: a thousand copies of a triangle are one run once the first copy has been
// compared with the others. Long lists have a limit to the pairs that are compared. Beyond the limit ranges alone
// decide, which makes the runs longer and the picture no worse.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_CONFLICTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#undef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#else
#define FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#endif

#include "abuffer/composite/composite_kernel.h"
#include "abuffer/gather/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sixteen words of a slot, split: 64 bits each, the key above the number.
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

/// kWide: there are more than 32 sub-samples.
template <bool kWide>
class GroupReader {
 public:
  /// `all` is the mask of all sub-samples.
  GroupReader(const GatherScratch& scratch, GroupFragments& fragments, std::uint64_t all)
      : s_(scratch), g_(fragments), all_(all) {}

  /// Fills GroupFragments. \returns the pixels, as bits, in which fragments may change places: none at a single sample.
  /// In these pixels `reach` holds, for every fragment, the last slot that a fragment up to it may change places with.
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

  /// Reads slots from the last to the first. \returns, as bits, the slots whose key ranges overlap those of slots
  /// behind; the last bit stands for all slots from there.
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
      // An empty slot covers all samples, so nothing is covered in part.
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

  /// Finds pairs of slot i with slots beyond the last that a slot up to i may change places with.
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

  /// \returns false if there are too many pairs. Pairs are counted by pixel, so the result does not depend on the width
  /// of vectors.
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

  /// Finds the runs of overlapping ranges.
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
    const auto bits = std::uint32_t(s_.slot(group_, 0)[at] >> 32);
    float key;
    std::memcpy(&key, &bits, sizeof key);
    return key;
  }

  const GatherScratch& s_;
  GroupFragments& g_;
  const std::uint64_t all_;
  std::size_t group_ = 0, length_ = 0;
  std::uint64_t in_conflict_ = 0;
  HWY_ALIGN_MAX std::int32_t run_end_[kGroup] = {};  ///< by pixel, last slot of the current run
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
