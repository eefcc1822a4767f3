// SPDX-License-Identifier: Apache-2.0
// Tiles of the picture, the picture that they are drawn to, and the memory that a thread needs to draw a tile.
//
//    picture      tiles of 128 x 128 pixels, row by row, each drawn by one thread
//    tile         8 x 8 blocks of 16 x 16 pixels, one bit each in masks of 64 bits
//    word         | key: 32 bits | ~id: 32 bits |      the greater word is nearer; at equal keys the lower id wins
//
// A tile's words are the private memory of one thread until the tile is written out. Threads never share a sample, so
// nothing is locked.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "base/memory.h"
#include "frontmost/view.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"

namespace frontmost::zbuffer_detail {

inline constexpr int kTileSize = 128;              ///< pixels
inline constexpr int kBlockSize = 16;              ///< pixels; a tile is 8 x 8 blocks, one bit of a 64-bit mask each
inline constexpr int kTileStride = kTileSize + 8;  ///< words; a power of two would collide in the cache
inline constexpr std::size_t kTileWords = std::size_t(kTileSize) * kTileStride;

/// The greatest pixel rectangle, in x and y, of triangles that are drawn in packets.
inline constexpr glm::ivec2 kMostWalked{16, 32};

/// Pixels [x0, x1] x [y0, y1], both ends included.
struct PixelRect {
  std::int32_t x0, y0, x1, y1;

