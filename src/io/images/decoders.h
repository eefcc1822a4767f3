// SPDX-License-Identifier: Apache-2.0
// The decoders behind decode_texture(). `name` begins every message.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "frontmost/scene.h"

namespace frontmost::detail {

/// What to read of an image.
enum class ImagePart : std::uint8_t { size, pixels };

[[nodiscard]] Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part);
[[nodiscard]] Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part);

/// The part of every decoder between header and pixels. `densest` is the most pixels that one byte of a valid file can
/// stand for: a header that claims more belongs to a truncated or hostile file, and gets no memory.
void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::size_t byte_count,
                      double densest);

}  // namespace frontmost::detail
