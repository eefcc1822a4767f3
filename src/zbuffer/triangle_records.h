// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen, set up one by one: the large ones, and those that had to be clipped.
#pragma once

#include <algorithm>
#include <vector>

#include "surfaces/cluster_set.h"
#include "view/screen_transform.h"
#include "zbuffer/cull.h"

namespace frontmost::zbuffer_detail {

/// A triangle on the screen, corners in 1/256 pixel from some origin, so turned that its area is positive (clockwise
/// to the eye, y being down). Which corner is first is kept: the depth plane is anchored there.
struct TriangleRecord {
  std::int32_t x[3], y[3];
  float key[3];
  PrimitiveId id;

  [[nodiscard]] float nearest() const { return std::max({key[0], key[1], key[2]}); }
};

/// Twice the signed area of a snapped triangle, exact; negative is counter-clockwise to the eye: front.
[[nodiscard]] inline std::int64_t doubled_area(const TriangleRecord& r) {
  return std::int64_t(r.x[1] - r.x[0]) * (r.y[2] - r.y[0]) - std::int64_t(r.x[2] - r.x[0]) * (r.y[1] - r.y[0]);
}

/// Turns a record's area positive. \returns false when it is culled, or has no area and so covers nothing.
[[nodiscard]] bool orient(TriangleRecord& record, Culling culling);

/// Appends the triangles of one cluster that may be seen, clipped where needed, corners from the image's top left.
void append_records(const ClusterSet& set, const Cluster& cluster, const ScreenTransform& transform, const View& view,
                    std::vector<TriangleRecord>& records);

/// The pixels whose samples a record may cover, within the image; empty (x1 < x0 or y1 < y0) when there are none.
[[nodiscard]] PixelRect pixel_rect(const TriangleRecord& record, int width, int height);

/// True when no sample of the rectangle's pixels lies inside all three edges: a quick test by corners.
[[nodiscard]] bool misses(const TriangleRecord& record, const PixelRect& rect);

}  // namespace frontmost::zbuffer_detail
