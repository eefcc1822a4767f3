// SPDX-License-Identifier: Apache-2.0
// Reads images and textures: recognizes their formats, holds the limits that all decoders share, and converts
// environments to the one layout that lighting expects.
#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "io/images/formats.h"
#include "io/input_file.h"

namespace frontmost {
namespace {

struct Signature {
  std::size_t offset;
  std::string_view bytes;
  const char* format;
};

using namespace std::string_view_literals;

/// Formats that occur in models but are not read; messages name them instead of calling them broken. Literals with a
/// zero byte inside use the suffix sv, because a plain literal would end at the zero. "MM" alone begins many
/// texts.
constexpr Signature foreign_formats[] = {
    {1, "KTX 20", "KTX2"},
    {1, "KTX 11", "KTX"},
    {0, "DDS ", "DDS"},
    {0, "GIF8", "GIF"},
    {0, "BM", "BMP"},
    {4, "ftypavif", "AVIF"},
    {0, "II*\0"sv, "TIFF"},
    {0, "MM\0*"sv, "TIFF"},
    {0, "8BPS", "PSD"},
    {0, "\x76\x2f\x31\x01", "OpenEXR"},
    {0, "#?RADIANCE", "Radiance"},
};

bool matches(std::span<const std::byte> bytes, std::size_t offset, std::string_view signature) {
  return bytes.size() >= offset + signature.size() &&
         std::memcmp(bytes.data() + offset, signature.data(), signature.size()) == 0;
}

Texture decode(std::span<const std::byte> bytes, const std::string& name, detail::ImagePart part) {
  if (matches(bytes, 0, "\x89PNG\r\n\x1a\n"sv)) return detail::decode_png(bytes, name, part);
  if (matches(bytes, 0, "\xff\xd8\xff"sv)) return detail::decode_jpeg(bytes, name, part);
  if (matches(bytes, 0, "RIFF") && matches(bytes, 8, "WEBP")) return detail::decode_webp(bytes, name, part);
  for (const Signature& foreign : foreign_formats)
    if (matches(bytes, foreign.offset, foreign.bytes))
      throw Error(ErrorCode::unsupported, name, "",
                  std::string(foreign.format) + " images are not supported, only PNG, JPEG and WebP");
  throw Error(ErrorCode::file_malformed, name, "",
              bytes.empty() ? "the image is empty" : "neither PNG nor JPEG nor WebP");
}

/// Runs the caller's decoder. Adds the file's name to its errors, which lack the name.
template <class Ask>
auto ask_decoder(const std::string& name, Ask ask) {
  try {
    return ask();
  } catch (const Error& error) {
    throw error.within(name);
  }
}

/// Returns a value of an environment, replaced as load_environment() documents if it is out of range.
float usable_light(float value) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), greatest_half = 65504;
  if (!(value > 0)) return 0;  // NaN too
  return value == infinity ? greatest_half : std::min(value, max_environment_value);
}

/// Moves the plane `name` out of `image`, or copies the grey plane.
Buffer<float> take_light(Image& image, const char* name, const std::string& file) {
  Channel* channel = image.find(name);
  const bool is_grey = channel == nullptr;
  if (is_grey) channel = image.find("Y");
  if (channel == nullptr || channel->is_integer())
    throw Error(ErrorCode::unsupported, file, "",
                "an environment has channels R, G and B, or Y, not " + detail::channel_list(image));
  return is_grey ? channel->floats() : std::move(channel->floats());
}

Image environment_of(Image image, const std::string& file) {
  if (image.width != 2 * image.height)
    throw Error(ErrorCode::unsupported, file, "",
                "an environment must be twice as wide as high (equirectangular), not " + std::to_string(image.width) +
                    " x " + std::to_string(image.height));
  Image environment{image.width, image.height, {}};
  for (const char* name : {"R", "G", "B"}) {
    environment.channels.push_back({name, take_light(image, name, file)});
    for (float& value : environment.channels.back().floats()) value = usable_light(value);
  }
  return environment;
}

}  // namespace

namespace detail {

void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::size_t byte_count,
                      double densest, const char* format) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width == 0 || height == 0)
    throw Error(ErrorCode::file_malformed, name, format,
                "the image has " + size + " pixels; width and height must be at least 1");
  // The sides are checked first, so that their product stays far below 64 bits.
  if (width > std::uint64_t(max_image_side) || height > std::uint64_t(max_image_side) ||
      width * height > max_image_pixels)
    throw Error(ErrorCode::limit_exceeded, name, format,
                size + " pixels, more than " + std::to_string(max_image_side) + " on a side or " +
                    std::to_string(max_image_pixels) + " in all");
  // A file of some hundred bytes may claim the greatest size. Memory is allocated only if the bytes can hold the
  // pixels.
  if (double(width * height) > densest * double(byte_count))
    throw Error(ErrorCode::file_malformed, name, format,
                std::to_string(byte_count) + " bytes cannot hold " + size + " pixels");
}

}  // namespace detail

bool decodes_webp(const ImageDecoder* decoder) { return decoder != nullptr || detail::has_webp(); }

glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name, const ImageDecoder* decoder) {
  if (decoder == nullptr) {
    const Texture header = decode(bytes, name, detail::ImagePart::size);
    return {header.width, header.height};
  }
  const glm::ivec2 size = ask_decoder(name, [&] { return decoder->size(bytes); });
  constexpr double any_density = double(max_image_pixels);  // callers' formats may be of any density
  detail::check_image_size(name, std::uint64_t(std::max(size.x, 0)), std::uint64_t(std::max(size.y, 0)), 1,
                           any_density);
  return size;
}

Texture decode_texture(std::span<const std::byte> bytes, const std::string& name, const ImageDecoder* decoder) {
  if (decoder == nullptr) return decode(bytes, name, detail::ImagePart::pixels);
  const glm::ivec2 size = texture_size(bytes, name, decoder);
  Texture texture = ask_decoder(name, [&] { return decoder->pixels(bytes); });
  if (glm::ivec2(texture.width, texture.height) != size ||
      texture.pixels.size() != std::size_t(size.x) * std::size_t(size.y))
    throw Error(ErrorCode::bad_argument, name, "",
                "LoadOptions::image_decoder gave pixels of another size than it had stated");
  return texture;
}

Image load_image(const std::string& path) { return load_image(InputFile::open_input(path).bytes(), input_name(path)); }

Image load_image(std::span<const std::byte> bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n\x1a\n"sv)) return detail::load_png(bytes, name);
  if (text.starts_with("\x76\x2f\x31\x01"sv)) return detail::load_exr(bytes, name);
  if (text.starts_with("\x93NUMPY"sv)) return detail::load_npy(bytes, name);
  if (text.starts_with("PF"sv) || text.starts_with("Pf"sv)) return detail::load_pfm(bytes, name);
  if (text.starts_with("#?"sv)) return detail::load_radiance(bytes, name);
  throw Error(ErrorCode::file_malformed, name, "", "neither PNG nor OpenEXR, Radiance, PFM or NPY");
}

Image load_environment(const std::string& path) { return environment_of(load_image(path), input_name(path)); }

Image load_environment(std::span<const std::byte> bytes, const std::string& name) {
  return environment_of(load_image(bytes, name), name);
}

}  // namespace frontmost
