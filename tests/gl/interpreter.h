// SPDX-License-Identifier: Apache-2.0
// A plain interpreter of OpenGL 1.x, one pixel at a time, written from the specification, to compare the library with.
//
// Rounding is part of every result, so a pixel holds ranges: all values that the library's float arithmetic may yield.
// A test of a fragment that rounding decides has both outcomes, and the pixel then holds either. Coverage is exact,
// except for primitives that a plane cuts: some 1/256 pixel around their edges may be covered or not.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace frontmost::test::gl {

/// All numbers from `low` to `high`.
struct Range {
  double low, high;

  Range(double value = 0) : low(value), high(value) {}  // NOLINT(google-explicit-constructor)
  Range(double l, double h) : low(l), high(h) {}
  [[nodiscard]] bool holds(double value) const { return low <= value && value <= high; }
};

using Matrix = std::array<double, 16>;  ///< column by column
inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
using Color = std::array<float, 4>;
using Texel = std::array<std::uint8_t, 4>;

inline constexpr std::size_t kUnits = 2;  ///< of textures

struct Vertex {
  std::array<float, 4> position, color;
  std::array<std::array<float, 4>, kUnits> texcoords;
};

struct Level {
  int width, height;
  std::vector<Texel> texels;  ///< as given to glTexImage1D or 2D, rows from the bottom
};

struct Image {
  GLenum format;  ///< base format, such as GL_LUMINANCE
  bool is_1d;
  std::vector<Level> levels;  ///< down to one texel
};

/// GL_COMBINE of one texture unit: of colors, then of alpha.
struct Combiner {
  std::array<GLenum, 2> mode{GL_MODULATE, GL_MODULATE};
  std::array<std::array<GLenum, 3>, 2> sources{
      {{GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT}, {GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT}}};
  std::array<std::array<GLenum, 3>, 2> operands{
      {{GL_SRC_COLOR, GL_SRC_COLOR, GL_SRC_ALPHA}, {GL_SRC_ALPHA, GL_SRC_ALPHA, GL_SRC_ALPHA}}};
  std::array<float, 2> scales{1, 1};
};

struct TextureUnit {
  bool is_on = false;
  std::shared_ptr<const Image> image;
  GLenum min_filter = GL_NEAREST, mag_filter = GL_NEAREST, wrap_s = GL_REPEAT, wrap_t = GL_REPEAT;
  GLenum env_mode = GL_MODULATE;
  Color env_color{}, border_color{};
  Combiner combiner;
};

/// The state that decides what a call draws. The product of the matrices must be exact in doubles.
struct State {
  Matrix projection = kIdentity, modelview = kIdentity;
  std::array<int, 4> viewport{}, scissor{};
  std::array<double, 2> depth_range{0, 1};
  std::array<std::array<double, 4>, 2> clip_planes{};  ///< eye space
  bool scissor_test = false, cull_face = false, blend = false, logic = false, alpha_test = false, depth_test = false,
       stencil_test = false, fog = false, offset = false, stipple = false, clip_plane0 = false, clip_plane1 = false,
       depth_mask = true;
  GLenum culled = GL_BACK, front = GL_CCW, shade_model = GL_SMOOTH;
  std::array<GLenum, 2> polygon_modes{GL_FILL, GL_FILL};  ///< of front and back
  GLenum alpha_func = GL_ALWAYS, depth_func = GL_LESS, stencil_func = GL_ALWAYS, logic_op = GL_COPY;
  float alpha_ref = 0, fog_start = 0, fog_end = 1, line_width = 1, point_size = 1;
  int stencil_ref = 0, clear_stencil = 0, stipple_factor = 1;
  GLuint stencil_mask = 0xFFFFFFFF, stencil_writes = 0xFFFFFFFF;
  std::array<GLenum, 3> stencil_ops{GL_KEEP, GL_KEEP, GL_KEEP};     ///< fail, depth fail, pass
  std::array<GLenum, 4> factors{GL_ONE, GL_ZERO, GL_ONE, GL_ZERO};  ///< source and target of color, then of alpha
  std::array<GLenum, 2> equations{GL_FUNC_ADD, GL_FUNC_ADD};        ///< of color and alpha
  Color blend_color{}, clear_color{}, fog_color{};
  std::array<bool, 4> color_mask{true, true, true, true};
  double clear_depth = 1;
  std::array<float, 2> polygon_offset{};  ///< factor, units
  GLushort stipple_pattern = 0xFFFF;
  std::array<TextureUnit, kUnits> units;
};

struct Pixel {
  std::array<Range, 4> color;  ///< bytes
  Range depth{0xFFFFFF};       ///< steps of 24 bits
  std::size_t source = 0;      ///< of the depth: fragments of equal sources have equal depths; 0 is like no other
  int stencil = 0;             ///< -1 if unknown
};

struct Interpreter {
  int width, height;
  std::vector<Pixel> pixels = std::vector<Pixel>(std::size_t(width) * std::size_t(height));  ///< rows from the bottom
  std::map<std::vector<std::array<double, 8>>, std::size_t> sources = {};  ///< by all that a depth depends on

  void clear(const State& state, GLbitfield planes);
  /// glBegin, the vertices and glEnd.
  void draw(const State& state, GLenum mode, const std::vector<Vertex>& vertices);
};

}  // namespace frontmost::test::gl
