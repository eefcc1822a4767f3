// SPDX-License-Identifier: Apache-2.0
// Reader of one PNG, by libpng's classic interface. The simplified interface would apply gamma chunks, which glTF says
// to ignore.
#pragma once

#include <png.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace frontmost::detail {

class PngReader {
 public:
  /// Pixel types that read() can convert any file to. 16-bit values are in the machine's byte order.
  enum class Pixels : std::uint8_t { rgba8, rgba16, grey16 };
  enum class Texts : std::uint8_t { skipped, kept };

  /// Reads everything before the pixels. `name` begins every message. \throws Error file_malformed, limit_exceeded.
  PngReader(std::span<const std::byte> bytes, const std::string& name, Texts texts = Texts::skipped);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int bits() const { return bits_; }
  /// Whether the file has one channel and no palette.
  [[nodiscard]] bool is_grey() const { return grey_; }
  /// Text chunks before the pixels, by keyword.
  [[nodiscard]] std::map<std::string, std::string> texts() const;

  /// Writes all pixels to `out`, which has room for width * height of them. May be called once.
  void read(Pixels pixels, void* out);

 private:
  [[noreturn]] void fail() const;
  bool read_header();
  bool read_rows(Pixels pixels, png_bytep* rows, std::size_t row_bytes);

  static void on_error(png_structp png, png_const_charp message);
  static void on_warning(png_structp png, png_const_charp message);
  static void read_bytes(png_structp png, png_bytep out, std::size_t count);

  std::span<const std::byte> rest_;
  std::string name_;
  bool keeps_texts_;
  char message_[128] = "";
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int width_ = 0, height_ = 0, bits_ = 0;
  bool grey_ = false;
};

}  // namespace frontmost::detail
