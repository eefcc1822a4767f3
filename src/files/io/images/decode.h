// SPDX-License-Identifier: Apache-2.0
// Texture images: PNG, JPEG and WebP bytes to 8-bit RGBA pixels. `name` begins every message.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "frontmost/files.h"

namespace frontmost {

/// No image is wider or higher than this, and none has more pixels (1 GiB as RGBA).
inline constexpr int max_image_side = 16384;
inline constexpr std::uint64_t max_image_pixels = std::uint64_t(1) << 28;

/// Decodes a PNG, a JPEG or a WebP, told apart by content. Grey, palette and transparent-colour images become RGBA; 16
/// bits are rounded to 8; gamma chunks and colour profiles are left aside, as glTF asks. `name` begins every message.
/// \throws Error file_malformed (truncated files included), unsupported, limit_exceeded.
[[nodiscard]] Texture decode_texture(std::span<const std::byte> bytes, const std::string& name);

/// By `decoder`, where that is not null, else as above. \throws Error also where what it gives is not an image: other
/// sizes than it told, or another number of pixels.
[[nodiscard]] Texture decode_texture(std::span<const std::byte> bytes, const std::string& name,
                                     const ImageDecoder* decoder);

/// Width and height as the file's header states them; the same limits and errors, without decoding.
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name);
/// The same by `decoder`, where that is not null.
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name,
                                      const ImageDecoder* decoder);

/// Whether WebP images can be decoded: by `decoder`, where that is not null, else by this build.
[[nodiscard]] bool decodes_webp(const ImageDecoder* decoder);

}  // namespace frontmost

namespace frontmost::detail {

/// What to read of an image.
enum class ImagePart : std::uint8_t { size, pixels };

[[nodiscard]] Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_webp(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] bool has_webp();

/// The part of every decoder between header and pixels. `densest` is the most pixels that one byte of a valid file can
/// stand for: a header that claims more belongs to a truncated or hostile file, and gets no memory. `format` is
/// the place of an error.
void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::size_t byte_count,
                      double densest, const char* format = "");

}  // namespace frontmost::detail
