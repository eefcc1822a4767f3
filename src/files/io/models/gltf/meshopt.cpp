// SPDX-License-Identifier: Apache-2.0
// Buffer views compressed by meshoptimizer. Its decoders check their input, but only assert counts and strides. Counts
// and strides are checked here, and so is whether the bytes can hold the stated amount.
#include <meshoptimizer.h>

#include "io/models/gltf/data.h"

namespace frontmost::gltf {
namespace {

/// The most bytes that one compressed byte can produce: 64 for vertices, because two bits can stand for 16 zero bytes,
/// and 12 for indices.
constexpr std::uint64_t densest = 64;

struct MeshoptStream {
  std::size_t count, stride;
  std::string mode, filter;
  Bytes bytes;
};

[[noreturn]] void fail_unsupported(const JsonValue& json, const std::string& what) {
  throw Error(ErrorCode::unsupported, json.source().name(), json.place(), printable(what) + " is not supported");
}

MeshoptStream read_stream(const JsonValue& json, Bytes compressed, std::uint64_t length) {
  MeshoptStream s{json.require("count").to_unsigned(), json.require("byteStride").to_unsigned(),
                  json.require("mode").to_string(), json.string_or_empty("filter"), compressed};
  const bool is_triangles = s.mode == "TRIANGLES", is_indices = s.mode == "INDICES";
  if (s.mode != "ATTRIBUTES" && !is_triangles && !is_indices) fail_unsupported(json, "mode " + s.mode);
  const bool stride_fits =
      is_triangles || is_indices ? s.stride == 2 || s.stride == 4 : s.stride % 4 == 0 && s.stride - 1 < 256;
  if (!stride_fits) json.fail("byteStride " + std::to_string(s.stride) + " does not fit mode " + s.mode);
  if (is_triangles && s.count % 3 != 0) json.fail("count " + std::to_string(s.count) + " is no multiple of 3");
  if (s.count > length / s.stride || s.count * s.stride != length)
    json.fail(std::to_string(s.count) + " elements of " + std::to_string(s.stride) + " bytes, but the view has " +
              std::to_string(length));
  if (length / densest > compressed.size())
    json.fail(std::to_string(compressed.size()) + " bytes cannot hold " + std::to_string(length));
  return s;
}

int decode_stream(const MeshoptStream& s, std::byte* out) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(s.bytes.data());
  if (s.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out, s.count, s.stride, bytes, s.bytes.size());
  if (s.mode == "INDICES") return meshopt_decodeIndexSequence(out, s.count, s.stride, bytes, s.bytes.size());
  return meshopt_decodeVertexBuffer(out, s.count, s.stride, bytes, s.bytes.size());
}

void undo_filter(const JsonValue& json, const MeshoptStream& s, std::byte* values) {
  if (s.filter.empty() || s.filter == "NONE") return;
  const auto check = [&](bool fits) {
    if (!fits || s.mode != "ATTRIBUTES")
      json.fail("filter " + s.filter + " does not fit mode " + s.mode + " and byteStride " + std::to_string(s.stride));
  };
  if (s.filter == "OCTAHEDRAL") {
    check(s.stride == 4 || s.stride == 8);
    meshopt_decodeFilterOct(values, s.count, s.stride);
  } else if (s.filter == "QUATERNION") {
    check(s.stride == 8);
    meshopt_decodeFilterQuat(values, s.count, s.stride);
  } else if (s.filter == "EXPONENTIAL") {
    check(true);
    meshopt_decodeFilterExp(values, s.count, s.stride);
  } else {
    fail_unsupported(json, "filter " + s.filter);
  }
}

}  // namespace

bool has_meshopt() { return true; }

std::vector<std::byte> decode_meshopt(const JsonValue& json, Bytes compressed, std::uint64_t length) {
  const MeshoptStream stream = read_stream(json, compressed, length);
  std::vector<std::byte> values(length);
  if (stream.count == 0) return values;
  if (decode_stream(stream, values.data()) != 0) {
    // KHR_meshopt_compression also allows version 1 of the vertex format, which libraries before 0.23 do not decode.
    if (!compressed.empty() && compressed[0] == std::byte{0xA1})
      fail_unsupported(json, "version 1 of the vertex format");
    json.fail("the " + std::to_string(compressed.size()) + " bytes are damaged, or not of mode " + stream.mode);
  }
  undo_filter(json, stream, values.data());
  return values;
}

}  // namespace frontmost::gltf
