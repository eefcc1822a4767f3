// SPDX-License-Identifier: Apache-2.0
#include "web/exr.h"

#include <algorithm>
#include <cstring>

namespace frontmost::web {
namespace {

/// Appends a value. WebAssembly is little-endian, like these files.
template <class T>
void add(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

void add_text(std::string& bytes, const std::string& text) { bytes.append(text.c_str(), text.size() + 1); }

void add_attribute(std::string& bytes, const char* name, const char* type, const std::string& value) {
  add_text(bytes, name);
  add_text(bytes, type);
  add(bytes, std::int32_t(value.size()));
  bytes += value;
}

template <class... T>
std::string packed(const T&... values) {
  std::string bytes;
  (add(bytes, values), ...);
  return bytes;
}

/// Channels sorted by name, as the format requires.
std::vector<const Channel*> sorted_channels(const Image& image) {
  std::vector<const Channel*> channels;
  for (const Channel& channel : image.channels) channels.push_back(&channel);
  std::sort(channels.begin(), channels.end(), [](const Channel* a, const Channel* b) { return a->name < b->name; });
  return channels;
}

std::string header(const Image& image, const std::vector<const Channel*>& channels) {
  constexpr std::int32_t whole_number = 0, real_number = 2;
  std::string list;
  for (const Channel* channel : channels) {
    add_text(list, channel->name);
    list +=
        packed(channel->is_integer() ? whole_number : real_number, std::int32_t(0), std::int32_t(1), std::int32_t(1));
  }
  list += '\0';
  const std::string window = packed(std::int32_t(0), std::int32_t(0), image.width - 1, image.height - 1);
  const std::string zero_byte(1, '\0');
  std::string bytes = packed(std::int32_t(20000630), std::int32_t(2));
  add_attribute(bytes, "channels", "chlist", list);
  add_attribute(bytes, "compression", "compression", zero_byte);
  add_attribute(bytes, "dataWindow", "box2i", window);
  add_attribute(bytes, "displayWindow", "box2i", window);
  add_attribute(bytes, "lineOrder", "lineOrder", zero_byte);
  add_attribute(bytes, "pixelAspectRatio", "float", packed(1.0f));
  add_attribute(bytes, "screenWindowCenter", "v2f", packed(0.0f, 0.0f));
  add_attribute(bytes, "screenWindowWidth", "float", packed(1.0f));
  return bytes + '\0';
}

}  // namespace

std::string exr_bytes(const Image& image) {
  const std::vector<const Channel*> channels = sorted_channels(image);
  std::string bytes = header(image, channels);
  const auto width = std::size_t(image.width), height = std::size_t(image.height);
  const std::size_t row_bytes = 4 * width * channels.size(), begin = bytes.size() + 8 * height;
  for (std::size_t y = 0; y < height; ++y) add(bytes, std::uint64_t(begin + y * (8 + row_bytes)));
  for (std::size_t y = 0; y < height; ++y) {
    bytes += packed(std::int32_t(y), std::int32_t(row_bytes));
    for (const Channel* channel : channels)
      std::visit(
          [&](const auto& values) {
            bytes.append(reinterpret_cast<const char*>(values.data() + y * width), 4 * width);
          },
          channel->values);
  }
  return bytes;
}

}  // namespace frontmost::web
