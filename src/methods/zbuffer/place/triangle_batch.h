// SPDX-License-Identifier: Apache-2.0
// A batch: some two thousand consecutive triangles of the scene, placed on the screen and sorted into tiles.
//
//   triangles of the scene
//     -> snap_vertices()      every vertex once
//     -> place_triangles()    small triangles into the batch, the numbers of the others into `apart`
//     -> polygon_of()         one of the others, clipped if needed
//
// Neighbours in a file are mostly neighbours on the screen, too, so a batch has long runs of triangles in most of its
// tiles. If they are not neighbours on the screen, the batch is merely in more tiles.
#pragma once

#include <span>
#include <vector>

#include "surfaces/placed_scene.h"
#include "view/clip.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// Triangles with vertices no farther apart than 124 pixels. Each coordinate of each vertex has an array; the origin is
/// the image's top left. Areas are positive, and each triangle has a sample inside its bounding box.
struct BatchColumns {
  static constexpr std::size_t room = MeshRange::most_triangles + 16;  ///< a store may write a whole vector

  alignas(64) std::int32_t x[3][room], y[3][room];
  alignas(64) std::int32_t key[3][room];  ///< bits of the float
  alignas(64) std::uint32_t id[room];
  /// The first and the last tile column and row that the triangle may touch: x0 | y0 << 8 | x1 << 16 | y1 << 24.
  alignas(64) std::uint32_t tiles[room];

  void copy_triangle(std::size_t i, BatchColumns& to, std::size_t place) const {
    for (int k = 0; k < 3; ++k) {
      to.x[k][place] = x[k][i];
      to.y[k][place] = y[k][i];
      to.key[k][place] = key[k][i];
    }
    to.id[place] = id[i];
    to.tiles[place] = tiles[i];
  }
};

/// Consecutive triangles of a batch that touch the same tiles.
struct TileRun {
  std::uint16_t first, count;
};

class TriangleBatch {
 public:
  static constexpr std::size_t most_triangles = MeshRange::most_triangles;

  // Filled by place_triangles().
  std::size_t count = 0;         ///< triangles in the columns
  PixelRect rect{0, 0, -1, -1};  ///< bounds of their pixels
  std::int32_t nearest = 0;      ///< bits of their greatest key

  TriangleBatch() : columns_(1) {}
  void clear();
  [[nodiscard]] BatchColumns& columns() { return columns_[0]; }
  [[nodiscard]] const BatchColumns& columns() const { return columns_[0]; }
  [[nodiscard]] TriangleRecord record(std::size_t i) const;
  /// Moves the triangles for which `is_out(id)` holds to `out`. Precondition: `out` is empty.
  template <class IsOut>
  void extract(const IsOut& is_out, TriangleBatch& out) {
    std::size_t kept = 0;
    out.rect = rect;
    out.nearest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const BatchColumns& c = columns();
      if (!is_out(c.id[i])) {
        c.copy_triangle(i, columns(), kept++);
        continue;
      }
      c.copy_triangle(i, out.columns(), out.count++);
      for (const auto& key : c.key) out.nearest = std::max(out.nearest, key[i]);
    }
    count = kept;
  }

  /// Sorts triangles by tile if neighbours are scattered over the picture, as in a polygon soup. This loses their
  /// order. The sorted columns are made in `spare`, and swapped with the old ones.
  void gather_strewn(Buffer<BatchColumns>& spare);
  /// Makes the lists by tile, once all triangles are placed.
  void list_tiles();
  [[nodiscard]] TileRect tiles() const { return TileRect(rect); }
  /// The runs of a tile, from the first triangle to the last. Precondition: list_tiles() was called.
  [[nodiscard]] std::span<const TileRun> in_tile(int column, int row) const {
    if (count == 0) return {};
    const TileRect all = tiles();
    if (!all.holds(column, row)) return {};
    const std::size_t tile = std::size_t((row - all.y0) * (all.x1 - all.x0 + 1) + column - all.x0);
    return std::span(runs_).subspan(begin_[tile], begin_[tile + 1] - begin_[tile]);
  }

 private:
  template <class Visit>
  std::size_t visit_runs(const Visit& visit) const;
  void sort_by_tiles(BatchColumns& sorted);

  Buffer<BatchColumns> columns_;
  std::vector<std::uint32_t> begin_;  // by tile: the first of its runs_
  std::vector<TileRun> runs_;
};

/// The source of one batch: ranges [begin, end) of the scene.
struct BatchSource {
  std::size_t begin, end;
};

/// Joins consecutive ranges into batches, because some scenes have many small instances instead of a few large ones.
[[nodiscard]] std::vector<BatchSource> batch_sources(std::span<const MeshRange> ranges);

/// Mask of out codes. A vertex that cannot be snapped has a negative key. Each of these bits of such a key is set if
/// the vertex is certainly outside one plane of the clip volume. A triangle is not seen if all its vertices share a
/// bit.
inline constexpr std::int32_t kOutside = 63;

/// Vertices on the screen, and their bounds.
struct SnappedVertices {
  std::vector<std::int32_t> x, y;  ///< from the image's top left
  std::vector<float> key;          ///< less than 0 if the vertex cannot be snapped as it is

  bool all_plain = true;       ///< every vertex can be snapped as it is; if false, `low`, `high` and `nearest` mean
                               ///< nothing
  glm::ivec2 low{0}, high{0};  ///< bounds on the screen
  std::int32_t nearest = 0;    ///< bits of the greatest key
  std::int32_t common = -1;    ///< bits that are set in all keys

  void make_room(std::size_t count) {
    if (x.size() >= count) return;
    x.resize(count);
    y.resize(count);
    key.resize(count);
  }
};

/// The scratch memory of one thread for placing triangles.
struct PlaceScratch : WorldScratch {
  SnappedVertices vertices;
  std::vector<std::uint32_t> apart;
};

/// Transforms and snaps the vertices, and finds their bounds.
void snap_vertices(const PlaceTarget& target, std::span<const glm::vec3> positions, SnappedVertices& vertices);

/// Appends small triangles that may cover a sample to the batch, in their order. Appends to `apart` the indices of
/// triangles that are drawn one by one: large ones, and ones that may need clipping. Precondition: the columns have
/// room.
void place_triangles(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                     TriangleBatch& batch, std::vector<std::uint32_t>& apart);

/// Returns one of the triangles, clipped if a vertex cannot be snapped. The result has no corners if a vertex is not
/// finite.
[[nodiscard]] ClippedPolygon polygon_of(const PlaceTarget& target, const WorldTriangles& triangles,
                                        const SnappedVertices& vertices, std::size_t triangle);

}  // namespace frontmost::zbuffer_detail
