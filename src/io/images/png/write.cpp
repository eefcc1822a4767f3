// SPDX-License-Identifier: Apache-2.0
// Strips of rows are filtered and compressed by themselves, each ending on a byte (Z_FULL_FLUSH), so that they can be
// strung together to the one zlib stream that PNG asks for. libpng compresses on one thread only.
//
// Measured at 1920 x 1080 RGB, one thread, Up filter, level 1: a shaded shape on white 8 ms by any strategy; a picture
// with noise in it 54 ms and 3.4 MB by the default strategy, 38 ms and 2.9 MB by Z_RLE; pure noise 90 ms against 28.
// What the filter leaves of rendered pictures has runs, but few repeated strings.
#include "io/images/png/write.h"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "base/parallel.h"
#include "base/pool.h"

namespace frontmost::detail {
namespace {

using ByteVector = std::vector<std::uint8_t>;

/// Filtered bytes in a strip: enough to make its start-up costs small, few enough to keep all threads busy.
constexpr std::size_t strip_bytes = std::size_t(1) << 18;

enum class Filter : std::uint8_t { sub = 1, up = 2 };

void append_word(ByteVector& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::uint8_t(word >> shift));
}

void store_word(std::uint8_t* place, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) place[i] = std::uint8_t(word >> (24 - 8 * i));
}

