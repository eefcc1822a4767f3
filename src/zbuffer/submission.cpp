// SPDX-License-Identifier: Apache-2.0
// From the scene's own arrays to triangles on the screen, in the order of their ids.

#include "zbuffer/submission.h"

#include <algorithm>

namespace frontmost::zbuffer_detail {
namespace {

constexpr std::size_t kMostItems = std::size_t(1) << 26;  // 256 MiB

/// The vertices of some triangles: all between the least and the greatest number where that is not many more than the
/// triangles have corners, as in files whose order is not random; else each corner by itself, and `own` its number.
std::span<const glm::vec3> positions_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const NumberRange& numbers,
                                        PlaceScratch& scratch, PieceGeometry& piece) {
  const ToWorld world(world_from_mesh);
  scratch.positions.clear();
  if (numbers.is_dense(piece.corners.size())) {
    piece.first_position = numbers.low;
    const auto range = std::span(mesh.positions).subspan(numbers.low, std::size_t(numbers.high - numbers.low) + 1);
    // No copy at all: most files have one instance, where it is.
    if (world.is_identity()) return range;
    for (const glm::vec3& p : range) scratch.positions.push_back(world(p));
    return scratch.positions;
  }
  scratch.corners.clear();
  for (const glm::uvec3& c : piece.corners) {
    const auto n = std::uint32_t(scratch.positions.size());
    scratch.corners.emplace_back(n, n + 1, n + 2);
    for (int k = 0; k < 3; ++k) scratch.positions.push_back(world(mesh.positions[c[k]]));
  }
  piece.corners = scratch.corners;
  return scratch.positions;
}

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

void append_clipped(const PlaceTarget& target, const PieceGeometry& piece, std::size_t triangle,
                    PlacedTriangles& placed) {
  const std::array<glm::vec3, 3> world = piece.world(triangle);
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

std::vector<Piece> pieces_of(const Scene& scene, std::span<const PrimitiveId> first_primitives,
                             const PrimitiveRange& range, std::uint32_t most) {
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const PrimitiveId first = first_primitives[i];
    const auto count = std::uint32_t(scene.meshes[scene.instances[i].mesh].triangles.size());
    const PrimitiveId low = std::max(range.begin, first), high = std::min(range.end, first + count);
    for (PrimitiveId id = low; id < high;) {
      const std::uint32_t size = std::min(most, high - id);
      pieces.push_back({i, id - first, id - first + size, first});
      id += size;
    }
  }
  return pieces;
}

std::size_t pieces_at_once(const TileGrid& grid) {
  constexpr std::size_t kMost = 128;  // 2^18 triangles
  // Clipping makes seven pieces of a triangle at most, but they do not overlap: a tile and a half each, on average.
  return std::clamp<std::size_t>(kMostItems / (grid.count() * kPieceTriangles), 1, kMost);
}

PieceGeometry geometry_of(const Scene& scene, const Piece& piece, const NumberRange& numbers, PlaceScratch& scratch) {
  const Instance& instance = scene.instances[piece.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  PieceGeometry geometry;
  geometry.corners = corners_of(scene, piece);
  geometry.positions = positions_of(mesh, instance.world_from_mesh, numbers, scratch, geometry);
  geometry.is_mirrored = mirrors(instance.world_from_mesh);
  geometry.first_id = piece.first + piece.begin;
  return geometry;
}

void place(const Scene& scene, const Piece& piece, const PlaceTarget& target, PlaceScratch& scratch,
           PlacedPiece& placed) {
  placed.triangles.count = 0;
  place_triangles(target, geometry_of(scene, piece, range_of_numbers(corners_of(scene, piece), target.isa), scratch),
                  scratch.vertices, placed.triangles);
  placed.bin(target.grid);
}

}  // namespace frontmost::zbuffer_detail
