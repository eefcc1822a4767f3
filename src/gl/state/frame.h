// SPDX-License-Identifier: Apache-2.0
// The picture that a context draws to, and rectangles of pixels on their way to it. Rows go up, as in OpenGL: row 0 is
// the lowest.
#pragma once

#include <cstdint>
#include <vector>

#include "frontmost/base.h"
#include "state/state.h"

namespace frontmost::gl_detail {

inline constexpr std::uint32_t kMostDepth = 0xFFFFFF;  ///< stored depths have 24 bits

/// All planes have `stride` entries a row, a multiple of 16, so that vectors at the right border stay in their row.
struct Frame {
  int width = 0, height = 0;
  std::size_t stride = 0;
  Buffer<std::uint32_t> color;  ///< red | green << 8 | blue << 16 | alpha << 24
  Buffer<std::uint32_t> depth;  ///< stored depth << 8 | stencil
  Buffer<std::uint32_t> ids;    ///< running number of the primitive that is seen; empty unless somebody asks for it

  void resize(int w, int h);  ///< all pixels become 0, and the farthest depth
  [[nodiscard]] std::size_t at(int x, int y) const { return std::size_t(y) * stride + std::size_t(x); }
};

/// A rectangle that glDrawPixels, glCopyPixels or glBitmap draws at the raster position.
struct PixelRectangle {
  enum class Kind { color, depth, stencil, bitmap };

  Kind kind = Kind::color;
  int width = 0, height = 0;
  float x = 0, y = 0;            ///< window place of the lower left corner of the first pixel
  float zoom_x = 1, zoom_y = 1;  ///< window pixels a pixel of the rectangle
  /// Row by row from the bottom: RGBA8 as in Frame, stored depths of 24 bits, stencil values, or 1 for the pixels of a
  /// bitmap that are drawn and 0 for others.
  std::vector<std::uint32_t> values;
};

struct MatrixStacks {
  std::vector<glm::dmat4> modelview{glm::dmat4(1)}, projection{glm::dmat4(1)};
  std::array<std::vector<glm::dmat4>, kTextureUnits> texture;

  MatrixStacks() { texture.fill({glm::dmat4(1)}); }
  /// The stack that glMatrixMode and glActiveTexture choose.
  [[nodiscard]] std::vector<glm::dmat4>& chosen(const State& state);
};

/// What drawing depends on.
struct DrawInput {
  State state;
  MatrixStacks matrices;
  Frame frame;
};

}  // namespace frontmost::gl_detail
