// SPDX-License-Identifier: Apache-2.0
// Growing columns, and lists by tile: counted in a first pass, filled in a second, so that nothing is allocated
// between.

#include "zbuffer/placed_triangles.h"

namespace frontmost::zbuffer_detail {
namespace {

template <class T>
void grow(Buffer<T>& column, std::size_t used, std::size_t size) {
  Buffer<T> larger(size);
  std::copy_n(column.data(), used, larger.data());
  column.swap(larger);
}

/// Calls add(tile) for every tile in which the triangle may cover a sample.
template <class Add>
void for_each_tile(const TriangleRecord& triangle, const TileGrid& grid, const Add& add) {
  const PixelRect rect = pixel_rect(triangle, grid.width, grid.height);
  for (int y = rect.y0 / kSubmissionTile; y <= rect.y1 / kSubmissionTile; ++y)
    for (int x = rect.x0 / kSubmissionTile; x <= rect.x1 / kSubmissionTile; ++x) {
      const std::size_t tile = std::size_t(y) * std::size_t(grid.across) + std::size_t(x);
      if (!misses(triangle, grid.rect(tile))) add(tile);
    }
}

}  // namespace

PixelRect TileGrid::rect(std::size_t tile) const {
  const int x = int(tile % std::size_t(across)) * kSubmissionTile,
            y = int(tile / std::size_t(across)) * kSubmissionTile;
  return {x, y, std::min(x + kSubmissionTile, width) - 1, std::min(y + kSubmissionTile, height) - 1};
}

void PlacedTriangles::make_room(std::size_t more) {
  const std::size_t needed = count + more + slack;
  if (id.size() >= needed) return;
  // All columns have the size of `id`, which grows last: what fails for want of memory leaves a size that holds for
  // all.
  const std::size_t size = std::max(needed, 2 * id.size());
  for (auto* columns : {&x, &y})
    for (Buffer<std::int32_t>& column : *columns) grow(column, count, size);
  for (Buffer<float>& column : key) grow(column, count, size);
  grow(low, count, size);
  grow(high, count, size);
  grow(tile, count, size);
  grow(id, count, size);
}

void PlacedTriangles::append(const TriangleRecord& record, float key_low, float key_high, std::uint32_t only_tile) {
  make_room(1);
  for (std::size_t k = 0; k < 3; ++k) {
    x[k][count] = record.x[k];
    y[k][count] = record.y[k];
    key[k][count] = record.key[k];
  }
  low[count] = key_low;
  high[count] = key_high;
  id[count] = record.id;
  tile[count] = only_tile;
  ++count;
}

void PlacedPiece::bin(const TileGrid& grid) {
  if (triangles.count == 0) return;
  const auto visit = [&](const auto& add) {
    for (std::uint32_t i = 0; i < triangles.count; ++i) {
      if (triangles.tile[i] != no_index)
        add(triangles.tile[i], i);
      else
        for_each_tile(triangles.record(i), grid, [&](std::size_t tile) { add(tile, i); });
    }
  };
  begin.assign(grid.count() + 1, 0);
  visit([&](std::size_t tile, std::uint32_t) { ++begin[tile + 1]; });
  for (std::size_t tile = 0; tile < grid.count(); ++tile) begin[tile + 1] += begin[tile];
  items.resize(begin[grid.count()]);
  // Filling moves each start to its end, which is the next one's start.
  visit([&](std::size_t tile, std::uint32_t i) { items[begin[tile]++] = i; });
  for (std::size_t tile = grid.count(); tile > 0; --tile) begin[tile] = begin[tile - 1];
  begin[0] = 0;
}

}  // namespace frontmost::zbuffer_detail
