// SPDX-License-Identifier: Apache-2.0
// Primitives compressed by Draco. Their decoded arrays become accessors of the file.
//
// Draco's decoder checks what it reads, but allocates memory by the numbers in its data: a stream of 20 bytes may state
// a billion triangles, or an attribute of 255 components. So classes derived from its decoders check these numbers:
//
//   header -> connectivity: counts of faces and seams -> attributes: their components -> values
//             ^ checked                                  ^ checked
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>

#include "io/models/gltf/data.h"

namespace frontmost::gltf {
namespace {

/// Cost of a compressed byte. Many overlapping buffer views may name the same bytes, so their decoding is charged, too.
/// In all, 4 times the size of the file and 16 MiB may be decoded.
constexpr std::size_t cost_of_compressed_byte = 16;

/// A decoded array, packed.
struct DecodedArray {
  Accessor accessor;  ///< without its bytes
  std::vector<std::byte> bytes;

  DecodedArray(Component component, int components, std::size_t count) {
    accessor.component = component;
    accessor.components = accessor.rows = components;
    accessor.count = count;
    accessor.size = accessor.stride = accessor.column_stride = std::size_t(components) * size_of(component);
    bytes.resize(count * accessor.size);
  }
};

// Estimates of the decoder's memory, from its sources: tables with three corners a face, another table for each set of
// attributes with seams of its own, and values with their quantised copies.
constexpr std::uint64_t bytes_of_face = 128, bytes_of_seams = 24, bytes_of_value = 32;
// Honest data need some 200 bytes of memory per compressed byte; regular grids need more. The base is that of Budget.
constexpr std::uint64_t working_base = std::uint64_t(1) << 28, working_factor = 1024;

class WorkingMemory {
 public:
  explicit WorkingMemory(std::uint64_t compressed) : left_(working_base + working_factor * compressed) {}
  /// \returns false if the decoder would exceed its memory.
  [[nodiscard]] bool take(std::uint64_t count, std::uint64_t size) {
    is_exceeded_ = count > left_ / size;
    if (!is_exceeded_) left_ -= count * size;
    return !is_exceeded_;
  }
  [[nodiscard]] bool is_exceeded() const { return is_exceeded_; }

 private:
  std::uint64_t left_;
  bool is_exceeded_ = false;
};

/// Stops the decoder before it decodes values that would take too much memory.
template <class Decoder>
class BoundedDecoder : public Decoder {
 public:
  explicit BoundedDecoder(WorkingMemory& memory) : memory_(memory) {}

 protected:
  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    std::uint64_t size = bytes_of_value * (1 + std::uint64_t(this->num_attributes_decoders()));  // perhaps 0
    for (int i = 0; i < cloud.num_attributes(); ++i)
      size += bytes_of_value + 3 * std::uint64_t(cloud.attribute(i)->byte_stride());
    return memory_.take(cloud.num_points(), size) && Decoder::DecodeAllAttributes();
  }

  WorkingMemory& memory_;
};

using SequentialDecoder = BoundedDecoder<draco::MeshSequentialDecoder>;  // checks its faces against its bytes itself

class EdgebreakerDecoder : public BoundedDecoder<draco::MeshEdgebreakerDecoder> {
 public:
  using BoundedDecoder::BoundedDecoder;

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *buffer();
    std::uint32_t vertices = 0, faces = 0;
    std::uint8_t seams = 0;
    return draco::DecodeVarint(&vertices, &ahead) && draco::DecodeVarint(&faces, &ahead) && ahead.Decode(&seams) &&
           memory_.take(faces, bytes_of_face + bytes_of_seams * seams) &&
           draco::MeshEdgebreakerDecoder::DecodeConnectivity();
  }
};

std::optional<Component> component_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8: return Component::i8;
    case draco::DT_UINT8: return Component::u8;
    case draco::DT_INT16: return Component::i16;
    case draco::DT_UINT16: return Component::u16;
    case draco::DT_UINT32: return Component::u32;
    case draco::DT_FLOAT32: return Component::f32;
    default: return std::nullopt;
  }
}

