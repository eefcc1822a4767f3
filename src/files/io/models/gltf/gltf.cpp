// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB: turns the file's JSON into a Scene. Each step checks what it reads, so that later ones need not:
// container, JSON, buffers and accessors, materials, meshes (planned), nodes, instances, textures.
//
// Lengths of a GLB's chunks are checked against the rest of the file first. URIs are read as leniently as exporters
// write them: both base64 alphabets are accepted, padding may be missing, and an invalid escape stays as text.
//
// A JSON library reads the document. The glTF library tinygltf is not used, because it reads past a GLB's end,
// truncates long integers, ignores members of the wrong type, and refuses indices without a buffer view.
#include <algorithm>
#include <array>
#include <string_view>

#include "io/binary.h"
#include "io/images/formats.h"
#include "io/models/gltf/data.h"
#include "io/models/gltf/nodes.h"
#include "io/models/mesh_building.h"
#include "io/models/reader.h"
#include "io/models/text.h"

namespace frontmost {
namespace gltf {
namespace {

// "JSON" and "BIN\0", read as little-endian numbers as the format defines them.
constexpr std::uint32_t json_type = 0x4E4F534A, binary_type = 0x004E4942;
constexpr std::size_t header_size = 12, chunk_header_size = 8;

std::uint32_t little_endian(Bytes bytes, std::size_t at) {
  return read_value<std::uint32_t>(bytes.data() + at, Endian::little);
}

/// Returns the bytes within the length that the header states.
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

constexpr std::uint8_t no_digit = 0xFF;

constexpr std::array<std::uint8_t, 256> base64_digits = [] {
  std::array<std::uint8_t, 256> digits{};
  for (std::uint8_t& digit : digits) digit = no_digit;
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    digits[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  digits['-'] = 62;  // the URL-safe alphabet, which some exporters write
  digits['_'] = 63;
  return digits;
}();

std::vector<std::byte> decode_base64(std::string_view text, const JsonValue& place) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) place.fail("base64 data end within a byte");
  std::vector<std::byte> out(text.size() / 4 * 3 + (text.size() % 4 == 0 ? 0 : text.size() % 4 - 1));
  std::uint32_t bits = 0;
  std::size_t written = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t digit = base64_digits[static_cast<unsigned char>(text[i])];
    if (digit == no_digit) place.fail("character " + std::to_string(i) + " of the base64 data is not in its alphabet");
    // Older digits fall off the top of the 32 bits; at most six bits wait for their byte.
    bits = bits << 6 | digit;
    // Six bits come in; whenever eight or more are held, the upper eight go out.
    if (i % 4 != 0) out[written++] = std::byte(bits >> (6 - 2 * (i % 4)));
  }
  return out;
}

/// Extensions that are implemented, or that change no shape or colour here.
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
    "FB_ngon_encoding",  // which triangles were polygons: assimp writes it, and nothing that is drawn depends on it
    "FRONTMOST_edges",
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
  root.each(key, [&](const JsonValue& json) {
    const std::string name = json.to_string();
    if (!is_supported(name, root.source())) names.push_back(printable(name));
  });
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
    warnings.push_back("extensionsUsed: " + name + " is not supported, and ignored");
}

/// Limits the lengths of the lists, because each element costs some hundred bytes of memory, even an empty one ("{}").
void check_counts(const JsonValue& root) {
  for (const char* key : {"accessors", "bufferViews", "buffers", "cameras", "images", "materials", "meshes", "nodes",
                          "samplers", "skins", "textures"})
    if (const auto array = root.find(key)) array->check_count(max_objects);
  if (const auto lights = find_lights(root)) lights->check_count(max_objects);
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
  // Textures come last, and only those that materials use: decoding is the dearest step, and futile if another fails.
  textures.load(scene);
  return scene;
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
      source.fail(place, "its header states a length of " + std::to_string(length) + " bytes, " +
                             std::to_string(rest.size()) + " are left");
    take_chunk(container, type, rest.first(length), number, source);
    rest = rest.subspan(length);
  }
  return container;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::vector<std::byte> decode_data_uri(std::string_view uri, const JsonValue& place) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) place.fail("a data URI without a comma");
  const std::string_view payload = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(payload, place);
  const std::string decoded = percent_decode(payload);
  const auto* first = reinterpret_cast<const std::byte*>(decoded.data());
  return {first, first + decoded.size()};
}

std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(high * 16 + low) : text[i];
    if (low >= 0) i += 2;
  }
  return out;
}

}  // namespace gltf

Scene read_gltf(Bytes bytes, const ModelSource& source) {
  Scene scene = gltf::read_scene(gltf::open_container(bytes, source), source);
  scene.source.metres_per_unit = 1;
  return scene;
}

}  // namespace frontmost
