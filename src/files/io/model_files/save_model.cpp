// SPDX-License-Identifier: Apache-2.0
// Writes models: chooses the format by suffix, PLY, binary STL or GLB. A GLB is a glTF document of objects that refer
// to meshes. A mesh has one primitive for each of its materials, and materials have layers and textures. The document
// is JSON that names pieces of one buffer.
//
//   Mesh       positions 0 1 2 3      normals 0 1 with indices of their own: a corner is (position, normal, ...)
//   glTF       vertices (0, 0) (1, 0) (1, 1) ...: each pair that a corner has, once
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "io/binary.h"
#include "io/images/formats.h"
#include "io/input_file.h"

namespace frontmost {
namespace {

using detail::append_bytes;
using detail::FileBytes;

/// The triangles of one object in the file's coordinates. Triangles of mirrored objects get the opposite winding, so
/// that their outer side stays outside.
class PlacedMesh {
 public:
  PlacedMesh(const Scene& scene, const Instance& instance)
      : mesh_(scene.meshes[instance.mesh]),
        place_(instance.world_from_mesh),
        origin_(scene.origin),
        is_mirrored_(glm::determinant(glm::dmat3(place_)) < 0) {}

  [[nodiscard]] std::size_t vertex_count() const { return mesh_.positions.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return mesh_.triangles.size(); }
  [[nodiscard]] glm::dvec3 vertex(std::size_t i) const {
    return origin_ + glm::dvec3(place_ * glm::dvec4(mesh_.positions[i], 1));
  }
  [[nodiscard]] glm::uvec3 corners(std::size_t triangle) const {
    const glm::uvec3& c = mesh_.triangles[triangle];
    return is_mirrored_ ? glm::uvec3(c.x, c.z, c.y) : c;
  }

 private:
  const Mesh& mesh_;
  const glm::dmat4& place_;
  glm::dvec3 origin_;
  bool is_mirrored_;
};

std::string ply_header(const Scene& scene, const Table& of_triangles) {
  std::uint64_t vertices = 0;
  for (const Instance& instance : scene.instances) vertices += scene.meshes[instance.mesh].positions.size();
  if (vertices >= no_index) throw Error(ErrorCode::limit_exceeded, "PLY", "more than 4294967294 vertices");
  // Floats suffice for a scene about zero; a scene far from zero needs doubles.
  const std::string real = scene.origin == glm::dvec3(0) ? "float" : "double";
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const char* const axis : {" x\n", " y\n", " z\n"}) text += "property " + real + axis;
  text += "element face " + std::to_string(triangle_count(scene)) + "\nproperty list uchar uint vertex_indices\n";
  constexpr const char* types[] = {"uchar ", "uint ", "double "};
  for (const TableColumn& column : of_triangles.columns)
    text += std::string("property ") + types[column.values.index()] + column.name + "\n";
  return text + "end_header\n";
}

/// Writes all objects as one mesh, with further properties of its faces.
void write_ply(const Scene& scene, const Table& of_triangles, OutputFile& file) {
  FileBytes sink(file);
  sink.bytes() = ply_header(scene, of_triangles);
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
      const glm::dvec3 at = mesh.vertex(i);
      for (int axis = 0; axis < 3; ++axis) {
        if (scene.origin == glm::dvec3(0))
          append_bytes(sink.bytes(), float(at[axis]));
        else
          append_bytes(sink.bytes(), at[axis]);
      }
      sink.pass_on();
    }
  }
  std::uint32_t first = 0;
  std::size_t row = 0;
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i, ++row) {
      const glm::uvec3 corners = mesh.corners(i);
      sink.bytes() += '\3';
      for (int k = 0; k < 3; ++k) append_bytes(sink.bytes(), first + corners[k]);
      for (const TableColumn& column : of_triangles.columns) append_bytes(sink.bytes(), column, row);
      sink.pass_on();
    }
    first += std::uint32_t(mesh.vertex_count());
  }
  sink.finish();
}