/// Returns the values of all vertices, or nothing if glTF lacks their type or a vertex has no value.
std::optional<DecodedArray> attribute_of(const draco::PointAttribute& from, std::uint32_t vertex_count) {
  const std::optional<Component> component = component_of(from.data_type());
  if (!component) return std::nullopt;
  DecodedArray to(*component, from.num_components(), vertex_count);
  const std::size_t size = to.accessor.size;
  if (!from.is_mapping_identity() && from.indices_map_size() < vertex_count) return std::nullopt;
  const std::size_t stored = std::min<std::size_t>(from.size(), from.buffer()->data_size() / size);
  for (std::uint32_t i = 0; i < vertex_count; ++i) {
    const draco::AttributeValueIndex value = from.mapped_index(draco::PointIndex(i));
    if (value.value() >= stored) return std::nullopt;
    std::copy_n(reinterpret_cast<const std::byte*>(from.GetAddress(value)), size, to.bytes.data() + i * size);
  }
  return to;
}

/// Returns three vertex numbers of 32 bits for each triangle.
DecodedArray corners_of(const draco::Mesh& from) {
  DecodedArray to(Component::u32, 1, 3 * std::size_t(from.num_faces()));
  for (std::uint32_t i = 0; i < from.num_faces(); ++i) {
    const draco::Mesh::Face& face = from.face(draco::FaceIndex(i));
    const std::uint32_t corners[] = {face[0].value(), face[1].value(), face[2].value()};
    std::copy_n(reinterpret_cast<const std::byte*>(corners), sizeof corners, to.bytes.data() + i * sizeof corners);
  }
  return to;
}

/// Decodes a primitive. `json` is the extension.
void decode_draco(const JsonValue& json, Bytes compressed, draco::Mesh& mesh) {
  const auto* bytes = reinterpret_cast<const char*>(compressed.data());
  draco::DecoderBuffer buffer, ahead;
  buffer.Init(bytes, compressed.size());
  ahead.Init(bytes, compressed.size());
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) json.fail("the buffer view holds no Draco data");
  // The extension requires version 2.2. Nobody writes older versions any more, so the old decoders' code is not used.
  if (header.version_major != 2 || header.version_minor != 2)
    throw Error(ErrorCode::unsupported, json.source().name(), json.place(),
                "version " + std::to_string(header.version_major) + "." + std::to_string(header.version_minor) +
                    " of Draco's format is not supported, only 2.2");
  const draco::DecoderOptions options;
  WorkingMemory memory(compressed.size());
  const draco::Status status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                                   ? EdgebreakerDecoder(memory).Decode(options, &buffer, &mesh)
                                   : SequentialDecoder(memory).Decode(options, &buffer, &mesh);
  if (memory.is_exceeded())
    json.source().fail_limit(json.place(), std::to_string(compressed.size()) +
                                               " bytes of Draco data ask for more memory than " +
                                               "256 MiB and 1024 bytes for each of them");
  if (!status.ok()) json.fail("the Draco data are damaged: " + printable(status.error_msg_string()));
}

}  // namespace

bool has_draco() { return true; }

std::optional<DecodedPrimitive> DracoPrimitives::decode(const JsonValue& primitive) {
  const std::optional<JsonValue> extension = primitive.extension("KHR_draco_mesh_compression");
  if (!extension) return std::nullopt;
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
  draco::Mesh mesh;
  decode_draco(extension, compressed, mesh);
  std::map<std::uint32_t, DecodedArray> attributes;  // by the file's number of the attribute
  for (int k = 0; k < mesh.num_attributes(); ++k)
    if (auto attribute = attribute_of(*mesh.attribute(k), mesh.num_points()))
      attributes.emplace(mesh.attribute(k)->unique_id(), *std::move(attribute));
  const auto add = [&](DecodedArray array) {
    budget_.charge(array.bytes.size(), 1, extension.place(), extension.source());
    array.accessor.bytes = data_.keep(std::move(array.bytes));
    return array.accessor;
  };
  view.indices = data_.add(add(corners_of(mesh)));
  for (auto& [number, attribute] : attributes) view.attributes.emplace(number, add(std::move(attribute)));
  return view;
}

}  // namespace frontmost::gltf
