// SPDX-License-Identifier: Apache-2.0
// The objects that a picture shows: as runs of samples, which are compared with masks 64 samples at a time, and as
// sums.
//
//    row y of the canvas    |    word 3    |    word 4    |    word 5    |    64 pixels each
//    sees                        aaaaaaabbb bbbbbbbbbbbbbb bb
//    runs                        a 4-10     b 0-63         b 0-1              a run never leaves its word
//                                b 11-63
#pragma once

#include <span>
#include <vector>

#include "frontmost/report.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::accounting_detail {

using zbuffer_detail::PixelRect;

/// Number of pixels in a word of the canvas.
inline constexpr int kWordPixels = 64;

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
  void append(int x0, int x1, std::uint32_t object);
  void end_row() { close_words(++row_count_ * words_across_); }

 private:
  void close_words(std::size_t count) {
    if (begin_.size() <= count) begin_.resize(count + 1, std::uint32_t(runs_.size()));
  }

  std::size_t words_across_, row_count_ = 0;  // closed rows
  std::vector<std::uint32_t> begin_;          // by row and word, and the end of the last closed one
  std::vector<SeenRun> runs_;
};

/// The samples at the beginning of a row that see the same object.
struct SeenSpan {
  std::size_t end = 0;
  float nearest = 0;  ///< the greatest key
};

/// The number of ids at the beginning that lie in [first, first + count). `keys` has as many elements as `ids`.
[[nodiscard]] SeenSpan find_seen_span(std::span<const PrimitiveId> ids, const float* keys, PrimitiveId first,
                                      std::uint32_t count, Isa isa);

/// The visible samples of one object.
struct SeenTally {
  std::uint32_t object;
  std::uint64_t count = 0;
  PixelRect rect;                      ///< in pixels of the picture
  float nearest = 0;                   ///< the greatest key
  std::uint64_t sum_x = 0, sum_y = 0;  ///< sums of the samples' positions, in 1/256 pixel

  /// Adds another tally of the same object.
  void add(const SeenTally& other);
};

struct SeenObjects {
  static constexpr int rows_in_band = 32;

  glm::ivec2 margin{0};         ///< of the canvas around the picture
  std::vector<SeenRows> bands;  ///< by sample number, then from top to bottom
  std::size_t bands_in_sample = 0;
  std::vector<SeenTally> tallies;  ///< of the objects that are seen, in no order
  std::uint64_t background = 0;    ///< samples that see no object

  /// The runs of a row and a word of the canvas. Preconditions: the row is in the picture, and the word has pixels of
  /// the picture.
  [[nodiscard]] std::span<const SeenRun> in(std::size_t sample, int y, int word) const {
    const int row = y - margin.y;
    return bands[sample * bands_in_sample + std::size_t(row / rows_in_band)].in(
        std::size_t(row % rows_in_band), std::size_t(word - margin.x / kWordPixels));
  }
};

/// Reads a picture. Precondition: check_answer() has passed. O(samples), in parallel.
[[nodiscard]] SeenObjects find_seen_objects(const Surfaces& surfaces, const Visible& visible, const glm::ivec2& margin,
                                            const Execution& execution);

}  // namespace frontmost::accounting_detail
