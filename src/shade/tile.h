// SPDX-License-Identifier: Apache-2.0
// A rectangle of pixels shaded by one thread: finds its fragments, hands them out in batches, and sums the answers.
#pragma once

#include <functional>
#include <vector>

#include "frontmost/visible.h"
#include "shade/batch.h"
#include "shade/geometry.h"

namespace frontmost::shading {

inline constexpr int tile_width = 64, tile_height = 8;
inline constexpr int tile_pixels = tile_width * tile_height;

struct TileRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Which of a Visible's samples count.
enum class SampleUse : std::uint8_t { all, first };

/// Triangles that were set up for one tile, by id: an open-addressing table.
class TriangleCache {
 public:
  TriangleCache() : slots_(slot_count), setups_(capacity) {}

  void clear() {
    ++generation_;
    count_ = 0;
  }
  static constexpr int capacity = 512;
  [[nodiscard]] bool is_full() const { return count_ == capacity; }
  [[nodiscard]] const std::vector<TriangleSetup>& setups() const { return setups_; }
  [[nodiscard]] std::vector<TriangleSetup>& setups() { return setups_; }

  struct Found {
    std::uint16_t number;
    bool is_new;  ///< to be set up by the caller
  };
  /// Precondition: not full.
  Found find_or_add(PrimitiveId id);

 private:
  static constexpr std::uint32_t slot_count = 2048;
  struct Slot {
    std::uint32_t generation = 0;
    PrimitiveId id = no_primitive;
    std::uint16_t number = 0;
  };

  std::vector<Slot> slots_;
  std::vector<TriangleSetup> setups_;
  std::uint32_t generation_ = 1;
  int count_ = 0;
};

/// Reused from tile to tile by one thread. About half a megabyte.
class TileWork {
 public:
  /// Colours a batch: reads coverage and geometry, fills batch.light and batch.material.alpha.
  using Colorist = std::function<void(const std::vector<TriangleSetup>&, Batch&)>;

  TileWork(const TriangleSource& source, const Visible& visible, SampleUse use, const Colorist& colorist);

  /// Premultiplied sums over the samples of each pixel, row by row of the tile. False where nothing is seen at all.
  bool shade(const TileRectangle& tile);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }
  /// Lays what another layer shows of the same tile behind the see-through parts of this one.
  void put_behind(const TileWork& layer);
  [[nodiscard]] bool is_see_through() const { return is_see_through_; }

 private:
  /// Sets seen_ for a row of pixels from `row` on. False when nothing is seen in any. O(samples), many at a time.
  bool find_seen(std::size_t row, int width);
  void add_pixel(int x, int y, std::uint32_t pixel);
  void add_mixed_pixel(const PrimitiveId* ids, const glm::vec2& corner, std::uint32_t pixel);
  void add_fragment(PrimitiveId id, std::uint32_t pixel, const glm::vec2& screen, float weight);
  void sort_by_triangle();
  void flush();

  const TriangleSource& source_;
  const Visible& visible_;
  const Colorist& colorist_;
  int samples_;
  std::vector<glm::vec2> offsets_;  ///< of the samples within a pixel
  glm::vec2 centre_{0};             ///< their mean
  TriangleCache cache_;
  std::vector<glm::vec4> pixels_;
  /// Of each pixel, the part whose samples are see-through, and of that the part that lets light pass.
  std::vector<glm::vec2> see_through_;
  bool is_see_through_ = false;
  std::vector<NewTriangle> new_triangles_;  ///< of the batch, not set up yet
  bool seen_[tile_width] = {};
  Coverage arrived_;                     ///< by pixels
  std::uint16_t place_[batch_capacity];  ///< of each that arrived, in the batch
  Batch batch_;                          ///< by triangles
};

}  // namespace frontmost::shading
