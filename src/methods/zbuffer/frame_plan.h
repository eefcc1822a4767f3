// SPDX-License-Identifier: Apache-2.0
// What is drawn where: the work of one frame, sorted into tiles, and the kernel that draws one of them.
//
//    clusters --cull--> whole ------ order by 32 slices of depth ------> cluster lists --+
//                   +-> apart ------ triangles, clipped: records ------> record lists ---+--> a TileJob for each tile
//
// Both lists of a tile are nearest first, and what has holes stands behind all else. That is never needed for the
// picture; it makes the hierarchical depth hide what comes later.
#pragma once

#include <span>
#include <vector>

#include "surfaces/cluster_set.h"
#include "zbuffer/cull.h"
#include "zbuffer/record_lists.h"
#include "zbuffer/tile/tile.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// What all tiles of a frame have in common. Borrows everything.
struct FrameInput : Picture {
  const ClusterSet& set;
  const ScreenTransform& transform;
  const FacingRule& facing;
  const CullResult& culled;
  std::span<const TriangleRecord> records;  ///< corners from the image's top left
};

/// One tile, and what may be seen in it.
struct TileJob : Tile {
  /// Near things first.
  struct Items {
    std::span<const std::uint32_t> records, clusters;

    [[nodiscard]] bool is_empty() const { return records.empty() && clusters.empty(); }
  };
  Items solid, cutouts;

  [[nodiscard]] bool is_empty() const { return solid.is_empty() && cutouts.is_empty(); }
};

/// Draws a tile and writes it to the output planes.
void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa);

/// The plan of a frame. Planning the next one reuses its memory.
class FramePlan {
 public:
  /// Culls, takes apart what must be, orders and bins. O(clusters + pairs of large triangle and tile) time. Memory:
  /// about 30 bytes a cluster and 64 for one drawn whole, 100 a large or clipped triangle, and the lists of one round.
  void make(const ClusterSet& set, const PlaceTarget& target, const Execution& execution,
            std::size_t most_record_items = kMostRecordItems);

  [[nodiscard]] const CullResult& culled() const { return culled_; }
  [[nodiscard]] RecordLists& records() { return records_; }

  /// Precondition: `tile` is of the round of records listed last.
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;

 private:
  void choose_apart(std::size_t cluster_count);
  void take_apart(const ClusterSet& set, const PlaceTarget& target, const Execution& execution);
  void order_whole(std::size_t cluster_count);
  void list_clusters(const View& view);

  CullResult culled_;
  std::vector<std::uint32_t> apart_;                      // clusters to be taken apart
  std::vector<std::vector<TriangleRecord>> apart_parts_;  // what threads made of them
  RecordLists records_;
  std::size_t first_cutout_ = 0;      // of the set's clusters
  std::vector<std::uint32_t> order_;  // clusters drawn whole, cutouts behind all others, nearer slices first
  TileLists cluster_lists_;
};

}  // namespace frontmost::zbuffer_detail
