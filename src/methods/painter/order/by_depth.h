// SPDX-License-Identifier: Apache-2.0
// Lists of pieces by depth, the farthest first.
//
// Bits of depths are turned into integers that rise as depths fall, so a radix sort of (depth, piece) needs no
// comparison. Runs of equal depths, which are short in most scenes, are then sorted by id. So the order depends neither
// on the number of threads nor on the order in which the pieces came.
#pragma once

#include <algorithm>
#include <cstring>

#include "painter/pieces.h"
#include "surfaces/radix_sort.h"

namespace frontmost::painter_detail {

/// An integer that rises as depths fall.
[[nodiscard]] inline std::uint32_t falling_key(float depth) {
  depth += 0.0f;  // no -0
  std::uint32_t bits;
  std::memcpy(&bits, &depth, sizeof bits);
  return bits >> 31 ? bits : ~bits & 0x7fffffff;
}

/// Sorts by a depth of each piece, the greatest first; equal depths by id, the greatest first, then by number.
template <class Depth>
void sort_by_depth(const Pieces& pieces, std::vector<std::uint32_t>& members, const Depth& depth,
                   const Execution& execution) {
  constexpr std::size_t few = 2048;  // counting digits does not pay for less
  Buffer<std::uint64_t> items(members.size());
  for (std::size_t i = 0; i < items.size(); ++i)
    items[i] = std::uint64_t(falling_key(depth(members[i]))) << 32 | members[i];
  if (items.size() < few) {
    std::sort(items.begin(), items.end());
  } else {
    items = radix_sort(std::move(items), 32, execution);
  }
  const auto is_before = [&](std::uint64_t a, std::uint64_t b) {
    const PrimitiveId id_a = pieces.face(std::uint32_t(a)).id, id_b = pieces.face(std::uint32_t(b)).id;
    return id_a != id_b ? id_a > id_b : std::uint32_t(a) < std::uint32_t(b);
  };
  for (std::size_t begin = 0, end; begin < items.size(); begin = end) {
    for (end = begin + 1; end < items.size() && items[end] >> 32 == items[begin] >> 32;) ++end;
    if (end > begin + 1) std::sort(items.begin() + begin, items.begin() + end, is_before);
  }
  for (std::size_t i = 0; i < items.size(); ++i) members[i] = std::uint32_t(items[i]);
}

}  // namespace frontmost::painter_detail
