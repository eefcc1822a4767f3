// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg-turbo: baseline, with colours at full resolution. Halved colours, the library's default, make files
// of rendered pictures a sixth to a quarter smaller, but double the greatest error at edges of colours.
// clang-format off
#include <cstdio>  // jpeglib.h needs it first
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <exception>
#include <new>
#include <vector>

#include "base/parallel.h"
#include "io/images/lossy/lossy.h"

namespace frontmost::detail {
namespace {

/// libjpeg reports errors by longjmp, which must not pass over C++ objects. The functions that call setjmp (`begin`,
/// `put`, `end`) hold none; their data lies here.
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

}  // namespace frontmost::detail
