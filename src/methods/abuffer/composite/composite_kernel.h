// SPDX-License-Identifier: Apache-2.0
// Composites the colours of the fragments of one rectangle of pixels in the order of depth.
//
//    slot 0   ffffffffffffffff      The lists of sixteen neighbouring pixels stand side by side, the nearest fragments
//    slot 1   ff.ffff.ffffff.f      in slot 0. A slot is composited under the slots before it in all sixteen pixels at
//    slot 2   f..f..f.....f...      once. A pixel whose list has ended contributes nothing.
//    pixel    0 ........... 15
//
// If two fragments of a pixel cross within it, their order differs from that of the list in places. Such pixels are
// composited again, with an order for each sub-sample.
#pragma once

#include "abuffer/gather/gather_kernel.h"

namespace frontmost::abuffer_detail {

/// The fragments of one group of pixels while it is composited; pixel p in slot s has the index s * 16 + p.
struct GroupFragments {
  Buffer<std::uint32_t> mask_low, mask_high;  ///< all samples if there is no fragment
  Buffer<std::uint32_t> triangle;             ///< number in LocalTriangles
  Buffer<std::uint32_t> number;               ///< in Arrived
  Buffer<float> nearest, farthest, behind;    ///< nearest and farthest key of the fragment; nearest key of all
                                              ///< fragments behind
  Buffer<std::int32_t> reach;                 ///< the fragment's slot, or the last slot beyond the run so far that it
                                              ///< may change places with

  /// Makes room for lists of so many slots. Loses the contents.
  void reserve(std::size_t slots) {
    const std::size_t wanted = slots * kGroup, size = 2 * wanted;
    if (reach.size() >= wanted) return;
    for (Buffer<std::uint32_t>* b : {&mask_low, &mask_high, &triangle, &number}) *b = Buffer<std::uint32_t>(size);
    for (Buffer<float>* b : {&nearest, &farthest, &behind}) *b = Buffer<float>(size);
    reach = Buffer<std::int32_t>(size);
  }
};

/// The input that all rectangles of a picture share.
struct CompositeInput {
  const SamplePattern& pattern;
  float opacity;  ///< multiplies every alpha
  Isa isa;
};

/// Returns the pixels of a rectangle, row by row: premultiplied means over the sub-samples. At every sub-sample
/// fragments are in the order of their keys there, the lower id first if keys are equal. `fragments` holds the
/// fragments of the rectangle. `colors` are linear with straight alpha of 0 to 1, and are indexed by the numbers in
/// Arrived.
[[nodiscard]] std::vector<glm::vec4> composite_tile(const CompositeInput& input, const Rectangle& pixels,
                                                    const GatherScratch& fragments,
                                                    const std::vector<glm::vec4>& colors);

}  // namespace frontmost::abuffer_detail
