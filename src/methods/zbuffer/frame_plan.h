// SPDX-License-Identifier: Apache-2.0
// The work of one frame, sorted into tiles, and the kernel that draws one tile.
//
//    clusters --cull--> whole ------ order by 32 slices of depth ------> cluster lists --+
//                   +-> apart ------ triangles, clipped: records ------> record lists ---+--> a TileJob for each tile
//
// Both lists of a tile are nearest first, with cutouts behind all solid items. The picture never depends on this order;
// the order makes the hierarchical depth hide later items.
#pragma once

#include <span>
#include <vector>

#include "surfaces/cluster_set.h"
#include "zbuffer/cull.h"
#include "zbuffer/record_lists.h"
#include "zbuffer/tile/tile.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// The input that all tiles of a frame share. Borrows everything.
struct FrameInput : Picture {
  const ClusterSet& set;
  const ScreenTransform& transform;
  const FacingRule& facing;
  const CullResult& culled;
  std::span<const TriangleRecord> records;  ///< vertices from the image's top left
};

/// One tile, and the records and clusters that may be seen in it.
struct TileJob : Tile {
  /// Nearest first.
  struct Items {
    std::span<const std::uint32_t> records, clusters;

    [[nodiscard]] bool is_empty() const { return records.empty() && clusters.empty(); }
  };
  Items solid, cutouts;

  [[nodiscard]] bool is_empty() const { return solid.is_empty() && cutouts.is_empty(); }
};

/// Draws a tile and writes it to the output planes.
void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa);

/// The plan of a frame. Planning the next frame reuses its memory.
class FramePlan {
 public:
  /// Culls clusters, takes some apart, orders and bins the rest. O(clusters + pairs of large triangle and tile) time.
  /// Memory: about 30 bytes a cluster, 64 more if drawn whole, 100 a large or clipped triangle, and the lists of one
  /// round.
  void make(const ClusterSet& set, const PlaceTarget& target, const Execution& execution,
            std::size_t most_record_items = kMostRecordItems);

  [[nodiscard]] const CullResult& culled() const { return culled_; }
  [[nodiscard]] RecordLists& records() { return records_; }

  /// Precondition: `tile` belongs to the round of records listed last.
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;

 private:
  void choose_apart(std::size_t cluster_count);
  void take_apart(const ClusterSet& set, const PlaceTarget& target, const Execution& execution);
  void order_whole(std::size_t cluster_count);
  void list_clusters(const View& view);

  CullResult culled_;
  std::int64_t frames_by_facing_ = 0;  // frames of last_set_ that leave front or back faces out
  std::weak_ptr<const void> last_set_;
  std::vector<std::uint32_t> apart_;                      // clusters to be taken apart
  std::vector<std::vector<TriangleRecord>> apart_parts_;  // records of each chunk of apart_
  RecordLists records_;
  std::size_t first_cutout_ = 0;      // first of the set's clusters that has holes
  std::vector<std::uint32_t> order_;  // clusters drawn whole, cutouts behind all others, nearer slices first
  TileLists cluster_lists_;
};

}  // namespace frontmost::zbuffer_detail
