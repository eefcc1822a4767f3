// SPDX-License-Identifier: Apache-2.0
#include "io/images/exr/header.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "frontmost/base.h"
#include "io/images/decode.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "EXR", reason);
}

/// Reads forward through a header, never past its end.
class Cursor {
 public:
  Cursor(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::span<const std::byte> take(std::size_t count) {
    if (count > bytes_.size()) fail(name_, "the header is cut short");
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  std::int32_t number() {
    std::int32_t value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  /// Returns the text up to the next zero, and passes the zero.
  std::string_view text() {
    const auto end = std::find(bytes_.begin(), bytes_.end(), std::byte{0});
    const auto taken = take(std::size_t(end - bytes_.begin()));
    take(1);
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

struct Sizes {
  std::uint64_t width = 0, height = 0, channels = 0;
  unsigned compression = 0;  ///< as in the file: 0 none, 1 RLE, 2 and 3 ZIP, then wavelets and other things

  /// The most bytes of memory that `bytes` bytes of a file can fill. Deflate makes at most 1032 bytes of one. Other
  /// methods have no bound for plain pictures, so they may always use some memory.
  [[nodiscard]] std::uint64_t most_memory(std::uint64_t bytes) const {
    constexpr std::uint64_t ratio = 1100, always = std::uint64_t(1) << 26;
    return compression <= 3 ? bytes * ratio : std::max(always, bytes * ratio);
  }
};

void read_window(Cursor window, Sizes& sizes) {
  // 64 bits, since the difference of two 32-bit corners, plus one, does not fit into 32.
  const std::int64_t left = window.number(), top = window.number();
  const std::int64_t right = window.number(), bottom = window.number();
  sizes.width = std::uint64_t(std::max<std::int64_t>(0, right - left + 1));
  sizes.height = std::uint64_t(std::max<std::int64_t>(0, bottom - top + 1));
}

/// Counts on from earlier lists, because the library adds the channels of a second list to those of the first.
void read_channels(Cursor list, Sizes& sizes, const std::string& name) {
  constexpr std::size_t record = 16;  // type, linearity and sampling
  for (; !list.text().empty(); ++sizes.channels) list.take(record);
  if (!list.at_end()) fail(name, "the channel list ends before its attribute");
}

/// The library reads most attributes by their type and ignores the size that the file states. If size and type
/// disagree, the library would parse another header than this check.
constexpr std::size_t any_size = ~std::size_t(0);
constexpr std::pair<std::string_view, std::size_t> attribute_sizes[] = {
    {"box2i", 16},        {"box2f", 16},   {"chlist", any_size}, {"chromaticities", 32},
    {"compression", 1},   {"double", 8},   {"envmap", 1},        {"float", 4},
    {"int", 4},           {"keycode", 28}, {"lineOrder", 1},     {"m33d", 72},
    {"m33f", 36},         {"m44d", 128},   {"m44f", 64},         {"rational", 8},
    {"string", any_size}, {"timecode", 8}, {"v2d", 16},          {"v2f", 8},
    {"v2i", 8},           {"v3d", 24},     {"v3f", 12},          {"v3i", 12},
};

void check_attribute(std::string_view type, std::size_t size, const std::string& name) {
  for (const auto& [known, its_size] : attribute_sizes) {
    if (type != known) continue;
    if (its_size != any_size && size != its_size)
      fail(name, "an attribute's size does not fit its type " + std::string(type));
    return;
  }
  throw Error(ErrorCode::unsupported, name, "EXR", "attributes of type " + std::string(type) + " are not read");
}

Sizes read_sizes(Cursor header, const std::string& name) {
  Sizes sizes;
  for (std::string_view key = header.text(); !key.empty(); key = header.text()) {
    const std::string_view type = header.text();
    const std::int32_t size = header.number();
    if (size < 0) fail(name, "attribute " + std::string(key) + " has a negative size");
    check_attribute(type, std::size_t(size), name);
    Cursor value(header.take(std::size_t(size)), name);
    if (key == "dataWindow") read_window(value, sizes);
    if (type == "chlist") read_channels(value, sizes, name);
    if (key == "compression") sizes.compression = std::to_integer<unsigned>(value.take(1)[0]);
  }
  return sizes;
}

}  // namespace

void check_exr_header(std::span<const std::byte> bytes, const std::string& name) {
  Cursor cursor(bytes, name);
  cursor.number();  // the signature
  const auto version = std::uint32_t(cursor.number());
  constexpr std::uint32_t tiled = 0x200, deep = 0x800, multi_part = 0x1000;
  if (version & (tiled | deep | multi_part))
    throw Error(ErrorCode::unsupported, name, "EXR", "tiled, deep and multi-part files are not read");
  const Sizes sizes = read_sizes(cursor, name);
  constexpr std::uint64_t most_channels = 1024;
  if (sizes.channels < 1 || sizes.channels > most_channels)
    throw Error(ErrorCode::limit_exceeded, name, "EXR", std::to_string(sizes.channels) + " channels, not 1 to 1024");
  check_image_size(name, sizes.width, sizes.height, bytes.size(), std::numeric_limits<double>::infinity(), "EXR");
  if (sizes.width * sizes.height * sizes.channels * 4 > sizes.most_memory(bytes.size()))
    fail(name, std::to_string(bytes.size()) + " bytes cannot hold " + std::to_string(sizes.width) + " x " +
                   std::to_string(sizes.height) + " pixels of " + std::to_string(sizes.channels) + " channels");
}

}  // namespace frontmost::detail
