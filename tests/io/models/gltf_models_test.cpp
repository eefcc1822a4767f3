// SPDX-License-Identifier: Apache-2.0
// glTF files of others: the reader must find the content that their makers state. Files that the official validator
// rejects must be refused, or be known as harmless.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "frontmost/files.h"
#include "support/models.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A row of the models' README, counted by others with other programs.
struct KnownGltf {
  const char* file;
  std::uint64_t triangles;
  std::size_t objects, cameras;
};

constexpr KnownGltf known[] = {
    {"assembly/2-cylinder-engine.glb", 121496, 67, 1},
    {"assembly/as1.glb", 10124, 18, 0},
    {"assembly/cesium-milk-truck.glb", 3624, 3, 0},
    {"assembly/toy-car.glb", 108936, 3, 8},
    {"cad/linkrod.glb", 16306, 1, 0},
    {"difficult/box-vertex-colors.glb", 12, 1, 0},
    {"difficult/negative-scale-test.glb", 7724, 11, 0},
    {"difficult/recursive-skeletons.glb", 6384, 84, 0},
    {"difficult/vertex-color-test.glb", 36, 2, 0},
    {"hero/avocado.glb", 682, 1, 0},
    {"hero/damaged-helmet.glb", 15452, 1, 0},
    {"hero/duck.glb", 4212, 1, 1},
    {"hero/fox.glb", 576, 1, 0},
    {"hero/suzanne.glb", 3936, 1, 0},
    {"scenes/city.glb", 751620, 2401, 0},
    {"scenes/home-theater.glb", 7915, 1, 0},
    {"scenes/occlusion-room.glb", 63720, 17, 0},
    {"scenes/sponza.glb", 262267, 381, 0},
    {"scenes/warehouse.glb", 15003, 26, 0},
    {"transparency/alpha-blend-mode-test.glb", 61, 9, 1},
    {"transparency/glass-table.glb", 592, 5, 0},
    {"transparency/glass-vase-flowers.glb", 14036, 4, 0},
    {"transparency/small-pine.glb", 1650, 2, 0},
    {"transparency/transmission-test.glb", 128775, 22, 1},
};

TEST(GltfModels, HoldWhatTheirTableSays) {
  FRONTMOST_NEEDS_MODELS();
  for (const KnownGltf& row : known) {
    SCOPED_TRACE(row.file);
    const Scene scene = load(test::model(row.file));
    EXPECT_EQ(triangle_count(scene), row.triangles);
    EXPECT_EQ(scene.instances.size(), row.objects);
    EXPECT_EQ(scene.cameras.size(), row.cameras);
    EXPECT_EQ(scene.up, Axis::y);
    for (const std::string& warning : scene.warnings)
      EXPECT_THAT(warning, testing::AnyOf(HasSubstr("extensionsUsed"), HasSubstr("KHR_materials_transmission: light")));
  }
}

TEST(GltfModels, NamesMaterialsAndTexturesSurvive) {
  FRONTMOST_NEEDS_MODELS();
  const Scene sponza = load(test::model("scenes/sponza.glb"));
  EXPECT_EQ(sponza.materials.size(), 25u);
  EXPECT_EQ(sponza.textures.size(), 24u);
  std::set<std::string> names;
  for (const Instance& instance : sponza.instances) names.insert(instance.name);
  EXPECT_EQ(names.size(), 381u);
  const auto masked = std::count_if(sponza.materials.begin(), sponza.materials.end(),
                                    [](const Material& m) { return m.alpha == Material::Alpha::mask; });
  EXPECT_GT(masked, 0);

  const Scene city = load(test::model("scenes/city.glb"));
  EXPECT_EQ(city.meshes.size(), 13u);
  ASSERT_EQ(city.textures.size(), 1u);
  EXPECT_TRUE(city.textures[0].nearest);
}

TEST(GltfModels, AlphaModesAreThoseOfTheTestModel) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("transparency/alpha-blend-mode-test.glb"));
  std::map<Material::Alpha, int> modes;
  for (const Material& material : scene.materials) ++modes[material.alpha];
  EXPECT_GE(modes[Material::Alpha::blend], 1);
  EXPECT_GE(modes[Material::Alpha::mask], 3);
  EXPECT_GE(modes[Material::Alpha::opaque], 1);
}

TEST(GltfModels, MirroredNodesKeepTheirMirror) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("difficult/negative-scale-test.glb"));
  const auto mirrored = std::count_if(scene.instances.begin(), scene.instances.end(), [](const Instance& instance) {
    return glm::determinant(glm::dmat3(instance.world_from_mesh)) < 0;
  });
  EXPECT_GT(mirrored, 0);
  EXPECT_LT(mirrored, 11);
}

TEST(GltfModels, HostileOnesEndInTheRightError) {
  FRONTMOST_NEEDS_MODELS();
  const std::pair<const char*, const char*> cases[] = {
      {"IndexOutOfRange/IndexOutOfRange.gltf", "meshes[0].primitives[0].indices: triangle 0: vertex 255"},
      {"IndexOutOfRange/AllIndicesOutOfRange.gltf", "vertex 65535 does not exist, there are 24"},
      {"MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
      {"RecursiveNodes/RecursiveNodes.gltf", "nodes[0]: is part of a loop"},
      {"SchemaFailures/sceneWrongType.gltf", ""},
  };
  for (const auto& [file, reason] : cases) {
    const std::string path = test::model(std::string("loader/assimp-gltf2/") + file);
    try {
      (void)load(path);
      ADD_FAILURE() << file << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason)) << file;
      EXPECT_THAT(error.what(), testing::StartsWith(path));
    }
  }
}

