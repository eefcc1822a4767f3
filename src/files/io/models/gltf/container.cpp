// SPDX-License-Identifier: Apache-2.0
// Splits a GLB file into chunks, or passes on plain JSON text. Lengths are checked against the rest of the file first.

#include "io/models/gltf/container.h"

#include <cstdint>
#include <cstring>

namespace frontmost::gltf {
namespace {

// "JSON" and "BIN\0", read as little-endian numbers as the format defines them.
constexpr std::uint32_t json_type = 0x4E4F534A, binary_type = 0x004E4942;
constexpr std::size_t header_size = 12, chunk_header_size = 8;

// Reads bytes one by one, so that neither alignment nor the machine's byte order matters.
std::uint32_t little_endian(Bytes bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

/// The bytes within the length that the header states.
Bytes checked_body(Bytes bytes, const ModelSource& source) {
  if (bytes.size() < header_size) source.fail("GLB header", "the file ends within it");
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2)
    throw Error(version == 1 ? ErrorCode::unsupported : ErrorCode::file_malformed, source.name(), "GLB header",
                "version " + std::to_string(version) + " is not supported, only 2");
  if (length > bytes.size())
    source.fail("GLB header", "the length is stated as " + std::to_string(length) + " bytes, the file has " +
                                  std::to_string(bytes.size()));
  if (length < header_size + chunk_header_size) source.fail("GLB header", "no room for a chunk");
  // Bytes behind the stated length belong to no chunk.
  return bytes.first(length);
}

void take_chunk(Container& container, std::uint32_t type, Bytes chunk, std::size_t number, const ModelSource& source) {
  const std::string place = "GLB chunk " + std::to_string(number);
  if (number == 0) {
    if (type != json_type) source.fail(place, "the first chunk must be JSON");
    container.json = text_of(chunk);
  } else if (type == json_type) {
    source.fail(place, "a second JSON chunk");
  } else if (type == binary_type) {
    // Chunks of other types may follow and are to be ignored (glTF 2.0, section 4.4). A late BIN chunk is an error
    // nevertheless, because a buffer without a URI could mean either one.
    if (number != 1) source.fail(place, "a BIN chunk that is not the second one");
    container.binary = chunk;
    container.has_binary = true;
  }
}

}  // namespace

Container open_container(Bytes bytes, const ModelSource& source) {
  Container container;
  if (!text_of(bytes).starts_with("glTF")) {
    container.json = text_of(bytes);
    return container;
  }
  container.is_glb = true;
  Bytes rest = checked_body(bytes, source).subspan(header_size);
  for (std::size_t number = 0; !rest.empty(); ++number) {
    const std::string place = "GLB chunk " + std::to_string(number);
    if (rest.size() < chunk_header_size) source.fail(place, "the file ends within its header");
    const std::uint32_t length = little_endian(rest, 0), type = little_endian(rest, 4);
    rest = rest.subspan(chunk_header_size);
    if (length > rest.size())
      source.fail(place, "its length is stated as " + std::to_string(length) + " bytes, " +
                             std::to_string(rest.size()) + " are left");
    take_chunk(container, type, rest.first(length), number, source);
    rest = rest.subspan(length);
  }
  return container;
}

}  // namespace frontmost::gltf
