// SPDX-License-Identifier: Apache-2.0
// From fragments in the order of arrival to sorted lists. The lists of sixteen neighbouring pixels take the length of
// the longest, so that one sorting network sorts all sixteen at once.
//
// K. Batcher. Sorting Networks and Their Applications. 1968; as algorithm M of D. Knuth, The Art of Computer
// Programming 3, 5.2.2, which takes any length.
//
// Measured against separate lists one after the other: insertion sort takes 7 to 8 times as long, std::sort 9 times.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_LIST_SORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_LIST_SORT_INL_H_
#undef FRONTMOST_ABUFFER_LIST_SORT_INL_H_
#else
#define FRONTMOST_ABUFFER_LIST_SORT_INL_H_
#endif

#include "abuffer/gather/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Keys are not negative, so words may be compared as signed: AVX2 has no other comparison.
using DW = hn::ScalableTag<std::int64_t>;

HWY_INLINE void CompareExchange(std::int64_t* a, std::int64_t* b) {
  const DW d;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
    const auto va = hn::Load(d, a + i), vb = hn::Load(d, b + i);
    // Empty slots are 0 and so sink to the end of their lists, whatever their lengths.
    hn::Store(hn::Max(va, vb), d, a + i);
    hn::Store(hn::Min(va, vb), d, b + i);
  }
}

/// Sorts the sixteen lists of a group, greatest first.
HWY_INLINE void SortGroup(std::uint64_t* slots, std::size_t length) {
  auto* words = reinterpret_cast<std::int64_t*>(slots);
  if (length < 2) return;
  std::size_t top = 1;
  while (2 * top < length) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      // All i with (i & p) == r: every other block of p.
      for (std::size_t begin = r; begin + d < length; begin += 2 * p)
        for (std::size_t i = begin; i < HWY_MIN(begin + p, length - d); ++i)
          CompareExchange(words + i * kGroup, words + (i + d) * kGroup);
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

/// Sorts fragments of equal keys, which are in the order of arrival, by id.
inline void OrderTies(GatherScratch& s, std::size_t group, std::size_t lane) {
  const auto length = s.length(group);
  const auto at = [&](std::size_t i) -> std::uint64_t& { return s.slot(group, i)[lane]; };
  const auto id = [&](std::uint64_t word) { return s.triangles.id[s.arrived.triangle[~std::uint32_t(word)]]; };
  for (std::size_t begin = 0; begin < length && at(begin) != 0;) {
    std::size_t end = begin + 1;
    // An empty slot has the key 0 as well.
    while (end < length && at(end) != 0 && at(end) >> 32 == at(begin) >> 32) ++end;
    if (end - begin > 1) {
      std::vector<std::uint64_t>& run = s.run;
      run.clear();
      for (std::size_t i = begin; i < end; ++i) run.push_back(at(i));
      // Pieces of one clipped triangle have one id; their masks are disjoint, and so give a definite order.
      std::sort(run.begin(), run.end(), [&](std::uint64_t a, std::uint64_t b) {
        const PrimitiveId ia = id(a), ib = id(b);
        if (ia != ib) return ia < ib;
        return s.arrived.mask(~std::uint32_t(a)) < s.arrived.mask(~std::uint32_t(b));
      });
      for (std::size_t i = begin; i < end; ++i) at(i) = run[i - begin];
    }
    begin = end;
  }
}

inline void FindTies(GatherScratch& s, std::size_t group) {
  const DW d;
  const std::size_t length = s.length(group);
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
    auto tied = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (std::size_t i = 0; i + 1 < length; ++i) {
      const auto a = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i)) + lane);
      const auto b = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i + 1)) + lane);
      // Empty slots are 0 and tie with each other, but b of a real tie is not 0.
      const auto equal = hn::Eq(hn::ShiftRight<32>(a), hn::ShiftRight<32>(b));
      tied = hn::Or(tied, hn::And(equal, hn::Ne(b, hn::Zero(d))));
    }
    for (std::uint64_t left = BitsOf(d, tied); left != 0; left &= left - 1)
      OrderTies(s, group, lane + hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
  }
}

/// Makes room for the lists. Counts of pixels become the beginnings of their lists, in words.
HWY_INLINE void MakeRoom(GatherScratch& s) {
  const DU d;
  std::uint32_t base = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    s.group_base[g] = base;
    VU longest = hn::Zero(d);
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
      std::uint32_t* counts = s.counts.data() + g * kGroup + i;
      longest = hn::Max(longest, hn::Load(d, counts));
      hn::Store(CountFrom(d, std::uint32_t(base * kGroup + i)), d, counts);
    }
    base += hn::GetLane(hn::MaxOfLanes(d, longest));
  }
  s.group_base[kGroups] = base;
  const std::size_t words = std::size_t(base) * kGroup;
  if (s.slots.size() < words) s.slots = Buffer<std::uint64_t>(words + words / 4);
  std::fill_n(s.slots.data(), words, std::uint64_t(0));
}

HWY_INLINE void Place(GatherScratch& s) {
  const std::uint32_t *place = s.arrived.place.data(), *key = s.arrived.key.data(), *begin = s.counts.data();
  auto* slots = reinterpret_cast<char*>(s.slots.data());
  const std::size_t count = s.arrived.count;
  for (std::size_t n = Arrived::first; n < count; ++n) {
    const std::size_t rank = place[n] & kMostOfPixel;
    const std::uint64_t word = std::uint64_t(key[n]) << 32 | ~std::uint32_t(n);
    // The pointer is to bytes, which may alias any other array: otherwise g++ makes a scatter, which takes longer.
    std::memcpy(slots + (begin[place[n] >> kRankBits] + rank * kGroup) * sizeof word, &word, sizeof word);
  }
}

inline void SortLists(GatherScratch& s) {
  MakeRoom(s);
  Place(s);
  for (std::size_t g = 0; g < kGroups; ++g) {
    SortGroup(s.slot(g, 0), s.length(g));
    FindTies(s, g);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
