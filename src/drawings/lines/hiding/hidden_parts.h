// SPDX-License-Identifier: Apache-2.0
// Where an edge goes out of sight, found edge by edge: each is held against the occluders in the cells that it passes,
// and cut where what hides it begins and ends. Cutters have memory that they keep from edge to edge, so each thread has
// one.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/hiding/hidden_intervals.h"
#include "lines/hiding/occluder_grid.h"
#include "lines/hiding/shadow_kernel.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

/// What edges are held against.
struct EdgeOccluders {
  const WeldedMesh& mesh;
  const Sight& sight;
  const View& view;
  const OccluderGrid& grid;
  const ShadowKernels kernels;
  const bool counts;    ///< LineOptions::counts_hidden
  const bool outlines;  ///< LineOptions::outlines
};

/// What has been found of an edge, and what is asked next.
struct EdgeSearch {
  HiddenIntervals hidden;
  OccluderBatch batch;  ///< those that are still to be held against the edge
  /// By the low bits of occluders' addresses: which were asked last, so that the next cell need not.
  std::array<const Occluder*, 64> asked{};
  std::vector<std::pair<double, int>> changes;  ///< where one more or one less hides
  std::uint64_t boxes = 0;                      ///< how many boxes of occluders were looked at, in all edges
  std::uint64_t batches = 0;                    ///< how many batches of occluders were held against edges
};

/// Cuts one edge after another. Not for several threads at once.
class EdgeCutter {
 public:
  explicit EdgeCutter(const EdgeOccluders& occlusion) : o_(occlusion) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view. Its distances need not be set.
  void cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

  /// How many boxes of occluders all edges so far were held against: what the time goes with.
  [[nodiscard]] std::uint64_t boxes_asked() const { return search_.boxes; }
  /// The work since the last call, in boxes that were looked at. A batch that was held against an edge takes as long as
  /// 256 of them.
  [[nodiscard]] std::uint64_t take_work() {
    const std::uint64_t work = search_.boxes + 256 * search_.batches;
    return work - std::exchange(told_, work);
  }

 private:
  const EdgeOccluders o_;
  EdgeSearch search_;  ///< kept for its memory
  std::uint64_t told_ = 0;
};

}  // namespace frontmost::lines_detail