/// Writes triangles and their normals, and nothing else.
void write_stl(const Scene& scene, OutputFile& file) {
  FileBytes sink(file);
  sink.bytes() = "Frontmost";  // anything but "solid", which begins the text form of STL
  sink.bytes().resize(80, ' ');
  append_bytes(sink.bytes(), std::uint32_t(triangle_count(scene)));
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      const glm::uvec3 corners = mesh.corners(i);
      const glm::dvec3 at[3] = {mesh.vertex(corners.x), mesh.vertex(corners.y), mesh.vertex(corners.z)};
      const glm::dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
      const double length = glm::length(normal);
      const glm::dvec3 unit = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0);
      for (const glm::dvec3& row : {unit, at[0], at[1], at[2]})
        for (int axis = 0; axis < 3; ++axis) append_bytes(sink.bytes(), float(row[axis]));
      sink.bytes() += {'\0', '\0'};
      sink.pass_on();
    }
  }
  sink.finish();
}

using Json = nlohmann::ordered_json;

// The numbers by which glTF names types and uses of buffers.
constexpr int float_type = 5126, unsigned_int_type = 5125, vertex_target = 34962, index_target = 34963;

float within(float value, float low, float high) { return std::clamp(std::isfinite(value) ? value : low, low, high); }

Json color_json(const glm::vec3& color) {
  return Json::array({within(color.x, 0, 1), within(color.y, 0, 1), within(color.z, 0, 1)});
}

Json sampler_json(const Texture& texture) {
  constexpr int wraps[] = {10497, 33648, 33071};
  return {{"magFilter", texture.nearest ? 9728 : 9729},
          {"minFilter", texture.nearest ? 9728 : 9987},
          {"wrapS", wraps[int(texture.wrap_u)]},
          {"wrapT", wraps[int(texture.wrap_v)]}};
}

/// A document under construction.
class GlbDocument {
 public:
  explicit GlbDocument(const Scene& scene) : scene_(scene) {}

  /// The whole JSON part except for the buffer, which is the file's second part.
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "Frontmost"}}}};
  std::string buffer;

  /// Appends bytes to the buffer, aligned to four. `target` is glTF's number for the use of the view, or 0. \returns
  /// the number of the view.
  std::size_t add_view(const std::string& bytes, int target) {
    pad_buffer();
    Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    buffer += bytes;
    return append("bufferViews", std::move(view));
  }
  /// Adds an accessor and a view with its bytes. \returns the number of the accessor.
  std::size_t add_accessor(Json accessor, const std::string& bytes, int target) {
    accessor["bufferView"] = add_view(bytes, target);
    return append("accessors", std::move(accessor));
  }
  /// Returns the number that the scene's texture or material `number` has in the document; no_index is the default
  /// material. The first request adds the texture or material to the document.
  std::size_t texture(std::uint32_t number) {
    const auto [place, is_new] = textures_.emplace(number, textures_.size());
    if (is_new) {
      const Texture& texture = scene_.textures[number];
      append("images", {{"name", utf8_text(texture.name)},
                        {"mimeType", "image/png"},
                        {"bufferView", add_view(detail::png_bytes(texture), 0)}});
      append("samplers", sampler_json(texture));
      append("textures", {{"sampler", place->second}, {"source", place->second}});
    }
    return place->second;
  }
  std::size_t material(std::uint32_t number);
  /// Adds an element to a list of the document. \returns its number.
  std::size_t append(const char* list, Json element) {
    json[list].push_back(std::move(element));
    return json[list].size() - 1;
  }
  void pad_buffer() { buffer.resize((buffer.size() + 3) / 4 * 4, '\0'); }
  /// Notes that an extension is used. \returns its name.
  const char* uses(const char* extension) {
    extensions_.insert(extension);
    return extension;
  }
  [[nodiscard]] const std::set<std::string>& extensions() const { return extensions_; }

 private:
  const Scene& scene_;
  std::map<std::uint32_t, std::size_t> textures_, materials_;
  std::set<std::string> extensions_;
};

