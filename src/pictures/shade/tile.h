// SPDX-License-Identifier: Apache-2.0
// A rectangle of pixels shaded by one thread: finds its fragments, hands them out in batches, and sums the answers.
#pragma once

#include <array>
#include <vector>

#include "frontmost/pictures.h"
#include "frontmost/view.h"
#include "shade/fragment_shader.h"

namespace frontmost::shading {

inline constexpr int tile_width = 64, tile_height = 8;
inline constexpr int tile_pixels = tile_width * tile_height;

struct TileRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Which of a Visible's samples count.
enum class SampleUse : std::uint8_t { all, first };

/// A Visible and what its triangles are set up from.
struct ShadedLayer {
  const TriangleSource& source;
  const Visible& visible;
  SampleUse use = SampleUse::all;
  const VisiblePixels* pixels = nullptr;  ///< what all samples see, where `visible` says it of the first alone

  [[nodiscard]] const View& view() const { return pixels ? pixels->view : visible.view; }
};

/// Reused from tile to tile and from picture to picture by one thread. About half a megabyte.
class TileWork {
 public:
  using Colorist = FragmentShader::Colorist;

  TileWork() : pixels_(tile_pixels) {}
  /// Starts a picture; borrows everything. Precondition of shade().
  void begin(const ShadedLayer& layer, const Colorist& colorist, ShadingRate rate, Isa isa);

  /// Premultiplied sums over the samples of each pixel, row by row of the tile. False where nothing is seen at all.
  bool shade(const TileRectangle& tile);
  /// Multiplies what is seen by this.
  void fade(float opacity);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  /// What the samples of a row of pixels see.
  struct Row {
    PrimitiveId first[tile_width];      ///< sample 0
    PrimitiveId differing[tile_width];  ///< not 0 where samples see different primitives
    /// Of a VisiblePixels, by its runs: what samples 1 and up of the next such pixel see.
    const PrimitiveId* others[tile_width / VisiblePixels::run];
    bool is_empty;
  };

  /// Of the pixels from (x, y) on.
  void look_at_row(const glm::ivec2& at, int width, Row& row) const;
  void compare_planes(std::size_t begin, int width, Row& row) const;
  void find_mixed(const glm::ivec2& at, int width, Row& row) const;
  /// What the samples of the next mixed pixel of a row see, which is at x of the tile.
  void list_ids(const TileRectangle& tile, int x, int y, PrimitiveId* ids);
  /// Fragments of the pixels [left, right) of a row of the tile.
  void add_pixels(const TileRectangle& tile, int y, int left, int right);
  /// As FragmentShader's, of pixels that no other primitive shares; `count` of any size.
  void add_row(PrimitiveId id, int count, FragmentShader::RowStart start);
  /// Fragments of rows y and y + 1, two by two pixels at a time: one for those that see the same primitive.
  void add_blocks(const TileRectangle& tile, int y, int left, int right);
  /// How many blocks side by side show one primitive alone, or none, as far as `right`.
  [[nodiscard]] int whole_blocks(int y, int x, int right) const;
  /// One for each of the ids of a block, from its upper left corner and first pixel on; they are used up.
  void add_shared(PrimitiveId (&ids)[4], glm::vec2 corner, std::uint32_t pixel);
  void add_mixed_pixel(const TileRectangle& tile, int x, int y);
  [[nodiscard]] std::uint64_t all_samples() const { return (1u << samples_) - 1; }
  void flush();

  const Visible* visible_ = nullptr;
  const VisiblePixels* mixed_ = nullptr;  ///< null where `visible_` holds all samples
  int samples_ = 1;
  ShadingRate rate_ = ShadingRate::each_pixel;
  int width_ = 0;                        ///< of the tile
  std::array<glm::vec2, 16> offsets_{};  ///< of the samples within a pixel
  glm::vec2 centre_{0};                  ///< their mean
  FragmentShader fragments_;
  std::vector<glm::vec4> pixels_;
  Row rows_[tile_height];
};

}  // namespace frontmost::shading
