// SPDX-License-Identifier: Apache-2.0
// The samples that an object covers if it is drawn alone, and the objects that a picture shows there.
//
//    row y     | word 0: pixels 0 ... 63 | word 1: 64 ... 127 | ...       the lowest bit is the leftmost pixel
//    mask          1111111111111111111      111111                        a bit for each sample of the canvas
//    runs          aaaaaaabbbbbbbbbb        bb                            of samples that see the same object; a run
//                                                                         never leaves its word
//
// The planes of a mask are as large as the canvas and are used for one object after another. Only the part that an
// object touched is read and cleared again, so small objects cost little.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "frontmost/report.h"
#include "surfaces/placed_scene.h"
#include "view/screen_cutout.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::accounting_detail {

using zbuffer_detail::BatchColumns;
using zbuffer_detail::PixelRect;
using zbuffer_detail::TriangleRecord;

/// Number of pixels in a word of the canvas.
inline constexpr int kWordPixels = 64;

/// A rectangle without pixels, the neutral element of around().
inline constexpr PixelRect kNoPixels{1 << 30, 1 << 30, -1, -1};
/// The smallest rectangle around two others.
[[nodiscard]] inline PixelRect around(const PixelRect& a, const PixelRect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

/// Pixels [first, last] of a word that see the same object.
struct SeenRun {
  std::uint32_t object;  ///< no_index: no object
  std::uint8_t first, last;

  [[nodiscard]] std::uint64_t bits() const { return ~std::uint64_t(0) >> (63 - (last - first)) << first; }
};

/// Runs of some rows of the picture, for one sample number.
class SeenRows {
 public:
  /// The runs of a row and a word. Words are counted from the first one that has pixels of the picture.
  [[nodiscard]] std::span<const SeenRun> in(std::size_t row, std::size_t word) const {
    const std::size_t at = row * words_across_ + word;
    return std::span(runs_).subspan(begin_[at], begin_[at + 1] - begin_[at]);
  }

  // Building: from left to right, row by row.

  explicit SeenRows(std::size_t words_across) : words_across_(words_across), begin_{0} {}
  /// Appends pixels [x0, x1), counted from the first pixel of the first word, that see an object, or none.
  void append(int x0, int x1, std::uint32_t object) {
    while (x0 < x1) {
      const int word = x0 / kWordPixels, end = std::min(x1, (word + 1) * kWordPixels);
      runs_.push_back({object, std::uint8_t(x0 % kWordPixels), std::uint8_t(end - 1 - word * kWordPixels)});
      if (end == (word + 1) * kWordPixels) close_words(row_count_ * words_across_ + std::size_t(word) + 1);
      x0 = end;
    }
  }
  void end_row() { close_words(++row_count_ * words_across_); }

 private:
  void close_words(std::size_t count) {
    if (begin_.size() <= count) begin_.resize(count + 1, std::uint32_t(runs_.size()));
  }

  std::size_t words_across_, row_count_ = 0;  // complete rows
  std::vector<std::uint32_t> begin_;          // index of the first run, by row and word; then the number of runs
  std::vector<SeenRun> runs_;
};

/// The objects that a picture shows.
struct SeenObjects {
  static constexpr int rows_in_band = 32;

  glm::ivec2 margin{0};         ///< pixels of the canvas around the picture
  std::vector<SeenRows> bands;  ///< by sample number, then from top to bottom
  std::size_t bands_in_sample = 0;

  /// The runs of a row and a word of the canvas. Preconditions: the row is in the picture, and the word has pixels of
  /// the picture.
  [[nodiscard]] std::span<const SeenRun> in(std::size_t sample, int y, int word) const {
    const int row = y - margin.y;
    return bands[sample * bands_in_sample + std::size_t(row / rows_in_band)].in(
        std::size_t(row % rows_in_band), std::size_t(word - margin.x / kWordPixels));
  }
};

/// The number of samples at the beginning of a row that see the same object, and the nearest of their keys.
struct SeenSpan {
  std::size_t end = 0;
  float nearest = 0;  ///< the greatest of their keys
};

/// Finds how many ids at the beginning lie in [first, first + count). `keys` has as many elements as `ids`.
[[nodiscard]] SeenSpan find_seen_span(std::span<const PrimitiveId> ids, const float* keys, PrimitiveId first,
                                      std::uint32_t count, Isa isa);

/// The bits of one sample number in all pixels of the canvas. Borrows the words; `stride` words make a row.
struct MaskPlane {
  std::uint64_t* words;
  std::size_t stride;
  int width, height;   ///< pixels
  std::size_t number;  ///< number of the sample within its pixel
  glm::ivec2 place;    ///< position of the sample within its pixel, in 1/256 pixel

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
/// Adds to the count of each object the number of marked samples that see the object, in a rectangle of the picture.
void count_seen(const MaskPlane& plane, const PixelRect& rect, const SeenObjects& seen, SampleCounts& counts, Isa isa);

/// The picture and its surroundings. Vertices have the picture's positions, to the bit, shifted by the margin.
struct ObjectCanvas {
  glm::ivec2 margin;          ///< pixels to the left of the picture and above it; negative for a part of the picture
  PixelRect frame;            ///< the picture, or the part of it, on the canvas
  View view;                  ///< only its size, samples and culling are the canvas'
  ScreenTransform transform;  ///< relative to the canvas' top left corner
  ScreenRays rays;            ///< rays of the picture, relative to its top left corner

  /// `scale`: AccountingOptions::canvas. Preconditions: the view is valid, and the scale in range.
  ObjectCanvas(const View& picture, double scale);
  /// A canvas of a part of the picture. Preconditions: the view is valid; the part is not empty and lies within the
  /// picture.
  ObjectCanvas(const View& picture, const PixelRect& part);
};

/// The ranges of an object's triangles.
[[nodiscard]] std::span<const MeshRange> ranges_of(const PlacedScene& scene, std::uint32_t object);

/// Places the triangles of one range after another as the z-buffer does. For one thread; borrows the scene and the
/// canvas.
class RecordPlacer {
 public:
  RecordPlacer(const PlacedScene& scene, const ObjectCanvas& canvas, Isa isa)
      : scene_(scene), target_(canvas.transform, canvas.view, scene.sides.get(), isa) {}

  /// Calls visit(record) for the triangles on the canvas, and for the parts of clipped ones.
  template <class Visit>
  void visit(const MeshRange& range, const Visit& visit) {
    const WorldTriangles triangles = world_triangles(scene_, range, target_.isa, scratch_);
    snap_vertices(target_, triangles.positions, scratch_.vertices);
    scratch_.apart.clear();
    batch_.clear();
    place_triangles(target_, triangles, scratch_.vertices, batch_, scratch_.apart);
    for (std::size_t i = 0; i < batch_.count; ++i) visit(batch_.record(i));
    records_.clear();
    for (const std::uint32_t i : scratch_.apart)
      append_polygon(target_, polygon_of(target_, triangles, scratch_.vertices, i), triangles.first_id + i, records_);
    for (const TriangleRecord& record : records_) visit(record);
  }

 private:
  const PlacedScene& scene_;
  zbuffer_detail::PlaceTarget target_;
  zbuffer_detail::PlaceScratch scratch_;
  zbuffer_detail::TriangleBatch batch_;
  std::vector<TriangleRecord> records_;
};

/// Draws the mask of one object after another. For one thread; borrows everything.
class ObjectMask {
 public:
  ObjectMask(const PlacedScene& scene, const ObjectCanvas& canvas, Isa isa);

  /// Marks the samples that an object covers. The mask of the previous object is lost.
  void draw(std::uint32_t object);

  /// One plane for each sample number.
  [[nodiscard]] std::span<const MaskPlane> planes() const { return planes_; }
  /// A rectangle around all marked samples; empty if none is marked.
  [[nodiscard]] const PixelRect& touched() const { return touched_; }
  /// Whether a triangle reaches across the near plane.
  [[nodiscard]] bool is_cut_by_near() const { return is_cut_by_near_; }

 private:
  void clear();
  /// Whether consecutive triangles have vertices from all over the mesh. All vertices are then placed at once.
  [[nodiscard]] bool is_strewn(std::span<const MeshRange> ranges) const;
  void draw_at_once(std::span<const MeshRange> ranges);
  /// Precondition: the scratch holds the vertices of these triangles.
  void draw_triangles(const WorldTriangles& triangles);
  void draw_small();
  void draw_large(const TriangleRecord& record);
  void draw_cutout(const TriangleRecord& record);

  const PlacedScene& scene_;
  const ObjectCanvas& canvas_;
  zbuffer_detail::PlaceTarget target_;
  Buffer<std::uint64_t> words_;
  std::vector<MaskPlane> planes_;
  zbuffer_detail::TriangleBatch batch_, cutout_batch_;
  zbuffer_detail::PlaceScratch scratch_;
  std::vector<TriangleRecord> large_, cutouts_;
  RowSpans spans_;
  PixelRect touched_;
  bool is_cut_by_near_ = false;
};

/// Pairs of an object and its hider, ordered by object, then by hider, each pair once.
struct HiderLists {
  std::vector<HiddenSamples> any;   ///< samples that the hider covers in front of the object
  std::vector<HiddenSamples> only;  ///< samples that only this hider hides: they appear when it is removed
};

/// Finds all hiding pairs of objects. `canvas` has no margin; `objects[i].in_frame` is the set of samples that object i
/// covers in the picture. O(bands * triangles in them + covered samples + pairs of objects in a column).
[[nodiscard]] HiderLists find_all_hiders(const PlacedScene& scene, const ObjectCanvas& canvas,
                                         std::span<const ObjectAccount> objects, const Execution& execution);

}  // namespace frontmost::accounting_detail
