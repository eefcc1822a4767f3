// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg-turbo. Files are written in baseline JPEG with colours at full resolution. Halved colours, the
// library's default, make files of rendered pictures a sixth to a quarter smaller, but double the greatest error at
// edges of colours. Baseline and progressive files are read, with grey, colour and four-ink images.
//
// libjpeg reports errors by longjmp, which must not pass over C++ objects. The functions that call setjmp have no such
// objects; their data lies in JpegWriter and JpegReader.
// clang-format off
#include <cstdio>  // jpeglib.h needs it first
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <exception>
#include <new>

#include "base/parallel.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

constexpr int most_jpeg_side = 65500;

class JpegWriter {
 public:
  JpegWriter() {
    jpeg_.err = jpeg_std_error(&errors_);
    jpeg_.client_data = this;
    errors_.error_exit = [](j_common_ptr common) {
      JpegWriter& writer = *static_cast<JpegWriter*>(common->client_data);
      writer.errors_.format_message(common, writer.message_);
      std::longjmp(writer.jump_, 1);
    };
    errors_.output_message = [](j_common_ptr) {};
    destination_.init_destination = [](j_compress_ptr) {};
    destination_.empty_output_buffer = [](j_compress_ptr jpeg) -> boolean {
      return static_cast<JpegWriter*>(jpeg->client_data)->grow() ? TRUE : FALSE;
    };
    destination_.term_destination = [](j_compress_ptr) {};
    grow();
  }
  ~JpegWriter() { jpeg_destroy_compress(&jpeg_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  [[nodiscard]] bool begin(int width, int height, int quality) {
    if (setjmp(jump_)) return false;
    jpeg_create_compress(&jpeg_);
    jpeg_.dest = &destination_;
    jpeg_.image_width = JDIMENSION(width);
    jpeg_.image_height = JDIMENSION(height);
    jpeg_.input_components = 3;
    jpeg_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg_);
    jpeg_set_quality(&jpeg_, quality, TRUE);
    jpeg_.comp_info[0].h_samp_factor = jpeg_.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg_, TRUE);
    return true;
  }
  [[nodiscard]] bool put(std::uint8_t* row) {
    if (setjmp(jump_)) return false;
    return jpeg_write_scanlines(&jpeg_, &row, 1) == 1;
  }
  [[nodiscard]] bool end() {
    if (setjmp(jump_)) return false;
    jpeg_finish_compress(&jpeg_);
    return true;
  }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return std::as_bytes(std::span(bytes_)).first(bytes_.size() - destination_.free_in_buffer);
  }
  [[nodiscard]] const char* message() const { return message_; }

 private:
  /// Enlarges the buffer; the library calls this function when the buffer is full. The library's own memory destination
  /// is not used, because nobody can tell who owns its buffer if the work is interrupted. \returns false if memory is
  /// exhausted, which the library reports as an error.
  bool grow() noexcept {
    const std::size_t filled = bytes_.size();
    try {
      bytes_.resize(std::max<std::size_t>(1 << 16, 2 * filled));
    } catch (const std::exception&) {
      return false;
    }
    destination_.next_output_byte = bytes_.data() + filled;
    destination_.free_in_buffer = bytes_.size() - filled;
    return true;
  }

  jpeg_compress_struct jpeg_{};
  jpeg_destination_mgr destination_{};
  jpeg_error_mgr errors_{};
  std::jmp_buf jump_{};
  char message_[JMSG_LENGTH_MAX] = "";
  std::vector<std::uint8_t> bytes_;
};

/// Limit of scans in a progressive file. Each scan is a pass over the whole image, and a file of a few kilobytes can
/// hold thousands of them; real files have about ten.
constexpr int max_scans = 200;
/// Limit of scans times pixels, for large images: 16 scans at the greatest size.
constexpr std::uint64_t max_scanned_pixels = 16 * max_image_pixels;

struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  char message[JMSG_LENGTH_MAX] = "";

  JpegReader() {
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = this;
    errors.error_exit = [](j_common_ptr common) { of(common).fail(); };
    errors.emit_message = [](j_common_ptr common, int level) { of(common).on_message(level); };
    errors.output_message = [](j_common_ptr) {};
    progress.progress_monitor = [](j_common_ptr common) { of(common).check_scans(); };
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  static JpegReader& of(j_common_ptr common) { return *static_cast<JpegReader*>(common->client_data); }

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

bool read_header(JpegReader& reader, const unsigned char* bytes, std::size_t count) {
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

bool read_rows(JpegReader& reader, unsigned char* pixels, std::size_t row_bytes) {
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

/// Converts four inks to colours. Adobe writes inverted inks (0 is full ink), other programs do not.
void inks_to_rgb(Texture& texture, bool inverted) {
  for (glm::u8vec4& pixel : texture.pixels) {
    const glm::uvec4 paper = inverted ? glm::uvec4(pixel) : 255u - glm::uvec4(pixel);
    pixel = glm::u8vec4((glm::uvec3(paper) * paper.w + 127u) / 255u, 255);
  }
}

[[noreturn]] void fail_jpeg(const JpegReader& reader, const std::string& name) {
  throw Error(reader.jpeg.arith_code ? ErrorCode::unsupported : ErrorCode::file_malformed, name, "JPEG",
              (reader.message[0] ? reader.message : "cannot be read"));
}

}  // namespace

void save_jpeg(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution) {
  if (std::max(picture.width, picture.height) > most_jpeg_side)
    throw Error(
        ErrorCode::limit_exceeded, file.name(), "",
        "JPEG holds at most 65500 pixels on a side, not " + std::to_string(std::max(picture.width, picture.height)));
  if (picture.with_alpha)
    throw Error(ErrorCode::unsupported, file.name(), "",
                "JPEG holds no alpha, and parts of the picture are transparent; write PNG or WebP");
  JpegWriter writer;
  const auto check = [&](bool done) {
    if (!done && *writer.message() == '\0') throw std::bad_alloc();
    if (!done) throw Error(ErrorCode::file_unwritable, file.name(), "JPEG", writer.message());
  };
  check(writer.begin(picture.width, picture.height, quality));
  Buffer<std::uint8_t> row(picture.row_bytes());
  for (int y = 0; y < picture.height; ++y) {
    check_cancelled(execution);
    picture.row(y, row.data());
    check(writer.put(row.data()));
  }
  check(writer.end());
  file.write(writer.bytes());
}

Texture decode_jpeg(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  JpegReader reader;
  if (!read_header(reader, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) fail_jpeg(reader, name);
  const std::uint64_t width = reader.jpeg.image_width, height = reader.jpeg.image_height;
  // Each block of 64 luminance samples takes at least one bit.
  check_image_size(name, width, height, bytes.size(), 64 * 8);

  Texture texture;
  texture.name = name;
  texture.width = int(width);
  texture.height = int(height);
  if (part == ImagePart::size) return texture;
  texture.pixels.resize(width * height);
  if (!read_rows(reader, reinterpret_cast<unsigned char*>(texture.pixels.data()), width * 4)) fail_jpeg(reader, name);
  if (reader.jpeg.out_color_space == JCS_CMYK) inks_to_rgb(texture, reader.jpeg.saw_Adobe_marker != 0);
  return texture;
}

}  // namespace frontmost::detail
