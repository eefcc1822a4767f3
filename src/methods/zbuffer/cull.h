// SPDX-License-Identifier: Apache-2.0
// Which clusters can be seen, and where on the screen.
//
//       the frustum          A cluster is left out where all eight corners of its box lie outside of one side of the
//     .   [c]      /         frustum, or where its cone of normals says that every triangle faces away. Others are
//      .     [w]  /          drawn whole (w), or are taken apart triangle by triangle (a) where some of them may reach
//   [a] .        /           the near plane or the guard band. Clusters that floats cannot decide are kept.
#pragma once

#include <vector>

#include "surfaces/cluster_set.h"
#include "view/screen_transform.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

enum class ClusterFate : std::uint8_t {
  culled,  ///< no sample can see it
  whole,   ///< every vertex can be snapped as it is
  apart,   ///< some triangle may need clipping: taken apart
};

/// One entry a cluster, padded to whole vectors. `rect` and `nearest` are valid if the fate is `whole`.
struct CullResult {
  std::vector<std::uint8_t> fate;  ///< ClusterFate
  std::vector<std::int32_t> x0, y0, x1, y1;
  std::vector<float> nearest;  ///< no key of the cluster is greater

  void resize(std::size_t cluster_count);
  [[nodiscard]] ClusterFate fate_of(std::size_t i) const { return ClusterFate(fate[i]); }
  [[nodiscard]] PixelRect rect(std::size_t i) const { return {x0[i], y0[i], x1[i], y1[i]}; }
};

/// The clusters, and the view that they are tested against.
struct CullInput {
  const BoxArrays& boxes;
  const ConeArrays* cones;  ///< null: facing culls triangles only
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

}  // namespace frontmost::zbuffer_detail
