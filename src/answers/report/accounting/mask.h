// SPDX-License-Identifier: Apache-2.0
// The mask of one object alone: a bit for every sample of the canvas.
//
//    row y     | word 0: pixels 0 ... 63 | word 1: 64 ... 127 | ...       the lowest bit is the leftmost pixel
//
// A plane is as large as the canvas and is used for one object after another. Only the part that an object touched is
// read and cleared again, so small objects cost little.
#pragma once

#include <span>
#include <vector>

#include "report/accounting/seen_objects.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::accounting_detail {

using zbuffer_detail::BatchColumns;
using zbuffer_detail::TriangleRecord;

/// The bits of one sample number in all pixels of the canvas. Borrows the words; `stride` words make a row.
struct MaskPlane {
  std::uint64_t* words;
  std::size_t stride;
  int width, height;   ///< pixels
  std::size_t number;  ///< of the sample within its pixel
  glm::ivec2 place;    ///< of the sample within its pixel, in 1/256 pixel

  [[nodiscard]] std::uint64_t* row(int y) const { return words + std::size_t(y) * stride; }
};

/// Pixels [begin[i], end[i]) of row first + i; none where end <= begin.
struct RowSpans {
  int first = 0, count = 0;
  std::vector<std::int32_t> begin, end;
};

/// The number of marked samples in a rectangle, and the smallest rectangle around them; empty if none is marked.
struct MarkedSamples {
  std::uint64_t count = 0;
  PixelRect rect{0, 0, -1, -1};
};

/// Number of samples by object. Few objects at a time are counted, and `met` lists them.
struct SampleCounts {
  std::vector<std::uint32_t> of_object;
  std::vector<std::uint32_t> met;  ///< objects whose count is not 0
};

/// Marks the samples that the first `count` triangles of a batch cover. Corners are relative to the canvas' top left.
void mark_triangles(const MaskPlane& plane, const BatchColumns& columns, std::size_t count, Isa isa);
/// Finds the span of each row that a triangle of any size covers.
void find_spans(const MaskPlane& plane, const TriangleRecord& record, RowSpans& spans, Isa isa);
/// Marks the spans.
void mark_spans(const MaskPlane& plane, const RowSpans& spans, Isa isa);

/// Counts the marked samples in a rectangle of the plane.
[[nodiscard]] MarkedSamples count_marked(const MaskPlane& plane, const PixelRect& rect, Isa isa);
/// Number of bits that two lists of words have in common. Precondition: both have the same length.
[[nodiscard]] std::uint64_t count_common(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b, Isa isa);
/// Adds to the count of every object the samples that see it and are marked, within a part of the picture.
void count_seen(const MaskPlane& plane, const PixelRect& rect, const SeenObjects& seen, SampleCounts& counts, Isa isa);
}  // namespace frontmost::accounting_detail
