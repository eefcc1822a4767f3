// SPDX-License-Identifier: Apache-2.0
// Binary STL, and the choice between the two encodings. Stored normals are dropped, because they follow from the
// corners.
//
//   byte   0                    80        84                134               184
//          | anything, 80 bytes | count   | triangle 0      | triangle 1      | ...
//                                         normal, three corners (12 floats), 2 bytes: perhaps a colour
//
// Neither the header nor the count can be trusted: the header may hold any text, and writers that cannot seek back
// leave the count open. The file's size decides.
#include "io/models/stl/stl.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "io/models/bytes.h"
#include "io/models/mesh_building.h"

namespace frontmost {
namespace {

constexpr std::size_t header_size = 80, prelude_size = stl_prelude_size, record_size = stl_record_size;
constexpr std::size_t normal_size = 12, corners_size = 36, attribute_offset = normal_size + corners_size;
// Each triangle has three vertices of its own, and 32-bit indices must reach all of them.
constexpr std::uint64_t max_triangles = no_index / 3;

bool is_text(Bytes bytes) {
  const Bytes start = bytes.first(std::min<std::size_t>(bytes.size(), 1024));
  return std::none_of(start.begin(), start.end(), [](std::byte b) {
    const auto c = std::to_integer<unsigned char>(b);
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

bool starts_like_ascii(Bytes bytes) {
  const std::string_view text = text_of(bytes);
  std::size_t i = 0;
  while (i < text.size() && (text[i] == ' ' || text[i] == '\t' || text[i] == '\n' || text[i] == '\r')) ++i;
  const auto is = [&](std::string_view word) {
    if (text.size() - i < word.size()) return false;
    for (std::size_t k = 0; k < word.size(); ++k)
      if ((text[i + k] | 0x20) != word[k]) return false;
    return true;
  };
  return is("solid") || is("facet");
}

/// Copies records to existing triangles of the mesh, from number `first` on.
void copy_records(Bytes records, std::size_t first, Mesh& mesh) {
  const std::byte* record = records.data();
  const std::size_t end = first + records.size() / record_size;
  for (std::size_t t = first; t < end; ++t, record += record_size) {
    std::memcpy(&mesh.positions[3 * t], record + normal_size, corners_size);
    mesh.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  }
  if constexpr (native_endian == Endian::big)
    for (std::size_t i = 3 * first; i < 3 * end; ++i)
      for (int k = 0; k < 3; ++k) {
        float& value = mesh.positions[i][k];
        value = read_value<float>(reinterpret_cast<const std::byte*>(&value), Endian::little);
      }
}

/// Fills the colours of triangles from number `first` on. The mesh has room for them.
void color_records(Bytes records, const StlColors& colors, std::size_t first, Mesh& mesh) {
  for (std::size_t t = first; !records.empty(); ++t, records = records.subspan(record_size)) {
    mesh.colors.values[t] = colors.of(records);
    mesh.colors.triangles[t] = glm::uvec3(std::uint32_t(t));
  }
}

std::uint16_t attribute_of(Bytes record) {
  return read_value<std::uint16_t>(record.data() + attribute_offset, Endian::little);
}

}  // namespace

StlColors::StlColors(Bytes prelude) {
  constexpr std::string_view key = "COLOR=";
  const std::string_view header(reinterpret_cast<const char*>(prelude.data()), header_size);
  const std::size_t at = header.find(key), end = at + key.size() + 3;
  if (at == std::string_view::npos || end > header_size) return;
  for (int k = 0; k < 3; ++k) part_[k] = float(static_cast<unsigned char>(header[end - 3 + std::size_t(k)])) / 255;
  part_ = linear_color(part_);
  is_red_lowest_ = true;
  is_own_by_bit_ = header.substr(end).starts_with(" MATERIAL=");  // MeshLab
}

bool StlColors::are_in(Bytes records) const {
  std::uint32_t bits = 0;
  for (; records.size() >= record_size; records = records.subspan(record_size)) bits |= attribute_of(records);
  return (bits & (is_own_by_bit_ ? 0x8000 : 0xFFFF)) != 0;
}

glm::vec4 StlColors::of(Bytes record) const {
  const std::uint16_t bits = attribute_of(record);
  if (((bits & 0x8000) != 0) != is_own_by_bit_) return part_;
  const auto channel = [&](int lowest) { return float((bits >> lowest) & 31) / 31; };
  const int red = is_red_lowest_ ? 0 : 10;
  return linear_color({channel(red), channel(5), channel(10 - red), 1});
}

std::uint64_t stl_promised_count(Bytes prelude) {
  return read_value<std::uint32_t>(prelude.data() + header_size, Endian::little);
}

std::uint64_t stl_checked_count(Bytes prelude, std::uint64_t file_size, const ModelSource& source,
                                std::vector<std::string>& warnings) {
  const std::uint64_t promised = stl_promised_count(prelude);
  const std::uint64_t room = file_size - prelude_size, whole = room / record_size;
  const std::string place = "byte " + std::to_string(header_size);
  if ((promised == 0 || promised == 0xFFFFFFFFu) && room > 0 && room % record_size == 0) {
    warnings.push_back(place + ": the triangle count was left open, the size of the file gives " +
                       std::to_string(whole));
    return whole;
  }
  if (promised > whole)
    source.fail("triangle " + std::to_string(whole),
                "the file ends here, but its header promises " + std::to_string(promised) + " triangles");
  if (room > promised * record_size)
    warnings.push_back("byte " + std::to_string(prelude_size + promised * record_size) + ": " +
                       std::to_string(room - promised * record_size) +
                       " bytes after the last triangle were passed over");
  return promised;
}

std::string stl_header_name(Bytes prelude) {
  std::string name(reinterpret_cast<const char*>(prelude.data()), header_size);
  name.resize(std::min(name.find('\0'), name.size()));
  // Programs leave dates, colours and rubbish in the header; unprintable text is no name.
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) return {};
  if (name.starts_with("solid ")) name.erase(0, 6);
  name.erase(name.find_last_not_of(' ') + 1);
  return name;
}

void append_stl_records(Bytes records, const StlColors* colors, Mesh& mesh) {
  const std::size_t first = mesh.triangles.size(), count = records.size() / record_size;
  // Blocks are small enough that growing (which writes zeros) and filling meet in the cache.
  constexpr std::size_t block = 8192;
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t end = std::min(count, begin + block);
    mesh.positions.resize(3 * (first + end));
    mesh.triangles.resize(first + end);
    const Bytes part = records.subspan(begin * record_size, (end - begin) * record_size);
    copy_records(part, first + begin, mesh);
    if (colors == nullptr) continue;
    mesh.colors.values.resize(first + end);
    mesh.colors.triangles.resize(first + end);
    color_records(part, *colors, first + begin, mesh);
  }
}

StlEncoding stl_encoding(Bytes start, std::uint64_t file_size) {
  if (file_size >= prelude_size) {
    const std::uint64_t room = file_size - prelude_size, needed = stl_promised_count(start) * record_size;
    // Size decides before words: many binary files begin with "solid", and a text hardly has exactly the length that
    // its bytes 80 to 83 would demand.
    if (room == needed) return StlEncoding::binary;
    if (!is_text(start)) return room > needed && needed > 0 ? StlEncoding::binary : StlEncoding::neither;
  }
  return starts_like_ascii(start) && is_text(start) ? StlEncoding::ascii : StlEncoding::neither;
}

StlEncoding known_stl_encoding(Bytes start, std::uint64_t file_size, const ModelSource& source) {
  const StlEncoding encoding = stl_encoding(start, file_size);
  if (encoding != StlEncoding::neither) return encoding;
  if (is_text(start)) source.fail("line 1", "the file looks like a text STL, but does not start with \"solid\"");
  if (file_size < prelude_size)
    source.fail("byte " + std::to_string(file_size), "the file ends within the 84 bytes of a binary STL header");
  return StlEncoding::binary;  // broken; its reader reports the fault
}

Scene read_stl(Bytes bytes, const ModelSource& source) {
  return known_stl_encoding(bytes, bytes.size(), source) == StlEncoding::ascii ? read_ascii_stl(bytes, source)
                                                                               : read_binary_stl(bytes, source);
}

Scene read_binary_stl(Bytes bytes, const ModelSource& source) {
  Scene scene;
  const std::uint64_t checked = stl_checked_count(bytes, bytes.size(), source, scene.warnings);
  if (checked > max_triangles)
    source.fail_limit("byte " + std::to_string(header_size),
                      std::to_string(checked) + " triangles are more than " + std::to_string(max_triangles));
  const auto count = std::size_t(checked);
  if (count == 0) return scene;
  Mesh mesh;
  mesh.name = stl_header_name(bytes);
  reserve_large(mesh.positions, 3 * count, source.execution());
  reserve_large(mesh.triangles, count, source.execution());
  mesh.positions.resize(3 * count);
  mesh.triangles.resize(count);
  constexpr std::size_t block = 1u << 14;
  const StlColors colors(bytes);
  std::atomic<bool> has_colors = false;
  const auto records_of = [&](std::size_t begin, std::size_t end) {
    return bytes.subspan(prelude_size + begin * record_size, (end - begin) * record_size);
  };
  parallel_for(source.execution(), count, block, [&](std::size_t begin, std::size_t end) {
    const Bytes records = records_of(begin, end);
    copy_records(records, begin, mesh);
    if (colors.are_in(records)) has_colors = true;
    source.release(records);
  });
  if (has_colors) {
    mesh.colors.values.resize(count);
    mesh.colors.triangles.resize(count);
    parallel_for(source.execution(), count, block, [&](std::size_t begin, std::size_t end) {
      color_records(records_of(begin, end), colors, begin, mesh);
      source.release(records_of(begin, end));
    });
  }
  scene.instances.push_back({.name = mesh.name, .mesh = 0});
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

}  // namespace frontmost
