// SPDX-License-Identifier: Apache-2.0
// Small files that could cost much. Each must be refused, or be read at a cost in proportion to its size; read naively,
// each takes gigabytes or minutes, so that this test would not end.
#include "io/input_file.h"
#include "io/models/reader.h"
#include "model_bytes.h"

namespace frontmost {
namespace {

using test::error_of;
using test::load_text;
using testing::HasSubstr;

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// `count` JSON values in an array.
std::string array_of(const std::string& json, int count) { return "[" + json + repeated("," + json, count - 1) + "]"; }

/// A glTF file with these members and accessors; its accessor 0 is three points at the origin.
std::string gltf(const std::string& members, const std::string& more_accessors = {}) {
  return R"({"asset":{"version":"2.0"},"accessors":[{"count":3,"componentType":5126,"type":"VEC3"})" + more_accessors +
         "]," + members + "}";
}
const std::string point_primitive = R"("primitives":[{"attributes":{"POSITION":0}}])";

const std::string long_name(1 << 20, 'A');
const std::string obj_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Hostile, LongNamesAreCutBeforeManyObjectsShareThem) {
  const Scene obj = load_text(obj_triangle + "o " + long_name + "\n" + repeated("g x\nf 1 2 3\ng off\nf 1 2 3\n", 5000),
                              ModelFormat::obj);
  ASSERT_EQ(obj.instances.size(), 10'000u);
  EXPECT_EQ(obj.instances[1].name, std::string(longest_name, 'A'));

  const Scene nodes = load_text(gltf(R"("meshes":[{"name":")" + long_name + R"(",)" + point_primitive +
                                     R"(}],"nodes":)" + array_of(R"({"mesh":0})", 10'000)));
  ASSERT_EQ(nodes.instances.size(), 10'000u);
  EXPECT_EQ(nodes.instances[9999].name, std::string(longest_name, 'A'));

  const Scene stl = load_text("solid " + long_name + "\nendsolid\n", ModelFormat::stl);
  EXPECT_EQ(stl.meshes.at(0).name.size(), longest_name);
}

TEST(Hostile, NamesAreCutBetweenCharacters) {
  const std::string start(longest_name - 1, 'a');
  EXPECT_EQ(name_of(start + "\xC3\xA9"), start);               // é, two bytes
  EXPECT_EQ(name_of(start + "\xF0\x9F\xAB\x96 more"), start);  // a teapot, four
  EXPECT_EQ(name_of(start + "bc"), start + "b");
  EXPECT_EQ(name_of("short \xC3\xA9"), "short \xC3\xA9");
}

TEST(Hostile, MessagesHoldNoControlCharacters) {
  for (const std::string& text :
       {error_of("ply\nformat \x1b[31m 1.0\n", ModelFormat::ply), error_of("\x1b[2JOFF\n", ModelFormat::off),
        error_of(R"({"asset":{"version":"\u001b[2J"}})", ModelFormat::gltf)}) {
    EXPECT_THAT(text, HasSubstr("\\x1B[")) << text;
    for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << text;
  }
  const Scene scene = load_text(obj_triangle + "mtllib \x1b[31m.mtl\n\x1b[2J x\n", ModelFormat::obj);
  ASSERT_EQ(scene.warnings.size(), 3u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("\\x1B[31m.mtl"));
  EXPECT_THAT(scene.warnings[1], HasSubstr("\\x1B[2J"));
}

TEST(Hostile, PlyElementsWithoutPropertiesHaveNoRows) {
  const std::string start = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string name : {"tristrips", "face", "other"}) {
    const Scene scene = load_text(start + "element " + name + " 1000000000000000\nend_header\n", ModelFormat::ply);
    EXPECT_EQ(triangle_count(scene), 0u);
  }
}

TEST(Hostile, PlyElementsDoNotMoveAllTrianglesEachTime) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\n";
  text += repeated("element face 1\nproperty list uchar uchar vertex_index\n", 50'000) + "end_header\n";
  text += std::string(3, '\0') + repeated(std::string("\3\0\0\0", 4), 50'000);
  EXPECT_EQ(triangle_count(load_text(text, ModelFormat::ply)), 50'000u);
}

TEST(Hostile, GltfElementsAreCounted) {
  for (const std::string key : {"nodes", "materials"}) {
    const std::string text = gltf('"' + key + "\":" + array_of("{}", (1 << 20) + 1));
    EXPECT_EQ(error_of(text, ModelFormat::gltf), "model: " + key + ": 1048577 are more than 1048576");
  }
}

TEST(Hostile, GltfNodesPayForTheirWeights) {
  const std::string text = gltf(R"("meshes":[{"weights":)" + array_of("0", 50'000) +
                                R"(,"primitives":[{"attributes":{"POSITION":0},"targets":)" + array_of("{}", 50'000) +
                                R"(}]}],"nodes":)" + array_of(R"({"mesh":0})", 50'000));
  EXPECT_THAT(error_of(text, ModelFormat::gltf), HasSubstr("far more than a file of this size can hold"));
}

TEST(Hostile, GltfNodesPayForTheTrianglesThatTheyRepeat) {
  // The million triangles take no bytes either: indices without a buffer view are zero.
  const std::string text = gltf(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"nodes":)" +
                                    array_of(R"({"mesh":0})", 4000),
                                R"(,{"count":3000000,"componentType":5125,"type":"SCALAR"})");
  EXPECT_THAT(error_of(text, ModelFormat::gltf), HasSubstr("far more than a file of this size can hold"));
}

TEST(Hostile, DevicesEnd) {
  try {
    (void)load("/dev/zero");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    EXPECT_STREQ(error.what(),
                 ("/dev/zero: larger than the limit of " + std::to_string(max_device_bytes) + " bytes").c_str());
  }
}

}  // namespace
}  // namespace frontmost
