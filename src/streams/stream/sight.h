// SPDX-License-Identifier: Apache-2.0
// What views show of the pieces so far.
//
//   piece --SampleFilter--> triangles that may be seen --ZBuffer--> its Visible --merge--> Visible of all so far
//                                                                                    |
//                                                               triangles that win a sample are kept (Kept)
//
// The first part is a Drawer's, of which every worker has one; merging and keeping are the SightGatherer's, under a
// lock.
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

/// What of a piece is drawn: the triangles that may hold a sample, renumbered.
struct Selection {
  std::vector<std::uint32_t> numbers;  ///< within the piece, ascending
  std::vector<PixelBounds> pixels;     ///< that they may cover, by view
};

/// What is to be known beside what is visible.
struct SightNeeds {
  bool triangles = false;                            ///< copies of those that are seen
  bool bounds = false;                               ///< of all triangles
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

  /// Nothing is seen in the first view so far.
  [[nodiscard]] bool is_blank() const { return is_blank_; }
  void include(const Box& bounds);
  /// Lays one piece's answers over what was there: at every sample the greater key stays, at equal keys the lower
  /// number in the stream, as by merge(). \returns for each triangle of the selection whether it is seen now.
  std::vector<bool> merge(const std::vector<const Visible*>& piece, const PiecePlace& place,
                          const Selection& selection);
  void keep(Kept kept);
  /// After the last piece: what is seen becomes what all ranks see. `shift` leads to the ids of the whole.
  void share(Ranks& ranks, const IdShift& shift, const Execution& execution);
  /// After that: forgets what was hidden by later ones, or by those of other ranks.
  void finish();

  [[nodiscard]] KeptPieces take_kept() { return std::move(kept_); }
  [[nodiscard]] std::vector<Visible> take_visible() { return std::move(visible_); }
  [[nodiscard]] const Box& bounds() const { return bounds_; }

 private:
  void forget_hidden();

  std::vector<Visible> visible_;
  std::size_t sample_count_ = 0;
  SightNeeds needs_;
  std::atomic<bool> is_blank_{true};
  std::mutex mutex_;
  KeptPieces kept_;
  std::size_t kept_count_ = 0, limit_;
  Box bounds_;
};

/// One worker: makes surfaces of pieces and draws them, in memory that is used again.
class Drawer {
 public:
  /// `frame` is what pieces are put into: materials and the instances.
  void draw(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
            const Execution& execution);

 private:
  void draw_selection(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
                      const Execution& execution);
  /// Those that may hold a sample of one of the views.
  [[nodiscard]] Selection select(const Mesh& mesh, const SightGatherer& sight);

  Scene scene_;
  std::vector<ZBuffer> buffers_;
  std::vector<SampleFilter> filters_;
  std::vector<std::uint8_t> marks_;  ///< of the piece's triangles
};

}  // namespace frontmost::streaming
