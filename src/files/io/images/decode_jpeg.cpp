// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg-turbo: baseline and progressive, grey, colour and four-ink images.
// clang-format off
#include <cstdio>  // jpeglib.h needs it first
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "io/images/decode.h"

namespace frontmost::detail {
namespace {

/// Limit of scans in a progressive file. Each scan is a pass over the whole image, and a file of a few kilobytes can
/// hold thousands of them; real files have about ten.
constexpr int max_scans = 200;
/// Limit of scans times pixels, for large images: 16 scans at the greatest size.
constexpr std::uint64_t max_scanned_pixels = 16 * max_image_pixels;

/// libjpeg reports errors by longjmp, which must not pass over C++ objects. The functions that call setjmp
/// (`read_header`, `read_rows`) hold none; their data lies here.
struct Reader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  char message[JMSG_LENGTH_MAX] = "";

  Reader() {
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = this;
    errors.error_exit = [](j_common_ptr common) { of(common).fail(); };
    errors.emit_message = [](j_common_ptr common, int level) { of(common).on_message(level); };
    errors.output_message = [](j_common_ptr) {};
    progress.progress_monitor = [](j_common_ptr common) { of(common).check_scans(); };
  }
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  static Reader& of(j_common_ptr common) { return *static_cast<Reader*>(common->client_data); }

  [[noreturn]] void fail(const char* reason = nullptr) {
    if (reason != nullptr)
      std::strncpy(message, reason, sizeof message - 1);
    else
      errors.format_message(reinterpret_cast<j_common_ptr>(&jpeg), message);
    std::longjmp(jump, 1);
  }
  /// Level -1 means damaged data, which libjpeg repairs. Most damage is harmless, but the lower part of an image that
  /// ends early would be grey.
  void on_message(int level) {
    if (level < 0 && std::strncmp(errors.jpeg_message_table[errors.msg_code], "Premature end", 13) == 0)
      fail("ends too early");
  }
  void check_scans() {
    const auto scans = std::uint64_t(std::max(jpeg.input_scan_number, 0));
    if (scans > max_scans || scans * jpeg.image_width * jpeg.image_height > max_scanned_pixels)
      fail("more scans than an image of its size has");
  }
};

bool read_header(Reader& reader, const unsigned char* bytes, std::size_t count) {
  if (setjmp(reader.jump)) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, bytes, static_cast<unsigned long>(count));
  jpeg_read_header(&reader.jpeg, TRUE);
  if (reader.jpeg.arith_code) reader.fail("arithmetic coding is not supported");
  const bool inks = reader.jpeg.jpeg_color_space == JCS_CMYK || reader.jpeg.jpeg_color_space == JCS_YCCK;
  reader.jpeg.out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
  return true;
}

bool read_rows(Reader& reader, unsigned char* pixels, std::size_t row_bytes) {
  if (setjmp(reader.jump)) return false;
  jpeg_start_decompress(&reader.jpeg);
  if (std::size_t(reader.jpeg.output_width) * 4 != row_bytes || reader.jpeg.output_components != 4)
    reader.fail("unexpected row size");
  while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
    JSAMPROW row = pixels + reader.jpeg.output_scanline * row_bytes;
    jpeg_read_scanlines(&reader.jpeg, &row, 1);
  }
  return true;
}

/// Adobe writes inverted inks (0 is full ink), other programs do not.
void inks_to_rgb(Texture& texture, bool inverted) {
  for (glm::u8vec4& pixel : texture.pixels) {
    const glm::uvec4 paper = inverted ? glm::uvec4(pixel) : 255u - glm::uvec4(pixel);
    pixel = glm::u8vec4((glm::uvec3(paper) * paper.w + 127u) / 255u, 255);
  }
}

[[noreturn]] void fail(const Reader& reader, const std::string& name) {
  throw Error(reader.jpeg.arith_code ? ErrorCode::unsupported : ErrorCode::file_malformed, name, "JPEG",
              (reader.message[0] ? reader.message : "cannot be read"));
}

}  // namespace

Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  Reader reader;
  if (!read_header(reader, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) fail(reader, name);
  const std::uint64_t width = reader.jpeg.image_width, height = reader.jpeg.image_height;
  // Each block of 64 luminance samples takes at least one bit.
  check_image_size(name, width, height, bytes.size(), 64 * 8);

  Texture texture;
  texture.name = name;
  texture.width = int(width);
  texture.height = int(height);
  if (part == ImagePart::size) return texture;
  texture.pixels.resize(width * height);
  if (!read_rows(reader, reinterpret_cast<unsigned char*>(texture.pixels.data()), width * 4)) fail(reader, name);
  if (reader.jpeg.out_color_space == JCS_CMYK) inks_to_rgb(texture, reader.jpeg.saw_Adobe_marker != 0);
  return texture;
}

}  // namespace frontmost::detail
