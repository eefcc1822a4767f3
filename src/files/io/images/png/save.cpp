// SPDX-License-Identifier: Apache-2.0
// Turns an image's channels into a PNG file: colours, directions, a depth map or an id map.
#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

#include "image/srgb_pixels.h"
#include "io/images/formats.h"
#include "io/images/picture_rows.h"
#include "io/images/png/text.h"
#include "io/images/png/write.h"

namespace frontmost::detail {
namespace {

using Color = PngContents::Color;

void store_big_endian(std::uint8_t* place, unsigned value) {
  place[0] = std::uint8_t(value >> 8);
  place[1] = std::uint8_t(value);
}

/// `number` with all digits that a double has, whatever the locale.
std::string digits(double number) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << number;
  return text.str();
}

PngContents colors(PictureRows rows) {
  PngContents contents;
  contents.color = rows.with_alpha ? Color::rgba : Color::rgb;
  contents.row = std::move(rows.row);
  return contents;
}

PngContents deep_colors(const ColorPlanes& planes) {
  PngContents contents;
  const bool with_alpha = !planes.is_opaque();
  contents.color = with_alpha ? Color::rgba : Color::rgb;
  contents.bits = 16;
  contents.row = [=](int y, std::uint8_t* row) {
    Buffer<std::uint16_t> values(std::size_t(planes.width) * (with_alpha ? 4 : 3));
    srgb16_row(planes, y, with_alpha, values.data());
    for (std::size_t i = 0; i < values.size(); ++i) store_big_endian(row + 2 * i, values[i]);
  };
  return contents;
}

/// Directions: zero is exactly the middle value, and 1 is the greatest value.
PngContents directions(const Image& image, int bits) {
  PngContents contents;
  contents.bits = bits;
  contents.is_srgb = false;
  contents.texts = {{png_channel_key, "N"}};
  const double middle = bits == 8 ? 128 : 32768;
  contents.row = [&image, middle, bits](int y, std::uint8_t* row) {
    for (int x = 0; x < image.width; ++x)
      for (const Channel& channel : image.channels) {
        const float raw = channel.floats()[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
        const float number = raw == raw ? std::clamp(raw, -1.0f, 1.0f) : 0.0f;
        const auto value = unsigned(std::floor(double(number) * (middle - 1) + middle + 0.5));
        if (bits == 8) *row++ = std::uint8_t(value);
        if (bits == 16) store_big_endian(row, value), row += 2;
      }
  };
  return contents;
}

/// stored = depth * scale + offset, rounded; 0 if the pixel shows nothing.
struct DepthMapping {
  double scale = 1, offset = 0;

  [[nodiscard]] double stored(float depth) const { return std::floor(double(depth) * scale + offset + 0.5); }
};

DepthMapping fitted_mapping(const Buffer<float>& depths) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float depth : depths) {
    if (!std::isfinite(depth)) continue;
    low = std::min(low, depth);
    high = std::max(high, depth);
  }
  if (!(low <= high)) return {1, 0};  // nothing is seen
  // Visible depths map to 1 to 65535; 0 means that the pixel shows nothing.
  const double scale = high > low ? 65534 / (double(high) - double(low)) : 1;
  return {scale, 1 - double(low) * scale};
}

/// A fixed scale promises what the numbers mean, so depths beyond it are an error and are not clipped.
DepthMapping fixed_mapping(const Channel& channel, double scale, const std::string& name) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw Error(ErrorCode::bad_argument, name, "", "the depth scale must be a positive number");
  const DepthMapping mapping{scale, 0};
  for (const float depth : channel.floats())
    if (std::isfinite(depth) && mapping.stored(depth) > 65535)
      throw Error(ErrorCode::limit_exceeded, name, "",
                  "depth " + digits(double(depth)) + " times scale " + digits(scale) +
                      " is over 65535, the most that a PNG can hold");
  return mapping;
}

PngContents grey_map() {
  PngContents contents;
  contents.color = Color::grey;
  contents.bits = 16;
  contents.is_srgb = false;
  return contents;
}

