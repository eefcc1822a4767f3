// SPDX-License-Identifier: Apache-2.0
// Colours of the fragments of one rectangle of pixels, laid over each other in the order of depth.
//
//    slot 0   ffffffffffffffff      The lists of sixteen neighbouring pixels stand side by side, the nearest fragments
//    slot 1   ff.ffff.ffffff.f      in slot 0. A slot is laid under those before it in all sixteen pixels at once; a
//    slot 2   f..f..f.....f...      pixel whose list has ended takes part with nothing.
//    pixel    0 ........... 15
//
// Where two fragments of a pixel cross within it, their order is not that of the list everywhere: such pixels are taken
// again, with an order for each sub-sample.
#pragma once

#include "abuffer/gather/gather_kernel.h"

namespace frontmost::abuffer_detail {

/// The fragments of one group of pixels while it is composited: of pixel p in slot s at s * 16 + p.
struct GroupFragments {
  Buffer<std::uint32_t> mask_low, mask_high;  ///< all samples where there is no fragment
  Buffer<std::uint32_t> triangle;             ///< number in LocalTriangles
  Buffer<std::uint32_t> number;               ///< in Arrived
  Buffer<float> nearest, farthest, behind;    ///< the range of its keys; the nearest of all behind it
  Buffer<std::int32_t> reach;                 ///< the last slot that one up to this may change places with

  /// Room for lists of so many slots. What was there is lost.
  void reserve(std::size_t slots) {
    const std::size_t wanted = slots * kGroup, size = 2 * wanted;
    if (reach.size() >= wanted) return;
    for (Buffer<std::uint32_t>* b : {&mask_low, &mask_high, &triangle, &number}) *b = Buffer<std::uint32_t>(size);
    for (Buffer<float>* b : {&nearest, &farthest, &behind}) *b = Buffer<float>(size);
    reach = Buffer<std::int32_t>(size);
  }
};

/// What all rectangles of a picture share.
struct CompositeInput {
  const SamplePattern& pattern;
  float opacity;  ///< multiplies every alpha
  Isa isa;
};

/// The pixels of a rectangle, row by row: premultiplied means over the sub-samples. At every sub-sample the order is
/// that of the keys there, the lower id first where they are equal. `fragments` are those of the rectangle; `colors`,
/// linear with straight alpha of 0 to 1, are numbered as in Arrived.
[[nodiscard]] std::vector<glm::vec4> composite_tile(const CompositeInput& input, const Rectangle& pixels,
                                                    const GatherScratch& fragments,
                                                    const std::vector<glm::vec4>& colors);

}  // namespace frontmost::abuffer_detail
