// SPDX-License-Identifier: Apache-2.0
// Where an edge is hidden. Each edge is compared with the occluders in the cells that it passes, and cut where the
// hidden stretches begin and end. A cutter reuses its memory from edge to edge, so each thread has its own.
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

/// The scene with which edges are compared.
struct EdgeOccluders {
  const WeldedMesh& mesh;
  const Sight& sight;
  const View& view;
  const OccluderGrid& grid;
  const ShadowKernels kernels;
  const bool counts;    ///< LineOptions::counts_hidden
  const bool outlines;  ///< LineOptions::outlines
};

/// The findings about an edge, and the occluders that are to be compared next.
struct EdgeSearch {
  HiddenIntervals hidden;
  OccluderBatch batch;  ///< occluders that are still to be compared with the edge
  /// The occluders that were asked last, by the low bits of their addresses, so that the next cell can skip them.
  std::array<const Occluder*, 64> asked{};
  std::vector<std::pair<double, int>> changes;  ///< places where one more or one less triangle hides the edge
  std::uint64_t boxes = 0;                      ///< number of occluder boxes that were tested, over all edges
  std::uint64_t batches = 0;                    ///< number of batches of occluders that were compared with edges
};

/// Cuts one edge after another. Not for several threads at once.
class EdgeCutter {
 public:
  explicit EdgeCutter(const EdgeOccluders& occlusion) : o_(occlusion) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view. Its distances need not be set.
  void cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

  /// The work since the last call, in tested boxes. A batch that is compared with an edge counts as 256 boxes.
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
