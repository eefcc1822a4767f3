// SPDX-License-Identifier: Apache-2.0
// The plan of a frame: clusters on the screen, and the clusters and single triangles of every tile.
//
// Unlike in the z-buffer, nothing is culled by depth, because hidden triangles count, too. So the vertices of all
// clusters in the picture are placed on the screen at once, before any tile begins, and tiles read them by their
// indices.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/buckets.h"
#include "surfaces/cluster_set.h"
#include "view/facing_rule.h"
#include "view/screen_transform.h"

namespace frontmost::abuffer_detail {

enum class ScreenFate : std::uint8_t {
  outside,  ///< no pixel can see it
  whole,    ///< every vertex is snapped
  spread,   ///< every vertex is snapped, but the cluster is taken apart, because it covers many tiles
  apart,    ///< the cluster is taken apart, because some triangle may need clipping
};

/// A cluster on the screen. Its bounds, in 1/256 pixel from the image's centre, are valid unless the fate is `apart`.
struct ClusterPlace {
  ScreenFate fate = ScreenFate::outside;
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Snapped vertices relative to the image's centre, with the indices of ClusterSet. Vertices that cannot be snapped are
/// 0.
struct ScreenClusters {
  Buffer<std::int32_t> x, y;
  Buffer<float> key;
  std::vector<ClusterPlace> places;
};

/// Transforms the vertices of clusters [begin, end) and sets the places of the clusters. Bounds are those of the
/// snapped vertices, and so need no margin for rounding.
void transform_clusters(const ClusterSet& set, const ScreenTransform& transform, Isa isa, std::size_t begin,
                        std::size_t end, ScreenClusters& screen);

inline constexpr int kTileSize = 64;

/// A rectangle of pixels, at most a tile.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// A triangle on the screen. Vertices are in 1/256 pixel from the image's top left. After orient(), their order makes
/// the area positive (clockwise to the eye, because y is down).
struct ScreenTriangle {
  std::int32_t x[3], y[3];
  float key[3];
  PrimitiveId id;
};

/// Makes the area positive. \returns false if the triangle is culled, or has no area and so covers nothing.
[[nodiscard]] bool orient(ScreenTriangle& triangle, const FacingRule& facing);

/// A list of numbers for every tile.
using TileNumbers = Buckets<std::uint32_t>;

/// Names a triangle of a plan: a triangle of a cluster, or a single.
struct TriangleNumber {
  std::uint32_t cluster;  ///< no_index if the triangle is a single
  std::uint32_t index;    ///< index in the cluster, or in singles()
};

/// The plan of a frame. Memory: 12 bytes a vertex, and 40 bytes for every triangle that is large or had to be clipped.
class FragmentPlan {
 public:
  FragmentPlan(const Surfaces& surfaces, const View& view, const Execution& execution);

  [[nodiscard]] const ClusterSet& set() const { return frame_->set; }
  [[nodiscard]] const ScreenTransform& transform() const { return frame_->transform; }
  [[nodiscard]] const View& view() const { return frame_->view; }
  [[nodiscard]] const FacingRule& facing() const { return frame_->facing; }
  [[nodiscard]] const ScreenClusters& screen() const { return frame_->screen; }
  [[nodiscard]] std::size_t tile_count() const { return std::size_t(frame_->tiles_x) * std::size_t(frame_->tiles_y); }
  [[nodiscard]] Rectangle tile(std::size_t number) const;

  [[nodiscard]] std::span<const std::uint32_t> clusters(std::size_t tile) const { return cluster_lists_[tile]; }
  [[nodiscard]] std::span<const ScreenTriangle> singles() const { return singles_; }
  /// Returns the indices of a tile's singles. None if the lists would be too long: any single may then be in the tile.
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> singles(std::size_t tile) const {
    if (!single_lists_) return std::nullopt;
    return (*single_lists_)[tile];
  }

  /// Calls visit(triangle, number) for every triangle that may cover a sample.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::uint32_t i = 0; i < singles_.size(); ++i) visit(singles_[i], TriangleNumber{no_index, i});
    for (std::uint32_t c = 0; c < screen().places.size(); ++c) {
      if (screen().places[c].fate != ScreenFate::whole) continue;
      const Cluster& cluster = set().clusters[c];
      for (std::uint32_t i = 0; i < cluster.triangle_count; ++i) {
        ScreenTriangle t = snapped(cluster, i);
        if (is_drawn(t)) visit(t, TriangleNumber{c, i});
      }
    }
  }
  /// Precondition: for_each() visits this number.
  [[nodiscard]] ScreenTriangle triangle(const TriangleNumber& number) const;
  /// Returns whether a texture may cut holes into the primitive.
  [[nodiscard]] bool may_have_holes(PrimitiveId id) const { return set().cutouts && set().cutouts->has(id); }
  /// Returns the plan of the same frame without some triangles. Precondition: `hidden` has no duplicates.
  [[nodiscard]] FragmentPlan without(std::span<const TriangleNumber> hidden) const;

 private:
  /// The data that all plans of a frame share, whatever triangles they leave out.
  struct Frame {
    const ClusterSet& set;
    ScreenTransform transform;
    View view;
    FacingRule facing;
    int tiles_x, tiles_y;
    ScreenClusters screen;
  };
  explicit FragmentPlan(std::shared_ptr<Frame> frame) : frame_(std::move(frame)) {}
  void transform_all(const Execution& execution);
  void take_apart(const Execution& execution);
  void append_clipped(const Cluster& cluster, std::vector<ScreenTriangle>& triangles) const;
  void append_snapped(const Cluster& cluster, std::vector<ScreenTriangle>& triangles) const;
  [[nodiscard]] ScreenTriangle snapped(const Cluster& cluster, std::size_t triangle) const;
  /// Makes the triangle's area positive. \returns false if the triangle covers nothing of the picture.
  [[nodiscard]] bool is_drawn(ScreenTriangle& triangle) const;
  /// `left_out` marks clusters whose triangles are among the singles; it may be empty.
  void make_lists(const std::vector<bool>& left_out);

  std::shared_ptr<Frame> frame_;
  std::vector<ScreenTriangle> singles_;
  TileNumbers cluster_lists_;
  std::optional<TileNumbers> single_lists_;
};

}  // namespace frontmost::abuffer_detail
