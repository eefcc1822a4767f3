// SPDX-License-Identifier: Apache-2.0
// Writes pixels into the memory of the client, in the opposite way of unpack.cpp.

#include "pixels/pack.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace frontmost::gl_detail {
namespace {

template <class T>
void store_value(T value, bool swap, std::uint8_t* to) {
  auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  if (swap) std::reverse(bytes.begin(), bytes.end());
  std::memcpy(to, bytes.data(), bytes.size());
}

/// Values are in [0, 1], or integers from 0 on if they are indexes. A depth of 24 bits in 32 is the exact one rounded.
template <class T>
void write_components(const std::vector<double>& from, bool swap, bool is_index, std::uint8_t* to) {
  for (const double v : from) {
    if constexpr (std::is_floating_point_v<T>) {
      store_value(T(v), swap, to);
    } else {
      const double component = std::is_signed_v<T> ? std::floor(v * kMostOf<T> / 2) : std::floor(v * kMostOf<T> + 0.5);
      // An index keeps the bits that a type has beside its sign.
      store_value(is_index ? T(std::int64_t(v) & std::int64_t(std::numeric_limits<T>::max())) : T(component), swap, to);
    }
    to += sizeof(T);
  }
}

void write_fields(const PixelType& type, const std::vector<double>& from, bool swap, std::uint8_t* to) {
  const auto fields = std::size_t(type.fields);
  for (std::size_t i = 0; i + fields <= from.size(); i += fields, to += type.bytes) {
    std::uint32_t word = 0;
    int low = type.is_reversed ? 0 : 8 * type.bytes;
    for (std::size_t k = 0; k < fields; ++k) {
      const int bits = type.bits[k];
      if (!type.is_reversed) low -= bits;
      word |= scaled(from[i + k], double((1u << bits) - 1)) << low;
      if (type.is_reversed) low += bits;
    }
    if (type.bytes == 1) *to = std::uint8_t(word);
    if (type.bytes == 2) store_value(std::uint16_t(word), swap, to);
    if (type.bytes == 4) store_value(word, swap, to);
  }
}

void write_bits(const std::vector<double>& from, std::size_t first, bool lsb_first, std::uint8_t* to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t at = i + first;
    const auto bit = std::uint8_t(1 << (lsb_first ? at % 8 : 7 - at % 8));
    to[at / 8] = std::uint8_t(std::int64_t(from[i]) & 1 ? to[at / 8] | bit : to[at / 8] & ~bit);
  }
}

void write_row(const ImageLayout& layout, const PixelStore& store, const std::vector<double>& from, std::uint8_t* to) {
  if (layout.type.fields) return write_fields(layout.type, from, store.swap_bytes, to);
  const bool is_index = layout.format.kind == PixelKind::stencil;
  with_component_type(layout.type.name, [&]<class T>(T) { write_components<T>(from, store.swap_bytes, is_index, to); });
}

/// The components of one pixel.
void read_word(const PixelFormat& format, const Transfer& transfer, std::uint32_t word, double* values) {
  if (format.kind == PixelKind::depth) {
    *values = transfer.depth((word >> 8) / 16777215.0);
  } else if (format.kind == PixelKind::stencil) {
    *values = transfer.stencil(word & 0xFF);
  } else {
    double color[5];
    for (int i = 0; i < 4; ++i) color[i] = (word >> 8 * i & 0xFF) / 255.0;
    if (transfer.changes_colors()) transfer.change(color);
    color[kLuminance] = unit(color[0] + color[1] + color[2]);
    for (int k = 0; k < format.components; ++k) values[k] = color[format.channels[std::size_t(k)]];
  }
}

void write_bytes(const std::uint32_t* from, std::size_t count, const PixelFormat& format, std::uint8_t* to) {
  if (format.name == GL_RGBA) return void(std::memcpy(to, from, 4 * count));
  int shifts[4];
  for (std::size_t k = 0; k < 4; ++k) shifts[k] = 8 * format.channels[k];
  for (std::size_t i = 0; format.components == 4 && i < count; ++i) {
    std::uint32_t word = 0;
    for (int k = 0; k < 4; ++k) word |= (from[i] >> shifts[k] & 0xFF) << 8 * k;
    std::memcpy(to + 4 * i, &word, 4);
  }
  for (std::size_t i = 0; format.components != 4 && i < count; ++i) {
    for (int k = 0; k < format.components; ++k) *to++ = std::uint8_t(from[i] >> shifts[k]);
  }
}

}  // namespace

bool pack(const WordRows& rows, const Transfer& transfer, const ClientTarget& target) {
  const std::optional<ImageLayout> layout = image_layout(target.store, target.shape);
  if (!layout) return false;
  const WindowRect& part = rows.part;
  if (!target.pixels || part.width <= 0 || part.height <= 0) return true;
  const PixelFormat& format = layout->format;
  const auto width = std::size_t(part.width), components = std::size_t(format.components);
  const bool has_bytes =
      has_color_bytes(*layout, target.store) && format.channels[0] != kLuminance && !transfer.changes_colors();
  std::optional<std::vector<double>> values = allocated<double>(has_bytes ? 0 : width * components);
  if (!values) return false;
  for (int row = 0; row < part.height; ++row) {
    std::uint8_t* const to = static_cast<std::uint8_t*>(target.pixels) + layout->first +
                             std::size_t(part.y + row) * layout->row_bytes + std::size_t(part.x) * layout->pixel_bytes;
    const std::uint32_t* const from = rows.words + std::size_t(row) * rows.stride;
    if (has_bytes) {
      write_bytes(from, width, format, to);
    } else {
      for (std::size_t x = 0; x < width; ++x) read_word(format, transfer, from[x], &(*values)[components * x]);
      if (layout->type.bytes) {
        write_row(*layout, target.store, *values, to);
      } else {
        write_bits(*values, std::size_t(layout->first_bit) + std::size_t(part.x), target.store.lsb_first, to);
      }
    }
  }
  return true;
}

}  // namespace frontmost::gl_detail
