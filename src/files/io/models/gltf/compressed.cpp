// SPDX-License-Identifier: Apache-2.0
// Reads the extensions for compression and adds the decoded arrays to the file's accessors. The decoders are in files
// of their own.
#include "io/models/gltf/compressed.h"

namespace frontmost::gltf {
namespace {

/// Cost of a compressed byte. Many overlapping buffer views may name the same bytes, so decoding is charged as well: in
/// all, 4 times the file and 16 MiB may be decoded.
constexpr std::size_t cost_of_compressed_byte = 16;

Accessor packed_accessor(Component component, int components, std::size_t count) {
  Accessor accessor;
  accessor.component = component;
  accessor.components = accessor.rows = components;
  accessor.count = count;
  accessor.size = accessor.stride = accessor.column_stride = std::size_t(components) * size_of(component);
  return accessor;
}

}  // namespace

std::optional<JsonValue> find_meshopt(const JsonValue& view) {
  const std::optional<JsonValue> found = view.extension("EXT_meshopt_compression");
  return found ? found : view.extension("KHR_meshopt_compression");
}

std::optional<DecodedPrimitive> DracoPrimitives::decode(const JsonValue& primitive) {
  const std::optional<JsonValue> extension = primitive.extension("KHR_draco_mesh_compression");
  if (!extension || !has_draco()) return std::nullopt;
  const std::uint64_t mode = primitive.unsigned_or("mode", 4);
  if (mode != 4 && mode != 5) extension->fail("holds triangles, but the primitive's mode is " + std::to_string(mode));
  const View& view = view_of(*extension);
  DecodedPrimitive decoded{view.indices, {}};
  const JsonValue numbers = extension->require("attributes"), stated = primitive.require("attributes");
  for (const std::string& name : numbers.keys()) {
    const JsonValue json = numbers.require(name.c_str());
    const std::uint32_t number = json.to_index(no_index);
    const auto attribute = view.attributes.find(number);
    if (attribute == view.attributes.end()) json.fail("the Draco data have no attribute " + std::to_string(number));
    Accessor accessor = attribute->second;
    accessor.normalized = data_.accessor(stated.require(name.c_str()).to_index(data_.accessor_count())).normalized;
    const std::uint32_t view_id = extension->require("bufferView").to_index(data_.view_count());
    const auto [known, is_new] = accessors_.try_emplace({view_id, number, accessor.normalized});
    if (is_new) known->second = data_.add(accessor);
    decoded.attributes.emplace(name, known->second);
  }
  return decoded;
}

const DracoPrimitives::View& DracoPrimitives::view_of(const JsonValue& extension) {
  const JsonValue json = extension.require("bufferView");
  const auto [entry, is_new] = views_.try_emplace(json.to_index(data_.view_count()));
  View& view = entry->second;
  if (!is_new) return view;
  const Bytes compressed = data_.view_bytes(entry->first, extension);
  budget_.charge(compressed.size(), cost_of_compressed_byte, extension.place(), extension.source());
  DracoMesh mesh = decode_draco(extension, compressed);
  const auto add = [&](Accessor accessor, std::vector<std::byte> bytes) {
    budget_.charge(bytes.size(), 1, extension.place(), extension.source());
    accessor.bytes = data_.keep(std::move(bytes));
    return accessor;
  };
  const std::size_t corner_count = mesh.corners.size() / sizeof(std::uint32_t);
  view.indices = data_.add(add(packed_accessor(Component::u32, 1, corner_count), std::move(mesh.corners)));
  for (auto& [number, attribute] : mesh.attributes)
    view.attributes.emplace(number, add(packed_accessor(attribute.component, attribute.components, mesh.vertex_count),
                                        std::move(attribute.values)));
  return view;
}

}  // namespace frontmost::gltf
