// SPDX-License-Identifier: Apache-2.0
// Items in buckets, by a counting sort over bands of sources.
//
//    sources      | band 0     | band 1     | band 2     |      each band counts its items for every bucket
//    counters     band 0: b0 b1 b2 ...   band 1: b0 b1 b2 ...   sums over bands say where the items of each band go
//
// Bands fill the buckets at the same time and without locks. A bucket holds its items in the order of their sources,
// whatever the number of bands.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace frontmost {

template <class Item>
class Buckets {
 public:
  Buckets() = default;
  /// Calls `list(source, add)` twice for each of `sources`; it calls add(bucket, item) for each item of the source,
  /// both times the same. O(sources + items + buckets * threads), in parallel.
  /// \throws Error limit_exceeded for 2^32 items and more. Precondition: no bucket gets 2^32 items from one band.
  template <class List>
  Buckets(std::size_t buckets, std::size_t sources, const List& list, const Execution& execution)
      : first_(buckets + 1) {
    const std::size_t bands = std::clamp<std::size_t>(sources / kLeastOfBand, 1, most_bands(execution));
    std::vector<std::vector<std::uint32_t>> next(bands);
    const auto for_bands = [&](const auto& visit) {
      parallel_for(execution, bands, 1, [&](std::size_t band, std::size_t) {
        const std::size_t end = sources * (band + 1) / bands;
        for (std::size_t source = sources * band / bands; source < end; ++source) {
          if (source % kSourcesBetweenPolls == 0) check_cancelled(execution);
          list(source, [&](std::size_t bucket, const Item& item) { visit(next[band], bucket, item); });
        }
      });
    };
    parallel_for(execution, bands, 1, [&](std::size_t band, std::size_t) { next[band].assign(buckets, 0); });
    for_bands([](std::vector<std::uint32_t>& counts, std::size_t bucket, const Item&) { ++counts[bucket]; });
    std::uint64_t count = 0;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
      first_[bucket] = std::uint32_t(count);
      for (std::vector<std::uint32_t>& places : next) count += std::exchange(places[bucket], std::uint32_t(count));
    }
    if (count > 0xFFFFFFFFu) throw Error(ErrorCode::limit_exceeded, "sorting", "more than 4294967295 items");
    first_[buckets] = std::uint32_t(count);
    items_ = Buffer<Item>(count);
    for_bands([&](std::vector<std::uint32_t>& places, std::size_t bucket, const Item& item) {
      items_[places[bucket]++] = item;
    });
  }

  [[nodiscard]] std::size_t count() const { return first_.empty() ? 0 : first_.size() - 1; }
  [[nodiscard]] std::size_t byte_count() const {
    return first_.size() * sizeof(first_[0]) + items_.size() * sizeof(Item);
  }
  [[nodiscard]] std::span<const Item> operator[](std::size_t bucket) const { return in(bucket, bucket + 1); }
  /// The items of buckets [begin, end), one bucket after another.
  [[nodiscard]] std::span<const Item> in(std::size_t begin, std::size_t end) const {
    return {items_.data() + first_[begin], first_[end] - first_[begin]};
  }
  /// The items of a bucket, which may be reordered or changed.
  [[nodiscard]] std::span<Item> operator[](std::size_t bucket) {
    return {items_.data() + first_[bucket], first_[bucket + 1] - first_[bucket]};
  }

 private:
  static constexpr std::size_t kLeastOfBand = 4096, kSourcesBetweenPolls = std::size_t(1) << 18;
  /// A band takes four bytes a bucket.
  static std::size_t most_bands(const Execution& execution) {
    return std::min<std::size_t>(std::size_t(thread_count(execution)), 8);
  }

  Buffer<std::uint32_t> first_;  ///< index of each bucket's first item; then the number of all items
  Buffer<Item> items_;
};

}  // namespace frontmost
