// SPDX-License-Identifier: Apache-2.0
// Writer of GLB: objects that refer to meshes, one primitive for each material of a mesh, materials with layers and
// textures.
#include <cmath>

#include "io/images/png/texture_bytes.h"
#include "io/model_files/glb_document.h"
#include "io/model_files/glb_vertices.h"
#include "io/model_files/model_files.h"
#include "io/row_bytes.h"

namespace frontmost::detail {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of these constants in glTF.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;

Json sampler_json(const Texture& texture) {
  constexpr int wraps[] = {10497, 33648, 33071};
  return {{"magFilter", texture.nearest ? 9728 : 9729},
          {"minFilter", texture.nearest ? 9728 : 9987},
          {"wrapS", wraps[int(texture.wrap_u)]},
          {"wrapT", wraps[int(texture.wrap_v)]}};
}

/// Adds one attribute of a primitive's vertices. \returns the number of its accessor.
template <class Value, class Of>
std::size_t add_values(GlbDocument& document, const WeldedCorners& corners, const char* type, const Of& of) {
  std::string bytes;
  Value low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
  for (const CornerKey& vertex : corners.vertices) {
    const Value value = of(vertex);
    for (int k = 0; k < Value::length(); ++k) append_bytes(bytes, value[k]);
    low = glm::min(low, value);
    high = glm::max(high, value);
  }
  Json accessor = {{"componentType", kFloat}, {"count", corners.vertices.size()}, {"type", type}};
  for (int k = 0; k < Value::length(); ++k) {
    accessor["min"].push_back(low[k]);
    accessor["max"].push_back(high[k]);
  }
  return document.add_accessor(std::move(accessor), bytes, kVertices);
}

template <class T>
bool is_all_finite(const std::vector<T>& values) {
  for (const T& value : values)
    for (int k = 0; k < T::length(); ++k)
      if (!std::isfinite(value[k])) return false;
  return true;
}

/// glTF requires normals of unit length. If any normal has no direction, none are written, and readers compute them.
bool has_normals(const Mesh& mesh) {
  return !mesh.normals.empty() && is_all_finite(mesh.normals.values) &&
         std::all_of(mesh.normals.values.begin(), mesh.normals.values.end(),
                     [](const glm::vec3& n) { return glm::length(glm::dvec3(n)) > 1e-30; });
}

/// The primitive that holds the triangles of one material.
Json part_json(GlbDocument& document, const Mesh& mesh, std::uint32_t material,
               const std::vector<std::uint32_t>& triangles) {
  const WeldedCorners corners = weld_corners(mesh, triangles);
  Json attributes;
  attributes["POSITION"] =
      add_values<glm::vec3>(document, corners, "VEC3", [&](const CornerKey& v) { return mesh.positions[v[0]]; });
  if (has_normals(mesh))
    attributes["NORMAL"] = add_values<glm::vec3>(document, corners, "VEC3", [&](const CornerKey& v) {
      return glm::vec3(glm::normalize(glm::dvec3(mesh.normals.values[v[1]])));
    });
  if (!mesh.colors.empty() && is_all_finite(mesh.colors.values))
    attributes["COLOR_0"] =
        add_values<glm::vec4>(document, corners, "VEC4", [&](const CornerKey& v) { return mesh.colors.values[v[2]]; });
  for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
    if (const auto* coordinates = mesh.texcoord_set(set); coordinates && is_all_finite(coordinates->values))
      attributes["TEXCOORD_" + std::to_string(set)] = add_values<glm::vec2>(
          document, corners, "VEC2", [&](const CornerKey& v) { return coordinates->values[v[3 + set]]; });
  std::string bytes;
  for (const std::uint32_t index : corners.indices) append_bytes(bytes, index);
  Json part = {{"attributes", std::move(attributes)}};
  part["indices"] = document.add_accessor(
      {{"componentType", kUnsignedInt}, {"count", corners.indices.size()}, {"type", "SCALAR"}}, bytes, kIndices);
  part["material"] = document.material(material);
  return part;
}

/// Null if nothing of the mesh can be written.
Json mesh_json(GlbDocument& document, const Mesh& mesh) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> triangles;  // by material
  const auto is_finite_at = [&](std::uint32_t vertex) { return is_finite(mesh.positions[vertex]); };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& c = mesh.triangles[t];
    if (is_finite_at(c.x) && is_finite_at(c.y) && is_finite_at(c.z)) triangles[mesh.material_of(t)].push_back(t);
  }
  Json parts = Json::array();
  for (const auto& [material, list] : triangles) parts.push_back(part_json(document, mesh, material, list));
  return parts.empty() ? Json() : Json{{"name", utf8_text(mesh.name)}, {"primitives", std::move(parts)}};
}

