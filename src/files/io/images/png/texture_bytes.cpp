// SPDX-License-Identifier: Apache-2.0
// Textures to PNG, by libpng's simplified interface.
#include "io/images/png/texture_bytes.h"

#include <png.h>

namespace frontmost::detail {

std::string png_bytes(const Texture& texture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(texture.width);
  image.height = png_uint_32(texture.height);
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  std::string bytes;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, texture.pixels.data(), 0, nullptr) != 0) {
    bytes.resize(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, texture.pixels.data(), 0, nullptr) != 0) return bytes;
  }
  throw Error(ErrorCode::limit_exceeded, "texture " + texture.name,
              std::string("cannot be written as PNG: ") + image.message);
}

}  // namespace frontmost::detail
