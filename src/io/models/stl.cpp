// SPDX-License-Identifier: Apache-2.0
// Binary STL, and the choice between the two encodings. Stored normals are not kept: they follow from the corners.
#include "io/models/stl.h"

#include <algorithm>
#include <cstring>

#include "base/large_pages.h"
#include "base/parallel.h"
#include "io/models/bytes.h"

namespace frontmost {
namespace {

constexpr std::size_t header_size = 80, prelude_size = 84, record_size = 50;
constexpr std::size_t normal_size = 12, corners_size = 36;
// Every triangle has three vertices of its own, which 32-bit indices must reach.
constexpr std::uint64_t max_triangles = no_index / 3;

bool is_text(Bytes bytes) {
  const Bytes start = bytes.first(std::min<std::size_t>(bytes.size(), 1024));
  return std::none_of(start.begin(), start.end(), [](std::byte b) {
    const auto c = std::to_integer<unsigned char>(b);
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

bool starts_like_ascii(Bytes bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  std::size_t i = 0;
  while (i < bytes.size() && (text[i] == ' ' || text[i] == '\t' || text[i] == '\n' || text[i] == '\r')) ++i;
  const auto is = [&](std::string_view word) {
    if (bytes.size() - i < word.size()) return false;
    for (std::size_t k = 0; k < word.size(); ++k)
      if ((text[i + k] | 0x20) != word[k]) return false;
    return true;
  };
  return is("solid") || is("facet");
}

std::uint64_t promised_count(Bytes bytes) {
  return read_value<std::uint32_t>(bytes.data() + header_size, Endian::little);
}

/// How many triangles to read, after holding the header against the size. Writers that cannot seek back leave 0 or
/// 0xFFFFFFFF as the count; then the size decides, if it fits whole records.
std::size_t checked_count(Bytes bytes, const ModelSource& source, Scene& scene) {
  const std::uint64_t promised = promised_count(bytes);
  const std::uint64_t room = bytes.size() - prelude_size, whole = room / record_size;
  const std::string place = "byte " + std::to_string(header_size);
  std::uint64_t count = promised;
  if ((promised == 0 || promised == 0xFFFFFFFFu) && room > 0 && room % record_size == 0) {
    scene.warnings.push_back(place + ": the triangle count was left open, the size of the file gives " +
                             std::to_string(whole));
    count = whole;
  } else if (promised > whole) {
    source.fail("triangle " + std::to_string(whole),
                "the file ends here, but its header promises " + std::to_string(promised) + " triangles");
  } else if (room > promised * record_size) {
    scene.warnings.push_back("byte " + std::to_string(prelude_size + promised * record_size) + ": " +
                             std::to_string(room - promised * record_size) +
                             " bytes after the last triangle were passed over");
  }
  if (count > max_triangles)
    source.fail_limit(place, std::to_string(count) + " triangles are more than " + std::to_string(max_triangles));
  return std::size_t(count);
}

/// The solid's name, if the header is text. Exporters often put "solid NAME" there.
std::string header_name(Bytes bytes) {
  std::string name(reinterpret_cast<const char*>(bytes.data()), header_size);
  name.resize(std::min(name.find('\0'), name.size()));
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) return {};
  if (name.starts_with("solid ")) name.erase(0, 6);
  name.erase(name.find_last_not_of(' ') + 1);
  return name;
}

}  // namespace

StlEncoding stl_encoding(Bytes bytes) {
  if (bytes.size() >= prelude_size) {
    const std::uint64_t room = bytes.size() - prelude_size, needed = promised_count(bytes) * record_size;
    if (room == needed) return StlEncoding::binary;
    if (!is_text(bytes)) return room > needed && needed > 0 ? StlEncoding::binary : StlEncoding::neither;
  }
  return starts_like_ascii(bytes) && is_text(bytes) ? StlEncoding::ascii : StlEncoding::neither;
}

Scene read_stl(Bytes bytes, const ModelSource& source) {
  const StlEncoding encoding = stl_encoding(bytes);
  if (encoding == StlEncoding::ascii) return read_ascii_stl(bytes, source);
  if (encoding == StlEncoding::binary) return read_binary_stl(bytes, source);
  if (is_text(bytes)) source.fail("line 1", "text STL starts with \"solid\"");
  if (bytes.size() < prelude_size)
    source.fail("byte " + std::to_string(bytes.size()), "the file ends within the 84 bytes of a binary STL header");
  return read_binary_stl(bytes, source);
}

Scene read_binary_stl(Bytes bytes, const ModelSource& source) {
  Scene scene;
  const std::size_t count = checked_count(bytes, source, scene);
  if (count == 0) return scene;
  Mesh mesh;
  mesh.name = header_name(bytes);
  reserve_large(mesh.positions, 3 * count);
  reserve_large(mesh.triangles, count);
  // In blocks small enough that growing (which writes zeros) and filling meet in the cache.
  constexpr std::size_t block = 8192;
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t end = std::min(count, begin + block);
    mesh.positions.resize(3 * end);
    mesh.triangles.resize(end);
    const std::byte* record = bytes.data() + prelude_size + begin * record_size;
    for (std::size_t t = begin; t < end; ++t, record += record_size) {
      std::memcpy(&mesh.positions[3 * t], record + normal_size, corners_size);
      mesh.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
    }
    source.release(bytes.subspan(begin * record_size, (end - begin) * record_size));
    check_cancelled(source.execution());
  }
  if constexpr (native_endian == Endian::big)
    for (glm::vec3& p : mesh.positions)
      for (int k = 0; k < 3; ++k) p[k] = read_value<float>(reinterpret_cast<const std::byte*>(&p[k]), Endian::little);
  scene.instances.push_back({.name = mesh.name, .mesh = 0});
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

}  // namespace frontmost
