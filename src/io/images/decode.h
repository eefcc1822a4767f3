// SPDX-License-Identifier: Apache-2.0
// Texture images: PNG and JPEG bytes to 8-bit RGBA pixels.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "frontmost/scene.h"

namespace frontmost {

/// No image is wider or higher than this, and none has more pixels (1 GiB as RGBA).
inline constexpr int max_image_side = 16384;
inline constexpr std::uint64_t max_image_pixels = std::uint64_t(1) << 28;

/// Decodes a PNG or a JPEG, told apart by content. Grey, palette and transparent-colour images become RGBA; 16 bits
/// are rounded to 8; gamma chunks and colour profiles are left aside, as glTF asks. `name` begins every message.
/// \throws Error file_malformed (truncated files included), unsupported, limit_exceeded.
[[nodiscard]] Texture decode_texture(std::span<const std::byte> bytes, const std::string& name);

/// Width and height as the file's header states them; the same limits and errors, without decoding.
[[nodiscard]] glm::ivec2 texture_size(std::span<const std::byte> bytes, const std::string& name);

}  // namespace frontmost
