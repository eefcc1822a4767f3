// SPDX-License-Identifier: Apache-2.0
// What views show of the pieces so far.
#pragma once

#include <mutex>
#include <vector>

#include "frontmost/visible.h"
#include "frontmost/zbuffer.h"
#include "stream/kept_triangles.h"

namespace frontmost::streaming {

/// Gathers what the workers draw.
class Sight {
 public:
  /// Copies of the triangles that are seen are kept, unless nobody will look at them.
  explicit Sight(const std::vector<View>& views, bool keeps_triangles = true);

  [[nodiscard]] std::size_t sample_count() const { return sample_count_; }
  [[nodiscard]] std::size_t view_count() const { return visible_.size(); }
  [[nodiscard]] const View& view(std::size_t i) const { return visible_[i].view; }

  /// Lays one piece's answers over what was there. \returns for each of its triangles whether it is seen now; empty
  /// where nothing is kept.
  std::vector<bool> merge(const std::vector<const Visible*>& piece, const Place& place, std::size_t triangle_count,
                          const Box& bounds);
  void keep(Kept kept);
  /// After the last piece: forgets what was hidden by later ones.
  void finish();

  [[nodiscard]] KeptPieces take_kept() { return std::move(kept_); }
  [[nodiscard]] std::vector<Visible> take_visible() { return std::move(visible_); }
  [[nodiscard]] const Box& bounds() const { return bounds_; }

 private:
  void forget_hidden();

  std::vector<Visible> visible_;
  std::size_t sample_count_ = 0;
  bool keeps_triangles_;
  std::mutex mutex_;
  KeptPieces kept_;
  std::size_t kept_count_ = 0, limit_;
  Box bounds_;
};

/// One worker: makes surfaces of pieces and draws them, in memory that is used again.
class Drawer {
 public:
  /// `frame` is what pieces are put into: materials and the instances.
  void draw(Piece& piece, const Place& place, const Scene& frame, Sight& sight, const Execution& execution);

 private:
  Scene scene_;
  std::vector<ZBuffer> buffers_;
};

}  // namespace frontmost::streaming
