// SPDX-License-Identifier: Apache-2.0
// Compressed glTF: the same models by Draco's two methods and by meshoptimizer, errors in their data, and the message
// of a build without the decoders.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "frontmost/files.h"
#include "io/models/gltf/data.h"
#include "io/models/gltf_maker.h"

namespace frontmost {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

/// A GLB of the corpus, split into parts that a test may change.
struct Parts {
  Json text;
  std::vector<std::byte> binary;

  explicit Parts(const std::string& name) {
    std::ifstream file(std::filesystem::path(FRONTMOST_CORPUS) / "gltf" / name, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof size);
    text = Json::parse(bytes.substr(20, size));
    for (const char c : bytes.substr(28 + size)) binary.push_back(std::byte(c));
  }
  [[nodiscard]] Scene read() const { return load(test::GltfMaker::glb_of(text.dump(), binary), "t.glb"); }
  [[nodiscard]] std::string error() const {
    try {
      (void)read();
      return "read";
    } catch (const Error& error) {
      return error.what();
    }
  }
};

Box bounds_of(const Scene& scene) {
  Box box;
  for (const glm::vec3& p : scene.meshes[0].positions)
    box.include(glm::vec3(scene.instances[0].world_from_mesh * glm::dvec4(p, 1)));
  return box;
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance) {
  EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

class Compressed : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const bool is_draco = std::string(GetParam()).starts_with("draco");
    if (is_draco ? !gltf::has_draco() : !gltf::has_meshopt()) GTEST_SKIP() << "built without the decoder";
  }
};

class CompressedBox : public Compressed {};
class CompressedTorus : public Compressed {};

TEST_P(CompressedBox, IsABoxOfOneByTwoByThree) {
  const Scene scene = Parts(GetParam()).read();
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
  EXPECT_EQ(triangle_count(scene), 12u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 8u);
  expect_near(bounds_of(scene).low, {0, 0, 0}, 2e-4f);
  expect_near(bounds_of(scene).high, {1, 2, 3}, 2e-4f);
}
INSTANTIATE_TEST_SUITE_P(Files, CompressedBox, testing::Values("draco.glb", "meshopt.glb"));

// A torus about z, radii 2 and 0.7, 4 by 3 quads: normals, texture coordinates and colours follow from the positions.
TEST_P(CompressedTorus, HasItsAttributes) {
  const Scene scene = Parts(GetParam()).read();
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(triangle_count(scene), 24u);
  ASSERT_EQ(mesh.positions.size(), 20u);
  ASSERT_EQ(mesh.normals.values.size(), 20u);
  ASSERT_EQ(mesh.texcoords.values.size(), 20u);
  ASSERT_EQ(mesh.colors.values.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    const glm::vec3 p(scene.instances[0].world_from_mesh * glm::dvec4(mesh.positions[i], 1));
    const glm::vec3 ring = 2.0f * glm::normalize(glm::vec3(p.x, p.y, 0));
    const glm::vec3 normal = (p - ring) / 0.7f;
    EXPECT_NEAR(glm::length(normal), 1, 2e-3);
    expect_near(mesh.normals.values[i], normal, 0.03f);
    const glm::vec2 turns = mesh.texcoords.values[i] * 6.2831853f;
    expect_near(ring, 2.0f * glm::vec3(std::cos(turns.x), std::sin(turns.x), 0), 0.02f);
    EXPECT_NEAR(normal.z, std::sin(turns.y), 0.02);
    expect_near(glm::vec3(mesh.colors.values[i]), normal * 0.5f + 0.5f, 0.02f);
    EXPECT_EQ(mesh.colors.values[i].a, 1);
  }
}
INSTANTIATE_TEST_SUITE_P(Files, CompressedTorus,
                         testing::Values("draco_edgebreaker.glb", "draco_sequential.glb", "meshopt_filters.glb"));

// ---- Draco ----

class GltfDraco : public testing::Test {
 protected:
  void SetUp() override {
    if (!gltf::has_draco()) GTEST_SKIP() << "built without Draco";
  }
  Parts box{"draco.glb"};
  Json& primitive() { return box.text["meshes"][0]["primitives"][0]; }
  Json& extension() { return primitive()["extensions"]["KHR_draco_mesh_compression"]; }
};

constexpr const char* draco_place = "t.glb: meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";

TEST_F(GltfDraco, PrimitivesOfOneViewShareItsVertices) {
  box.text["meshes"][0]["primitives"].push_back(primitive());
  const Scene scene = box.read();
  EXPECT_EQ(triangle_count(scene), 24u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 8u);
}

TEST_F(GltfDraco, UncompressedAttributesMayBeBeside) {
  const std::vector<float> colors(8 * 3, 0.5f);
  const std::size_t offset = (box.binary.size() + 3) / 4 * 4;
  box.binary.resize(offset + colors.size() * 4);
  std::memcpy(box.binary.data() + offset, colors.data(), colors.size() * 4);
  box.text["buffers"][0]["byteLength"] = box.binary.size();
  box.text["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", colors.size() * 4}});
  box.text["accessors"].push_back({{"bufferView", 1}, {"type", "VEC3"}, {"componentType", 5126}, {"count", 8}});
  primitive()["attributes"]["COLOR_0"] = 2;
  EXPECT_EQ(box.read().meshes[0].colors.values, std::vector<glm::vec4>(8, glm::vec4(0.5f, 0.5f, 0.5f, 1)));
  box.text["accessors"][2]["count"] = 7;
  EXPECT_THAT(box.error(), HasSubstr("7 elements where others have 8"));
}

