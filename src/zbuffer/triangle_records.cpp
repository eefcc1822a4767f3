// SPDX-License-Identifier: Apache-2.0
#include "zbuffer/triangle_records.h"

#include <algorithm>
#include <utility>

#include "view/clip.h"

namespace frontmost::zbuffer_detail {
namespace {

bool keeps(Culling culling, bool is_front) {
  switch (culling) {
    case Culling::none: return true;
    case Culling::back: return is_front;
    case Culling::front: return !is_front;
    case Culling::both: return false;
  }
  return true;
}

/// The corners of a cluster's triangle, world space.
std::array<glm::vec3, 3> corners_of(const ClusterSet& set, const Cluster& cluster, std::size_t triangle) {
  std::array<glm::vec3, 3> corners;
  const std::size_t c = cluster.first_triangle + triangle;
  const std::array<std::uint8_t, 3> numbers{set.i0[c], set.i1[c], set.i2[c]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = cluster.first_vertex + numbers[k];
    corners[k] = {set.x[v], set.y[v], set.z[v]};
  }
  return corners;
}

}  // namespace

bool orient(TriangleRecord& r, Culling culling) {
  const std::int64_t area = doubled_area(r);
  if (area == 0 || !keeps(culling, area < 0)) return false;
  if (area < 0) {
    std::swap(r.x[1], r.x[2]);
    std::swap(r.y[1], r.y[2]);
    std::swap(r.key[1], r.key[2]);
  }
  return true;
}

void append_records(const ClusterSet& set, const Cluster& cluster, const ScreenTransform& t, Culling culling,
                    std::vector<TriangleRecord>& records) {
  for (std::size_t i = 0; i < cluster.triangle_count; ++i) {
    const std::size_t c = cluster.first_triangle + i;
    if (set.i0[c] == set.i1[c] || set.i1[c] == set.i2[c] || set.i0[c] == set.i2[c]) continue;
    const ClippedPolygon polygon = clip_triangle(t, corners_of(set, cluster, i));
    for (int k = 2; k < polygon.count; ++k) {
      const ScreenVertex* fan[3] = {&polygon.corners[0], &polygon.corners[std::size_t(k - 1)],
                                    &polygon.corners[std::size_t(k)]};
      TriangleRecord record;
      record.id = set.id[c];
      for (int v = 0; v < 3; ++v) {
        record.x[v] = fan[v]->x + t.centre_x;
        record.y[v] = fan[v]->y + t.centre_y;
        record.key[v] = fan[v]->key;
      }
      if (orient(record, culling)) records.push_back(record);
    }
  }
}

PixelRect pixel_rect(const TriangleRecord& r, int width, int height) {
  // Samples lie within [0, 256) of a pixel, so the pixels of the outermost corners are all that can be touched.
  const auto [x_min, x_max] = std::minmax({r.x[0], r.x[1], r.x[2]});
  const auto [y_min, y_max] = std::minmax({r.y[0], r.y[1], r.y[2]});
  return {std::max(x_min >> 8, 0), std::max(y_min >> 8, 0), std::min(x_max >> 8, width - 1),
          std::min(y_max >> 8, height - 1)};
}

bool misses(const TriangleRecord& r, const PixelRect& rect) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const std::int64_t dx = r.x[b] - r.x[a], dy = r.y[b] - r.y[a];
    // The corner of the rectangle that lies deepest inside the edge.
    const std::int64_t x = dy < 0 ? (std::int64_t(rect.x1) + 1) * kSubPixels : std::int64_t(rect.x0) * kSubPixels;
    const std::int64_t y = dx > 0 ? (std::int64_t(rect.y1) + 1) * kSubPixels : std::int64_t(rect.y0) * kSubPixels;
    if (dx * (y - r.y[a]) - dy * (x - r.x[a]) < 0) return true;
  }
  return false;
}

}  // namespace frontmost::zbuffer_detail
