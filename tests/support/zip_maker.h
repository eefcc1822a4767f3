// SPDX-License-Identifier: Apache-2.0
// Makes small zip archives for tests and fuzz targets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace frontmost::test {

inline std::uint32_t crc_of(std::string_view text) {
  std::uint32_t crc = ~0u;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

class ZipMaker {
 public:
  /// Stores a file as it is.
  ZipMaker& add(const std::string& name, const std::string& text) {
    return add_as(name, text, {0, crc_of(text), std::uint32_t(text.size())});
  }

  /// How the bytes of a file are packed (8: deflated), and what they are said to unpack to.
  struct Packing {
    std::uint16_t method;
    std::uint32_t crc, size;
  };
  ZipMaker& add_as(const std::string& name, const std::string& bytes, const Packing& packing) {
    std::string header;
    put(header, {20, 0, packing.method, 0, 0});
    for (const std::uint32_t value : {packing.crc, std::uint32_t(bytes.size()), packing.size}) put32(header, value);
    put(header, {std::uint16_t(name.size()), 0});
    put32(directory_, 0x02014B50);
    put(directory_, {20});
    directory_ += header;
    put(directory_, {0, 0, 0});
    put32(directory_, 0);
    put32(directory_, std::uint32_t(files_.size()));
    directory_ += name;
    put32(files_, 0x04034B50);
    files_ += header + name + bytes;
    ++count_;
    return *this;
  }

  [[nodiscard]] std::string bytes() const {
    std::string end;
    put32(end, 0x06054B50);
    put(end, {0, 0, count_, count_});
    put32(end, std::uint32_t(directory_.size()));
    put32(end, std::uint32_t(files_.size()));
    put(end, {0});
    return files_ + directory_ + end;
  }

 private:
  static void put(std::string& to, std::initializer_list<std::uint16_t> values) {
    for (const std::uint16_t value : values) {
      to += char(value & 0xFF);
      to += char(value >> 8);
    }
  }
  static void put32(std::string& to, std::uint32_t value) {
    put(to, {std::uint16_t(value & 0xFFFF), std::uint16_t(value >> 16)});
  }

  std::string files_, directory_;
  std::uint16_t count_ = 0;
};

}  // namespace frontmost::test
