// SPDX-License-Identifier: Apache-2.0
#include "io/images/png/reader.h"

#include <bit>
#include <csetjmp>
#include <cstring>
#include <string_view>
#include <vector>

#include "io/images/decode.h"

namespace frontmost::detail {
namespace {

/// Chunks that libpng must not see: none of them changes a pixel here, and compressed ones may be huge.
constexpr png_byte unread_chunks[] = "iCCP\0zTXt\0iTXt\0eXIf\0sPLT\0hIST\0gAMA\0cHRM\0sRGB";
constexpr png_byte text_chunk[] = "tEXt";

std::size_t pixel_bytes(PngReader::Pixels pixels) {
  switch (pixels) {
    case PngReader::Pixels::rgba8: return 4;
    case PngReader::Pixels::rgba16: return 8;
    case PngReader::Pixels::grey16: return 2;
  }
  return 0;
}

/// Whether each chunk up to the last lies within the file. libpng allocates and clears memory by a chunk's stated
/// length before it finds that the file ends; its own limit only causes a warning.
bool chunks_fit(std::span<const std::byte> bytes) {
  constexpr std::size_t signature = 8, frame = 12;  // length, type and checksum
  constexpr std::string_view last = "IEND";
  for (std::size_t place = signature; place + frame <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[place + i]);
    if (length > bytes.size() - place - frame) return false;
    if (std::memcmp(&bytes[place + 4], last.data(), last.size()) == 0) return true;
    place += frame + length;
  }
  return false;
}

}  // namespace

// libpng reports errors by longjmp, which must not pass over C++ objects. The functions that call setjmp (read_header,
// read_rows) hold none; their data lies in the reader.

PngReader::PngReader(std::span<const std::byte> bytes, const std::string& name, Texts texts)
    : rest_(bytes), name_(name), keeps_texts_(texts == Texts::kept) {
  try {
    if (!chunks_fit(bytes)) throw Error(ErrorCode::file_malformed, name_, "PNG", "ends too early");
    if (!read_header()) fail();
    const std::uint64_t width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
    bits_ = png_get_bit_depth(png_, info_);
    grey_ = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY;
    // Deflate makes at most 258 bytes of two bits.
    check_image_size(name_, width, height, bytes.size(), 258 * 4 * 8.0 / (bits_ * png_get_channels(png_, info_)));
    width_ = int(width);
    height_ = int(height);
  } catch (...) {
    png_destroy_read_struct(&png_, &info_, nullptr);
    throw;
  }
}

PngReader::~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

void PngReader::fail() const {
  throw Error(ErrorCode::file_malformed, name_, "PNG", (message_[0] ? message_ : "cannot be read"));
}

void PngReader::on_error(png_structp png, png_const_charp message) {
  PngReader& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader.message_, message, sizeof reader.message_ - 1);
  png_longjmp(png, 1);
}

void PngReader::on_warning(png_structp, png_const_charp) {}

void PngReader::read_bytes(png_structp png, png_bytep out, std::size_t count) {
  PngReader& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader.rest_.size()) png_error(png, "ends too early");
  std::memcpy(out, reader.rest_.data(), count);
  reader.rest_ = reader.rest_.subspan(count);
}

bool PngReader::read_header() {
  png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
  if (png_ == nullptr || setjmp(png_jmpbuf(png_))) return false;
  info_ = png_create_info_struct(png_);
  if (info_ == nullptr) png_error(png_, "out of memory");
  png_set_read_fn(png_, this, read_bytes);
  // All sizes pass here; check_image_size() reports the limit in the same words for all formats.
  png_set_user_limits(png_, 0x7FFFFFFF, 0x7FFFFFFF);
  png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, unread_chunks, int(sizeof unread_chunks / 5));
  if (!keeps_texts_) png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, text_chunk, 1);
  png_read_info(png_, info_);
  return true;
}

std::map<std::string, std::string> PngReader::texts() const {
  std::map<std::string, std::string> result;
  png_textp texts = nullptr;
  const int count = png_get_text(png_, info_, &texts, nullptr);
  for (int i = 0; i < count; ++i) result[texts[i].key] = std::string(texts[i].text, texts[i].text_length);
  return result;
}

void PngReader::read(Pixels pixels, void* out) {
  const std::size_t row_bytes = std::size_t(width_) * pixel_bytes(pixels);
  std::vector<png_bytep> rows(static_cast<std::size_t>(height_));
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = static_cast<png_bytep>(out) + y * row_bytes;
  if (!read_rows(pixels, rows.data(), row_bytes)) fail();
}

/// Converts the file's pixels to `pixels` and fills `rows`, with all passes of interlaced images.
bool PngReader::read_rows(Pixels pixels, png_bytep* rows, std::size_t row_bytes) {
  if (setjmp(png_jmpbuf(png_))) return false;
  if (pixels == Pixels::rgba8) {
    png_set_expand(png_);
    png_set_scale_16(png_);
  } else {
    png_set_expand_16(png_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
  }
  if (pixels != Pixels::grey16) {
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, pixels == Pixels::rgba8 ? 0xFF : 0xFFFF, PNG_FILLER_AFTER);
  }
  png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  if (png_get_rowbytes(png_, info_) != row_bytes) png_error(png_, "unexpected row size");
  png_read_image(png_, rows);
  png_read_end(png_, nullptr);
  return true;
}

}  // namespace frontmost::detail
