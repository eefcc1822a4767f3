// SPDX-License-Identifier: Apache-2.0
// PNG by libpng's classic interface. The simplified one would apply gamma chunks, which glTF says to ignore.
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <vector>

#include "io/images/decoders.h"

namespace frontmost::detail {
namespace {

/// Chunks that are held back from libpng: none changes a pixel here, and compressed ones may be huge.
constexpr png_byte unread_chunks[] = "iCCP\0zTXt\0iTXt\0tEXt\0eXIf\0sPLT\0hIST\0gAMA\0cHRM\0sRGB";

/// libpng reports errors by longjmp, which must not pass over C++ objects: the functions that set the jump
/// (`read_header`, `read_rows`) hold none, and everything they need lies here.
struct Reader {
  std::span<const std::byte> rest;
  char message[128] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Reader(std::span<const std::byte> bytes) : rest(bytes) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  Reader& reader = *static_cast<Reader*>(png_get_error_ptr(png));
  std::strncpy(reader.message, message, sizeof reader.message - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
  Reader& reader = *static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader.rest.size()) png_error(png, "ends too early");
  std::memcpy(out, reader.rest.data(), count);
  reader.rest = reader.rest.subspan(count);
}

bool read_header(Reader& reader) {
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
  if (reader.png == nullptr || setjmp(png_jmpbuf(reader.png))) return false;
  reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) png_error(reader.png, "out of memory");
  png_set_read_fn(reader.png, &reader, read_bytes);
  // Every size is let through here, so that the limit is told in the same words for all formats.
  png_set_user_limits(reader.png, 0x7FFFFFFF, 0x7FFFFFFF);
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, unread_chunks, int(sizeof unread_chunks / 5));
  png_read_info(reader.png, reader.info);
  return true;
}

/// Turns whatever the file holds into 8-bit RGBA and fills `rows`, all passes of interlaced images included.
bool read_rows(Reader& reader, png_bytep* rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  if (png_get_rowbytes(reader.png, reader.info) != std::size_t(png_get_image_width(reader.png, reader.info)) * 4)
    png_error(reader.png, "unexpected row size");
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

[[noreturn]] void fail(const Reader& reader, const std::string& name) {
  throw Error(ErrorCode::file_malformed, name + ": PNG: " + (reader.message[0] ? reader.message : "cannot be read"));
}

}  // namespace

Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  Reader reader(bytes);
  if (!read_header(reader)) fail(reader, name);
  const std::uint64_t width = png_get_image_width(reader.png, reader.info);
  const std::uint64_t height = png_get_image_height(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info) * png_get_channels(reader.png, reader.info);
  // Deflate cannot do better than 258 bytes for two bits.
  check_image_size(name, width, height, bytes.size(), 258 * 4 * 8.0 / bits);

  Texture texture;
  texture.name = name;
  texture.width = int(width);
  texture.height = int(height);
  if (part == ImagePart::size) return texture;
  texture.pixels.resize(width * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = reinterpret_cast<png_bytep>(texture.pixels.data() + y * width);
  if (!read_rows(reader, rows.data())) fail(reader, name);
  return texture;
}

}  // namespace frontmost::detail
