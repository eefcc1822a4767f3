// SPDX-License-Identifier: Apache-2.0
// A stable parallel radix sort, for orders of clusters, grids and painting that are made anew for every scene or view.
//
// An item is its key and its payload in one word, so that sorting moves 8 bytes and needs no comparison:
//
//   bit  63                32 31                 0
//        | anything | key   | anything           |
#pragma once

#include <cstdint>

#include "frontmost/base.h"

namespace frontmost {

/// Sorts by the bits [32, 32 + key_bits) of each item; items of equal keys keep their order. Precondition: 0 < key_bits
/// <= 32. O(count) with one more buffer of the same size. The result is the same for any number of threads.
[[nodiscard]] Buffer<std::uint64_t> radix_sort(Buffer<std::uint64_t> items, int key_bits, const Execution& execution);

}  // namespace frontmost
