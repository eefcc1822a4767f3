// SPDX-License-Identifier: Apache-2.0
// Least significant digit first. Each chunk counts its digits; a prefix sum over (digit, chunk) tells every chunk where
// its items go, so chunks scatter independently and stably.

#include "surfaces/radix_sort.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace frontmost {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t(1) << kDigitBits;
constexpr std::size_t kChunk = std::size_t(1) << 16;

std::size_t digit_of(std::uint64_t item, int shift) { return std::size_t(item >> shift) & (kDigits - 1); }

/// `Item` is what is kept of an item: all of it, or in the last round only its low half.
template <class Item>
void sort_by_digit(const Buffer<std::uint64_t>& from, Buffer<Item>& to, int shift, const Execution& execution) {
  const std::size_t chunks = (from.size() + kChunk - 1) / kChunk;
  std::vector<std::uint32_t> places(chunks * kDigits, 0);
  parallel_for(execution, from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* counts = places.data() + begin / kChunk * kDigits;
    for (std::size_t i = begin; i < end; ++i) ++counts[digit_of(from[i], shift)];
  });
  std::uint32_t place = 0;
  for (std::size_t digit = 0; digit < kDigits; ++digit)
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      std::uint32_t& entry = places[chunk * kDigits + digit];
      const std::uint32_t count = entry;
      entry = place;
      place += count;
    }
  parallel_for(execution, from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* next = places.data() + begin / kChunk * kDigits;
    for (std::size_t i = begin; i < end; ++i) to[next[digit_of(from[i], shift)]++] = Item(from[i]);
  });
}

}  // namespace

Buffer<std::uint32_t> radix_order(Buffer<std::uint64_t> items, int key_bits, const Execution& execution) {
  const int last = 32 + (key_bits - 1) / kDigitBits * kDigitBits;
  if (last > 32) {
    Buffer<std::uint64_t> other(items.size());
    for (int shift = 32; shift < last; shift += kDigitBits) {
      sort_by_digit(items, other, shift, execution);
      items.swap(other);
    }
  }
  Buffer<std::uint32_t> order(items.size());
  sort_by_digit(items, order, last, execution);
  return order;
}

}  // namespace frontmost
