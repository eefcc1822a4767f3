// SPDX-License-Identifier: Apache-2.0
// Reads PNG files: textures, and images that write.cpp or other programs have made. Uses libpng's classic interface,
// because the simplified one would apply gamma chunks, which glTF says to ignore.
#include <png.h>

#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <locale>
#include <map>
#include <sstream>

#include "base/srgb.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

/// Chunks that libpng must not see. None of them changes a pixel here, and compressed ones may be huge.
constexpr png_byte unread_chunks[] = "iCCP\0zTXt\0iTXt\0eXIf\0sPLT\0hIST\0gAMA\0cHRM\0sRGB";
constexpr png_byte text_chunk[] = "tEXt";

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

/// libpng reports errors by longjmp, which must not pass over C++ objects. The functions that call setjmp (read_header,
/// read_rows) have no such objects; their data lies in the reader.
class PngReader {
 public:
  /// Pixel types that read() can convert any file to. 16-bit values are in the machine's byte order.
  enum class Pixels : std::uint8_t { rgba8, rgba16, grey16 };

  /// Reads everything before the pixels. `name` begins every message. \throws Error file_malformed, limit_exceeded.
  PngReader(std::span<const std::byte> bytes, const std::string& name, bool keeps_texts) : rest_(bytes), name_(name) {
    try {
      if (!chunks_fit(bytes)) throw Error(ErrorCode::file_malformed, name_, "PNG", "ends too early");
      if (!read_header(keeps_texts)) fail();
      const std::uint64_t width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
      bits_ = png_get_bit_depth(png_, info_);
      // Deflate makes at most 258 bytes out of two bits.
      check_image_size(name_, width, height, bytes.size(), 258 * 4 * 8.0 / (bits_ * png_get_channels(png_, info_)));
      width_ = int(width);
      height_ = int(height);
    } catch (...) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int bits() const { return bits_; }
  /// Whether the file has one channel and no palette.
  [[nodiscard]] bool is_grey() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY; }

  /// Returns the texts of the chunks before the pixels, by keyword.
  [[nodiscard]] std::map<std::string, std::string> texts() const {
    std::map<std::string, std::string> result;
    png_textp texts = nullptr;
    const int count = png_get_text(png_, info_, &texts, nullptr);
    for (int i = 0; i < count; ++i) result[texts[i].key] = std::string(texts[i].text, texts[i].text_length);
    return result;
  }

  /// Writes all pixels to `out`, which has room for width * height of them. May be called once.
  void read(Pixels pixels, void* out) {
    const std::size_t row_bytes = std::size_t(width_) * (pixels == Pixels::rgba8    ? 4
                                                         : pixels == Pixels::rgba16 ? 8
                                                                                    : 2);
    std::vector<png_bytep> rows(static_cast<std::size_t>(height_));
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = static_cast<png_bytep>(out) + y * row_bytes;
    if (!read_rows(pixels, rows.data(), row_bytes)) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(ErrorCode::file_malformed, name_, "PNG", (message_[0] ? message_ : "cannot be read"));
  }

  static void on_error(png_structp png, png_const_charp message) {
    PngReader& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader.message_, message, sizeof reader.message_ - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static void read_bytes(png_structp png, png_bytep out, std::size_t count) {
    PngReader& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.rest_.size()) png_error(png, "ends too early");
    std::memcpy(out, reader.rest_.data(), count);
    reader.rest_ = reader.rest_.subspan(count);
  }

  bool read_header(bool keeps_texts) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ == nullptr || setjmp(png_jmpbuf(png_))) return false;
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) png_error(png_, "out of memory");
    png_set_read_fn(png_, this, read_bytes);
    // libpng accepts all sizes, because check_image_size() reports the limit in the same words for all formats.
    png_set_user_limits(png_, 0x7FFFFFFF, 0x7FFFFFFF);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, unread_chunks, int(sizeof unread_chunks / 5));
    if (!keeps_texts) png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, text_chunk, 1);
    png_read_info(png_, info_);
    return true;
  }

  /// Converts the file's pixels to `pixels` and fills `rows`, with all passes of interlaced images.
  bool read_rows(Pixels pixels, png_bytep* rows, std::size_t row_bytes) {
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

  std::span<const std::byte> rest_;
  std::string name_;
  char message_[128] = "";
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int width_ = 0, height_ = 0, bits_ = 0;
};

using Texts = std::map<std::string, std::string>;

/// Adds a channel and returns its values.
template <class T>
T* add_channel(Image& image, const std::string& name) {
  Buffer<T> values(std::size_t(image.width) * std::size_t(image.height));
  image.channels.push_back({name, std::move(values)});
  return std::get<Buffer<T>>(image.channels.back().values).data();
}

