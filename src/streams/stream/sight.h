// SPDX-License-Identifier: Apache-2.0
// Gathers what views show of the pieces so far.
//
//   piece --SampleFilter--> triangles that may be seen --ZBuffer--> its Visible --merge--> Visible of all so far
//                                                                                    |
//                                                               triangles that win a sample are kept (Kept)
//
// Every worker has a Drawer, which does the first part. The SightGatherer merges and keeps, under a lock.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "frontmost/streams.h"
#include "frontmost/view.h"
#include "frontmost/zbuffer.h"
#include "stream/kept_triangles.h"
#include "stream/sample_filter.h"
#include "stream/shared.h"

namespace frontmost::streaming {

/// The part of a piece that is drawn: triangles that may cover a sample, renumbered.
struct Selection {
  std::vector<std::uint32_t> numbers;  ///< numbers of the triangles within the piece, ascending
  std::vector<PixelBounds> pixels;     ///< pixels that the triangles may cover, by view
};

/// Facts needed besides the visible samples.
struct SightNeeds {
  bool triangles = false;                            ///< copies of the visible triangles
  bool bounds = false;                               ///< bounds of all triangles
  std::function<void(CornerSpan)> unseen = nullptr;  ///< as in StreamNeeds
};

/// Gathers what the workers draw.
class SightGatherer {
 public:
  SightGatherer(const std::vector<View>& views, const SightNeeds& needs);

  [[nodiscard]] std::size_t sample_count() const { return sample_count_; }
  [[nodiscard]] const SightNeeds& needs() const { return needs_; }
  [[nodiscard]] std::size_t view_count() const { return visible_.size(); }
  [[nodiscard]] const View& view(std::size_t i) const { return visible_[i].view; }

  /// True while nothing is seen in the first view.
  [[nodiscard]] bool is_blank() const { return is_blank_; }
  void include(const Box& bounds);
  /// Merges one piece's answers into the planes: at every sample the greater key wins, at equal keys the lower number
  /// in the stream, as in frontmost::merge(). \returns for each triangle of the selection whether it is visible now.
  std::vector<bool> merge(const std::vector<const Visible*>& piece, const PiecePlace& place,
                          const Selection& selection);
  void keep(Kept kept);
  /// Merges the planes of all ranks after the last piece. `shift` maps ids to those of the whole model.
  void share(Ranks& ranks, const IdShift& shift, const Execution& execution);
  /// Removes kept triangles that later pieces or other ranks hide. If there are ranks, share() must come first.
  void forget_hidden();

  [[nodiscard]] KeptPieces take_kept() { return std::move(kept_); }
  [[nodiscard]] std::vector<Visible> take_visible() { return std::move(visible_); }
  [[nodiscard]] const Box& bounds() const { return bounds_; }

 private:
  std::vector<Visible> visible_;
  std::size_t sample_count_ = 0;
  SightNeeds needs_;
  std::atomic<bool> is_blank_{true};
  std::mutex mutex_;
  KeptPieces kept_;
  std::size_t kept_count_ = 0, limit_;
  Box bounds_;
};

/// Makes surfaces of pieces and draws them, for one worker, in memory that is reused.
class Drawer {
 public:
  /// `frame` has the materials and instances that pieces belong to.
  void draw(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
            const Execution& execution);

 private:
  void draw_selection(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
                      const Execution& execution);
  /// Selects the triangles that may cover a sample of one of the views.
  [[nodiscard]] Selection select(const Mesh& mesh, const SightGatherer& sight);

  Scene scene_;
  std::vector<ZBuffer> buffers_;
  std::vector<SampleFilter> filters_;
  std::vector<std::uint8_t> marks_;  ///< by triangle of the piece
};

}  // namespace frontmost::streaming
