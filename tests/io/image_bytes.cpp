// SPDX-License-Identifier: Apache-2.0
#include "io/image_bytes.h"

// clang-format off
#include <cstdio>  // jpeglib.h needs it first
#include <jpeglib.h>
// clang-format on
#include <png.h>

#include <cstdlib>

namespace frontmost::test {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t count) {
  auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  out.insert(out.end(), first, first + count);
}

int channels_of(int color_type) { return color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1; }

void write_transparency(png_structp png, png_infop info, const PngFlavour& flavour) {
  if (!flavour.transparency.empty())
    png_set_tRNS(png, info, flavour.transparency.data(), int(flavour.transparency.size()), nullptr);
  if (flavour.transparent_grey >= 0) {
    png_color_16 grey{};
    grey.gray = png_uint_16(flavour.transparent_grey);
    png_set_tRNS(png, info, nullptr, 0, &grey);
  }
}

}  // namespace

std::vector<std::byte> encode_png(const PngFlavour& flavour, std::span<const std::uint8_t> rows) {
  std::vector<std::byte> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, png_uint_32(flavour.width), png_uint_32(flavour.height), flavour.bits, flavour.color_type,
               flavour.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
  if (!flavour.palette.empty())
    png_set_PLTE(png, info, reinterpret_cast<png_const_colorp>(flavour.palette.data()),
                 int(flavour.palette.size() / 3));
  write_transparency(png, info, flavour);
  png_set_gAMA(png, info, 1.0);  // readers must not apply this gamma
  png_write_info(png, info);
  const std::size_t row_bytes =
      (std::size_t(flavour.width) * std::size_t(channels_of(flavour.color_type) * flavour.bits) + 7) / 8;
  std::vector<png_bytep> pointers;
  for (int y = 0; y < flavour.height; ++y)
    pointers.push_back(const_cast<png_bytep>(rows.data() + std::size_t(y) * row_bytes));
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

std::vector<std::byte> encode_jpeg(const JpegFlavour& flavour, std::span<const std::uint8_t> samples) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&jpeg, &bytes, &count);
  jpeg.image_width = JDIMENSION(flavour.width);
  jpeg.image_height = JDIMENSION(flavour.height);
  jpeg.input_components = flavour.components;
  jpeg.in_color_space = flavour.components == 1 ? JCS_GRAYSCALE : flavour.components == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg.arith_code = flavour.arithmetic;
  if (flavour.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < flavour.height; ++y) {
    auto* row = const_cast<JSAMPROW>(samples.data() + std::size_t(y) * std::size_t(flavour.width * flavour.components));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> out(first, first + count);
  std::free(bytes);
  jpeg_destroy_compress(&jpeg);
  return out;
}

}  // namespace frontmost::test
