// SPDX-License-Identifier: Apache-2.0
// What is drawn where: the work of one frame, sorted into tiles.
#pragma once

#include <vector>

#include "zbuffer/cull.h"
#include "zbuffer/record_lists.h"
#include "zbuffer/tile/tile_kernel.h"

namespace frontmost::zbuffer_detail {

/// The plan of a frame. Planning the next one reuses its memory.
class FramePlan {
 public:
  /// Culls, takes apart what must be, orders and bins. O(clusters + pairs of large triangle and tile) time. Memory:
  /// about 30 bytes a cluster and 64 for one drawn whole, 100 a large or clipped triangle, and the lists of one round.
  void make(const ClusterSet& set, const ScreenTransform& transform, const View& view, const Execution& execution,
            std::size_t most_record_items = kMostRecordItems);

  [[nodiscard]] const CullResult& culled() const { return culled_; }
  [[nodiscard]] RecordLists& records() { return records_; }

  /// Precondition: `tile` is of the round of records listed last.
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;

 private:
  void choose_apart(std::size_t cluster_count);
  void take_apart(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                  const Execution& execution);
  void order_whole(std::size_t cluster_count);
  void list_clusters(const View& view);

  CullResult culled_;
  std::vector<std::uint32_t> apart_;                      // clusters to be taken apart
  std::vector<std::vector<TriangleRecord>> apart_parts_;  // what threads made of them
  RecordLists records_;
  std::vector<std::uint32_t> order_;  // clusters drawn whole, nearer slices first
  TileLists cluster_lists_;
};

}  // namespace frontmost::zbuffer_detail