TEST_F(GltfDraco, AStripIsAListToo) {
  primitive()["mode"] = 5;
  EXPECT_EQ(triangle_count(box.read()), 12u);
  primitive()["mode"] = 1;
  EXPECT_EQ(box.error(), std::string(draco_place) + ": holds triangles, but the primitive's mode is 1");
}

TEST_F(GltfDraco, WrongNumbersNameTheirPlace) {
  extension()["attributes"]["POSITION"] = 3;
  EXPECT_EQ(box.error(), std::string(draco_place) + ".attributes.POSITION: the Draco data have no attribute 3");
  extension()["attributes"] = {{"NORMAL", 0}};
  EXPECT_EQ(box.error(), "t.glb: meshes[0].primitives[0].attributes: 'NORMAL' is missing");
  extension()["bufferView"] = 1;
  EXPECT_EQ(box.error(), std::string(draco_place) + ".bufferView: 1 does not exist, there are 1");
}

TEST_F(GltfDraco, OtherBytesAreNamed) {
  box.binary[6] = std::byte{1};  // the header: DRACO, major and minor version, type, method, flags
  EXPECT_EQ(box.error(), std::string(draco_place) + ": version 2.1 of Draco's format is not supported, only 2.2");
  box.binary[0] = std::byte{'X'};
  EXPECT_EQ(box.error(), std::string(draco_place) + ": the buffer view holds no Draco data");
}

// 20 bytes may state a billion triangles: numbers of 7 bits a byte follow the header and the kind of traversal.
TEST_F(GltfDraco, CountsAreCheckedBeforeMemoryIsAskedFor) {
  const unsigned char counts[] = {0x80, 0x80, 0x80, 0x80, 0x01, 0x80, 0x80, 0x80, 0x80, 0x02};
  ASSERT_EQ(box.binary[12], std::byte{8}) << "vertices";
  ASSERT_EQ(box.binary[13], std::byte{12}) << "triangles";
  box.binary.erase(box.binary.begin() + 12, box.binary.begin() + 14);
  for (std::size_t i = 0; i < sizeof counts; ++i)
    box.binary.insert(box.binary.begin() + std::ptrdiff_t(12 + i), std::byte(counts[i]));
  box.text["buffers"][0]["byteLength"] = box.text["bufferViews"][0]["byteLength"] = box.binary.size();
  EXPECT_THAT(box.error(), HasSubstr("of Draco data ask for more memory than 256 MiB"));
}

TEST_F(GltfDraco, DataMayHaveNoAttributes) {
  // Version 2.2, a mesh, sequential; one triangle of three vertices as bytes; no attributes.
  const unsigned char data[] = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 1, 3, 1, 0, 1, 2, 0, 0, 0};
  box.binary.resize(sizeof data);
  std::memcpy(box.binary.data(), data, sizeof data);
  box.text["buffers"][0]["byteLength"] = box.text["bufferViews"][0]["byteLength"] = sizeof data;
  EXPECT_THAT(box.error(), HasSubstr("the Draco data have no attribute 0"));
}

TEST_F(GltfDraco, EveryPrefixIsAnError) {
  for (std::size_t size = 1; size < 100; ++size) {
    box.text["bufferViews"][0]["byteLength"] = size;
    EXPECT_THAT(box.error(), HasSubstr(draco_place)) << size;
  }
}

// ---- meshoptimizer ----

