// SPDX-License-Identifier: Apache-2.0
// Textures from PNG, by the reader that images use.
#include "io/images/decode.h"

#include "io/images/png/reader.h"

namespace frontmost::detail {

Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  PngReader reader(bytes, name);
  Texture texture;
  texture.name = name;
  texture.width = reader.width();
  texture.height = reader.height();
  if (part == ImagePart::size) return texture;
  texture.pixels.resize(std::size_t(texture.width) * std::size_t(texture.height));
  reader.read(PngReader::Pixels::rgba8, texture.pixels.data());
  return texture;
}

}  // namespace frontmost::detail
