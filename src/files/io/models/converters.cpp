// SPDX-License-Identifier: Apache-2.0
// Formats that this library does not read by itself. Some are read by frontmost-import, where it is installed. For the
// others there is advice: the program that converts them, and its command line.
#include <algorithm>

#include "io/models/reader.h"

namespace frontmost {
namespace {

/// A program and its command line. {in} stands for the model, {out} for the model without its suffix.
struct Converter {
  std::string_view program, command;
};
// Gmsh tessellates by OpenCASCADE, here with 48 edges for a circle. Assimp keeps materials and the tree of objects.
constexpr Converter gmsh{"Debian package gmsh", "gmsh -2 -clcurv 48 {in} -o {out}.stl"};
constexpr Converter assimp{"Debian package assimp-utils", "assimp export {in} {out}.glb"};
constexpr Converter blender{
    "Debian package blender",
    R"sh(blender -b {in} --python-expr "import bpy; bpy.ops.export_scene.gltf(filepath='{out}.glb')")sh"};
// glTF Transform writes decoded meshes without the extension, but converts images only if told to.
constexpr std::string_view gltf_transform = "Node.js fetches glTF Transform";
constexpr Converter decompress{gltf_transform, "npx @gltf-transform/cli copy {in} {out}-plain.glb"};
constexpr Converter webp_to_png{gltf_transform, "npx @gltf-transform/cli png --formats webp {in} {out}-plain.glb"};
constexpr Converter ktx_to_png{gltf_transform, "npx @gltf-transform/cli ktxdecompress {in} {out}-plain.glb"};
constexpr Converter blender_usd{
    "Blender from blender.org; that of Debian has no USD",
    R"sh(blender -b --python-expr "import bpy; bpy.ops.wm.read_factory_settings(use_empty=True); )sh"
    R"sh(bpy.ops.wm.usd_import(filepath='{in}'); bpy.ops.export_scene.gltf(filepath='{out}.glb')")sh"};

struct OtherFormat {
  std::string_view name;
  std::string_view suffixes;  ///< a blank behind each
  const Converter& converter;
  std::optional<ModelFormat> imported{};  ///< how frontmost-import reads it; none: it does not
};
constexpr OtherFormat step{"STEP", ".step .stp .p21 ", gmsh, ModelFormat::step},
    iges{"IGES", ".iges .igs ", gmsh, ModelFormat::iges}, brep{"BREP", ".brep .brp ", gmsh, ModelFormat::brep},
    fbx{"FBX", ".fbx ", assimp, ModelFormat::foreign}, collada{"COLLADA", ".dae .zae ", assimp, ModelFormat::foreign},
    three_ds{"3DS", ".3ds ", assimp, ModelFormat::foreign}, x3d{"X3D", ".x3d .x3db ", assimp, ModelFormat::foreign},
    lightwave{"LightWave", ".lwo .lxo ", assimp, ModelFormat::foreign},
    ac3d{"AC3D", ".ac .ac3d ", assimp, ModelFormat::foreign}, ifc{"IFC", ".ifc .ifczip ", assimp, ModelFormat::foreign},
    amf{"AMF", ".amf ", assimp, ModelFormat::foreign}, dxf{"DXF", ".dxf ", assimp, ModelFormat::foreign},
    directx{"DirectX", ".x ", assimp, ModelFormat::foreign},
    games{"this format of games",
          ".ase .b3d .cob .hmp .irrmesh .iqm .md2 .md3 .md5mesh .mdl .ms3d .ogex .q3o .smd .xgl ", assimp,
          ModelFormat::foreign},
    blend{"Blender", ".blend ", blender}, usd{"USD", ".usdz .usd .usda .usdc ", blender_usd};
constexpr const OtherFormat* all[] = {&step, &iges, &brep, &fbx, &collada, &three_ds, &x3d,   &lightwave,
                                      &ac3d, &ifc,  &amf,  &dxf, &directx, &games,    &blend, &usd};

struct ForeignExtension {
  std::string_view name;
  const Converter& converter;
};
/// Extensions in order of precedence. The first one that a file has chooses the command, which also decodes the later
/// ones.
constexpr ForeignExtension foreign_extensions[] = {{"KHR_texture_basisu", ktx_to_png},
                                                   {"EXT_texture_webp", webp_to_png},
                                                   {"KHR_draco_mesh_compression", decompress},
                                                   {"EXT_meshopt_compression", decompress},
                                                   {"KHR_meshopt_compression", decompress}};

/// Quotes `path` for a shell's command line if needed. Within quotes, which allow no others, a plain name stands in.
std::string word_of(const std::string& path, bool is_in_quotes) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/+,:@%";
  if (path.find_first_not_of(plain) == std::string::npos && !path.starts_with('-')) return path;
  if (is_in_quotes || path.find('\'') != std::string::npos || path.starts_with('-') || printable(path) != path)
    return "model" + lower_suffix(path);
  return "'" + path + "'";
}