class GltfMeshopt : public testing::Test {
 protected:
  void SetUp() override {
    if (!gltf::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer";
  }
  Parts box{"meshopt.glb"};
  Json& extension(std::size_t view) { return box.text["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]; }
  std::string error_with(std::size_t view, const char* key, const Json& value) {
    Parts changed = box;
    changed.text["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    const std::string error = changed.error();
    const std::string place = "t.glb: bufferViews[" + std::to_string(view) + "].extensions.EXT_meshopt_compression";
    EXPECT_THAT(error, testing::StartsWith(place));
    return error.substr(std::min(place.size(), error.size()));
  }
};

TEST_F(GltfMeshopt, TheNameOfKhronosIsReadToo) {
  for (Json& view : box.text["bufferViews"]) {
    view["extensions"]["KHR_meshopt_compression"] = view["extensions"]["EXT_meshopt_compression"];
    view["extensions"].erase("EXT_meshopt_compression");
  }
  box.text["extensionsRequired"][0] = box.text["extensionsUsed"][0] = "KHR_meshopt_compression";
  EXPECT_EQ(triangle_count(box.read()), 12u);
  // Version 1 of the vertex format, which the extension allows.
  box.binary[32] = std::byte{0xA1};
  EXPECT_EQ(
      box.error(),
      "t.glb: bufferViews[1].extensions.KHR_meshopt_compression: version 1 of the vertex format is not supported");
}

TEST_F(GltfMeshopt, WrongNumbersNameTheirPlace) {
  EXPECT_EQ(error_with(0, "mode", "STRIPS"), ": mode STRIPS is not supported");
  EXPECT_EQ(error_with(0, "byteStride", 3), ": byteStride 3 does not fit mode TRIANGLES");
  EXPECT_EQ(error_with(1, "byteStride", 0), ": byteStride 0 does not fit mode ATTRIBUTES");
  EXPECT_EQ(error_with(1, "byteStride", 260), ": byteStride 260 does not fit mode ATTRIBUTES");
  EXPECT_EQ(error_with(0, "count", 35), ": count 35 is no multiple of 3");
  EXPECT_EQ(error_with(1, "count", 9), ": 9 elements of 8 bytes, but the view has 64");
  EXPECT_EQ(error_with(1, "count", 0x2000000000000008u),
            ": 2305843009213693960 elements of 8 bytes, but the view has 64");
  EXPECT_EQ(error_with(1, "filter", "COLOR"), ": filter COLOR is not supported");
  EXPECT_EQ(error_with(0, "filter", "OCTAHEDRAL"), ": filter OCTAHEDRAL does not fit mode TRIANGLES and byteStride 2");
  EXPECT_EQ(error_with(1, "mode", "INDICES"), ": byteStride 8 does not fit mode INDICES");
  EXPECT_EQ(error_with(0, "mode", "INDICES"), ": the 29 bytes are damaged, or not of mode INDICES");
  EXPECT_EQ(error_with(1, "byteLength", 100), ": bytes 32 + 100 are not within the buffer, which has 116");
  EXPECT_EQ(error_with(1, "byteLength", 80), ": the 80 bytes are damaged, or not of mode ATTRIBUTES");
  EXPECT_EQ(error_with(1, "buffer", 1), ": its buffer has no contents in this file");
}

TEST_F(GltfMeshopt, BytesThatCannotHoldTheViewGetNoMemory) {
  const auto error_of = [&](std::uint64_t count) {
    box.text["buffers"][1]["byteLength"] = box.text["bufferViews"][1]["byteLength"] = count * 8;
    box.text["bufferViews"][1]["byteOffset"] = 0;
    return error_with(1, "count", count);
  };
  EXPECT_EQ(error_of(1000), ": 81 bytes cannot hold 8000");
  EXPECT_EQ(error_of(std::uint64_t(1) << 40),
            ": 8796093022208 elements are far more than a file of this size can hold");
}

// ---- Hostile, and builds without ----

TEST(GltfCompressed, MutationsNeverCrash) {
  std::size_t refused = 0, read = 0;
  std::uint32_t random = 1;
  for (const char* name :
       {"draco.glb", "draco_edgebreaker.glb", "draco_sequential.glb", "meshopt.glb", "meshopt_filters.glb"})
    for (int round = 0; round < 100; ++round) {
      Parts parts(name);
      for (int change = 0; change <= round % 4; ++change) {
        random = random * 1664525u + 1013904223u;
        parts.binary[(random >> 8) % parts.binary.size()] = std::byte(random);
      }
      ++(parts.error() == "read" ? read : refused);
    }
  EXPECT_GT(refused, 50u);
  EXPECT_TRUE(read > 0 || !gltf::has_draco() || !gltf::has_meshopt());
}

TEST(GltfCompressed, ABuildWithoutADecoderNamesItAndTheCommand) {
  const auto expect_named = [](const char* name, bool has, const char* extension, const char* option) {
    if (has) return;
    const std::string error = Parts(name).error();
    EXPECT_THAT(error, testing::StartsWith(std::string("t.glb: extensionsRequired: ") + extension + ": not supported"));
    EXPECT_THAT(error, HasSubstr(option));
    EXPECT_THAT(error, HasSubstr("convert it first: npx @gltf-transform/cli copy t.glb t-plain.glb"));
  };
  expect_named("draco.glb", gltf::has_draco(), "KHR_draco_mesh_compression", "FRONTMOST_DRACO");
  expect_named("meshopt.glb", gltf::has_meshopt(), "EXT_meshopt_compression", "FRONTMOST_MESHOPT");
}

TEST(GltfCompressed, Ktx2NamesTheCommand) {
  const std::string ways =
      "convert it first: npx @gltf-transform/cli ktxdecompress t.glb t-plain.glb (Node.js fetches glTF Transform)";
  Parts parts("webp.glb");
  parts.text["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 0}}}};
  parts.text["extensionsUsed"] = {"KHR_texture_basisu"};
  EXPECT_THAT(parts.read().warnings, testing::Contains("t.glb: textures[0]: its image is KTX2, which is not read (" +
                                                       ways + "), materials go without it"));
  parts.text["extensionsRequired"] = {"KHR_texture_basisu"};
  EXPECT_EQ(parts.error(), "t.glb: extensionsRequired: KHR_texture_basisu: not supported; " + ways);
}

}  // namespace
}  // namespace frontmost
