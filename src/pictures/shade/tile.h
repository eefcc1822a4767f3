// SPDX-License-Identifier: Apache-2.0
// A tile is a rectangle of pixels that one thread shades: it collects fragments, shades them in batches, and sums
// colours.
#pragma once

#include <array>
#include <vector>

#include "base/pool.h"
#include "frontmost/pictures.h"
#include "frontmost/view.h"
#include "shade/fragment_shader.h"

namespace frontmost::shading {

inline constexpr int tile_width = 64, tile_height = 8;
inline constexpr int tile_pixels = tile_width * tile_height;

struct TileRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Which samples of a Visible are shaded.
enum class SampleUse : std::uint8_t { all, first };

/// A Visible, and the source of its triangles.
struct ShadedLayer {
  const TriangleSource& source;
  const Visible& visible;
  SampleUse use = SampleUse::all;
  const VisiblePixels* pixels = nullptr;  ///< primitives of all samples, if `visible` has the first sample only

  [[nodiscard]] const View& view() const { return pixels ? pixels->view : visible.view; }
};

/// Shades tiles in one thread. The object, of about half a megabyte, is used again for every tile and picture.
class TileWork {
 public:
  using Colorist = FragmentShader::Colorist;

  TileWork() : pixels_(tile_pixels) {}
  /// Starts a picture, and borrows all arguments. Must come before shade().
  void begin(const ShadedLayer& layer, const Colorist& colorist, ShadingRate rate, Isa isa);

  /// Computes the premultiplied colour of each pixel, as a sum over its samples. \returns false if the tile is empty.
  bool shade(const TileRectangle& tile);
  /// Multiplies all pixels by `opacity`.
  void fade(float opacity);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  /// The primitives that the samples of a row of pixels see.
  struct Row {
    PrimitiveId first[tile_width];      ///< sample 0
    PrimitiveId differing[tile_width];  ///< not 0 where samples see different primitives
    /// For each run of a VisiblePixels: the primitives of the next mixed pixel, from sample 1 on.
    const PrimitiveId* others[tile_width / VisiblePixels::run];
    bool is_empty;
  };

  /// Reads `width` pixels, of which the first is `at`.
  void look_at_row(const glm::ivec2& at, int width, Row& row) const;
  void compare_planes(std::size_t begin, int width, Row& row) const;
  void find_mixed(const glm::ivec2& at, int width, Row& row) const;
  /// Lists the primitives of all samples of the mixed pixel (x, y) of the tile. The mixed pixels of a row must be asked
  /// for from left to right.
  void list_ids(const TileRectangle& tile, int x, int y, PrimitiveId* ids);
  /// Adds the fragments of the pixels [left, right) of a row of the tile.
  void add_pixels(const TileRectangle& tile, int y, int left, int right);
  /// Adds any number of adjacent pixels that one primitive covers. Shades the batch whenever it is full.
  void add_row(PrimitiveId id, int count, FragmentShader::RowStart start);
  /// Adds the fragments of rows y and y + 1 by blocks of 2 x 2 pixels. Pixels of a block with the same primitive share
  /// one fragment.
  void add_blocks(const TileRectangle& tile, int y, int left, int right);
  /// Returns the number of adjacent blocks, from x up to `right`, that show the same single primitive, or background
  /// only.
  [[nodiscard]] int whole_blocks(int y, int x, int right) const;
  /// Adds one fragment for each different id of a block, and clears the ids. The block begins at `corner` and `pixel`.
  void add_shared(PrimitiveId (&ids)[4], glm::vec2 corner, std::uint32_t pixel);
  void add_mixed_pixel(const TileRectangle& tile, int x, int y);
  [[nodiscard]] std::uint64_t all_samples() const { return (1u << samples_) - 1; }
  void flush();

  const Visible* visible_ = nullptr;
  const VisiblePixels* mixed_ = nullptr;  ///< null if `visible_` holds all samples
  int samples_ = 1;
  ShadingRate rate_ = ShadingRate::each_pixel;
  int width_ = 0;                        ///< width of the tile
  std::array<glm::vec2, 16> offsets_{};  ///< positions of the samples within a pixel
  glm::vec2 centre_{0};                  ///< mean of the offsets
  FragmentShader fragments_;
  std::vector<glm::vec4> pixels_;
  Row rows_[tile_height];
};

struct Painting;

/// Shades the tiles of a part of the picture. The part begins at the corner of a tile.
void shade_part(const TileRectangle& part, const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                Isa isa);
/// Shades all tiles, one row of tiles per thread at a time.
void shade_tiles(const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works, const Execution& execution);

}  // namespace frontmost::shading