/// Writes a material. Each use of a texture is written in the JSON object that it belongs to. Values that equal glTF's
/// defaults and layers that are absent are left out.
class MaterialWriter {
 public:
  explicit MaterialWriter(GlbDocument& document) : document_(document) {}

  [[nodiscard]] Json write(const Material& material) {
    Json json = {{"name", utf8_text(material.name)}};
    Json& surface = json["pbrMetallicRoughness"];
    Json base = color_json(material.base_color);
    base.push_back(within(material.base_color.w, 0, 1));
    surface["baseColorFactor"] = std::move(base);
    surface["metallicFactor"] = within(material.metallic, 0, 1);
    surface["roughnessFactor"] = within(material.roughness, 0, 1);
    set(surface, "baseColorTexture", material.base_color_texture);
    set(surface, "metallicRoughnessTexture", material.metallic_roughness_texture);
    set_scaled(json, "normalTexture", material.normal_texture, "scale", material.normal_scale);
    set_scaled(json, "occlusionTexture", material.occlusion_texture, "strength",
               within(material.occlusion_strength, 0, 1));
    write_emission(json, material);
    if (material.alpha == Material::Alpha::mask) {
      json["alphaMode"] = "MASK";
      json["alphaCutoff"] = within(material.alpha_cutoff, 0, 1e30f);
    } else if (material.alpha == Material::Alpha::blend) {
      json["alphaMode"] = "BLEND";
    }
    if (material.double_sided) json["doubleSided"] = true;
    write_layers(json, material);
    return json;
  }

 private:
  void set(Json& object, const char* key, const TextureUse& use) {
    if (use.is_set()) object[key] = texture_json(use);
  }
  void set_scaled(Json& object, const char* key, const TextureUse& use, const char* factor, float value) {
    if (!use.is_set()) return;
    object[key] = texture_json(use);
    object[key][factor] = value;
  }
  Json texture_json(const TextureUse& use) {
    Json json = {{"index", document_.texture(use.texture)}};
    if (use.set != 0) json["texCoord"] = use.set;
    if (use.offset == glm::vec2(0) && use.scale == glm::vec2(1) && use.rotation == 0) return json;
    json["extensions"][document_.uses("KHR_texture_transform")] = {
        {"offset", {use.offset.x, use.offset.y}}, {"rotation", use.rotation}, {"scale", {use.scale.x, use.scale.y}}};
    return json;
  }
  /// Writes the emitted light. Its strength is written separately if it is above 1.
  void write_emission(Json& json, const Material& material) {
    const float most = std::max({material.emissive.x, material.emissive.y, material.emissive.z});
    set(json, "emissiveTexture", material.emissive_texture);
    if (!(most > 0) || !std::isfinite(most)) return;
    json["emissiveFactor"] = color_json(material.emissive / std::max(most, 1.0f));
    if (most > 1) json["extensions"][document_.uses("KHR_materials_emissive_strength")]["emissiveStrength"] = most;
  }
  void write_layers(Json& json, const Material& material) {
    const auto layer = [&](const char* name) -> Json& {
      return json["extensions"][document_.uses(name)] = Json::object();
    };
    if (material.unlit) {
      layer("KHR_materials_unlit");
      return;  // nothing else counts for an unlit surface
    }
    if (material.ior != 1.5f) layer("KHR_materials_ior")["ior"] = material.ior;
    if (const auto& s = material.specular; s.factor != 1 || s.color != glm::vec3(1)) {
      Json& object = layer("KHR_materials_specular");
      object["specularFactor"] = within(s.factor, 0, 1);
      object["specularColorFactor"] = {s.color.x, s.color.y, s.color.z};
      set(object, "specularTexture", s.factor_texture);
      set(object, "specularColorTexture", s.color_texture);
    }
    if (const auto& c = material.clearcoat; c.factor > 0) {
      Json& object = layer("KHR_materials_clearcoat");
      object["clearcoatFactor"] = within(c.factor, 0, 1);
      object["clearcoatRoughnessFactor"] = within(c.roughness, 0, 1);
      set(object, "clearcoatTexture", c.factor_texture);
      set(object, "clearcoatRoughnessTexture", c.roughness_texture);
      set_scaled(object, "clearcoatNormalTexture", c.normal_texture, "scale", c.normal_scale);
    }
    if (const auto& s = material.sheen; s.color != glm::vec3(0)) {
      Json& object = layer("KHR_materials_sheen");
      object["sheenColorFactor"] = color_json(s.color);
      object["sheenRoughnessFactor"] = within(s.roughness, 0, 1);
      set(object, "sheenColorTexture", s.color_texture);
      set(object, "sheenRoughnessTexture", s.roughness_texture);
    }
    write_glass(layer, material);
  }
  template <class Layer>
  void write_glass(const Layer& layer, const Material& material) {
    if (!(material.transmission.factor > 0)) return;
    Json& glass = layer("KHR_materials_transmission");
    glass["transmissionFactor"] = within(material.transmission.factor, 0, 1);
    set(glass, "transmissionTexture", material.transmission.factor_texture);
    const auto& v = material.volume;
    if (!(v.thickness > 0)) return;
    Json& volume = layer("KHR_materials_volume");
    volume["thicknessFactor"] = v.thickness;
    set(volume, "thicknessTexture", v.thickness_texture);
    if (std::isfinite(v.attenuation_distance)) volume["attenuationDistance"] = v.attenuation_distance;
    volume["attenuationColor"] = color_json(v.attenuation_color);
  }