/// The transform from the scene's axes and origin to the axes of glTF's world, in which y is up and z is front.
Json root_matrix(const Scene& scene) {
  const glm::dvec3 up = direction(scene.up), right = up.x == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 front = glm::cross(right, up);
  // Each row is an axis of the result in scene coordinates.
  const glm::dvec3 rows[3] = {right, up, front};
  Json matrix = Json::array();
  for (int column = 0; column < 3; ++column) {
    for (const glm::dvec3& row : rows) matrix.push_back(row[column]);
    matrix.push_back(0);
  }
  for (const glm::dvec3& row : rows) matrix.push_back(glm::dot(row, scene.origin));
  matrix.push_back(1);
  return matrix;
}

Json node_json(const Instance& instance, const Json& mesh) {
  Json node = {{"name", utf8_text(instance.name)}};
  if (!mesh.is_null()) node["mesh"] = mesh;
  if (instance.world_from_mesh == glm::dmat4(1.0)) return node;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      node["matrix"].push_back(row == 3 ? double(column == 3) : instance.world_from_mesh[column][row]);
  return node;
}

/// Writes the objects, below one node if the scene's axes or origin differ from the file's.
void write_nodes(const Scene& scene, GlbDocument& document) {
  std::map<std::uint32_t, Json> meshes;  // number in the document, by number in the scene
  Json nodes = Json::array();
  for (const Instance& instance : scene.instances) {
    auto found = meshes.find(instance.mesh);
    if (found == meshes.end()) {
      Json mesh = mesh_json(document, scene.meshes[instance.mesh]);
      found = meshes.emplace(instance.mesh, Json()).first;
      if (!mesh.is_null()) {
        found->second = document.json["meshes"].size();
        document.json["meshes"].push_back(std::move(mesh));
      }
    }
    nodes.push_back(node_json(instance, found->second));
  }
  Json all = Json::array();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) all.push_back(i);
  if (!all.empty() && (scene.up != Axis::y || scene.origin != glm::dvec3(0))) {
    nodes.push_back({{"name", utf8_text(scene.name)}, {"matrix", root_matrix(scene)}, {"children", all}});
    all = Json::array({scene.instances.size()});
  }
  Json& json = document.json;
  if (!nodes.empty()) json["nodes"] = std::move(nodes);
  json["scene"] = 0;
  json["scenes"] = Json::array({all.empty() ? Json::object() : Json{{"nodes", all}}});
}

void append_chunk(std::string& file, const std::string& chunk, const char* type) {
  append_bytes(file, std::uint32_t(chunk.size()));
  file.append(type, 4);
  file += chunk;
}

}  // namespace

std::size_t GlbDocument::add_view(const std::string& bytes, int target) {
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  buffer += bytes;
  json["bufferViews"].push_back(std::move(view));
  return json["bufferViews"].size() - 1;
}

std::size_t GlbDocument::add_accessor(Json accessor, const std::string& bytes, int target) {
  accessor["bufferView"] = add_view(bytes, target);
  json["accessors"].push_back(std::move(accessor));
  return json["accessors"].size() - 1;
}

std::size_t GlbDocument::texture(std::uint32_t number) {
  const auto [place, is_new] = textures_.emplace(number, textures_.size());
  if (is_new) {
    const Texture& texture = scene_.textures[number];
    json["images"].push_back({{"name", utf8_text(texture.name)},
                              {"mimeType", "image/png"},
                              {"bufferView", add_view(png_bytes(texture), 0)}});
    json["samplers"].push_back(sampler_json(texture));
    json["textures"].push_back({{"sampler", place->second}, {"source", place->second}});
  }
  return place->second;
}

std::size_t GlbDocument::material(std::uint32_t number) {
  const auto [place, is_new] = materials_.emplace(number, materials_.size());
  if (is_new) {
    static const Material standard;
    Json material = material_json(number == no_index ? standard : scene_.materials[number], *this);
    json["materials"].push_back(std::move(material));
  }
  return place->second;
}

void write_glb(const Scene& scene, OutputFile& file) {
  GlbDocument document(scene);
  write_nodes(scene, document);
  if (!document.extensions().empty()) document.json["extensionsUsed"] = document.extensions();
  document.buffer.resize((document.buffer.size() + 3) / 4 * 4, '\0');
  if (!document.buffer.empty()) document.json["buffers"] = Json::array({{{"byteLength", document.buffer.size()}}});
  std::string text = document.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + text.size() + (document.buffer.empty() ? 0 : 8 + document.buffer.size());
  if (size > 0xFFFFFFFF) throw Error(ErrorCode::limit_exceeded, file.name(), "GLB", "more than 4 GiB");
  std::string head = "glTF";
  append_bytes(head, std::uint32_t(2));
  append_bytes(head, std::uint32_t(size));
  append_chunk(head, text, "JSON");
  file.write(std::as_bytes(std::span(head)));
  if (document.buffer.empty()) return;
  std::string chunk;
  append_bytes(chunk, std::uint32_t(document.buffer.size()));
  chunk.append("BIN\0", 4);
  file.write(std::as_bytes(std::span(chunk)));
  file.write(std::as_bytes(std::span(document.buffer)));
}

}  // namespace frontmost::detail
