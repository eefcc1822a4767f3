// SPDX-License-Identifier: Apache-2.0
// A rectangle of pixels shaded by one thread: finds its fragments, hands them out in batches, and sums the answers.
#pragma once

#include <array>
#include <vector>

#include "frontmost/visible.h"
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
};

/// Reused from tile to tile and from picture to picture by one thread. About half a megabyte.
class TileWork {
 public:
  using Colorist = FragmentShader::Colorist;

  TileWork() : pixels_(tile_pixels) {}
  /// Starts a picture; borrows everything. Precondition of shade().
  void begin(const ShadedLayer& layer, const Colorist& colorist);

  /// Premultiplied sums over the samples of each pixel, row by row of the tile. False where nothing is seen at all.
  bool shade(const TileRectangle& tile);
  /// Multiplies what is seen by this.
  void fade(float opacity);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  /// Sets seen_[y] for a row of pixels from `row` on. False when nothing is seen in any. O(samples), many at a time.
  bool find_seen(std::size_t row, int width, int y);
  void add_pixel(int x, int y, std::uint32_t pixel);
  void add_mixed_pixel(const PrimitiveId* ids, const glm::vec2& corner, std::uint32_t pixel);
  void add_fragment(PrimitiveId id, std::uint32_t pixel, const glm::vec2& screen, unsigned samples);
  void flush();

  const Visible* visible_ = nullptr;
  int samples_ = 1;
  std::array<glm::vec2, 16> offsets_{};  ///< of the samples within a pixel
  glm::vec2 centre_{0};                  ///< their mean
  FragmentShader fragments_;
  std::vector<glm::vec4> pixels_;
  bool seen_[tile_height][tile_width] = {};
};

}  // namespace frontmost::shading
