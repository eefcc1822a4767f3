// SPDX-License-Identifier: Apache-2.0
// Drawing one tile of the picture: the inner loop of the z-buffer.
#pragma once

#include <span>
#include <vector>

#include "surfaces/cluster_set.h"
#include "view/screen_transform.h"
#include "zbuffer/cull.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

inline constexpr int kTileSize = 128;              ///< pixels
inline constexpr int kBlockSize = 16;              ///< pixels; a tile is 8 x 8 blocks, one bit of a 64-bit mask each
inline constexpr int kTileStride = kTileSize + 8;  ///< words; a power of two would collide in the cache
inline constexpr std::size_t kTileWords = std::size_t(kTileSize) * kTileStride;

/// The greatest pixel rectangle of triangles that are drawn many at a time, in x and y.
inline constexpr glm::ivec2 kMostWalked{16, 32};

/// What all tiles of a frame have in common. Borrows everything.
struct FrameInput {
  const ClusterSet& set;
  const ScreenTransform& transform;
  const View& view;
  const CullResult& culled;
  std::span<const TriangleRecord> records;  ///< corners from the image's top left
  std::span<const glm::ivec2> samples;      ///< offsets within a pixel
  PrimitiveId* primitives;                  ///< output planes, [sample][y][x]
  float* keys;
  bool streams;  ///< write them past the cache: they are too large to stay in it
};

/// One tile: its pixels, and what may be seen in it, near things first.
struct TileJob {
  int x = 0, y = 0, width = 0, height = 0;
  std::span<const std::uint32_t> records, clusters;

  [[nodiscard]] bool is_empty() const { return records.empty() && clusters.empty(); }
};

/// What is known of the 64 blocks of a tile, row by row.
struct BlockBounds {
  static constexpr std::size_t count = 64;
  /// No sample of the block is farther than this key; 0 where some sample sees nothing.
  alignas(64) float farthest[count];
  /// A triangle that covers all of the block: its keys at the four outermost samples, less what rounding may add, and
  /// the greatest it can have. No sample of the block is farther than the plane through the four, or than `greatest`.
  alignas(64) float corner[4][count];
  alignas(64) float greatest[count];
};

/// The private memory of one thread, reused from tile to tile.
struct TileScratch {
  TileScratch();
  /// Makes room for that many samples a pixel.
  void reserve(std::size_t sample_count);

  /// By sample, kTileWords each: key bits << 32 | ~id, the greatest wins. 0 is "nothing".
  Buffer<std::uint64_t> words;
  Buffer<BlockBounds> bounds;        ///< one
  Buffer<std::uint32_t> references;  ///< covered (triangle, pixel) pairs of one batch
};

/// Draws a tile and writes it to the output planes.
void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
