// SPDX-License-Identifier: Apache-2.0
// The image formats behind save() and load_image(), and the decoders that turn PNG, JPEG and WebP into textures of
// 8-bit RGBA.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/output_file.h"
#include "frontmost/files.h"

namespace frontmost {

/// No image is wider or higher than this, and none has more pixels (1 GiB as RGBA).
inline constexpr int max_image_side = 16384;
inline constexpr std::uint64_t max_image_pixels = std::uint64_t(1) << 28;

/// Decodes a texture by `decoder`. If that is null, decodes a PNG, JPEG or WebP, and recognizes the format by content.
/// Grey, palette and transparent-colour images become RGBA. 16 bits are rounded to 8. Gamma chunks and colour profiles
/// are ignored, as glTF asks. `name` begins every message. \throws Error file_malformed (truncated files included),
/// unsupported, limit_exceeded; bad_argument if the decoder's result has not the size that the decoder announced.
[[nodiscard]] Texture decode_texture(std::span<const std::byte> bytes, const std::string& name,
                                     const ImageDecoder* decoder = nullptr);

/// Width and height, by `decoder` or by the file's header, without decoding. Limits and errors as decode_texture().
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name,
                                      const ImageDecoder* decoder = nullptr);

/// Whether WebP images can be decoded, by `decoder` or, if it is null, by this build.
[[nodiscard]] bool decodes_webp(const ImageDecoder* decoder);

}  // namespace frontmost

namespace frontmost::detail {

/// Writers get valid images. \throws Error unsupported, before anything is written, with what the format cannot hold.
void save_png(const Image& image, const SaveOptions& options, OutputFile& file, const Execution& execution);
void save_png(const Bitmap& bitmap, OutputFile& file, const Execution& execution);
void save_exr(const Image& image, OutputFile& file, const Execution& execution);
void save_deep_exr(const DeepImage& image, OutputFile& file, const Execution& execution);
void save_pfm(const Image& image, OutputFile& file);
void save_npy(const Image& image, OutputFile& file);

/// Rows of sRGB bytes with straight alpha: R, G, B or R, G, B, A. Borrows the picture that it was made from.
struct PictureRows {
  int width = 0, height = 0;
  bool with_alpha = false;  ///< whether any pixel is not opaque
  /// Fills row y, from the top. May be called from many threads at once.
  std::function<void(int y, std::uint8_t* row)> row;

  [[nodiscard]] std::size_t row_bytes() const { return std::size_t(with_alpha ? 4 : 3) * std::size_t(width); }
};

/// Returns the rows of a picture whose channels are R, G and B, and perhaps A, all of floats; otherwise nothing.
/// O(pixels), because it looks for alpha.
[[nodiscard]] std::optional<PictureRows> picture_rows(const Image& image);
[[nodiscard]] PictureRows picture_rows(const Bitmap& bitmap);

/// Writers of lossy formats. `quality` is 1 to 100. The writers check the side lengths before they allocate memory.
/// \throws Error limit_exceeded; unsupported for a JPEG of a picture with alpha, or for WebP in a build without
/// libwebp.
void save_jpeg(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);
void save_webp(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);

/// Returns a texture as the bytes of a PNG file with 8 bits per channel and alpha, for model files. \throws Error
/// limit_exceeded if PNG cannot hold the size; unsupported in a build without libpng.
[[nodiscard]] std::string png_bytes(const Texture& texture);

/// Returns the header of a NumPy array file. `type` is Python text; `shape` is numbers separated by commas.
[[nodiscard]] std::string npy_header(const std::string& type, const std::string& shape);

/// Readers check each size against the file's size before they allocate memory. `name` begins every message.
[[nodiscard]] Image load_png(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_exr(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_pfm(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_radiance(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_npy(std::span<const std::byte> bytes, const std::string& name);

/// The part of an image to read: its size alone, or its pixels, too.
enum class ImagePart : std::uint8_t { size, pixels };

[[nodiscard]] Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_webp(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] bool has_webp();
/// A texture of this size, with room for its pixels unless only the size is wanted.
[[nodiscard]] Texture texture_of_size(const std::string& name, int width, int height, ImagePart part);

/// \throws Error limit_exceeded if a side has more pixels than the format holds.
void check_sides(const PictureRows& picture, int most, const char* format, const OutputFile& file);

/// \throws Error file_malformed "name: format: reason".
[[noreturn]] void fail_image(const std::string& name, const char* format, const std::string& reason);

/// Checks a size before any pixel is decoded; every decoder calls this function after it has read the header. `densest`
/// is the greatest number of pixels that one byte of a valid file can hold. A header that claims more belongs to a
/// truncated or hostile file, for which no memory is allocated. `format` is the place of an error.
void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::size_t byte_count,
                      double densest, const char* format = "");

/// Keywords of the text chunks that tell the meaning of the numbers in a PNG map, for load_image().
inline constexpr const char* png_channel_key = "frontmost:channel";  ///< name of the channel; "N" for the three
                                                                     ///< channels of a direction
inline constexpr const char* png_scale_key = "frontmost:scale";      ///< depth = (value - offset) / scale
inline constexpr const char* png_offset_key = "frontmost:offset";
inline constexpr const char* png_ids_key = "frontmost:ids";  ///< marks an id map; id = value - 1

/// Returns a channel's values as they lie in memory, four bytes each.
[[nodiscard]] inline const std::byte* bytes_of(const Channel& channel) {
  return channel.is_integer() ? reinterpret_cast<const std::byte*>(channel.integers().data())
                              : reinterpret_cast<const std::byte*>(channel.floats().data());
}

}  // namespace frontmost::detail
