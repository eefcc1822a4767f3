// SPDX-License-Identifier: Apache-2.0
// Images from PNG files: the inverse of save.cpp, and colours from other programs' files.
#include <cmath>
#include <locale>
#include <map>
#include <sstream>

#include "base/srgb.h"
#include "io/images/formats.h"
#include "io/images/png/reader.h"
#include "io/images/png/text.h"

namespace frontmost::detail {
namespace {

using Texts = std::map<std::string, std::string>;

/// Adds a channel and returns its values.
template <class T>
T* add_channel(Image& image, const std::string& name) {
  Buffer<T> values(std::size_t(image.width) * std::size_t(image.height));
  image.channels.push_back({name, std::move(values)});
  return std::get<Buffer<T>>(image.channels.back().values).data();
}

/// Colours as load_image() returns them: linear, premultiplied. `linear` turns a stored value into a linear one.
template <class Value, class Linear>
void unpack_colors(const Buffer<Value>& pixels, Image& image, Linear&& linear) {
  constexpr float most = float(std::numeric_limits<Value>::max());
  float* planes[4];
  image.channels.reserve(4);
  for (int i = 0; i < 4; ++i) planes[i] = add_channel<float>(image, std::string(1, "RGBA"[i]));
  for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
    const float alpha = float(pixels[4 * i + 3]) / most;
    for (std::size_t c = 0; c < 3; ++c) planes[c][i] = linear(pixels[4 * i + c]) * alpha;
    planes[3][i] = alpha;
  }
}

/// Directions as save.cpp writes them.
template <class Value>
void unpack_directions(const Buffer<Value>& pixels, Image& image) {
  constexpr int middle = (std::numeric_limits<Value>::max() + 1) / 2;
  float* planes[3];
  image.channels.reserve(3);
  for (int i = 0; i < 3; ++i) planes[i] = add_channel<float>(image, std::string("N.") + "XYZ"[i]);
  for (std::size_t i = 0; i < pixels.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) planes[c][i] = float(int(pixels[4 * i + c]) - middle) / float(middle - 1);
}

template <class Value, class Linear>
void unpack(const Buffer<Value>& pixels, bool directions, Image& image, Linear&& linear) {
  if (directions) {
    unpack_directions(pixels, image);
  } else {
    unpack_colors(pixels, image, linear);
  }
}

std::size_t pixel_count(const Image& image) { return std::size_t(image.width) * std::size_t(image.height); }

void load_pixels(PngReader& reader, bool directions, Image& image) {
  if (reader.bits() <= 8) {
    Buffer<std::uint8_t> pixels(pixel_count(image) * 4);
    reader.read(PngReader::Pixels::rgba8, pixels.data());
    unpack(pixels, directions, image, [](std::uint8_t value) { return linear_of_srgb8(value); });
    return;
  }
  Buffer<std::uint16_t> pixels(pixel_count(image) * 4);
  reader.read(PngReader::Pixels::rgba16, pixels.data());
  // A table of all 65536 values pays off if there are at least as many pixels.
  if (pixel_count(image) < 65536)
    return unpack(pixels, directions, image, [](std::uint16_t value) { return linear_of_srgb16(value); });
  Buffer<float> table(65536);
  for (std::size_t value = 0; value < table.size(); ++value) table[value] = linear_of_srgb16(std::uint16_t(value));
  unpack(pixels, directions, image, [&](std::uint16_t value) { return table[value]; });
}

double number(const Texts& texts, const char* key, const std::string& name) {
  const auto found = texts.find(key);
  std::istringstream text(found == texts.end() ? std::string() : found->second);
  text.imbue(std::locale::classic());
  double value = 0;
  if (!(text >> value) || !std::isfinite(value))
    throw Error(ErrorCode::file_malformed, name, "PNG", std::string("text ") + key + " is not a number");
  return value;
}

/// A depth or id map, as described by the file's text chunks.
void load_map(PngReader& reader, const Texts& texts, const std::string& name, Image& image) {
  const std::string& channel = texts.at(png_channel_key);
  const bool ids = texts.count(png_ids_key) != 0;
  const double scale = ids ? 1 : number(texts, png_scale_key, name);
  const double offset = ids ? 0 : number(texts, png_offset_key, name);
  if (scale == 0) throw Error(ErrorCode::file_malformed, name, "PNG", "the depth scale is 0");
  Buffer<std::uint16_t> pixels(pixel_count(image));
  reader.read(PngReader::Pixels::grey16, pixels.data());
  if (ids) {
    std::uint32_t* out = add_channel<std::uint32_t>(image, channel);
    for (const std::uint16_t value : pixels) *out++ = std::uint32_t(value) - 1;  // 0 wraps to the id for none
  } else {
    float* out = add_channel<float>(image, channel);
    for (const std::uint16_t value : pixels)
      *out++ = value ? float((double(value) - offset) / scale) : std::numeric_limits<float>::infinity();
  }
}

}  // namespace

Image load_png(std::span<const std::byte> bytes, const std::string& name) {
  PngReader reader(bytes, name, PngReader::Texts::kept);
  const Texts texts = reader.texts();
  Image image{reader.width(), reader.height(), {}};
  const auto channel = texts.find(png_channel_key);
  if (channel != texts.end() && reader.is_grey() && reader.bits() == 16) {
    load_map(reader, texts, name, image);
  } else {
    load_pixels(reader, channel != texts.end() && channel->second == "N", image);
  }
  return image;
}

}  // namespace frontmost::detail
