// SPDX-License-Identifier: Apache-2.0
// Decodes any bytes as a texture: the result has the size that the header states, or an Error names the file.
#include <cstdint>
#include <cstdlib>

#include "io/images/formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  try {
    const glm::ivec2 stated = frontmost::texture_size(bytes, "fuzz");
    // Large pictures only slow the search down.
    if (std::int64_t(stated.x) * stated.y > 1 << 20) return 0;
    const frontmost::Texture texture = frontmost::decode_texture(bytes, "fuzz");
    if (glm::ivec2(texture.width, texture.height) != stated ||
        texture.pixels.size() != std::size_t(stated.x) * std::size_t(stated.y))
      std::abort();
  } catch (const frontmost::Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
  }
  return 0;
}
