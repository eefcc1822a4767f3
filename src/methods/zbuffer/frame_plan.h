// SPDX-License-Identifier: Apache-2.0
// The work of one frame, sorted into tiles, and the kernel that draws one tile.
//
//    clusters --cull--> whole ------ order by 32 slices of depth ------> cluster lists --+
//                   +-> apart ------ triangles, clipped: records ------> record lists ---+--> a TileJob for each tile
//
// In both lists of a tile the nearest item comes first, and cutouts come after all solid items. The picture never
// depends on this order; the order makes the hierarchical depth hide later items.
#pragma once

#include <span>
#include <vector>

#include "surfaces/cluster_set.h"
#include "view/screen_transform.h"
#include "zbuffer/tile/tile.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// A cluster is culled if all eight corners of its box lie outside one side of the frustum, or if its cone of normals
/// shows that every triangle faces away. It is kept if rounding leaves either test undecided.
enum class ClusterFate : std::uint8_t {
  culled,  ///< no sample can see it
  whole,   ///< every vertex can be snapped as it is
  apart,   ///< drawn as single triangles: some may need clipping, or the cluster is on many tiles
};

/// Columns with one entry a cluster, padded to whole vectors. `rect` and `nearest` are valid if the fate is `whole`.
struct CullResult {
  std::vector<std::uint8_t> fate;  ///< ClusterFate
  std::vector<std::int32_t> x0, y0, x1, y1;
  std::vector<float> nearest;  ///< upper bound of the cluster's keys

  void resize(std::size_t cluster_count) {
    const std::size_t padded = (cluster_count + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
    fate.resize(padded);
    for (auto* side : {&x0, &y0, &x1, &y1}) side->resize(padded);
    nearest.resize(padded);
  }
  [[nodiscard]] ClusterFate fate_of(std::size_t i) const { return ClusterFate(fate[i]); }
  [[nodiscard]] PixelRect rect(std::size_t i) const { return {x0[i], y0[i], x1[i], y1[i]}; }
};

/// The clusters, and the view that they are tested against.
struct CullInput {
  const BoxArrays& boxes;
  const ConeArrays* cones;  ///< null if facing culls single triangles only
  const ScreenTransform& transform;
  const View& view;
};

/// Clusters [begin, end); `begin` is a multiple of 16.
struct ClusterRange {
  std::size_t begin, end;
};

/// Decides the fate of each cluster, and never culls a cluster that a sample sees. Each bound from a box corner is
/// padded by the greatest rounding error of a vertex inside the box.
void cull_clusters(const CullInput& input, Isa isa, const ClusterRange& range, CullResult& result);

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
  /// Indices of records and of clusters, nearest first.
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
  /// Culls clusters, takes some apart into records, and sorts the others by depth and into tiles. Time: O(clusters +
  /// pairs of large triangle and tile). Memory: about 30 bytes a cluster, 64 bytes more for a cluster that is drawn
  /// whole, 100 bytes for each large or clipped triangle, and the lists of one round.
  void make(const ClusterSet& set, const PlaceTarget& target, const Execution& execution,
            std::size_t most_record_items = kMostRecordItems);

  [[nodiscard]] const CullResult& culled() const { return culled_; }
  [[nodiscard]] RecordLists& records() { return records_; }

  /// \returns the items of a tile. Precondition: `tile` belongs to the round of records that was listed last.
  [[nodiscard]] TileJob job(std::size_t tile, const View& view) const;

 private:
  void choose_apart(std::size_t cluster_count);
  void take_apart(const ClusterSet& set, const PlaceTarget& target, const Execution& execution);
  void order_whole(std::size_t cluster_count);
  void list_clusters(const View& view);

  CullResult culled_;
  std::int64_t frames_by_facing_ = 0;  // frames of last_set_ so far in which front or back faces were culled
  std::weak_ptr<const void> last_set_;
  std::vector<std::uint32_t> apart_;                      // clusters to be taken apart
  std::vector<std::vector<TriangleRecord>> apart_parts_;  // records of each chunk of apart_
  RecordLists records_;
  std::size_t first_cutout_ = 0;      // index of the set's first cluster with holes
  std::vector<std::uint32_t> order_;  // clusters drawn whole: solid ones, then cutouts, each with nearer slices first
  TileLists cluster_lists_;
};

}  // namespace frontmost::zbuffer_detail