std::string filled(std::string_view command, const std::string& path) {
  std::string out;
  for (std::size_t at = 0; at < command.size();) {
    const std::size_t mark = std::min(command.find('{', at), command.size());
    out += command.substr(at, mark - at);
    if (mark == command.size()) break;
    const bool is_input = command.substr(mark).starts_with("{in}");
    const bool is_in_quotes = std::count(out.begin(), out.end(), '"') % 2 == 1;
    const std::filesystem::path file(path);
    const std::string name = is_input ? path : (file.parent_path() / file.stem()).string();
    // The suffix of the output is part of the quoted name.
    const std::size_t end = command.find('}', mark) + 1;
    const std::size_t next = is_input ? end : std::min(command.find_first_of(" '", end), command.size());
    out += word_of(name + std::string(command.substr(end, next - end)), is_in_quotes);
    at = next;
  }
  return out;
}

std::string advice(const Converter& converter, const std::string& path) {
  return "convert it first: " + filled(converter.command, path) + " (" + std::string(converter.program) + ")";
}
std::string advice(const OtherFormat& format, const std::string& path) {
  return std::string(format.name) +
         (format.imported ? " is read where frontmost-import is installed; or " : " is not read; ") +
         advice(format.converter, path);
}

const OtherFormat* format_by_suffix(const std::string& path) {
  const std::string suffix = lower_suffix(path);
  if (suffix.size() < 2) return nullptr;
  for (const OtherFormat* format : all)
    if (format->suffixes.find(suffix + " ") != std::string_view::npos) return format;
  return nullptr;
}

/// A format, and a name for a file of it.
struct Recognized {
  const OtherFormat* format = nullptr;
  const char* name = "";
};

Recognized recognized(Bytes bytes) {
  constexpr std::size_t window = 1024;
  const std::string_view text = text_of(bytes.first(std::min(bytes.size(), window)));
  const auto contains = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
  if (text.starts_with("ISO-10303-21;"))
    return contains("FILE_SCHEMA(('IFC") ? Recognized{&ifc, "model.ifc"} : Recognized{&step, "model.step"};
  // Lines of IGES have 80 columns; the first one begins the start section.
  if (text.size() >= 80 && text.substr(72, 8) == "S      1") return {&iges, "model.iges"};
  if (text.starts_with("DBRep_DrawableShape") || contains("CASCADE Topology V")) return {&brep, "model.brep"};
  if (text.starts_with("Kaydara FBX Binary") || text.starts_with("; FBX ")) return {&fbx, "model.fbx"};
  if (contains("<COLLADA")) return {&collada, "model.dae"};
  if (text.starts_with("BLENDER")) return {&blend, "model.blend"};
  if (text.starts_with("PXR-USDC") || text.starts_with("#usda")) return {&usd, "model.usd"};
  return {};
}

}  // namespace

std::optional<std::string> conversion_by_suffix(const std::string& path) {
  const OtherFormat* const format = format_by_suffix(path);
  return format == nullptr ? std::nullopt : std::optional(advice(*format, path));
}

void refuse_import(Bytes bytes, const ModelSource& source) {
  const std::optional<std::string> by_suffix = conversion_by_suffix(source.name());
  throw Error(
      ErrorCode::unsupported, source.name(), "",
      by_suffix ? *by_suffix : conversion_by_content(bytes).value_or("takes frontmost-import, which is not installed"));
}

std::optional<ModelFormat> imported_by_suffix(const std::string& path) {
  const OtherFormat* const format = format_by_suffix(path);
  return format == nullptr ? std::nullopt : format->imported;
}

std::optional<ModelFormat> imported_by_content(Bytes bytes) {
  const OtherFormat* const format = recognized(bytes).format;
  return format == nullptr ? std::nullopt : format->imported;
}

std::string foreign_suffix(const std::string& path, Bytes bytes) {
  const Recognized found = recognized(bytes);
  const std::string suffix = lower_suffix(format_by_suffix(path) == nullptr && found.format ? found.name : path);
  return suffix.empty() ? suffix : suffix.substr(1);
}

std::optional<std::string> conversion_of_extensions(const std::vector<std::string>& names, const std::string& path) {
  const std::string file = lower_suffix(path).size() < 2 ? "model.glb" : path;  // standard input has no name
  for (const ForeignExtension& known : foreign_extensions)
    if (std::find(names.begin(), names.end(), known.name) != names.end()) return advice(known.converter, file);
  return std::nullopt;
}

std::optional<std::string> conversion_by_content(Bytes bytes) {
  const Recognized found = recognized(bytes);
  return found.format == nullptr ? std::nullopt : std::optional(advice(*found.format, found.name));
}

}  // namespace frontmost