  GlbDocument& document_;
};

std::size_t GlbDocument::material(std::uint32_t number) {
  const auto [place, is_new] = materials_.emplace(number, materials_.size());
  if (is_new) {
    static const Material standard;
    append("materials", MaterialWriter(*this).write(number == no_index ? standard : scene_.materials[number]));
  }
  return place->second;
}

/// The numbers of a corner's values: position, normal, colour, and texture coordinates by set.
using CornerKey = std::array<std::uint32_t, 3 + max_texcoord_sets>;

CornerKey corner_key(const Mesh& mesh, std::uint32_t triangle, int corner) {
  CornerKey key{};
  key[0] = mesh.triangles[triangle][corner];
  if (!mesh.normals.empty()) key[1] = mesh.corners(mesh.normals, triangle)[corner];
  if (!mesh.colors.empty()) key[2] = mesh.corners(mesh.colors, triangle)[corner];
  for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
    if (const auto* texcoords = mesh.texcoord_set(set)) key[3 + set] = mesh.corners(*texcoords, triangle)[corner];
  return key;
}

struct WeldedCorners {
  std::vector<CornerKey> vertices;
  std::vector<std::uint32_t> indices;  ///< three for each triangle
};

/// Merges equal corners of the given triangles of a mesh. O(n log n).
WeldedCorners weld_corners(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<CornerKey> keys;
  keys.reserve(3 * triangles.size());
  for (const std::uint32_t triangle : triangles)
    for (int corner = 0; corner < 3; ++corner) keys.push_back(corner_key(mesh, triangle, corner));
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  WeldedCorners welded;
  welded.indices.resize(keys.size());
  for (const std::uint32_t corner : order) {
    if (welded.vertices.empty() || welded.vertices.back() != keys[corner]) welded.vertices.push_back(keys[corner]);
    welded.indices[corner] = std::uint32_t(welded.vertices.size() - 1);
  }
  return welded;
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
  Json accessor = {{"componentType", float_type}, {"count", corners.vertices.size()}, {"type", type}};
  for (int k = 0; k < Value::length(); ++k) {
    accessor["min"].push_back(low[k]);
    accessor["max"].push_back(high[k]);
  }
  return document.add_accessor(std::move(accessor), bytes, vertex_target);
}

