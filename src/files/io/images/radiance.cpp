// SPDX-License-Identifier: Apache-2.0
// Radiance pictures (.hdr, .pic): a text header, a line with the size, and rows of pixels with one exponent for three
// mantissas. Rows are plain, or repeat whole pixels (until 1991), or pack the bytes of each component by itself. G.
// Ward. Real Pixels. Graphics Gems II. 1991; Radiance's src/common/color.c.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void fail_radiance(const std::string& name, const std::string& reason,
                                ErrorCode code = ErrorCode::file_malformed) {
  throw Error(code, name, "Radiance", reason);
}

/// Returns the start of a text of the file, in quotes for messages.
std::string quoted(std::string_view text) {
  std::string quote(1, '"');
  quote += text.substr(0, 40);
  quote += '"';
  return quote;
}

/// The bytes of the file that are not read yet.
class RadianceBytes {
 public:
  RadianceBytes(std::span<const std::byte> bytes, const std::string& name) : rest_(bytes), name_(name) {}

  /// Takes the next line of the header. \returns the line without its end.
  std::string_view line() {
    const auto* text = reinterpret_cast<const char*>(rest_.data());
    const void* end = rest_.empty() ? nullptr : std::memchr(text, '\n', rest_.size());
    if (end == nullptr) fail_radiance(name_, "the header is cut short");
    const auto length = std::size_t(static_cast<const char*>(end) - text);
    rest_ = rest_.subspan(length + 1);
    return {text, length > 0 && text[length - 1] == '\r' ? length - 1 : length};
  }
  /// Takes the next `count` bytes. Messages name `row`.
  const std::uint8_t* take(std::size_t count, std::size_t row) {
    if (count > rest_.size()) fail_radiance(name_, "row " + std::to_string(row) + " is cut short");
    const auto* taken = reinterpret_cast<const std::uint8_t*>(rest_.data());
    rest_ = rest_.subspan(count);
    return taken;
  }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

 private:
  std::span<const std::byte> rest_;
  const std::string& name_;
};

struct RadianceSize {
  std::size_t width = 0, height = 0;
  bool bottom_row_first = false, right_column_first = false;
};

/// Reads the line of the size, such as "-Y 512 +X 1024": rows from the top, columns from the left.
RadianceSize size_of(std::string_view line, const std::string& name) {
  RadianceSize size;
  const char *place = line.data(), *const end = place + line.size();
  for (const char axis : {'Y', 'X'}) {
    const bool is_signed = end - place > 3 && (place[0] == '-' || place[0] == '+') && place[2] == ' ';
    if (is_signed && axis == 'Y' && place[1] == 'X')
      fail_radiance(name, "pictures stored column by column are not supported", ErrorCode::unsupported);
    std::uint32_t pixels = 0;
    const auto [rest, error] = std::from_chars(is_signed ? place + 3 : place, end, pixels);
    if (!is_signed || place[1] != axis || error != std::errc())
      fail_radiance(name, quoted(line) + " is not a size such as -Y 512 +X 1024");
    (axis == 'Y' ? size.height : size.width) = pixels;
    (axis == 'Y' ? size.bottom_row_first : size.right_column_first) = *place == (axis == 'Y' ? '+' : '-');
    place = rest;
    while (place < end && *place == ' ') ++place;
  }
  return size;
}

/// Reads everything before the pixels.
RadianceSize read_radiance_header(RadianceBytes& bytes, const std::string& name) {
  constexpr std::string_view format_key = "FORMAT=", rgbe = "32-bit_rle_rgbe";
  bytes.line();  // "#?RADIANCE" or "#?RGBE"
  for (std::string_view line = bytes.line(); !line.empty(); line = bytes.line()) {
    if (!line.starts_with(format_key)) continue;
    const std::string_view format = line.substr(format_key.size());
    if (format == rgbe) continue;
    std::string reason = quoted(format);
    reason += " is not supported, only " + std::string(rgbe);
    fail_radiance(name, "format " + reason, ErrorCode::unsupported);
  }
  return size_of(bytes.line(), name);
}

/// One row of pixels, stored by component: red, green, blue, exponent.
struct RadianceRow {
  std::array<std::vector<std::uint8_t>, 4> components;
  std::size_t number = 0;  ///< row of the file, for messages
};

