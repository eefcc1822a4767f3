// SPDX-License-Identifier: Apache-2.0
// What one object covers alone: a bit for every sample of the canvas.
//
//    row y     | word 0: pixels 0 ... 63 | word 1: 64 ... 127 | ...       the lowest bit is the leftmost pixel
//
// A plane is as large as the canvas and is used for one object after another; only what an object touched is looked at
// and cleared again, so that small objects cost little.
#pragma once

#include <span>
#include <vector>

#include "report/accounting/seen_objects.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::accounting_detail {

using zbuffer_detail::BatchColumns;
using zbuffer_detail::TriangleRecord;

/// One sample of every pixel of the canvas. Borrows the words, of which `stride` make a row.
struct MaskPlane {
  std::uint64_t* words;
  std::size_t stride;
  int width, height;   ///< pixels
  std::size_t number;  ///< of the sample
  glm::ivec2 place;    ///< of the sample in its pixel, in 1/256 pixel

  [[nodiscard]] std::uint64_t* row(int y) const { return words + std::size_t(y) * stride; }
};

/// Pixels [begin[i], end[i]) of row first + i; none where end <= begin.
struct RowSpans {
  int first = 0, count = 0;
  std::vector<std::int32_t> begin, end;
};

/// How many samples of a rectangle are marked, and where the outermost ones are; an empty rectangle where none is.
struct MarkedSamples {
  std::uint64_t count = 0;
  PixelRect rect{0, 0, -1, -1};
};

/// Samples by object: of few objects at a time, whose numbers are kept to find them again.
struct SampleCounts {
  std::vector<std::uint32_t> of_object;
  std::vector<std::uint32_t> met;  ///< objects whose count is not 0
};

/// Marks what the first `count` triangles of a batch cover, corners from the canvas' top left.
void mark_triangles(const MaskPlane& plane, const BatchColumns& columns, std::size_t count, Isa isa);
/// What of each row a triangle of any size covers.
void find_spans(const MaskPlane& plane, const TriangleRecord& record, RowSpans& spans, Isa isa);
/// Marks the spans.
void mark_spans(const MaskPlane& plane, const RowSpans& spans, Isa isa);

/// Counts what is marked in a rectangle of the plane.
[[nodiscard]] MarkedSamples count_marked(const MaskPlane& plane, const PixelRect& rect, Isa isa);
/// How many bits two lists of words have in common. Precondition: they are equally long.
[[nodiscard]] std::uint64_t count_common(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b, Isa isa);
/// Adds to the counts of every object how many samples see it that are marked within a part of the picture.
void count_seen(const MaskPlane& plane, const PixelRect& rect, const SeenObjects& seen, SampleCounts& counts, Isa isa);
}  // namespace frontmost::accounting_detail