template <class T>
bool is_all_finite(const std::vector<T>& values) {
  for (const T& value : values)
    for (int k = 0; k < T::length(); ++k)
      if (!std::isfinite(value[k])) return false;
  return true;
}

/// Whether the normals of a mesh are written. glTF requires normals of unit length. If any normal has no direction,
/// none are written, and readers compute them.
bool has_normals(const Mesh& mesh) {
  return !mesh.normals.empty() && is_all_finite(mesh.normals.values) &&
         std::all_of(mesh.normals.values.begin(), mesh.normals.values.end(),
                     [](const glm::vec3& n) { return glm::length(glm::dvec3(n)) > 1e-30; });
}

/// Returns the primitive that holds the triangles of one material.
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
      {{"componentType", unsigned_int_type}, {"count", corners.indices.size()}, {"type", "SCALAR"}}, bytes,
      index_target);
  part["material"] = document.material(material);
  return part;
}

/// Returns a mesh, or null if none of its triangles can be written.
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

/// Returns the transform from the scene's axes and origin to the axes of glTF's world, in which y is up and z is front.
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
      if (!mesh.is_null()) found->second = document.append("meshes", std::move(mesh));
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

void write_glb(const Scene& scene, OutputFile& file) {
  GlbDocument document(scene);
  write_nodes(scene, document);
  if (!document.extensions().empty()) document.json["extensionsUsed"] = document.extensions();
  document.pad_buffer();
  const std::string& buffer = document.buffer;
  if (!buffer.empty()) document.json["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
  std::string text = document.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + text.size() + (buffer.empty() ? 0 : 8 + buffer.size());
  if (size > 0xFFFFFFFF) throw Error(ErrorCode::limit_exceeded, file.name(), "GLB", "more than 4 GiB");
  std::string head = "glTF";
  append_bytes(head, std::uint32_t(2));
  append_bytes(head, std::uint32_t(size));
  append_bytes(head, std::uint32_t(text.size()));
  head += "JSON" + text;
  if (!buffer.empty()) {
    append_bytes(head, std::uint32_t(buffer.size()));
    head.append("BIN\0", 4);
  }
  file.write(std::as_bytes(std::span(head)));
  file.write(std::as_bytes(std::span(buffer)));
}

enum class ModelFile { ply, stl, glb };

ModelFile model_file_of(const std::string& path) {
  const std::string suffix = lower_suffix(path);
  if (suffix == ".ply") return ModelFile::ply;
  if (suffix == ".stl") return ModelFile::stl;
  if (suffix == ".glb") return ModelFile::glb;
  throw Error(ErrorCode::unsupported, path, "", "models are written as .ply, .stl or .glb");
}

}  // namespace

void save(const Scene& scene, const std::string& path, const Table& of_triangles) {
  const ModelFile kind = model_file_of(path);
  validate(scene);
  if (!of_triangles.columns.empty() && kind != ModelFile::ply)
    throw Error(ErrorCode::unsupported, path, "", "only PLY stores properties of triangles");
  validate(of_triangles);
  if (!of_triangles.columns.empty() && of_triangles.row_count() != triangle_count(scene))
    throw Error(ErrorCode::bad_argument, path, "",
                std::to_string(of_triangles.row_count()) + " rows are given for " +
                    std::to_string(triangle_count(scene)) + " triangles");
  OutputFile file(path);
  switch (kind) {
    case ModelFile::ply: write_ply(scene, of_triangles, file); break;
    case ModelFile::stl: write_stl(scene, file); break;
    case ModelFile::glb: write_glb(scene, file); break;
  }
  file.commit();
}

}  // namespace frontmost