  [[nodiscard]] bool is_empty() const { return x1 < x0 || y1 < y0; }
};

/// The intersection of two rectangles.
[[nodiscard]] inline PixelRect common_part(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// The planes that a VisiblePixels is written to. Borrows everything.
struct PixelPlanes {
  PrimitiveId* primitives;  ///< ids of sample 0
  float* keys;
  std::uint16_t* mixed;
  std::uint32_t* places;
  PrimitiveId* others;
  std::size_t runs_across;
  std::atomic<std::uint32_t>* other_count;
};

/// The picture that tiles are drawn to. Borrows everything.
struct Picture {
  const View& view;
  std::span<const glm::ivec2> samples;  ///< offsets within a pixel
  PrimitiveId* primitives;              ///< planes, [sample][y][x]
  float* keys;
  bool streams;                         ///< true if planes are written past the cache, because they are too large to
                                        ///< stay in it
  const Cutouts* cutouts;               ///< null if no triangle has holes
  ScreenRays rays;                      ///< rays of the view, which find the holes
  const PixelPlanes* pixels = nullptr;  ///< if not null, receives the final result; `primitives` and `keys` then hold
                                        ///< intermediate results
};

/// The pixels of one tile.
struct Tile {
  std::size_t number;  ///< counted row by row
  int x, y, width, height;

  Tile(std::size_t n, const View& view)
      : number(n),
        x(int(n % tiles_across(view)) * kTileSize),
        y(int(n / tiles_across(view)) * kTileSize),
        width(std::min(kTileSize, view.width - x)),
        height(std::min(kTileSize, view.height - y)) {}

  [[nodiscard]] static std::size_t tiles_across(const View& view) {
    return (std::size_t(view.width) + kTileSize - 1) / kTileSize;
  }
  [[nodiscard]] static std::size_t count(const View& view) {
    return tiles_across(view) * ((std::size_t(view.height) + kTileSize - 1) / kTileSize);
  }
  [[nodiscard]] PixelRect rect() const { return {x, y, x + width - 1, y + height - 1}; }
  [[nodiscard]] int column() const { return x / kTileSize; }
  [[nodiscard]] int row() const { return y / kTileSize; }
};

/// Tiles [begin, end), counted row by row.
struct TileRange {
  std::size_t begin = 0, end = 0;
};

/// Tiles [x0, x1] x [y0, y1], both ends included.
struct TileRect {
  int x0, y0, x1, y1;

  explicit TileRect(const PixelRect& rect)
      : x0(rect.x0 / kTileSize), y0(rect.y0 / kTileSize), x1(rect.x1 / kTileSize), y1(rect.y1 / kTileSize) {}
  [[nodiscard]] int count() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
  [[nodiscard]] bool holds(int column, int row) const { return x0 <= column && column <= x1 && y0 <= row && row <= y1; }
};

/// Splits a list of solid items followed by cutouts into these two parts.
struct PartedList {
  std::span<const std::uint32_t> solid, cutouts;

  template <class IsCutout>
  PartedList(std::span<const std::uint32_t> list, const IsCutout& is_cutout) {
    const auto first = std::partition_point(list.begin(), list.end(), [&](std::uint32_t i) { return !is_cutout(i); });
    solid = list.first(std::size_t(first - list.begin()));
    cutouts = list.subspan(solid.size());
  }
};

/// A list of numbers for every tile of a range, one after another in one array:
///
///    begin    tile 0: 0    tile 1: 3    tile 2: 3    tile 3: 7 ...
///    items    | a b c |    |            | a d e f |  ...
struct TileLists {
  std::size_t first_tile = 0;
  std::vector<std::size_t> begin;  ///< first item of each tile, then the end of the last tile
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const {
    const std::size_t i = tile - first_tile;
    return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
  }
  /// Makes the lists. visit(item, add) calls add(tile) for each tile whose list holds the item. Lists keep the order of
  /// items. Each item is visited twice: items are counted by tile first and then filled in.
  template <class Visit>
  void make(const TileRange& tiles, std::size_t item_count, const Visit& visit) {
    first_tile = tiles.begin;
    const std::size_t tile_count = tiles.end - tiles.begin;
    // Filling a list advances its beginning, so beginnings are first stored one entry after their final place.
    begin.assign(tile_count + 2, 0);
    for (std::size_t i = 0; i < item_count; ++i) visit(i, [&](std::size_t tile) { ++begin[tile - tiles.begin + 2]; });
    for (std::size_t tile = 0; tile < tile_count; ++tile) begin[tile + 2] += begin[tile + 1];
    items.resize(begin[tile_count + 1]);
    for (std::size_t i = 0; i < item_count; ++i)
      visit(i, [&](std::size_t tile) { items[begin[tile - tiles.begin + 1]++] = static_cast<std::uint32_t>(i); });
  }
};

/// Depth bounds of the 64 blocks of a tile, row by row.
struct BlockBounds {
  static constexpr std::size_t count = 64;
  /// No sample of the block is farther than this key; 0 where some sample sees nothing.
  alignas(64) float farthest[count];
  /// A triangle that covers all of the block: `corner` holds its keys at the four outermost samples, less what rounding
  /// may add, and `greatest` its greatest key. Every sample of the block is at least as near as the farther of two
  /// bounds: the plane through the four keys, and `greatest`.
  alignas(64) float corner[4][count];
  alignas(64) float greatest[count];
};

/// The private memory of one thread, reused from tile to tile.
struct TileScratch {
  /// `references` has room for every pixel of the largest walk in every lane, and for one vector more, because stores
  /// write whole vectors.
  TileScratch() : bounds(1), references(std::size_t(16 * kMostWalked.x * kMostWalked.y) + 64) {}
  /// Makes room for `sample_count` samples a pixel.
  void reserve(std::size_t sample_count) {
    if (words.size() < sample_count * kTileWords) words = Buffer<std::uint64_t>(sample_count * kTileWords);
  }

  /// kTileWords words for each sample. A word is key bits << 32 | ~id; the greatest word wins, and 0 means "nothing".
  Buffer<std::uint64_t> words;
  Buffer<BlockBounds> bounds;        ///< a single element
  Buffer<std::uint32_t> references;  ///< covered (triangle, pixel) pairs of one packet
};

/// Tells whether samples of a tile look through holes. A sample is tested only if the triangle with holes would be seen
/// there. The same few triangles are tested again and again, so the class keeps the last triangles' ScreenCutouts.
class TileHoles {
 public:
  /// Borrows the picture. Precondition: it has cutouts.
  TileHoles(const Picture& picture, const Tile& tile)
      : picture_(picture), first_(glm::ivec2(tile.x, tile.y) * kSubPixels) {
    ids_.fill(no_primitive);
  }
  /// Returns whether the triangle has a hole at `place`, in 1/256 pixel of the tile. Precondition: the triangle is a
  /// cutout.
  [[nodiscard]] bool has(PrimitiveId id, const glm::ivec2& place) {
    const std::size_t slot = id % kSlots;
    if (ids_[slot] != id) {
      cutouts_[slot].emplace((*picture_.cutouts)[id], picture_.rays);
      ids_[slot] = id;
    }
    return cutouts_[slot]->is_hole(first_.x + place.x, first_.y + place.y);
  }

 private:
  static constexpr std::size_t kSlots = 32;

  const Picture& picture_;
  glm::ivec2 first_;  // top left corner of the tile in the image, in 1/256 pixel
  std::array<PrimitiveId, kSlots> ids_;
  std::array<std::optional<ScreenCutout>, kSlots> cutouts_;
};

}  // namespace frontmost::zbuffer_detail
