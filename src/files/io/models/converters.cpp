// SPDX-License-Identifier: Apache-2.0
// Advice for files in formats that are not read: the program that converts them, and its command line. Reading these
// formats takes large libraries; the advice takes a table.
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

struct Foreign {
  std::string_view name;
  std::string_view suffixes;  ///< a blank behind each
  const Converter& converter;
};
constexpr Foreign step{"STEP", ".step .stp .p21 ", gmsh}, iges{"IGES", ".iges .igs ", gmsh},
    brep{"BREP", ".brep .brp ", gmsh}, fbx{"FBX", ".fbx ", assimp}, collada{"COLLADA", ".dae .zae ", assimp},
    three_ds{"3DS", ".3ds ", assimp}, x3d{"X3D", ".x3d .x3db ", assimp}, lightwave{"LightWave", ".lwo ", assimp},
    ac3d{"AC3D", ".ac .ac3d ", assimp}, ifc{"IFC", ".ifc .ifczip ", assimp}, amf{"AMF", ".amf ", assimp},
    blend{"Blender", ".blend ", blender}, usd{"USD", ".usdz .usd .usda .usdc ", blender_usd};
constexpr const Foreign* all[] = {&step,      &iges, &brep, &fbx, &collada, &three_ds, &x3d,
                                  &lightwave, &ac3d, &ifc,  &amf, &blend,   &usd};

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

/// Quotes `path` for a shell's command line if needed. Within a text that is in quotes already, further quotes would
/// end the text, so a plain name stands for the file there.
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
std::string advice(const Foreign& format, const std::string& path) {
  return std::string(format.name) + " is not read; " + advice(format.converter, path);
}

/// Whether the text is IGES: lines of 80 columns, the first of which begins the start section.
bool looks_like_iges(std::string_view text) { return text.size() >= 80 && text.substr(72, 8) == "S      1"; }

}  // namespace

std::optional<std::string> conversion_by_suffix(const std::string& path) {
  const std::string suffix = lower_suffix(path);
  if (suffix.size() < 2) return std::nullopt;
  for (const Foreign* format : all)
    if (format->suffixes.find(suffix + " ") != std::string_view::npos) return advice(*format, path);
  return std::nullopt;
}

std::optional<std::string> conversion_of_extensions(const std::vector<std::string>& names, const std::string& path) {
  const std::string file = lower_suffix(path).size() < 2 ? "model.glb" : path;  // standard input has no name
  for (const ForeignExtension& known : foreign_extensions)
    if (std::find(names.begin(), names.end(), known.name) != names.end()) return advice(known.converter, file);
  return std::nullopt;
}

std::optional<std::string> conversion_by_content(Bytes bytes) {
  constexpr std::size_t window = 1024;
  const std::string_view text = text_of(bytes.first(std::min(bytes.size(), window)));
  const auto contains = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
  if (text.starts_with("ISO-10303-21;"))
    return contains("FILE_SCHEMA(('IFC") ? advice(ifc, "model.ifc") : advice(step, "model.step");
  if (looks_like_iges(text)) return advice(iges, "model.iges");
  if (text.starts_with("Kaydara FBX Binary") || text.starts_with("; FBX ")) return advice(fbx, "model.fbx");
  if (contains("<COLLADA")) return advice(collada, "model.dae");
  if (text.starts_with("BLENDER")) return advice(blend, "model.blend");
  if (text.starts_with("PXR-USDC") || text.starts_with("#usda")) return advice(usd, "model.usd");
  return std::nullopt;
}

}  // namespace frontmost