TEST(GltfModels, NonFiniteNumbersAreKept) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("loader/assimp-gltf2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb"));
  EXPECT_EQ(triangle_count(scene), 12u);
}

TEST(GltfModels, AssetGeneratorSetsDrawTheUnitSquare) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t drawn = 0;
  for (const char* set : {"Buffer_Interleaved", "Material_AlphaMask", "Mesh_PrimitiveMode", "Mesh_Primitives"})
    for (const auto& entry :
         fs::directory_iterator(test::model(std::string("reference/gltf-asset-generator/") + set))) {
      if (entry.path().extension() != ".gltf") continue;
      const Scene scene = load(entry.path().string());
      if (triangle_count(scene) == 0) {  // a model of points and lines
        EXPECT_FALSE(scene.warnings.empty()) << entry.path();
        continue;
      }
      EXPECT_EQ(triangle_count(scene), 2u) << entry.path();
      Box box;
      double area = 0;
      const Mesh& mesh = scene.meshes[0];
      for (const glm::vec3& p : mesh.positions) box.include(p);
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 normal =
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
        EXPECT_GT(normal.z, 0) << entry.path() << ": winding";
        area += 0.5 * double(normal.z);
      }
      EXPECT_EQ(box.low, glm::vec3(-0.5f, -0.5f, 0)) << entry.path();
      EXPECT_EQ(box.high, glm::vec3(0.5f, 0.5f, 0)) << entry.path();
      EXPECT_NEAR(area, 1.0, 1e-6) << entry.path();
      ++drawn;
    }
  EXPECT_EQ(drawn, 5u + 7u + 8u + 1u);
}

/// Validator errors that do not prevent correct reading: rules for the sake of GPUs, members without effect, and names
/// that are skipped.
const std::set<std::string> harmless = {
    "ACCESSOR_MATRIX_ALIGNMENT",
    "ACCESSOR_NORMALIZED_INVALID",
    "ACCESSOR_OFFSET_ALIGNMENT",
    "ACCESSOR_TOTAL_OFFSET_ALIGNMENT",
    "BUFFER_DATA_URI_MIME_TYPE_INVALID",
    "BUFFER_VIEW_INVALID_BYTE_STRIDE",
    "BUFFER_VIEW_TARGET_OVERRIDE",
    "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
    "EMPTY_ENTITY",
    "GLB_CHUNK_LENGTH_UNALIGNED",
    "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
    "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
    "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
    "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
    "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
    "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
    "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
    "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
    "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
    "NODE_MATRIX_TRS",
    "NODE_SKIN_WITH_NON_SKINNED_MESH",
    "ROTATION_NON_UNIT",
    "UNSATISFIED_DEPENDENCY",
    "VALUE_MULTIPLE_OF",
};
/// Files that are harmless although their error code alone does not show it.
const std::set<std::string> harmless_files = {
    "bom.glb", "bom.gltf",    // a byte order mark before the JSON
    "invalid_uri_data.gltf",  // ";;base64", a stray semicolon
    "zero_bytelength.gltf",   // empty buffers and views
};
/// Valid files that are refused, as network addresses are never followed.
const std::set<std::string> refused_though_valid = {"non_relative_uri.gltf"};

bool only_harmless(const fs::path& file, const nlohmann::json& report) {
  if (harmless_files.count(file.filename().string()) > 0) return true;
  for (const auto& message : report["issues"]["messages"])
    if (message["severity"] == 0 && harmless.count(message["code"]) == 0) return false;
  return true;
}

std::size_t error_count(const nlohmann::json& report) { return report["issues"]["numErrors"]; }

// No file without errors in the official report is refused, except for network addresses and meshes without bytes.
TEST(GltfModels, WhatTheValidatorPassesIsRead) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t passed = 0, read = 0, elsewhere = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::model("loader/gltf-validator"))) {
    const fs::path report_path = entry.path().string() + ".report.json";
    if (!fs::exists(report_path) || error_count(nlohmann::json::parse(std::ifstream(report_path))) > 0) continue;
    ++passed;
    try {
      (void)load(entry.path().string());
      ++read;
    } catch (const Error& error) {
      const std::string what = error.what();
      const bool is_elsewhere = refused_though_valid.count(entry.path().filename().string()) > 0 ||
                                what.find("has no contents") != std::string::npos;
      EXPECT_TRUE(is_elsewhere) << what;
      elsewhere += is_elsewhere;
    }
  }
  std::cout << read << " of " << passed << " files without an error are read, " << elsewhere
            << " have their bytes elsewhere\n";
  EXPECT_EQ(read + elsewhere, passed);
  EXPECT_GT(read, 20u);
}

TEST(GltfModels, TheValidatorsVerdictIsOurs) {
  FRONTMOST_NEEDS_MODELS();
  std::size_t accepted = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::model("loader/gltf-validator"))) {
    const fs::path report_path = entry.path().string() + ".report.json";
    if (!fs::exists(report_path)) continue;
    const fs::path file = entry.path();
    const auto report = nlohmann::json::parse(std::ifstream(report_path));
    const bool expected = only_harmless(file, report) && refused_though_valid.count(file.filename().string()) == 0;
    try {
      (void)load(file.string());
      EXPECT_TRUE(expected) << file << " was accepted: " << report["issues"]["messages"];
      ++accepted;
    } catch (const Error& error) {
      // The validator also accepts files whose meshes have no bytes anywhere.
      const bool has_contents = std::string(error.what()).find("has no contents") == std::string::npos;
      EXPECT_FALSE(expected && has_contents) << error.what();
      ++refused;
    }
  }
  EXPECT_EQ(accepted + refused, 129u);
  EXPECT_GT(accepted, 50u);
  EXPECT_GT(refused, 50u);
}

}  // namespace
}  // namespace frontmost