/// Reads a row of packed components. A byte above 128 says how often the next byte is repeated; any other byte says how
/// many plain bytes follow.
void read_packed(RadianceBytes& bytes, RadianceRow& row, const std::string& name) {
  for (std::vector<std::uint8_t>& component : row.components)
    for (std::size_t x = 0; x < component.size();) {
      const std::size_t code = *bytes.take(1, row.number);
      const bool repeats = code > 128;
      const std::size_t count = repeats ? code - 128 : code;
      if (count == 0 || count > component.size() - x)
        fail_radiance(name, "row " + std::to_string(row.number) + ": a run of " + std::to_string(count) + " bytes at " +
                                std::to_string(x) + " of " + std::to_string(component.size()));
      const std::uint8_t* values = bytes.take(repeats ? 1 : count, row.number);
      for (std::size_t i = 0; i < count; ++i) component[x + i] = values[repeats ? 0 : i];
      x += count;
    }
}

/// Reads pixels of four bytes each. A pixel that begins with three ones repeats the pixel before it, as often as its
/// fourth byte says, times 256 for each repeating pixel directly before it.
void read_plain(RadianceBytes& bytes, RadianceRow& row, const std::string& name) {
  const std::size_t width = row.components[0].size();
  std::size_t unit = 1;
  for (std::size_t x = 0; x < width;) {
    const std::uint8_t* pixel = bytes.take(4, row.number);
    const bool repeats = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
    const std::size_t count = repeats ? pixel[3] * unit : 1;
    // Errors: nothing to repeat, a factor that would grow without end, or more pixels than the row has.
    if (repeats && (x == 0 || unit > width || count > width - x))
      fail_radiance(name, "row " + std::to_string(row.number) + ": a run of " + std::to_string(count) + " pixels at " +
                              std::to_string(x) + " of " + std::to_string(width));
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<std::uint8_t>& component = row.components[k];
      const std::uint8_t value = repeats ? component[x - 1] : pixel[k];
      std::fill_n(component.begin() + std::ptrdiff_t(x), count, value);
    }
    x += count;
    unit = repeats ? unit * 256 : 1;
  }
}

void read_row(RadianceBytes& bytes, RadianceRow& row, const std::string& name) {
  const std::size_t width = row.components[0].size();
  constexpr std::size_t shortest_packed = 8, longest_packed = 0x7FFF;
  const auto next = bytes.rest();
  const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(next[i]); };
  const bool packed = width >= shortest_packed && width <= longest_packed && next.size() >= 4 && byte(0) == 2 &&
                      byte(1) == 2 && byte(2) < 128;
  if (!packed) return read_plain(bytes, row, name);
  bytes.take(4, row.number);
  if ((byte(2) << 8 | byte(3)) != width)
    fail_radiance(name, "row " + std::to_string(row.number) + " has " + std::to_string(byte(2) << 8 | byte(3)) +
                            " pixels, not " + std::to_string(width));
  read_packed(bytes, row, name);
}

}  // namespace

Image load_radiance(std::span<const std::byte> bytes, const std::string& name) {
  RadianceBytes rest(bytes, name);
  const RadianceSize size = read_radiance_header(rest, name);
  // A file is densest if its rows have one colour each: such a row takes one pixel and one run.
  const double densest = double(std::max<std::size_t>(size.width, 2)) / 8;
  check_image_size(name, size.width, size.height, rest.rest().size(), densest, "Radiance");
  Image image{int(size.width), int(size.height), {}};
  for (const char* channel : {"R", "G", "B"})
    image.channels.push_back({channel, Buffer<float>(size.width * size.height)});
  // The stored value is mantissa / 256 * 2^(exponent - 128), or 0 for exponent 0.
  std::array<float, 256> scales = {};
  for (int exponent = 1; exponent < 256; ++exponent) scales[std::size_t(exponent)] = std::ldexp(1.0f, exponent - 136);
  RadianceRow row;
  for (std::vector<std::uint8_t>& component : row.components) component.resize(size.width);
  for (row.number = 0; row.number < size.height; ++row.number) {
    read_row(rest, row, name);
    const std::size_t y = size.bottom_row_first ? size.height - 1 - row.number : row.number;
    for (std::size_t c = 0; c < 3; ++c) {
      float* plane = image.channels[c].floats().data() + y * size.width;
      for (std::size_t x = 0; x < size.width; ++x)
        plane[size.right_column_first ? size.width - 1 - x : x] =
            float(row.components[c][x]) * scales[row.components[3][x]];
    }
  }
  return image;
}

}  // namespace frontmost::detail
