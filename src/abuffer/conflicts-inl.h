// SPDX-License-Identifier: Apache-2.0
// Which pixels of a group must be taken one by one: those with fragments that cover them in part, and those in which
// two fragments may change places.
//
// Lists are in the order of keys at the centre. Two fragments can be in another order elsewhere in the pixel only if
// they share a sub-sample, the ranges of their keys overlap, and their keys at the centre differ by no more than the
// difference of their slopes makes up for. The last holds only of planes that are not clamped within the pixel. On
// finely tessellated models it leaves a seventh of the pixels that ranges alone would.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_CONFLICTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#undef FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#else
#define FRONTMOST_ABUFFER_CONFLICTS_INL_H_
#endif

#include "abuffer/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Pixels of a group as bits.
struct SpecialPixels {
  std::uint64_t pixels = 0;
  /// In these TileScratch::reach holds, for every fragment, the last slot that one up to it may change places with.
  std::uint64_t in_conflict = 0;
};

class ConflictFinder {
 public:
  ConflictFinder(const FrameInput& frame, TileScratch& scratch, std::size_t group)
      : full_(frame.pattern.full()), s_(scratch), group_(group), length_(scratch.length(group)) {
    s_.reserve_group(length_);
  }

  SpecialPixels Find() {
    SpecialPixels result;
    Load();
    result.pixels = partial_;
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(DF())) FindPairs(lane);
    result.in_conflict = in_conflict_;
    result.pixels |= in_conflict_;
    return result;
  }

 private:
  using D64 = hn::ScalableTag<std::int64_t>;
  using D64U = hn::RebindToUnsigned<D64>;
  using DHF = hn::Rebind<float, D64>;
  using DHU = hn::Rebind<std::uint32_t, D64U>;
  using DHI = hn::Rebind<std::int32_t, D64>;

  /// Puts ranges and masks of the group's fragments beside each other.
  void Load() {
    const D64 d;
    const DHF df;
    const auto* masks = reinterpret_cast<const std::int64_t*>(s_.arrived.mask.data());
    const auto full = hn::Set(d, std::int64_t(full_));
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
      auto missing = hn::Zero(d);
      for (std::size_t i = 0; i < length_; ++i) {
        const auto word = hn::Load(d, reinterpret_cast<const std::int64_t*>(s_.slot(group_, i)) + lane);
        const auto valid = hn::Ne(word, hn::Zero(d));
        const auto number = hn::IfThenElseZero(valid, hn::And(hn::Not(word), hn::Set(d, 0xFFFFFFFF)));
        const auto mask = hn::GatherIndex(d, masks, number);
        missing = hn::Or(missing, hn::IfThenElseZero(valid, hn::Xor(mask, full)));
        const std::size_t at = i * kGroup + lane;
        const auto bits = hn::BitCast(D64U(), mask);
        hn::Store(hn::TruncateTo(DHU(), bits), DHU(), s_.mask_low.data() + at);
        hn::Store(hn::TruncateTo(DHU(), hn::ShiftRight<32>(bits)), DHU(), s_.mask_high.data() + at);
        const auto index = hn::BitCast(DHI(), hn::TruncateTo(DHU(), hn::BitCast(D64U(), number)));
        hn::Store(hn::GatherIndex(df, s_.arrived.nearest.data(), index), df, s_.nearest.data() + at);
        hn::Store(hn::GatherIndex(df, s_.arrived.farthest.data(), index), df, s_.farthest.data() + at);
      }
      partial_ |= BitsOf(d, hn::Ne(missing, hn::Zero(d))) << lane;
    }
  }

  void FindPairs(std::size_t lane) {
    const DF d;
    const DI di;
    auto behind = hn::Set(d, -1.0f);
    for (std::size_t i = length_; i-- > 0;) {
      const std::size_t at = i * kGroup + lane;
      hn::Store(behind, d, s_.behind_nearest.data() + at);
      behind = hn::Max(behind, hn::Load(d, s_.nearest.data() + at));
      hn::Store(hn::Set(di, std::int32_t(i)), di, s_.reach.data() + at);
    }
    for (std::size_t i = 0; i + 1 < length_; ++i) FindPairsOf(i, lane);
  }

  HWY_INLINE void FindPairsOf(std::size_t i, std::size_t lane) {
    const DF d;
    const DU du;
    const VF farthest = hn::Load(d, s_.farthest.data() + i * kGroup + lane);
    const VU low = hn::Load(du, s_.mask_low.data() + i * kGroup + lane);
    const VU high = hn::Load(du, s_.mask_high.data() + i * kGroup + lane);
    for (std::size_t j = i + 1; j < length_; ++j) {
      const VF most = hn::Load(d, s_.behind_nearest.data() + (j - 1) * kGroup + lane);
      if (hn::AllTrue(d, hn::Lt(most, farthest))) return;
      const std::size_t at = j * kGroup + lane;
      const VU shared = hn::Or(hn::And(low, hn::Load(du, s_.mask_low.data() + at)),
                               hn::And(high, hn::Load(du, s_.mask_high.data() + at)));
      const auto overlap = hn::Ge(hn::Load(d, s_.nearest.data() + at), farthest);
      const auto both = hn::And(hn::RebindMask(du, overlap), hn::Ne(shared, hn::Zero(du)));
      for (std::uint64_t left = BitsOf(du, both); left != 0; left &= left - 1) {
        const std::size_t pixel = lane + hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
        if (!MayChangePlaces(i * kGroup + pixel, j * kGroup + pixel)) continue;
        s_.reach[i * kGroup + pixel] = std::int32_t(j);
        in_conflict_ |= std::uint64_t(1) << pixel;
      }
    }
  }

  [[nodiscard]] HWY_INLINE bool MayChangePlaces(std::size_t a, std::size_t b) const {
    const std::uint64_t *words = s_.slot(group_, 0), wa = words[a], wb = words[b];
    const LocalTriangles& t = s_.triangles;
    const std::size_t ta = s_.arrived.triangle[~std::uint32_t(wa)], tb = s_.arrived.triangle[~std::uint32_t(wb)];
    const bool is_affine = s_.nearest[a] < t.high[ta] && s_.farthest[a] > t.low[ta] && s_.nearest[b] < t.high[tb] &&
                           s_.farthest[b] > t.low[tb];
    if (!is_affine) return true;
    const float slope = std::abs(t.gx[ta] - t.gx[tb]) + std::abs(t.gy[ta] - t.gy[tb]);
    const float most = slope * kHalfPixel + (t.slack[ta] + t.slack[tb]);
    return KeyOf(wa) - KeyOf(wb) <= most;
  }

  static HWY_INLINE float KeyOf(std::uint64_t word) {
    const auto bits = std::uint32_t(word >> 32);
    float key;
    std::memcpy(&key, &bits, sizeof key);
    return key;
  }

  const std::uint64_t full_;
  TileScratch& s_;
  const std::size_t group_, length_;
  std::uint64_t partial_ = 0, in_conflict_ = 0;
};

inline SpecialPixels FindSpecial(const FrameInput& frame, TileScratch& scratch, std::size_t group) {
  if (scratch.length(group) == 0) return {};
  return ConflictFinder(frame, scratch, group).Find();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
