// SPDX-License-Identifier: Apache-2.0
// Pixels in the memory of the client: their formats and types, where rows lie, and the transfer operations.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <type_traits>
#include <vector>

#include "state/state.h"

namespace frontmost::gl_detail {

enum class PixelKind : std::uint8_t { color, index, stencil, depth };

/// Meaning of the components of a pixel.
struct PixelFormat {
  GLenum name;
  PixelKind kind;
  int components;
  std::array<std::uint8_t, 4> channels;  ///< 0 to 3 for red to alpha, kLuminance
};
inline constexpr int kLuminance = 4;

/// Storage of the components of a pixel.
struct PixelType {
  GLenum name;
  int bytes;                           ///< of a component, or of a packed pixel; 0 for GL_BITMAP
  int fields = 0;                      ///< components of a packed pixel, 0 for other types
  std::array<std::uint8_t, 4> bits{};  ///< of each field; the first one is the highest
  bool is_reversed = false;            ///< the first field is the lowest
};

/// \returns null for an unknown format, or the type. Component types from GL_BYTE to GL_FLOAT, GL_BITMAP and packed
/// ones.
[[nodiscard]] const PixelFormat* pixel_format(GLenum format);
[[nodiscard]] const PixelType* pixel_type(GLenum type);
/// \returns the error of this pair, or GL_NO_ERROR.
[[nodiscard]] GLenum pixel_error(GLenum format, GLenum type);

struct ImageShape {
  int width = 0, height = 0;
  GLenum format = GL_RGBA, type = GL_UNSIGNED_BYTE;
};

/// Place of the rows of an image in memory.
struct ImageLayout {
  PixelFormat format;
  PixelType type;
  std::size_t first = 0;        ///< byte of the first pixel
  std::size_t row_bytes = 0;    ///< from one row to the next
  std::size_t pixel_bytes = 0;  ///< 0 for bitmaps
  std::size_t end = 0;          ///< behind the last byte
  int first_bit = 0;            ///< of each row of a bitmap
};

/// \returns nothing for a pair that has an error, sizes below 0, and images that no memory can hold.
[[nodiscard]] std::optional<ImageLayout> image_layout(const PixelStore& store, const ImageShape& shape);

/// Whether the components of colors are bytes, the first one first.
[[nodiscard]] inline bool has_color_bytes(const ImageLayout& layout, const PixelStore& store) {
  const GLenum type = layout.type.name;
  return layout.format.kind == PixelKind::color &&
         (type == GL_UNSIGNED_BYTE || (type == GL_UNSIGNED_INT_8_8_8_8_REV && !store.swap_bytes));
}

/// The greatest value of the unsigned type of this size; 1 for floats.
template <class T>
inline constexpr double kMostOf = std::is_integral_v<T> ? double((std::uint64_t(1) << 8 * sizeof(T)) - 1) : 1;

/// \returns the value in [0, 1], 0 for NaN.
[[nodiscard]] inline double unit(double v) { return v > 0 ? (v < 1 ? v : 1) : 0; }
/// \returns the integer nearest to v * most, for v in [0, 1].
[[nodiscard]] inline std::uint32_t scaled(double v, double most) { return std::uint32_t(std::floor(v * most + 0.5)); }

/// Transfer operations between client memory and the frame or a texture. Colors are red, green, blue and alpha.
struct Transfer {
  const PixelModeState& mode;
  const std::array<PixelMap, 10>& maps;

  [[nodiscard]] bool changes_colors() const;
  void change(double* color) const;
  void color_of_index(double index, double* color) const;
  [[nodiscard]] double depth(double v) const { return unit(v * double(mode.depth_scale) + double(mode.depth_bias)); }
  [[nodiscard]] std::uint32_t stencil(double index) const;
  /// Changes a pixel of a Frame's color plane, of depths with 24 bits, or of stencil values.
  [[nodiscard]] std::uint32_t change_word(PixelKind kind, std::uint32_t word) const;
};

/// Calls `use` with a value of the component type, if it is one.
template <class Use>
void with_component_type(GLenum type, const Use& use) {
  switch (type) {
    case GL_UNSIGNED_BYTE: return use(GLubyte());
    case GL_BYTE: return use(GLbyte());
    case GL_UNSIGNED_SHORT: return use(GLushort());
    case GL_SHORT: return use(GLshort());
    case GL_UNSIGNED_INT: return use(GLuint());
    case GL_INT: return use(GLint());
    case GL_FLOAT: return use(GLfloat());
    default: return;
  }
}

/// \returns zeros, or nothing if there is no memory for them.
template <class T>
[[nodiscard]] std::optional<std::vector<T>> allocated(std::size_t size) {
  try {
    return std::vector<T>(size);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace frontmost::gl_detail
