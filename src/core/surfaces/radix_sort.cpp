// SPDX-License-Identifier: Apache-2.0
// The least significant digit comes first. Each chunk counts its digits; a prefix sum over (digit, chunk) gives every
// chunk the places of its items, so chunks scatter independently and stably.
//
//             chunk 0   chunk 1                 chunk 0   chunk 1
//   digit 0      2         1                       0         2
//   digit 1      1         3      --sums-->        3         4        place of the first item of each
//   digit 2      0         2                       7         7

#include "surfaces/radix_sort.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace frontmost {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t(1) << kDigitBits;
// A chunk's counts, 8 KiB, stay in the first-level cache while its quarter of a megabyte is read.
constexpr std::size_t kChunk = std::size_t(1) << 15;

/// Some bits of an item.
struct Digit {
  int shift, bits;
  [[nodiscard]] std::size_t of(std::uint64_t item) const {
    return std::size_t(item >> shift) & ((std::size_t(1) << bits) - 1);
  }
};

void sort_by_digit(const Buffer<std::uint64_t>& from, Buffer<std::uint64_t>& to, const Digit& digit,
                   const Execution& execution) {
  const std::size_t chunks = (from.size() + kChunk - 1) / kChunk;
  std::vector<std::uint32_t> places(chunks * kDigits, 0);
  parallel_for(execution, from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* counts = places.data() + begin / kChunk * kDigits;
    for (std::size_t i = begin; i < end; ++i) ++counts[digit.of(from[i])];
  });
  std::uint32_t place = 0;
  // Sums go by digit first and chunk second: equal digits keep the order of the chunks, which makes the sort stable.
  for (std::size_t value = 0; value < kDigits; ++value)
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      std::uint32_t& entry = places[chunk * kDigits + value];
      const std::uint32_t count = entry;
      entry = place;
      place += count;
    }
  parallel_for(execution, from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* next = places.data() + begin / kChunk * kDigits;
    for (std::size_t i = begin; i < end; ++i) to[next[digit.of(from[i])]++] = from[i];
  });
}

}  // namespace

Buffer<std::uint64_t> radix_sort(Buffer<std::uint64_t> items, int key_bits, const Execution& execution) {
  Buffer<std::uint64_t> other(items.size());
  for (int shift = 32; shift < 32 + key_bits; shift += kDigitBits) {
    sort_by_digit(items, other, {shift, std::min(kDigitBits, 32 + key_bits - shift)}, execution);
    items.swap(other);
  }
  return items;
}

}  // namespace frontmost