void append_chunk(ByteVector& bytes, std::string_view type, std::string_view data) {
  append_word(bytes, std::uint32_t(data.size()));
  const std::size_t checked = bytes.size();
  bytes.insert(bytes.end(), type.begin(), type.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  append_word(bytes, std::uint32_t(::crc32(0, bytes.data() + checked, uInt(bytes.size() - checked))));
}

std::string_view as_text(const ByteVector& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Signature and all chunks before the pixels.
ByteVector head(const PngContents& contents) {
  ByteVector header;
  append_word(header, std::uint32_t(contents.width));
  append_word(header, std::uint32_t(contents.height));
  header.push_back(std::uint8_t(contents.bits));
  header.push_back(std::uint8_t(contents.color));
  header.insert(header.end(), {0, 0, 0});  // deflate, the five filters, not interlaced

  ByteVector bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  append_chunk(bytes, "IHDR", as_text(header));
  if (contents.is_srgb) append_chunk(bytes, "sRGB", std::string_view("\0", 1));
  for (const PngContents::Text& text : contents.texts)
    append_chunk(bytes, "tEXt", text.keyword + std::string(1, '\0') + text.text);
  return bytes;
}

/// zlib's state of a quarter of a megabyte, used for one strip after the other.
class Deflater {
 public:
  Deflater() {
    constexpr int level = 1, raw_window_bits = -15, memory = 8;
    if (::deflateInit2(&stream_, level, Z_DEFLATED, raw_window_bits, memory, Z_RLE) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { ::deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// Compresses `raw` to `out`. \returns the number of bytes.
  std::size_t run(std::span<std::uint8_t> raw, std::span<std::uint8_t> out, bool last) {
    ::deflateReset(&stream_);
    stream_.next_in = raw.data();
    stream_.avail_in = uInt(raw.size());
    stream_.next_out = out.data();
    stream_.avail_out = uInt(out.size());
    ::deflate(&stream_, last ? Z_FINISH : Z_FULL_FLUSH);  // `out` is as large as the worst case, so one call does it
    return stream_.total_out;
  }

 private:
  z_stream stream_{};
};

/// What a thread needs to make strips. Kept from strip to strip: the first touch of fresh memory costs more than the
/// filter.
struct Workspace {
  Buffer<std::uint8_t> raw, row, above;
  Deflater deflater;

  Workspace(std::size_t rows, std::size_t row_size) : raw(rows * (row_size + 1)), row(row_size), above(row_size) {}
};

/// Rows of a strip after filtering: Up, except for the first, which must not look at another strip.
std::span<std::uint8_t> filtered_rows(const PngContents& contents, int first, int end, Workspace& space) {
  const std::size_t pixel = contents.pixel_bytes();
  const std::size_t size = std::size_t(contents.width) * pixel;
  Buffer<std::uint8_t>&raw = space.raw, &row = space.row, &above = space.above;
  std::uint8_t* out = raw.data();
  for (int y = first; y < end; ++y, out += size + 1) {
    contents.row(y, row.data());
    out[0] = std::uint8_t(y == first ? Filter::sub : Filter::up);
    if (y == first) {
      std::copy_n(row.data(), pixel, out + 1);
      for (std::size_t i = pixel; i < size; ++i) out[1 + i] = std::uint8_t(row[i] - row[i - pixel]);
    } else {
      for (std::size_t i = 0; i < size; ++i) out[1 + i] = std::uint8_t(row[i] - above[i]);
    }
    row.swap(above);
  }
  return {raw.data(), out};
}

/// One IDAT chunk, ready to be written.
struct Strip {
  Buffer<std::uint8_t> chunk;
  std::size_t chunk_size = 0;
  std::size_t raw_size = 0;
  uLong checksum = 0;  ///< Adler-32 of the raw bytes
};

/// zlib's bound for any settings, and room for the empty block of a flush and what makes it a chunk.
std::size_t worst_case(std::size_t raw) { return ::deflateBound(nullptr, uLong(raw)) + 64; }

Strip make_strip(const PngContents& contents, int first, int end, Workspace& space) {
  const std::span<std::uint8_t> raw = filtered_rows(contents, first, end, space);
  Strip strip;
  strip.raw_size = raw.size();
  // Of each strip by itself; zlib can put sums of parts together, so that no byte is summed up twice.
  strip.checksum = ::adler32(1, raw.data(), uInt(raw.size()));
  strip.chunk = Buffer<std::uint8_t>(worst_case(raw.size()));
  std::uint8_t* const type = strip.chunk.data() + 4;
  std::copy_n("IDAT", 4, type);
  std::uint8_t* data = type + 4;
  if (first == 0) {  // the zlib header: 32 KiB window, fastest
    *data++ = 0x78;
    *data++ = 0x01;
  }
  const std::size_t spare = std::size_t(data - strip.chunk.data()) + 4;
  data += space.deflater.run(raw, {data, strip.chunk.size() - spare}, end == contents.height);
  store_word(strip.chunk.data(), std::uint32_t(data - type - 4));
  store_word(data, std::uint32_t(::crc32(0, type, uInt(data - type))));
  strip.chunk_size = std::size_t(data + 4 - strip.chunk.data());
  return strip;
}

/// The end of the zlib stream, and of the file.
ByteVector tail(const std::vector<Strip>& strips) {
  uLong checksum = 1;  // of nothing
  for (const Strip& strip : strips) checksum = ::adler32_combine(checksum, strip.checksum, z_off_t(strip.raw_size));
  ByteVector word, bytes;
  append_word(word, std::uint32_t(checksum));
  append_chunk(bytes, "IDAT", as_text(word));
  append_chunk(bytes, "IEND", {});
  return bytes;
}

}  // namespace

std::size_t PngContents::pixel_bytes() const {
  const std::size_t channels = color == Color::grey ? 1 : color == Color::rgb ? 3 : 4;
  return channels * std::size_t(bits / 8);
}

void write_png(const PngContents& contents, OutputFile& file, const Execution& execution) {
  const std::size_t row_size = std::size_t(contents.width) * contents.pixel_bytes();
  // By the size of a row alone, never by the number of threads: strips are seen in the bytes of the file.
  const std::size_t rows = std::max<std::size_t>(1, strip_bytes / (row_size + 1));
  Pool<Workspace> workspaces;
  std::vector<Strip> strips((std::size_t(contents.height) + rows - 1) / rows);
  parallel_for(execution, std::size_t(contents.height), rows, [&](std::size_t first, std::size_t end) {
    const auto space = workspaces.borrow([&] { return std::make_unique<Workspace>(rows, row_size); });
    strips[first / rows] = make_strip(contents, int(first), int(end), *space);
  });
  const ByteVector start = head(contents);
  file.write(std::as_bytes(std::span(start)));
  for (const Strip& strip : strips) file.write(std::as_bytes(std::span(strip.chunk.data(), strip.chunk_size)));
  const ByteVector end = tail(strips);
  file.write(std::as_bytes(std::span(end)));
}

}  // namespace frontmost::detail
