// SPDX-License-Identifier: Apache-2.0
// Makes small zip archives, and small 3MF files, which are such archives, for tests and fuzz targets.
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
  /// Stores a file uncompressed.
  ZipMaker& add(const std::string& name, const std::string& text) {
    return add_as(name, text, {0, crc_of(text), std::uint32_t(text.size())});
  }

  /// The compression method of a file (8: deflate), and its stated unpacked size.
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

inline const std::string model_part_name = "3D/3dmodel.model";
inline const std::string relationships =
    R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target="/3D/3dmodel.model"/>
</Relationships>)";
/// Four vertices and four triangles.
inline const std::string tetrahedron =
    R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>
<triangle v1="1" v2="2" v3="3"/><triangle v1="0" v2="3" v3="2"/></triangles></mesh>)";

/// A model part with `attributes` in its first tag, and its contents.
inline std::string model_of(const std::string& contents, const std::string& attributes = {}) {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
 xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" )" +
         attributes + ">" + contents + "</model>";
}

/// A package with this model.
inline ZipMaker package_of(const std::string& model) {
  ZipMaker zip;
  zip.add("_rels/.rels", relationships).add(model_part_name, model);
  return zip;
}

}  // namespace frontmost::test
