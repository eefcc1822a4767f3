// SPDX-License-Identifier: Apache-2.0
// All clusters on the screen: every vertex is transformed once a frame.
#pragma once

#include <vector>

#include "surfaces/cluster_set.h"
#include "view/screen_transform.h"

namespace frontmost::abuffer_detail {

enum class ScreenFate : std::uint8_t {
  outside,  ///< no pixel can see it
  whole,    ///< every vertex is snapped
  spread,   ///< likewise, but over so many tiles that it is taken apart
  apart,    ///< some triangle may need clipping
};

/// Where a cluster is; the bounds, in 1/256 pixel from the image's centre, hold unless it is to be taken apart.
struct ClusterPlace {
  ScreenFate fate = ScreenFate::outside;
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Snapped vertices, from the image's centre, at the places where ClusterSet has them. Those of vertices that cannot be
/// snapped are 0.
struct ScreenClusters {
  Buffer<std::int32_t> x, y;
  Buffer<float> key;
  std::vector<ClusterPlace> places;
};

/// Transforms the vertices of clusters [begin, end) and says where the clusters are. Exact: bounds are those of the
/// snapped vertices, so no margin for rounding is needed.
void transform_clusters(const ClusterSet& set, const ScreenTransform& transform, Isa isa, std::size_t begin,
                        std::size_t end, ScreenClusters& screen);

}  // namespace frontmost::abuffer_detail
