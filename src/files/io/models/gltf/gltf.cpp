// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB: turns the file's JSON into a Scene. Each step checks what it reads, so that later ones need not:
// container, JSON, buffers and accessors, materials, meshes (planned), nodes, instances, textures.
//
// A JSON library reads the document. The glTF library tinygltf is not used, because it reads past a GLB's end,
// truncates long integers, ignores members of the wrong type, and refuses indices without a buffer view.
#include <algorithm>
#include <string_view>

#include "io/images/decode.h"
#include "io/models/gltf/compressed.h"
#include "io/models/gltf/nodes.h"
#include "io/models/mesh_building.h"
#include "io/models/reader.h"

namespace frontmost {
namespace gltf {
namespace {

/// Extensions that are implemented, or that change nothing that is visible or coloured here.
constexpr std::string_view supported_extensions[] = {
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_materials_emissive_strength",
    "KHR_lights_punctual",
    "KHR_node_visibility",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_pbrSpecularGlossiness",
};

/// Extensions whose decoder is an optional part of a build.
struct OptionalExtension {
  std::string_view name;
  bool (*is_there)(const ModelSource& source);
  const char* part;
};
constexpr OptionalExtension optional_extensions[] = {
    {"KHR_draco_mesh_compression", [](const ModelSource&) { return has_draco(); },
     "Draco (Debian package libdraco-dev, FRONTMOST_DRACO)"},
    {"EXT_meshopt_compression", [](const ModelSource&) { return has_meshopt(); },
     "meshoptimizer (Debian package libmeshoptimizer-dev, FRONTMOST_MESHOPT)"},
    {"KHR_meshopt_compression", [](const ModelSource&) { return has_meshopt(); },
     "meshoptimizer (Debian package libmeshoptimizer-dev, FRONTMOST_MESHOPT)"},
    {"EXT_texture_webp", [](const ModelSource& source) { return decodes_webp(source.image_decoder()); },
     "libwebp (Debian package libwebp-dev, FRONTMOST_WEBP)"},
};

const OptionalExtension* optional_extension(std::string_view name) {
  for (const OptionalExtension& extension : optional_extensions)
    if (extension.name == name) return &extension;
  return nullptr;
}

bool is_supported(const std::string& extension, const ModelSource& source) {
  if (const OptionalExtension* known = optional_extension(extension)) return known->is_there(source);
  return std::find(std::begin(supported_extensions), std::end(supported_extensions), extension) !=
         std::end(supported_extensions);
}

void check_version(const JsonValue& root) {
  const JsonValue asset = root.require("asset");
  const JsonValue version = asset.find("minVersion").value_or(asset.require("version"));
  const std::string text = version.to_string();
  // Versions 2.x only add members that older readers may ignore, unless minVersion is greater.
  const bool fits = version.place() == "asset.version" ? text.starts_with("2.") : text == "2.0";
  if (!fits)
    throw Error(ErrorCode::unsupported, root.source().name(), version.place(),
                "glTF " + printable(text) + " is not supported, only 2.0");
}

std::vector<std::string> unsupported(const JsonValue& root, const char* key) {
  std::vector<std::string> names;
  const std::optional<JsonValue> array = root.find(key);
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    const std::string name = (*array)[i].to_string();
    if (!is_supported(name, root.source())) names.push_back(printable(name));
  }
  return names;
}

void check_extensions(const JsonValue& root, std::vector<std::string>& warnings) {
  const std::vector<std::string> required = unsupported(root, "extensionsRequired");
  if (!required.empty()) {
    std::string list, absent;
    for (const std::string& name : required) {
      list += (list.empty() ? "" : ", ") + name;
      if (const OptionalExtension* known = optional_extension(name))
        absent += (absent.empty() ? "; this Frontmost was built without " : " and ") + std::string(known->part);
    }
    const std::optional<std::string> advice = conversion_of_extensions(required, root.source().name());
    throw Error(ErrorCode::unsupported, root.source().name(), "extensionsRequired",
                printable(list) + ": not supported" + absent + (advice ? "; " + *advice : ""));
  }
  for (const std::string& name : unsupported(root, "extensionsUsed"))
    warnings.push_back("extensionsUsed: " + name + " is not supported and passed over");
}

/// Each element costs some hundred bytes of memory, even an empty one ("{}").
void check_counts(const JsonValue& root) {
  const auto check = [](const std::optional<JsonValue>& array) {
    if (array && array->size() > max_objects)
      array->source().fail_limit(array->place(),
                                 std::to_string(array->size()) + " are more than " + std::to_string(max_objects));
  };
  for (const char* key : {"accessors", "bufferViews", "buffers", "cameras", "images", "materials", "meshes", "nodes",
                          "samplers", "skins", "textures"})
    check(root.find(key));
  check(find_lights(root));
}

Scene read_scene(const Container& container, const ModelSource& source) {
  const JsonDocument document(container.json, source);
  const JsonValue root(document, source);
  Scene scene;
  check_version(root);
  check_extensions(root, scene.warnings);
  check_counts(root);
  // Ranges come first: later steps read through `data` and check no lengths.
  Data data(root, container);
  TextureTable textures(root, data);
  // Materials come before meshes, because their textures decide which sets of texture coordinates are read.
  MaterialList materials = read_materials(root, textures, scene.warnings);
  const std::vector<MeshPlan> plans = plan_meshes(root, data, materials, scene.warnings);
  const NodeTree tree = read_nodes(root, data, scene.warnings);
  scene.materials = std::move(materials.materials);
  place_meshes(root, data, plans, tree, scene);
  place_cameras(root, tree, scene);
  place_lights(root, tree, scene);
  // Textures come last, and only those that materials use: decoding is the dearest step, and futile if another step
  // fails.
  textures.load(scene);
  return scene;
}

}  // namespace
}  // namespace gltf

Scene read_gltf(Bytes bytes, const ModelSource& source) {
  Scene scene = gltf::read_scene(gltf::open_container(bytes, source), source);
  scene.source.metres_per_unit = 1;
  return scene;
}

}  // namespace frontmost
