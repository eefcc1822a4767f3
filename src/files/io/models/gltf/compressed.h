// SPDX-License-Identifier: Apache-2.0
// Compressed arrays of a glTF file: buffer views by meshoptimizer, and arrays of a primitive by Draco. Each decoder is
// an optional part of a build; *_absent.cpp stands for a decoder that is left out.
//
//   bufferViews[3]             --EXT_meshopt_compression----> bytes of the view
//   meshes[0].primitives[0]    --KHR_draco_mesh_compression-> corners and attributes, as further accessors
//
// The range of the bytes is checked before a decoder gets them, and stated sizes are checked before memory is
// allocated.
#pragma once

#include <tuple>

#include "io/models/gltf/data.h"

namespace frontmost::gltf {

/// Whether this build contains the decoder.
[[nodiscard]] bool has_meshopt();
[[nodiscard]] bool has_draco();

/// EXT_meshopt_compression or KHR_meshopt_compression of a buffer view, or nothing.
[[nodiscard]] std::optional<JsonValue> find_meshopt(const JsonValue& view);

/// Decodes a compressed view to `length` bytes. `json` is the extension. Precondition: has_meshopt().
/// \throws Error file_malformed, unsupported.
[[nodiscard]] std::vector<std::byte> decode_meshopt(const JsonValue& json, Bytes compressed, std::uint64_t length);

struct DracoAttribute {
  Component component{};
  int components = 0;
  std::vector<std::byte> values;  ///< packed, one element for each vertex
};

/// Arrays that Draco decoded.
struct DracoMesh {
  std::size_t vertex_count = 0;
  std::vector<std::byte> corners;                      ///< three for each triangle, 32 bits
  std::map<std::uint32_t, DracoAttribute> attributes;  ///< by the file's number of the attribute
};

/// Decodes a primitive. `json` is the extension. Precondition: has_draco().
/// \throws Error file_malformed, unsupported, limit_exceeded.
[[nodiscard]] DracoMesh decode_draco(const JsonValue& json, Bytes compressed);

/// Accessors of a primitive's decoded arrays.
struct DecodedPrimitive {
  std::uint32_t indices = no_index;
  std::map<std::string, std::uint32_t> attributes;
};

/// Decodes each buffer view of KHR_draco_mesh_compression once, and adds its arrays to the file's accessors.
class DracoPrimitives {
 public:
  explicit DracoPrimitives(Data& data) : data_(data), budget_(data.byte_count()) {}
  /// Empty if the primitive is not compressed or if this build has no Draco.
  [[nodiscard]] std::optional<DecodedPrimitive> decode(const JsonValue& primitive);

 private:
  struct View {
    std::uint32_t indices = no_index;
    std::map<std::uint32_t, Accessor> attributes;
  };
  const View& view_of(const JsonValue& extension);

  Data& data_;
  Budget budget_;
  std::map<std::uint32_t, View> views_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::uint32_t> accessors_;
};

}  // namespace frontmost::gltf
