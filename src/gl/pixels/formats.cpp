// SPDX-License-Identifier: Apache-2.0
// Tables of pixel formats and types, the layout of images, and the transfer operations.

#include "pixels/formats.h"

#include <algorithm>

namespace frontmost::gl_detail {
namespace {

// clang-format off
constexpr PixelFormat kPixelFormats[] = {
    {GL_RGBA, PixelKind::color, 4, {0, 1, 2, 3}}, {GL_BGRA, PixelKind::color, 4, {2, 1, 0, 3}},
    {GL_RGB, PixelKind::color, 3, {0, 1, 2}}, {GL_BGR, PixelKind::color, 3, {2, 1, 0}},
    {GL_RED, PixelKind::color, 1, {0}}, {GL_GREEN, PixelKind::color, 1, {1}}, {GL_BLUE, PixelKind::color, 1, {2}},
    {GL_ALPHA, PixelKind::color, 1, {3}}, {GL_ABGR_EXT, PixelKind::color, 4, {3, 2, 1, 0}},
    {GL_LUMINANCE, PixelKind::color, 1, {kLuminance}}, {GL_LUMINANCE_ALPHA, PixelKind::color, 2, {kLuminance, 3}},
    {GL_COLOR_INDEX, PixelKind::index, 1, {}}, {GL_STENCIL_INDEX, PixelKind::stencil, 1, {}},
    {GL_DEPTH_COMPONENT, PixelKind::depth, 1, {}}};

constexpr PixelType kPixelTypes[] = {
    {GL_UNSIGNED_BYTE, 1}, {GL_BYTE, 1}, {GL_UNSIGNED_SHORT, 2}, {GL_SHORT, 2}, {GL_UNSIGNED_INT, 4}, {GL_INT, 4},
    {GL_FLOAT, 4}, {GL_BITMAP, 0},
    {GL_UNSIGNED_BYTE_3_3_2, 1, 3, {3, 3, 2}}, {GL_UNSIGNED_BYTE_2_3_3_REV, 1, 3, {3, 3, 2}, true},
    {GL_UNSIGNED_SHORT_5_6_5, 2, 3, {5, 6, 5}}, {GL_UNSIGNED_SHORT_5_6_5_REV, 2, 3, {5, 6, 5}, true},
    {GL_UNSIGNED_SHORT_4_4_4_4, 2, 4, {4, 4, 4, 4}}, {GL_UNSIGNED_SHORT_4_4_4_4_REV, 2, 4, {4, 4, 4, 4}, true},
    {GL_UNSIGNED_SHORT_5_5_5_1, 2, 4, {5, 5, 5, 1}}, {GL_UNSIGNED_SHORT_1_5_5_5_REV, 2, 4, {5, 5, 5, 1}, true},
    {GL_UNSIGNED_INT_8_8_8_8, 4, 4, {8, 8, 8, 8}}, {GL_UNSIGNED_INT_8_8_8_8_REV, 4, 4, {8, 8, 8, 8}, true},
    {GL_UNSIGNED_INT_10_10_10_2, 4, 4, {10, 10, 10, 2}}, {GL_UNSIGNED_INT_2_10_10_10_REV, 4, 4, {10, 10, 10, 2}, true}};
// clang-format on

template <class Row, std::size_t n>
const Row* row_named(const Row (&table)[n], GLenum name) {
  const Row* const row = std::find_if(table, table + n, [name](const Row& r) { return r.name == name; });
  return row == table + n ? nullptr : row;
}

/// The entry of a map for a value in [0, 1].
double looked_up(const PixelMap& map, double v) {
  return double(map.values[std::size_t(scaled(unit(v), double(map.size - 1)))]);
}

/// The index after shift and offset. Indexes of floats are limited to 32 bits.
std::int64_t shifted_index(const PixelModeState& mode, double index) {
  const double limited = index >= -2147483648.0 ? std::min(index, 4294967295.0) : index < 0 ? -2147483648.0 : 0;
  const auto whole = std::int64_t(limited);
  const int shift = std::clamp(mode.index_shift, -31, 31);
  return (shift >= 0 ? whole * (std::int64_t(1) << shift) : whole >> -shift) + mode.index_offset;
}

/// The entry of a map, whose size is a power of two, for an index.
double looked_up(const PixelMap& map, std::int64_t index) {
  return double(map.values[std::size_t(index & (map.size - 1))]);
}

}  // namespace

const PixelFormat* pixel_format(GLenum format) { return row_named(kPixelFormats, format); }
const PixelType* pixel_type(GLenum type) { return row_named(kPixelTypes, type); }

GLenum pixel_error(GLenum format, GLenum type) {
  const PixelFormat* const f = pixel_format(format);
  const PixelType* const t = pixel_type(type);
  if (!f || !t) return GL_INVALID_ENUM;
  if (type == GL_BITMAP)
    return f->kind == PixelKind::index || f->kind == PixelKind::stencil ? GL_NO_ERROR : GL_INVALID_ENUM;
  if (t->fields == 0) return GL_NO_ERROR;
  return t->fields == f->components && format != GL_BGR ? GL_NO_ERROR : GL_INVALID_OPERATION;
}

std::optional<ImageLayout> image_layout(const PixelStore& store, const ImageShape& shape) {
  if (shape.width < 0 || shape.height < 0 || pixel_error(shape.format, shape.type) != GL_NO_ERROR) return std::nullopt;
  ImageLayout layout{*pixel_format(shape.format), *pixel_type(shape.type)};
  const auto width = std::size_t(shape.width), height = std::size_t(shape.height);
  const auto skip_pixels = std::size_t(store.skip_pixels), skip_rows = std::size_t(store.skip_rows);
  const std::size_t length = store.row_length > 0 ? std::size_t(store.row_length) : width;
  const bool has_bits = layout.type.bytes == 0;
  layout.pixel_bytes = std::size_t(layout.type.bytes) * std::size_t(layout.type.fields ? 1 : layout.format.components);
  const auto alignment = std::size_t(store.alignment);
  const std::size_t tight = has_bits ? (length + 7) / 8 : length * layout.pixel_bytes;
  layout.row_bytes = (tight + alignment - 1) / alignment * alignment;
  if (double(skip_rows + height + 1) * double(layout.row_bytes) > 4e18) return std::nullopt;
  layout.first = skip_rows * layout.row_bytes + (has_bits ? skip_pixels / 8 : skip_pixels * layout.pixel_bytes);
  layout.first_bit = has_bits ? int(skip_pixels % 8) : 0;
  layout.end = layout.first;
  if (width > 0 && height > 0) {
    const std::size_t last = has_bits ? (std::size_t(layout.first_bit) + width + 7) / 8 : width * layout.pixel_bytes;
    layout.end += (height - 1) * layout.row_bytes + last;
  }
  return layout;
}

bool Transfer::changes_colors() const {
  return mode.map_color || mode.scale != glm::vec4(1) || mode.bias != glm::vec4(0);
}

void Transfer::change(double* color) const {
  for (int i = 0; i < 4; ++i) {
    color[i] = unit(color[i] * double(mode.scale[i]) + double(mode.bias[i]));
    if (mode.map_color)
      color[i] = looked_up(maps[std::size_t(GL_PIXEL_MAP_R_TO_R - GL_PIXEL_MAP_I_TO_I + i)], color[i]);
  }
}

void Transfer::color_of_index(double index, double* color) const {
  const std::int64_t i = shifted_index(mode, index);
  for (int k = 0; k < 4; ++k) color[k] = looked_up(maps[std::size_t(GL_PIXEL_MAP_I_TO_R - GL_PIXEL_MAP_I_TO_I + k)], i);
}

std::uint32_t Transfer::stencil(double index) const {
  const std::int64_t i = shifted_index(mode, index);
  if (!mode.map_stencil) return std::uint32_t(i) & 0xFF;
  return std::uint32_t(std::int64_t(looked_up(maps[GL_PIXEL_MAP_S_TO_S - GL_PIXEL_MAP_I_TO_I], i))) & 0xFF;
}

std::uint32_t Transfer::change_word(PixelKind kind, std::uint32_t word) const {
  if (kind == PixelKind::depth) return scaled(depth(word / 16777215.0), 16777215.0);
  if (kind == PixelKind::stencil) return stencil(word);
  double color[4];
  for (int i = 0; i < 4; ++i) color[i] = (word >> 8 * i & 0xFF) / 255.0;
  change(color);
  word = 0;
  for (int i = 0; i < 4; ++i) word |= scaled(unit(color[i]), 255) << 8 * i;
  return word;
}

}  // namespace frontmost::gl_detail
