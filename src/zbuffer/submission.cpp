// SPDX-License-Identifier: Apache-2.0
// From the scene's own arrays to triangles on the screen, in the order of their ids.

#include "zbuffer/submission.h"

#include <algorithm>

namespace frontmost::zbuffer_detail {
namespace {

constexpr std::size_t kMostItems = std::size_t(1) << 26;  // 256 MiB

/// The tile of a triangle's outermost corners where it is a single one.
std::uint32_t only_tile(const TileGrid& grid, const PixelRect& rect) {
  const int x = rect.x0 / kSubmissionTile, y = rect.y0 / kSubmissionTile;
  if (x != rect.x1 / kSubmissionTile || y != rect.y1 / kSubmissionTile) return no_index;
  return std::uint32_t(y * grid.across + x);
}

}  // namespace

PlaceTarget::PlaceTarget(const ScreenTransform& t, const View& v, Isa i)
    : transform(t), view(v), grid(v), low(kSubPixels), high(0), isa(i) {
  for (const glm::ivec2& s : sample_offsets(v.samples)) low = glm::min(low, s), high = glm::max(high, s);
}

void append_clipped(const PlaceTarget& target, const WorldTriangles& piece, std::size_t triangle,
                    PlacedTriangles& placed) {
  const std::array<glm::vec3, 3> world = piece[triangle];
  if (!is_finite(world[0]) || !is_finite(world[1]) || !is_finite(world[2])) return;
  const ClippedPolygon polygon = clip_triangle(target.transform, world);
  // Of the whole polygon, not of each piece: the polygon offset of f32 looks at the greatest depth of the primitive.
  float low = polygon.corners[0].key, high = low;
  for (int i = 0; i < polygon.count; ++i) {
    low = std::min(low, polygon.corners[std::size_t(i)].key);
    high = std::max(high, polygon.corners[std::size_t(i)].key);
  }
  for_each_of_fan(polygon, target.transform, piece.first_id + PrimitiveId(triangle), [&](TriangleRecord& record) {
    const PixelRect rect = sampled_rect(record, target.low, target.high, target.view.width, target.view.height);
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0 || !orient(record, target.view.culling)) return;
    placed.append(record, low, high, only_tile(target.grid, rect));
  });
}

std::vector<MeshRange> ranges_within(const PlacedScene& placed, const PrimitiveRange& range) {
  std::vector<MeshRange> within;
  for (MeshRange part : placed.ranges) {
    const PrimitiveId first = placed.first_primitives[part.instance];
    if (range.end <= first + part.begin || range.begin >= first + part.end) continue;
    part.begin = std::max(part.begin, range.begin - std::min(range.begin, first));
    part.end = std::min(part.end, range.end - first);
    within.push_back(part);
  }
  return within;
}

std::size_t pieces_at_once(const TileGrid& grid) {
  constexpr std::size_t kMost = 128;  // 2^18 triangles
  // Clipping makes seven pieces of a triangle at most, but they do not overlap: a tile and a half each, on average.
  return std::clamp<std::size_t>(kMostItems / (grid.count() * MeshRange::most_triangles), 1, kMost);
}

void place(const WorldTriangles& triangles, const PlaceTarget& target, PieceVertices& vertices, PlacedPiece& piece) {
  piece.triangles.count = 0;
  place_triangles(target, triangles, vertices, piece.triangles);
  piece.bin(target.grid);
}

}  // namespace frontmost::zbuffer_detail
