// SPDX-License-Identifier: Apache-2.0
// Encoded images for tests, in every flavour of PNG and JPEG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace frontmost::test {

struct PngFlavour {
  int width = 1, height = 1;
  int color_type = 6;  ///< as in the header: 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
  int bits = 8;
  bool interlaced = false;
  std::vector<std::uint8_t> palette{};       ///< RGB triples
  std::vector<std::uint8_t> transparency{};  ///< alphas of palette entries
  int transparent_grey = -1;                 ///< the grey that is transparent
};
/// Encodes `rows`, which are packed as PNG packs them, big-endian for 16 bits.
std::vector<std::byte> encode_png(const PngFlavour& flavour, std::span<const std::uint8_t> rows);

struct JpegFlavour {
  int width = 1, height = 1;
  int components = 3;  ///< 1 grey, 3 RGB, 4 CMYK
  bool progressive = false;
  bool arithmetic = false;
};
std::vector<std::byte> encode_jpeg(const JpegFlavour& flavour, std::span<const std::uint8_t> samples);

}  // namespace frontmost::test
