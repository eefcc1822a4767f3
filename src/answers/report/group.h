// SPDX-License-Identifier: Apache-2.0
// Groups equal items: edges by their vertices, and duplicate triangles.
//
// Items are distributed to buckets by a hash of their key; within a bucket, in the cache, once more by other bits of
// the hash; the groups of about four items that result are sorted. The hash only spreads the work: if keys were chosen
// to collide, all items would be in one group and would still be sorted, where a hash table would become quadratic.
#pragma once

#include <algorithm>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace frontmost {

/// A key of 96 bits with 32 carried bits. Ordered by key, then by the carried bits.
struct Keyed {
  std::uint64_t high;  ///< upper 64 bits of the key
  std::uint64_t low;   ///< lower 32 bits of the key, 32 carried bits

  Keyed() = default;
  Keyed(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t carried)
      : high(std::uint64_t(a) << 32 | b), low(std::uint64_t(c) << 32 | carried) {}
  [[nodiscard]] std::uint32_t carried() const { return std::uint32_t(low); }
  [[nodiscard]] bool same_key(const Keyed& other) const { return high == other.high && (low ^ other.low) >> 32 == 0; }
  friend bool operator<(const Keyed& a, const Keyed& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }
};

namespace detail {

inline constexpr std::size_t max_buckets = 1024;

struct Dealt {
  std::vector<std::size_t> starts;  // beginning of each bucket, and the end of the last
  Buffer<Keyed> items;
};

/// A hash of 24 bits: 10 of them choose the bucket, the others the place in the bucket.
[[nodiscard]] inline std::uint32_t hash_of(const Keyed& item) {
  std::uint64_t mixed = (item.high ^ (item.low >> 32) * 0x9E3779B97F4A7C15u) * 0xD6E8FEB86659FD93u;
  mixed ^= mixed >> 32;
  return std::uint32_t((mixed * 0xD6E8FEB86659FD93u) >> 40);
}

[[nodiscard]] inline std::size_t bucket_of(const Keyed& item, std::size_t bucket_count) {
  return hash_of(item) & (bucket_count - 1);
}

/// A bucket's items in order, equal keys side by side. Sorting alone would take most of the time of grouping, because
/// its branches cannot be predicted.
[[nodiscard]] inline Buffer<Keyed> gathered(std::span<const Keyed> items) {
  constexpr std::size_t together = 4, most_places = std::size_t(1) << 14;
  std::size_t places = 1;
  while (places < most_places && places * together < items.size()) places *= 2;
  const auto place_of = [&](const Keyed& item) { return hash_of(item) / max_buckets & (places - 1); };
  std::vector<std::uint32_t> ends(places, 0);  // beginnings, until the items are filled in
  for (const Keyed& item : items) ++ends[place_of(item)];
  std::uint32_t total = 0;
  for (std::uint32_t& end : ends) total += std::exchange(end, total);
  Buffer<Keyed> sorted(items.size());
  for (const Keyed& item : items) sorted[ends[place_of(item)]++] = item;
  Keyed* begin = sorted.begin();
  for (const std::uint32_t end : ends) {
    std::sort(begin, sorted.begin() + end);
    begin = sorted.begin() + end;
  }
  return sorted;
}

// A counting sort by bucket: every chunk of items is counted, which tells each chunk where its items go.
template <class Produce>
Dealt deal(const Execution& execution, std::size_t count, const Produce& produce) {
  std::size_t buckets = 1;
  while (buckets < max_buckets && count / buckets > 2048) buckets *= 2;
  const std::size_t grain = std::max<std::size_t>(1 << 15, count / 64 + 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  std::vector<std::size_t> places(chunks * buckets, 0);
  parallel_for(execution, count, grain, [&](std::size_t begin, std::size_t end) {
    Keyed item;
    std::size_t* const counts = &places[begin / grain * buckets];
    for (std::size_t i = begin; i < end; ++i)
      if (produce(i, item)) ++counts[bucket_of(item, buckets)];
  });
  Dealt dealt;
  dealt.starts.reserve(buckets + 1);
  std::size_t total = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    dealt.starts.push_back(total);
    for (std::size_t c = 0; c < chunks; ++c) total += std::exchange(places[c * buckets + b], total);
  }
  dealt.starts.push_back(total);
  dealt.items = Buffer<Keyed>(total);
  parallel_for(execution, count, grain, [&](std::size_t begin, std::size_t end) {
    Keyed item;
    std::size_t* const next = &places[begin / grain * buckets];
    for (std::size_t i = begin; i < end; ++i)
      if (produce(i, item)) dealt.items[next[bucket_of(item, buckets)]++] = item;
  });
  return dealt;
}

}  // namespace detail

/// Calls `visit(group, sums)` once for every group of items with the same key, carried numbers ascending, from several
/// threads and in any order. `produce(i, item)` makes the item of each i < count, or returns false for none; it is
/// called twice. \returns all `sums` (default-constructed, any number of them) added by `+=`.
template <class Sums, class Produce, class Visit>
Sums for_each_group(const Execution& execution, std::size_t count, const Produce& produce, const Visit& visit) {
  detail::Dealt dealt = detail::deal(execution, count, produce);
  Sums all{};
  std::mutex mutex;
  parallel_for(execution, dealt.starts.size() - 1, 1, [&](std::size_t bucket, std::size_t) {
    const std::size_t start = dealt.starts[bucket];
    const Buffer<Keyed> items = detail::gathered({dealt.items.data() + start, dealt.starts[bucket + 1] - start});
    const Keyed* const end = items.end();
    Sums sums{};
    for (const Keyed* first = items.begin(); first != end;) {
      const Keyed* last = first + 1;
      while (last != end && last->same_key(*first)) ++last;
      visit(std::span<const Keyed>(first, last), sums);
      first = last;
    }
    const std::lock_guard lock(mutex);
    all += sums;
  });
  return all;
}

}  // namespace frontmost
