// SPDX-License-Identifier: Apache-2.0
// Formats that are not read, or not where frontmost-import is missing: the message names a converter, ready to paste
// into a shell.
#include <unistd.h>

#include <fstream>

#include "io/models/reader.h"
#include "model_bytes.h"

namespace frontmost {
namespace {

using test::bytes_of;
using testing::HasSubstr;

std::string by_suffix(const std::string& path) { return conversion_by_suffix(path).value_or("none"); }

TEST(Converters, SuffixesNameTheCommand) {
  EXPECT_EQ(by_suffix("part.step"),
            "STEP is read where frontmost-import is installed; or convert it first: gmsh -2 -clcurv 48 part.step -o "
            "part.stl (Debian package gmsh)");
  EXPECT_EQ(by_suffix("a/b.v2.IGS"),
            "IGES is read where frontmost-import is installed; or convert it first: gmsh -2 -clcurv 48 a/b.v2.IGS -o "
            "a/b.v2.stl (Debian package gmsh)");
  EXPECT_EQ(
      by_suffix("fox.fbx"),
      "FBX is read where frontmost-import is installed; or convert it first: assimp export fox.fbx fox.glb (Debian "
      "package assimp-utils)");
  EXPECT_EQ(by_suffix("scene.blend"),
            "Blender is not read; convert it first: blender -b scene.blend --python-expr \"import bpy; "
            "bpy.ops.export_scene.gltf(filepath='scene.glb')\" (Debian package blender)");
  EXPECT_THAT(by_suffix("toy.usdz"), HasSubstr("usd_import(filepath='toy.usdz'); "
                                               "bpy.ops.export_scene.gltf(filepath='toy.glb')\" (Blender from"));
  for (const char* path : {"a.stp", "a.p21", "a.iges", "a.brep", "a.dae", "a.3ds", "a.x3d", "a.ifc", "a.dxf", "a.md2"})
    EXPECT_THAT(by_suffix(path), HasSubstr(" is read where frontmost-import is installed; or convert it first: "))
        << path;
  for (const char* path : {"a.usd", "a.usdc"})
    EXPECT_THAT(by_suffix(path), HasSubstr(" is not read; convert it first: ")) << path;
  for (const char* path : {"a.stl", "a.3mf", "a.glb", "a.ac3", "a.", "a", ".step", "step", "a.d", "a.step "})
    EXPECT_EQ(by_suffix(path), "none") << path;
}

TEST(Converters, NamesAreWordsOfTheShell) {
  EXPECT_THAT(by_suffix("my part.step"), HasSubstr("48 'my part.step' -o 'my part.stl' ("));
  EXPECT_THAT(by_suffix("$(rm x).fbx"), HasSubstr("export '$(rm x).fbx' '$(rm x).glb' ("));
  for (const char* path : {"it's.fbx", "-o.fbx", "\x1b[2J.fbx"})
    EXPECT_THAT(by_suffix(path), HasSubstr("export model.fbx model.glb (")) << path;
  EXPECT_THAT(by_suffix("my \"toy\".blend"), HasSubstr("filepath='model.glb')"));
}

TEST(Converters, ContentsAreKnownToo) {
  setenv("FRONTMOST_IMPORT", "/missing", 1);
  const auto by_content = [](const std::string& text) {
    return test::error_of(text + std::string(100, ' '), std::nullopt);
  };
  EXPECT_THAT(by_content("ISO-10303-21;\nHEADER;"),
              HasSubstr("model: STEP is read where frontmost-import is installed; or convert it first: gmsh"));
  EXPECT_THAT(by_content("Kaydara FBX Binary  "), HasSubstr("FBX is read where"));
  EXPECT_THAT(by_content("<?xml version=\"1.0\"?>\n<COLLADA xmlns="), HasSubstr("COLLADA is read where"));
  EXPECT_THAT(by_content("BLENDER-v304"), HasSubstr("Blender is not read"));
  EXPECT_THAT(by_content("PXR-USDC"), HasSubstr("USD is not read"));
  EXPECT_THAT(by_content(std::string(72, ' ') + "S      1\n"), HasSubstr("IGES is read where"));
  EXPECT_EQ(by_content("<html>"),
            "model: not a model that Frontmost can read (STL, PLY, OBJ, OFF, glTF, GLB, 3MF, a scene file)");
  unsetenv("FRONTMOST_IMPORT");
}

TEST(Converters, ExtensionsOfGltfNameTheCommand) {
  const auto by_extensions = [](const std::vector<std::string>& names, const std::string& path) {
    return conversion_of_extensions(names, path).value_or("none");
  };
  EXPECT_EQ(by_extensions({"KHR_draco_mesh_compression"}, "a/my lamp.glb"),
            "convert it first: npx @gltf-transform/cli copy 'a/my lamp.glb' 'a/my lamp-plain.glb' "
            "(Node.js fetches glTF Transform)");
  EXPECT_THAT(by_extensions({"EXT_meshopt_compression"}, "standard input"),
              HasSubstr("copy model.glb model-plain.glb"));
  EXPECT_THAT(by_extensions({"EXT_texture_webp"}, "a.gltf"), HasSubstr("png --formats webp a.gltf a-plain.glb"));
  // The converter for images decodes meshes as well.
  EXPECT_THAT(by_extensions({"KHR_draco_mesh_compression", "KHR_texture_basisu"}, "a.glb"),
              HasSubstr("ktxdecompress a.glb a-plain.glb"));
  EXPECT_EQ(by_extensions({"EXT_other"}, "a.glb"), "none");
}

// The suffix decides, whatever the contents, unless a format is given: a zip archive may also be 3MF.
TEST(Converters, LoadSaysSoBeforeItReads) {
  const std::string path = std::filesystem::temp_directory_path() / ("toy" + std::to_string(getpid()) + ".usdz");
  std::ofstream(path) << "PK\x03\x04 and OFF 0 0 0";
  const auto error = [&](const LoadOptions& options) -> std::string {
    try {
      (void)load(path, options);
      return "read";
    } catch (const Error& refusal) {
      return refusal.what();
    }
  };
  EXPECT_THAT(error({}), HasSubstr(path + ": USD is not read; convert it first: blender -b"));
  LoadOptions off;
  off.format = ModelFormat::off;
  EXPECT_THAT(error(off), HasSubstr("line 1"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace frontmost