/// Adds channels of colours as load_image() returns them: linear and premultiplied. `linear` turns a stored value into
/// a linear one.
template <class Value, class Linear>
void unpack_colors(const Buffer<Value>& pixels, Image& image, Linear&& linear) {
  constexpr float most = float(std::numeric_limits<Value>::max());
  float* planes[4];
  image.channels.reserve(4);
  for (int i = 0; i < 4; ++i) planes[i] = add_channel<float>(image, std::string(1, "RGBA"[i]));
  for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
    const float alpha = float(pixels[4 * i + 3]) / most;
    for (std::size_t c = 0; c < 3; ++c) planes[c][i] = linear(pixels[4 * i + c]) * alpha;
    planes[3][i] = alpha;
  }
}

/// Adds channels of directions from the values that write.cpp stores.
template <class Value>
void unpack_directions(const Buffer<Value>& pixels, Image& image) {
  constexpr int middle = (std::numeric_limits<Value>::max() + 1) / 2;
  float* planes[3];
  image.channels.reserve(3);
  for (int i = 0; i < 3; ++i) planes[i] = add_channel<float>(image, std::string("N.") + "XYZ"[i]);
  for (std::size_t i = 0; i < pixels.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) planes[c][i] = float(int(pixels[4 * i + c]) - middle) / float(middle - 1);
}

template <class Value, class Linear>
void unpack(const Buffer<Value>& pixels, bool directions, Image& image, Linear&& linear) {
  if (directions) {
    unpack_directions(pixels, image);
  } else {
    unpack_colors(pixels, image, linear);
  }
}

std::size_t pixel_count(const Image& image) { return std::size_t(image.width) * std::size_t(image.height); }

void load_pixels(PngReader& reader, bool directions, Image& image) {
  if (reader.bits() <= 8) {
    Buffer<std::uint8_t> pixels(pixel_count(image) * 4);
    reader.read(PngReader::Pixels::rgba8, pixels.data());
    unpack(pixels, directions, image, [](std::uint8_t value) { return linear_of_srgb8(value); });
    return;
  }
  Buffer<std::uint16_t> pixels(pixel_count(image) * 4);
  reader.read(PngReader::Pixels::rgba16, pixels.data());
  // A table of all 65536 values pays off if there are at least as many pixels.
  if (pixel_count(image) < 65536)
    return unpack(pixels, directions, image, [](std::uint16_t value) { return linear_of_srgb16(value); });
  Buffer<float> table(65536);
  for (std::size_t value = 0; value < table.size(); ++value) table[value] = linear_of_srgb16(std::uint16_t(value));
  unpack(pixels, directions, image, [&](std::uint16_t value) { return table[value]; });
}

double number(const Texts& texts, const char* key, const std::string& name) {
  const auto found = texts.find(key);
  std::istringstream text(found == texts.end() ? std::string() : found->second);
  text.imbue(std::locale::classic());
  double value = 0;
  if (!(text >> value) || !std::isfinite(value))
    throw Error(ErrorCode::file_malformed, name, "PNG", std::string("text ") + key + " is not a number");
  return value;
}

/// Reads a depth or id map, which the file's text chunks describe.
void load_map(PngReader& reader, const Texts& texts, const std::string& name, Image& image) {
  const std::string& channel = texts.at(png_channel_key);
  const bool ids = texts.count(png_ids_key) != 0;
  const double scale = ids ? 1 : number(texts, png_scale_key, name);
  const double offset = ids ? 0 : number(texts, png_offset_key, name);
  if (scale == 0) throw Error(ErrorCode::file_malformed, name, "PNG", "the depth scale is 0");
  Buffer<std::uint16_t> pixels(pixel_count(image));
  reader.read(PngReader::Pixels::grey16, pixels.data());
  if (ids) {
    std::uint32_t* out = add_channel<std::uint32_t>(image, channel);
    for (const std::uint16_t value : pixels) *out++ = std::uint32_t(value) - 1;  // 0 wraps to the id for none
  } else {
    float* out = add_channel<float>(image, channel);
    for (const std::uint16_t value : pixels)
      *out++ = value ? float((double(value) - offset) / scale) : std::numeric_limits<float>::infinity();
  }
}

}  // namespace

Image load_png(std::span<const std::byte> bytes, const std::string& name) {
  PngReader reader(bytes, name, true);
  const Texts texts = reader.texts();
  Image image{reader.width(), reader.height(), {}};
  const auto channel = texts.find(png_channel_key);
  if (channel != texts.end() && reader.is_grey() && reader.bits() == 16) {
    load_map(reader, texts, name, image);
  } else {
    load_pixels(reader, channel != texts.end() && channel->second == "N", image);
  }
  return image;
}

Texture decode_png(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  PngReader reader(bytes, name, false);
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
