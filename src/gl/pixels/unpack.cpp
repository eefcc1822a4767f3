// SPDX-License-Identifier: Apache-2.0
// Reads pixels from the memory of the client: each row becomes doubles, then colors, depths or stencil values. Colors
// of bytes without transfer operations take a path of their own, which gives the same values.

#include "pixels/unpack.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace frontmost::gl_detail {
namespace {

static_assert(std::endian::native == std::endian::little, "words of colors are copied as bytes");

template <class T>
T loaded(const std::uint8_t* from, bool swap) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof bytes);
  if (swap) std::reverse(bytes, bytes + sizeof bytes);
  return std::bit_cast<T>(bytes);
}

/// Components become [0, 1] or [-1, 1]; those of indexes stay.
template <class T>
void read_components(const std::uint8_t* from, bool swap, bool is_index, std::vector<double>& to) {
  for (double& v : to) {
    v = double(loaded<T>(from, swap));
    if (!is_index && std::is_integral_v<T>) v = std::is_signed_v<T> ? (2 * v + 1) / kMostOf<T> : v / kMostOf<T>;
    from += sizeof(T);
  }
}

void read_fields(const PixelType& type, const std::uint8_t* from, bool swap, std::vector<double>& to) {
  const auto fields = std::size_t(type.fields);
  for (std::size_t i = 0; i + fields <= to.size(); i += fields, from += type.bytes) {
    const std::uint32_t word = type.bytes == 1   ? *from
                               : type.bytes == 2 ? loaded<std::uint16_t>(from, swap)
                                                 : loaded<std::uint32_t>(from, swap);
    int low = type.is_reversed ? 0 : 8 * type.bytes;
    for (std::size_t k = 0; k < fields; ++k) {
      const int bits = type.bits[k];
      if (!type.is_reversed) low -= bits;
      const std::uint32_t most = (1u << bits) - 1;
      to[i + k] = (word >> low & most) / double(most);
      if (type.is_reversed) low += bits;
    }
  }
}

template <class T>
void read_bits(const std::uint8_t* from, int first, bool lsb_first, std::size_t count, T* to) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i + std::size_t(first);
    to[i] = T(from[at / 8] >> (lsb_first ? at % 8 : 7 - at % 8) & 1);
  }
}

void read_row(const ImageLayout& layout, const PixelStore& store, const std::uint8_t* from, std::vector<double>& to) {
  if (layout.type.fields) return read_fields(layout.type, from, store.swap_bytes, to);
  const bool is_index = layout.format.kind == PixelKind::index || layout.format.kind == PixelKind::stencil;
  if (layout.pixel_bytes == 0) return read_bits(from, layout.first_bit, store.lsb_first, to.size(), to.data());
  with_component_type(layout.type.name, [&]<class T>(T) { read_components<T>(from, store.swap_bytes, is_index, to); });
}

/// One pixel of `values`, which are the components of one pixel.
std::uint32_t word_of(const PixelFormat& format, const Transfer& transfer, bool changes_colors, const double* values) {
  if (format.kind == PixelKind::depth) return scaled(transfer.depth(*values), 16777215.0);
  if (format.kind == PixelKind::stencil) return transfer.stencil(*values);
  double color[4] = {0, 0, 0, 1};
  if (format.kind == PixelKind::index) {
    transfer.color_of_index(*values, color);
  } else {
    for (int k = 0; k < format.components; ++k) {
      const int channel = format.channels[std::size_t(k)];
      if (channel == kLuminance) {
        color[0] = color[1] = color[2] = values[k];
      } else {
        color[channel] = values[k];
      }
    }
    if (changes_colors) transfer.change(color);
  }
  std::uint32_t word = 0;
  for (int i = 0; i < 4; ++i) word |= scaled(unit(color[i]), 255) << 8 * i;
  return word;
}

