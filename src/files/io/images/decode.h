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

/// Decodes by `decoder`, unless it is null, else as above. \throws Error also if the decoder's result is no image of
/// the size that the decoder announced, or has another number of pixels.
[[nodiscard]] Texture decode_texture(std::span<const std::byte> bytes, const std::string& name,
                                     const ImageDecoder* decoder);

/// Width and height as the file's header states them, without decoding. Limits and errors are those of
/// decode_texture().
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name);
/// Width and height by `decoder`, unless it is null, else as above.
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name,
                                      const ImageDecoder* decoder);

/// Whether WebP images can be decoded: by `decoder`, unless it is null, else by this build.
[[nodiscard]] bool decodes_webp(const ImageDecoder* decoder);

}  // namespace frontmost

namespace frontmost::detail {

/// The part of an image to read: its size alone, or its pixels, too.
enum class ImagePart : std::uint8_t { size, pixels };

[[nodiscard]] Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_webp(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] bool has_webp();

/// Check of every decoder between header and pixels. `densest` is the greatest number of pixels that one byte of a
/// valid file can hold. A header that claims more belongs to a truncated or hostile file, and no memory is allocated
/// for it. `format` is the place of an error.
void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::size_t byte_count,
                      double densest, const char* format = "");

}  // namespace frontmost::detail