PngContents depth_map(const Image& image, const std::optional<double>& scale, const std::string& name) {
  const Channel& channel = image.channels[0];
  const DepthMapping mapping = scale ? fixed_mapping(channel, *scale, name) : fitted_mapping(channel.floats());
  PngContents contents = grey_map();
  contents.texts = {{png_channel_key, channel.name},
                    {png_scale_key, digits(mapping.scale)},
                    {png_offset_key, digits(mapping.offset)}};
  contents.row = [&image, mapping, fitted = !scale](int y, std::uint8_t* row) {
    const float* depths = image.channels[0].floats().data() + std::size_t(y) * std::size_t(image.width);
    for (int x = 0; x < image.width; ++x) {
      // 0 means that the pixel shows nothing, so visible depths become at least 1. Depths that are not before the eye
      // get 0.
      const bool seen = std::isfinite(depths[x]) && (fitted || depths[x] > 0);
      store_big_endian(row + 2 * x, seen ? unsigned(std::clamp(mapping.stored(depths[x]), 1.0, 65535.0)) : 0);
    }
  };
  return contents;
}

PngContents id_map(const Image& image, const std::string& name) {
  const Channel& channel = image.channels[0];
  for (const std::uint32_t id : channel.integers())
    if (id != no_index && id > 65534)
      throw Error(ErrorCode::limit_exceeded, name, "",
                  "id " + std::to_string(id) + " is over 65534, the most that a PNG can hold; write EXR or NPY");
  PngContents contents = grey_map();
  contents.texts = {{png_channel_key, channel.name}, {png_ids_key, "value - 1, 0 is none"}};
  contents.row = [&image](int y, std::uint8_t* row) {
    const std::uint32_t* ids = image.channels[0].integers().data() + std::size_t(y) * std::size_t(image.width);
    for (int x = 0; x < image.width; ++x) store_big_endian(row + 2 * x, ids[x] + 1);  // the id for none wraps to 0
  };
  return contents;
}

/// Luminance from 0 to 1, for masks.
PngContents grey_picture(const Image& image) {
  PngContents contents;
  contents.color = Color::grey;
  contents.row = [&image](int y, std::uint8_t* row) {
    const float* values = image.channels[0].floats().data() + std::size_t(y) * std::size_t(image.width);
    for (int x = 0; x < image.width; ++x) row[x] = srgb8_of_linear(values[x]);
  };
  return contents;
}

bool holds_directions(const Image& image) {
  constexpr std::string_view names[] = {"N.X", "N.Y", "N.Z"};
  if (image.channels.size() != 3) return false;
  for (std::size_t i = 0; i < 3; ++i)
    if (image.channels[i].name != names[i] || image.channels[i].is_integer()) return false;
  return true;
}

PngContents contents_of(const Image& image, const SaveOptions& options, const std::string& name) {
  if (image.channels.size() == 1 && image.channels[0].name == "Y" && !image.channels[0].is_integer())
    return grey_picture(image);
  if (image.channels.size() == 1)
    return image.channels[0].is_integer() ? id_map(image, name) : depth_map(image, options.depth_scale, name);
  if (holds_directions(image)) return directions(image, options.bits);
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (planes && image.channels.size() == (planes->alpha ? 4u : 3u))
    return options.bits == 8 ? colors(*picture_rows(image)) : deep_colors(*planes);
  throw Error(ErrorCode::unsupported, name, "",
              "PNG holds R, G, B and A, or N.X, N.Y, N.Z, or one channel, not " + channel_list(image));
}

}  // namespace

void save_png(const Image& image, const SaveOptions& options, OutputFile& file, const Execution& execution) {
  if (options.bits != 8 && options.bits != 16)
    throw Error(ErrorCode::bad_argument, file.name(), "", "PNG has 8 or 16 bits, not " + std::to_string(options.bits));
  PngContents contents = contents_of(image, options, file.name());
  contents.width = image.width;
  contents.height = image.height;
  write_png(contents, file, execution);
}

void save_png(const Bitmap& bitmap, OutputFile& file, const Execution& execution) {
  PngContents contents = colors(picture_rows(bitmap));
  contents.width = bitmap.width;
  contents.height = bitmap.height;
  write_png(contents, file, execution);
}

}  // namespace frontmost::detail