/// A row of colors of `n` bytes each. A component times its factor is the part of the word that it sets.
template <std::size_t n>
void read_bytes(const std::uint8_t* from, std::size_t count, const PixelFormat& format, std::uint32_t* to) {
  std::array<std::uint32_t, n> factors;
  std::uint32_t rest = 0xFF000000;
  for (std::size_t k = 0; k < n; ++k) {
    factors[k] = format.channels[k] == kLuminance ? 0x010101u : 1u << 8 * format.channels[k];
    if (format.channels[k] == 3) rest = 0;
  }
  for (std::size_t i = 0; i < count; ++i, from += n) {
    std::uint32_t word = rest;
    for (std::size_t k = 0; k < n; ++k) word |= from[k] * factors[k];
    to[i] = word;
  }
}

void read_bytes(const std::uint8_t* from, std::size_t count, const PixelFormat& format, std::uint32_t* to) {
  if (format.name == GL_RGBA) return void(std::memcpy(to, from, 4 * count));
  switch (format.components) {
    case 1: return read_bytes<1>(from, count, format, to);
    case 2: return read_bytes<2>(from, count, format, to);
    case 3: return read_bytes<3>(from, count, format, to);
    default: return read_bytes<4>(from, count, format, to);
  }
}

}  // namespace

void ClientImage::keep() {
  const std::optional<ImageLayout> layout = pixels ? image_layout(store, shape) : std::nullopt;
  if (!layout) return;
  std::optional<std::vector<std::uint8_t>> copy = allocated<std::uint8_t>(layout->end - layout->first);
  is_lost = !copy;
  if (!copy) return;
  if (!copy->empty()) std::memcpy(copy->data(), static_cast<const std::uint8_t*>(pixels) + layout->first, copy->size());
  if (store.row_length == 0) store.row_length = shape.width;
  store.skip_rows = 0;
  store.skip_pixels = layout->first_bit;
  kept = std::make_shared<const std::vector<std::uint8_t>>(std::move(*copy));
  pixels = kept->data();
}

std::optional<std::vector<std::uint32_t>> unpack(const ClientImage& image, const Transfer& transfer) {
  const std::optional<ImageLayout> layout = image_layout(image.store, image.shape);
  if (!layout || image.is_lost) return std::nullopt;
  const auto width = std::size_t(image.shape.width), height = std::size_t(image.shape.height);
  std::optional<std::vector<std::uint32_t>> words = allocated<std::uint32_t>(width * height);
  if (!words || words->empty() || !image.pixels) return words;
  const PixelFormat& format = layout->format;
  const bool changes_colors = format.kind == PixelKind::color && transfer.changes_colors();
  const bool has_bytes = has_color_bytes(*layout, image.store) && !changes_colors;
  const auto components = std::size_t(format.components);
  std::optional<std::vector<double>> values = allocated<double>(has_bytes ? 0 : width * components);
  if (!values) return std::nullopt;
  for (std::size_t y = 0; y < height; ++y) {
    const auto* const from = static_cast<const std::uint8_t*>(image.pixels) + layout->first + y * layout->row_bytes;
    std::uint32_t* const to = words->data() + y * width;
    if (has_bytes) {
      read_bytes(from, width, format, to);
      continue;
    }
    read_row(*layout, image.store, from, *values);
    for (std::size_t x = 0; x < width; ++x)
      to[x] = word_of(format, transfer, changes_colors, &(*values)[components * x]);
  }
  return words;
}

std::optional<std::vector<std::uint8_t>> unpack_bitmap(const PixelStore& store, int width, int height,
                                                       const GLubyte* bits) {
  const std::optional<ImageLayout> layout = image_layout(store, {width, height, GL_COLOR_INDEX, GL_BITMAP});
  if (!layout) return std::nullopt;
  const auto columns = std::size_t(width);
  std::optional<std::vector<std::uint8_t>> values = allocated<std::uint8_t>(columns * std::size_t(height));
  if (!values || values->empty() || !bits) return values;
  for (std::size_t y = 0; y < std::size_t(height); ++y) {
    const GLubyte* const from = bits + layout->first + y * layout->row_bytes;
    read_bits(from, layout->first_bit, store.lsb_first, columns, values->data() + y * columns);
  }
  return values;
}

}  // namespace frontmost::gl_detail
