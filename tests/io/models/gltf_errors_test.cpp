// SPDX-License-Identifier: Apache-2.0
// Errors of glTF files, one at a time, and the message for each: file, place, reason.
#include <gmock/gmock.h>

#include "frontmost/files.h"
#include "io/models/gltf_maker.h"

namespace frontmost {
namespace {

using test::GltfMaker;
using test::Type;

/// "code: place: reason" of the error that loading ends in; "read" if there is none.
std::string outcome(const std::vector<std::byte>& bytes) {
  LoadOptions options;
  options.format = ModelFormat::gltf;
  try {
    (void)load(bytes, "t.glb", options);
    return "read";
  } catch (const Error& error) {
    const std::string what = error.what(), start = "t.glb: ";
    EXPECT_TRUE(what.starts_with(start)) << what;
    const char* code = error.code() == ErrorCode::file_malformed   ? "malformed: "
                       : error.code() == ErrorCode::limit_exceeded ? "limit: "
                       : error.code() == ErrorCode::unsupported    ? "unsupported: "
                                                                   : "another code: ";
    return code + what.substr(std::min(start.size(), what.size()));
  }
}
std::string outcome(const GltfMaker& maker) { return outcome(maker.glb()); }
std::string outcome_of_json(const std::string& members) {
  return outcome(test::byte_vector(R"({"asset":{"version":"2.0"})" + members + "}"));
}

// ---- The container ----

constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

/// A GLB file written number by number.
class RawGlb {
 public:
  RawGlb& put(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes_.push_back(std::byte(value >> (8 * i)));
    return *this;
  }
  RawGlb& header(std::uint32_t length, std::uint32_t version = 2) { return put(0x46546C67).put(version).put(length); }
  RawGlb& chunk(std::uint32_t type, const std::string& text) {
    put(std::uint32_t(text.size())).put(type);
    for (const char c : text) bytes_.push_back(std::byte(c));
    return *this;
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

const std::string least_json = R"({"asset":{"version":"2.0"}})" + std::string(1, ' ');  // 28 bytes

TEST(GltfContainer, HeadersThatLie) {
  RawGlb cut;
  cut.put(0x46546C67).put(2);
  EXPECT_EQ(outcome(cut.bytes()), "malformed: GLB header: the file ends within it");
  const auto with = [](std::uint32_t length, std::uint32_t version) {
    RawGlb glb;
    glb.header(length, version).chunk(json_chunk, least_json);
    return outcome(glb.bytes());
  };
  EXPECT_EQ(with(48, 2), "read");
  EXPECT_EQ(with(48, 1), "unsupported: GLB header: version 1 is not supported, only 2");
  EXPECT_EQ(with(48, 3), "malformed: GLB header: version 3 is not supported, only 2");
  EXPECT_EQ(with(49, 2), "malformed: GLB header: the length is stated as 49 bytes, the file has 48");
  EXPECT_EQ(with(0xFFFFFFFF, 2), "malformed: GLB header: the length is stated as 4294967295 bytes, the file has 48");
  EXPECT_EQ(with(19, 2), "malformed: GLB header: no room for a chunk");
  EXPECT_EQ(with(20, 2), "malformed: GLB chunk 0: its header states a length of 28 bytes, 0 are left");
  EXPECT_EQ(with(47, 2), "malformed: GLB chunk 0: its header states a length of 28 bytes, 27 are left");
}

TEST(GltfContainer, ChunksComeInOneOrder) {
  RawGlb binary_first, second_json, late_binary, half_header;
  binary_first.header(24).chunk(binary_chunk, "0000");
  EXPECT_EQ(outcome(binary_first.bytes()), "malformed: GLB chunk 0: the first chunk must be JSON");
  second_json.header(84).chunk(json_chunk, least_json).chunk(json_chunk, least_json);
  EXPECT_EQ(outcome(second_json.bytes()), "malformed: GLB chunk 1: a second JSON chunk");
  late_binary.header(68).chunk(json_chunk, least_json).chunk(7, "").chunk(binary_chunk, "0000");
  EXPECT_EQ(outcome(late_binary.bytes()), "malformed: GLB chunk 2: a BIN chunk that is not the second one");
  half_header.header(52).chunk(json_chunk, least_json).put(4);
  EXPECT_EQ(outcome(half_header.bytes()), "malformed: GLB chunk 1: the file ends within its header");
}

// glTF 2.0, section 4.4: clients must ignore chunks with unknown types.
TEST(GltfContainer, WhatIsUnknownOrBehindTheEndIsPassedOver) {
  RawGlb glb;
  glb.header(72).chunk(json_chunk, least_json).chunk(binary_chunk, "0000").chunk(99, "abcd");
  EXPECT_EQ(outcome(glb.bytes()), "read");
  glb.chunk(json_chunk, "behind the stated length");
  EXPECT_EQ(outcome(glb.bytes()), "read");
}

// ---- JSON ----

TEST(GltfJson, ValuesOfTheWrongKindNameTheirPlace) {
  const std::pair<const char*, const char*> cases[] = {
      {R"(,"nodes":{})", "nodes: an array is expected, not object"},
      {R"(,"nodes":[7])", "nodes[0]: an object is expected, not number"},
      {R"(,"nodes":[{"name":7}])", "nodes[0].name: a string is expected, not number"},
      {R"(,"nodes":[{"children":[true]}])", "nodes[0].children[0]: a number is expected, not boolean"},
      {R"(,"nodes":[{"children":[-0.5]}])", "nodes[0].children[0]: a whole number from 0 on is expected, not -0.5"},
      {R"(,"nodes":[{"children":[1e16]}])", "nodes[0].children[0]: a whole number from 0 on is expected, not 1e+16"},
      {R"(,"nodes":[{"scale":[1,2]}])", "nodes[0].scale: 3 numbers are expected, not 2"},
      {R"(,"nodes":[{"rotation":[0,0,0,1,0]}])", "nodes[0].rotation: 4 numbers are expected, not 5"},
      {R"(,"nodes":[{"extensions":[]}])", "nodes[0].extensions: an object is expected, not array"},
      {R"(,"materials":[{"doubleSided":1}])", "materials[0].doubleSided: true or false is expected, not number"},
      {R"(,"buffers":[{}])", "buffers[0]: 'byteLength' is missing"},
      {R"(,"extensionsRequired":[null])", "extensionsRequired[0]: a string is expected, not null"},
  };
  for (const auto& [members, words] : cases)
    EXPECT_EQ(outcome_of_json(members), std::string("malformed: ") + words) << members;
  EXPECT_EQ(outcome(test::byte_vector("[]")), "malformed: JSON: an object is expected, not array");
  EXPECT_EQ(outcome(test::byte_vector("{}")), "malformed: JSON: 'asset' is missing");
  EXPECT_EQ(outcome_of_json(R"(,"nodes":[{"children":[0.0]}])"), "malformed: nodes[0]: is part of a loop of nodes")
      << "0.0 is a whole number";
}

TEST(GltfJson, TooManyValuesAreCountedBeforeTheyBecomeObjects) {
  const std::string most = std::string(8'000'000, ','), strings = "\"" + most + "\"";
  EXPECT_EQ(outcome_of_json(",\"extras\":" + strings), "read") << "commas in a string are no values";
  EXPECT_EQ(outcome_of_json(",\"extras\":[" + most + std::string(400'000, ',')),
            "limit: JSON: more than 8388608 values");
  EXPECT_EQ(outcome_of_json(",\"nodes\":[{}" + std::string(8 << 20, ' ') + "]"), "read") << "nor are blanks";
}

TEST(GltfJson, ABracketInAStringNeedsNoCounterpart) {
  EXPECT_EQ(outcome_of_json(R"(,"extras":"\")" + std::string(300, '[') + R"(\\")"), "read") << "nor does a quote in it";
  std::string nested(252, '[');
  nested += std::string(252, ']');
  EXPECT_EQ(outcome_of_json(",\"extras\":" + nested), "read");
  const std::string deeper = std::string(256, '[') + std::string(256, ']');
  EXPECT_EQ(outcome_of_json(",\"extras\":" + deeper), "limit: byte 291: JSON nested deeper than 256");
}

TEST(GltfJson, ObjectsOfEveryKindAreCounted) {
  for (const char* key : {"nodes", "skins"}) {
    std::string text = std::string(",\"") + key + "\":[0";
    for (int i = 0; i < 1 << 20; ++i) text += ",0";
    EXPECT_EQ(outcome_of_json(text + "]"), std::string("limit: ") + key + ": 1048577 are more than 1048576");
  }
}

// ---- Buffers, views and accessors ----

TEST(GltfData, BuffersWithoutContents) {
  EXPECT_EQ(outcome(GltfMaker::glb_of(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]})", {})),
            "malformed: buffers[0]: the GLB has no BIN chunk");
  EXPECT_EQ(outcome_of_json(R"(,"buffers":[{"byteLength":9,"uri":"data:,12345678"}])"),
            "malformed: buffers[0]: byteLength is 9, but there are only 8 bytes");
  // A file of JSON alone may leave a buffer to an extension; reading the buffer is an error.
  const std::string open =
      R"(,"buffers":[{"byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,
         "count":3,"type":"VEC3","componentType":5126}])";
  EXPECT_EQ(outcome_of_json(open), "read");
  EXPECT_EQ(outcome_of_json(open + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"),
            "malformed: meshes[0].primitives[0].attributes.POSITION: its buffer has no contents in this file");
  EXPECT_EQ(outcome_of_json(open + R"(,"bufferViews":[],"accessors":[{"bufferView":0,"count":1,"type":"SCALAR",
                                        "componentType":5121}])"),
            "malformed: accessors[0].bufferView: 0 does not exist, there are 0")
      << "of two members of one name the last one holds";
}

TEST(GltfData, ViewsLieWithinTheirBuffer) {
  const auto view = [](const std::string& members) {
    return outcome_of_json(R"(,"buffers":[{"byteLength":12,"uri":"data:,123456789012"}],"bufferViews":[{"buffer":0,)" +
                           members + "}]");
  };
  EXPECT_EQ(view(R"("byteLength":12)"), "read");
  EXPECT_EQ(view(R"("byteLength":0,"byteOffset":12)"), "read");
  EXPECT_EQ(view(R"("byteLength":13)"),
            "malformed: bufferViews[0]: bytes 0 + 13 are not within the buffer, which has 12");
  EXPECT_EQ(view(R"("byteLength":8,"byteOffset":5)"),
            "malformed: bufferViews[0]: bytes 5 + 8 are not within the buffer, which has 12");
  EXPECT_EQ(view(R"("byteLength":0,"byteOffset":13)"),
            "malformed: bufferViews[0]: bytes 13 + 0 are not within the buffer, which has 12");
  EXPECT_EQ(view(R"("byteLength":18446744073709551615,"byteOffset":2)"),
            "malformed: bufferViews[0]: bytes 2 + 18446744073709551615 are not within the buffer, which has 12")
      << "the sum would be 1";
}

// Columns of matrices start at multiples of four bytes, and no padding need follow the last column: three columns of
// three bytes take 11 bytes, two of two take 6.
TEST(GltfData, ColumnsOfMatricesArePadded) {
  const auto matrix = [](const char* shape, int component, int bytes) {
    GltfMaker maker;
    const std::vector<std::byte> zeros{std::size_t(bytes)};
    maker.view(zeros.data(), zeros.size());
    maker.bare_accessor({shape, component, ""}, 1, R"(,"bufferView":0)");
    return outcome(maker);
  };
  const auto too_short = [](int bytes) {
    return "malformed: accessors[0]: 1 elements from byte 0 on are not within bufferViews[0], which has " +
           std::to_string(bytes) + " bytes";
  };
  EXPECT_EQ(matrix("MAT2", 5121, 6), "read");
  EXPECT_EQ(matrix("MAT2", 5121, 5), too_short(5));
  EXPECT_EQ(matrix("MAT3", 5120, 11), "read");
  EXPECT_EQ(matrix("MAT3", 5120, 10), too_short(10));
  EXPECT_EQ(matrix("MAT3", 5123, 22), "read");
  EXPECT_EQ(matrix("MAT3", 5123, 21), too_short(21));
  EXPECT_EQ(matrix("MAT4", 5121, 16), "read");
  EXPECT_EQ(matrix("MAT4", 5121, 15), too_short(15));
}

TEST(GltfData, StridesAreNotShorterThanElements) {
  const auto strided = [](int stride) {
    GltfMaker maker;
    maker.view(std::vector<float>(9).data(), 36, R"(,"byteStride":)" + std::to_string(stride));
    maker.bare_accessor({"VEC3", 5126, ""}, 2, R"(,"bufferView":0)");
    return outcome(maker);
  };
  EXPECT_EQ(strided(11), "malformed: accessors[0]: byteStride 11 is less than an element, 12");
  EXPECT_EQ(strided(12), "read");
  EXPECT_EQ(strided(24), "read") << "the last element needs no room behind it";
  EXPECT_EQ(strided(25),
            "malformed: accessors[0]: 2 elements from byte 0 on are not within bufferViews[0], which has 36 bytes");
}

TEST(GltfData, AccessorsOfUnknownTypesAreErrorsOnceTheyAreRead) {
  for (const Type& type : {Type{"VEC3", 5130, ""}, Type{"VEC9", 5126, ""}}) {
    GltfMaker maker;
    maker.bare_accessor(type, 3);
    EXPECT_EQ(outcome(maker), "read");
    maker.show(R"({"attributes":{"POSITION":0}})");
    EXPECT_EQ(outcome(maker), "malformed: meshes[0].primitives[0].attributes.POSITION: the accessor's type is unknown");
  }
}

/// Two positions, `count` of them replaced; views 0 and 1 hold `indices` bytes and `values` bytes.
std::string sparse_outcome(int count, int component, std::size_t indices, std::size_t values) {
  GltfMaker maker;
  std::vector<std::byte> bytes(96);
  bytes[std::size_t(component == 5121 ? 1 : component == 5123 ? 2 : 4)] = std::byte(1);  // 0, 1 in any width
  maker.view(bytes.data(), indices);
  maker.view(bytes.data() + 32, values);
  maker.bare_accessor({"VEC3", 5126, ""}, 2,
                      R"(,"sparse":{"count":)" + std::to_string(count) +
                          R"(,"indices":{"bufferView":0,"componentType":)" + std::to_string(component) +
                          R"(},"values":{"bufferView":1}})");
  return outcome(maker);
}

TEST(GltfData, SparseArraysAreHeldAgainstTheirViews) {
  for (const int component : {5121, 5123, 5125}) {
    const std::size_t width = component == 5121 ? 1 : component == 5123 ? 2 : 4;
    EXPECT_EQ(sparse_outcome(2, component, 2 * width, 24), "read") << component;
    EXPECT_EQ(sparse_outcome(2, component, 2 * width - 1, 24),
              "malformed: accessors[0].sparse.indices: 2 elements from byte 0 on are not within the buffer view, which "
              "has " +
                  std::to_string(2 * width - 1) + " bytes");
  }
  EXPECT_EQ(
      sparse_outcome(2, 5121, 2, 23),
      "malformed: accessors[0].sparse.values: 2 elements from byte 0 on are not within the buffer view, which has "
      "23 bytes");
  EXPECT_EQ(sparse_outcome(3, 5121, 3, 36), "malformed: accessors[0].sparse: replaces 3 of 2 elements");
  for (const int component : {5120, 5122, 5126, 9})
    EXPECT_EQ(sparse_outcome(1, component, 8, 24),
              "malformed: accessors[0].sparse.indices: componentType is not an unsigned integer");
}

TEST(GltfData, SparseElementsReplaceThoseOfAView) {
  GltfMaker maker;
  const std::vector<float> base = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}, values = {7, 8, 9};
  const std::uint32_t place = 2;
  maker.view(base.data(), 48);
  maker.view(&place, 4);
  maker.view(values.data(), 12);
  maker.bare_accessor({"VEC3", 5126, ""}, 4,
                      R"(,"bufferView":0,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5125},
                         "values":{"bufferView":2}})");
  maker.shorts({1, 2, 3});
  maker.show(R"({"attributes":{"POSITION":0},"indices":1})");
  // Vertex 0 is not in use, so the data to read begins in the middle of the accessor.
  EXPECT_THAT(load(maker.glb(), "t.glb").meshes[0].positions,
              testing::ElementsAre(glm::vec3(2), glm::vec3(7, 8, 9), glm::vec3(4)));
}

TEST(GltfData, DataUrisKnowBothAlphabets) {
  const auto first_position = [](const std::string& uri) {
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":")" + uri +
                             R"("}],"bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4}],"accessors":[
        {"bufferView":0,"count":3,"type":"VEC3","componentType":5121}],"meshes":[{"primitives":[
        {"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
    return load(test::byte_vector(text), "t.gltf").meshes[0].positions.at(0);
  };
  // 255 239 190 is "/+++" or "_---": the digits 63 and 62 of base64 (RFC 4648, sections 4 and 5).
  EXPECT_EQ(first_position("data:;base64,/+++AAAAAAAAAAAA"), glm::vec3(255, 239, 190));
  EXPECT_EQ(first_position("data:;base64,_---AAAAAAAAAAAA"), glm::vec3(255, 239, 190));
  // A percent sign that begins no escape stands for itself, even at the end.
  EXPECT_EQ(first_position("data:,%41%4a%4A567890123"), glm::vec3('A', 'J', 'J'));
  EXPECT_EQ(first_position("data:,%zz4567890%1"), glm::vec3('%', 'z', 'z'));
}

TEST(GltfData, BrokenDataUris) {
  const auto buffer = [](const std::string& uri) {
    return outcome_of_json(R"(,"buffers":[{"byteLength":3,"uri":")" + uri + R"("}])");
  };
  EXPECT_EQ(buffer("data:;base64,AAAA"), "read");
  EXPECT_EQ(buffer("data:;base64,AAA="), "malformed: buffers[0]: byteLength is 3, but there are only 2 bytes");
  EXPECT_EQ(buffer("data:;base64,AA=="), "malformed: buffers[0]: byteLength is 3, but there are only 1 bytes");
  EXPECT_EQ(buffer("data:;base64,AAAAA"), "malformed: buffers[0].uri: base64 data end within a byte");
  EXPECT_EQ(buffer("data:;base64,AA A"),
            "malformed: buffers[0].uri: character 2 of the base64 data is not in its alphabet");
}

// ---- Meshes ----

/// Outcome of a mesh with one primitive of three positions (accessor 0); `fill` may add accessors from 1 on.
template <class Fill>
std::string primitive_outcome(const std::string& members, Fill fill) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  fill(maker);
  maker.show("{" + members + "}");
  return outcome(maker);
}

TEST(GltfMesh, AttributesOfTheWrongTypeNameTheirPlace) {
  const std::string place = "malformed: meshes[0].primitives[0].attributes.";
  const auto second = [](const char* name, const Type& type, std::size_t count = 3) {
    return primitive_outcome(R"("attributes":{"POSITION":0,")" + std::string(name) + R"(":1})",
                             [&](GltfMaker& maker) { maker.bare_accessor(type, count); });
  };
  EXPECT_EQ(second("NORMAL", {}), "read");
  EXPECT_EQ(second("NORMAL", {"VEC4", 5126, ""}), place + "NORMAL: has 4 components");
  EXPECT_EQ(second("COLOR_0", {"VEC2", 5126, ""}), place + "COLOR_0: has 2 components");
  EXPECT_EQ(second("COLOR_0", {"VEC4", 5126, ""}), "read");
  EXPECT_EQ(second("TEXCOORD_3", {"VEC3", 5126, ""}), place + "TEXCOORD_3: has 3 components");
  EXPECT_EQ(second("TEXCOORD_4", {"VEC3", 5126, ""}), "read") << "sets above the fourth are not looked at";
  EXPECT_EQ(second("NORMAL", {}, 4), place + "NORMAL: 4 elements where others have 3");
  EXPECT_EQ(second("JOINTS_0", {"VEC4", 5126, ""}), place + "JOINTS_0: is not of unsigned bytes or shorts");
  EXPECT_EQ(second("JOINTS_0", {"VEC4", 5121, ""}),
            "malformed: meshes[0].primitives[0].attributes: joints without weights, or weights without joints");
  EXPECT_EQ(second("WEIGHTS_0", {"VEC4", 5126, ""}),
            "malformed: meshes[0].primitives[0].attributes: joints without weights, or weights without joints");
}

TEST(GltfMesh, IndicesAreUnsignedScalars) {
  const auto with = [](const Type& type) {
    return primitive_outcome(R"("attributes":{"POSITION":0},"indices":1)",
                             [&](GltfMaker& maker) { maker.bare_accessor(type, 3); });
  };
  const std::string refused = "malformed: meshes[0].primitives[0].indices: the accessor is not of unsigned scalars";
  for (const int component : {5121, 5123, 5125}) EXPECT_EQ(with({"SCALAR", component, ""}), "read");
  for (const int component : {5120, 5122, 5126}) EXPECT_EQ(with({"SCALAR", component, ""}), refused);
  EXPECT_EQ(with({"VEC2", 5123, ""}), refused);
}

TEST(GltfMesh, MorphTargetsAndWeightsAreCounted) {
  const auto none = [](GltfMaker&) {};
  EXPECT_EQ(primitive_outcome(R"("attributes":{"POSITION":0},"targets":[{"POSITION":0},{}])", none), "read");
  EXPECT_EQ(primitive_outcome(R"("attributes":{"POSITION":0},"targets":[{"POSITION":0},{"POSITION":1}])",
                              [](GltfMaker& maker) { maker.bare_accessor({}, 2); }),
            "malformed: meshes[0].primitives[0].targets[1].POSITION: 2 elements where others have 3");
  EXPECT_EQ(primitive_outcome(R"("attributes":{"POSITION":0},"targets":[{"POSITION":0}]},{"attributes":{"POSITION":0})",
                              none),
            "malformed: meshes[0].primitives[1]: 0 morph targets where others have 1");
  const auto weights = [](const char* of_mesh, const char* of_node) {
    GltfMaker maker;
    maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    maker.add("meshes", std::string(R"({"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":0}]}])") +
                            of_mesh + "}");
    maker.add("nodes", std::string(R"({"mesh":0)") + of_node + "}");
    return outcome(maker);
  };
  EXPECT_EQ(weights("", ""), "read");
  EXPECT_EQ(weights(R"(,"weights":[1])", R"(,"weights":[0])"), "read");
  EXPECT_EQ(weights(R"(,"weights":[1,2])", ""), "malformed: meshes[0]: 2 weights for 1 morph targets");
  EXPECT_EQ(weights("", R"(,"weights":[1,2,3])"), "malformed: nodes[0].weights: 3 weights for 1 morph targets");
}

// ---- Nodes and skins ----

TEST(GltfNodes, MatricesAreAffine) {
  const auto with = [](const char* last_row) {
    // Column-major: the last row is every fourth number.
    const std::string r = last_row;
    return outcome_of_json(R"(,"nodes":[{"matrix":[1,0,0,)" + r.substr(0, r.find(' ')) + ",0,1,0,0,0,0,1,0,5,6,7," +
                           r.substr(r.find(' ') + 1) + "]}]");
  };
  EXPECT_EQ(with("0 1"), "read");
  EXPECT_EQ(with("1e-7 0.9999999"), "read") << "exporters work in floats";
  EXPECT_EQ(with("1e-5 1"), "malformed: nodes[0].matrix: is not affine");
  EXPECT_EQ(with("0 2"), "malformed: nodes[0].matrix: is not affine");
}

TEST(GltfNodes, SkinsHaveJointsAndAMatrixForEach) {
  const auto skin = [](const std::string& members, const Type& type = {"MAT4", 5126, ""}, std::size_t count = 1) {
    GltfMaker maker;
    maker.bare_accessor(type, count);
    maker.add("skins", "{" + members + "}");
    maker.add("nodes", "{}");
    maker.add("nodes", "{}");
    return outcome(maker);
  };
  EXPECT_EQ(skin(""), "malformed: skins[0]: 'joints' is missing");
  EXPECT_EQ(skin(R"("joints":[])"), "malformed: skins[0].joints: a skin without joints");
  EXPECT_EQ(skin(R"("joints":[2])"), "malformed: skins[0].joints[0]: 2 does not exist, there are 2");
  EXPECT_EQ(skin(R"("joints":[0],"inverseBindMatrices":0)"), "read");
  EXPECT_EQ(skin(R"("joints":[0,1],"inverseBindMatrices":0)"),
            "malformed: skins[0].inverseBindMatrices: 1 matrices for 2 joints");
  for (const Type& type : {Type{"MAT3", 5126, ""}, Type{"MAT4", 5121, ""}})
    EXPECT_EQ(skin(R"("joints":[0],"inverseBindMatrices":0)", type),
              "malformed: skins[0].inverseBindMatrices: the accessor is not of float MAT4");
}

/// A triangle, copied by the attributes `names` with accessors of `counts` elements, all zero.
std::string copies_outcome(const std::vector<std::pair<const char*, Type>>& attributes,
                           const std::vector<std::size_t>& counts) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.add("meshes", R"({"primitives":[{"attributes":{"POSITION":0}}]})");
  // The view has a few bytes. An accessor without elements lies in it, and reads nothing behind it.
  const int view = maker.view(std::vector<float>(8).data(), 32);
  std::string names;
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    maker.bare_accessor(attributes[i].second, counts[i], R"(,"bufferView":)" + std::to_string(view));
    names += (i == 0 ? "\"" : ",\"") + std::string(attributes[i].first) + "\":" + std::to_string(i + 1);
  }
  maker.add("nodes", R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" + names + "}}}}");
  return outcome(maker);
}

TEST(GltfNodes, CopiesHaveAsManyElementsOfEachKind) {
  const Type three, four{"VEC4", 5126, ""};
  const std::string place = "malformed: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.";
  EXPECT_EQ(copies_outcome({{"TRANSLATION", three}, {"ROTATION", four}}, {2, 2}), "read");
  EXPECT_EQ(copies_outcome({{"TRANSLATION", four}}, {2}), place + "TRANSLATION: the accessor's type does not fit");
  EXPECT_EQ(copies_outcome({{"ROTATION", three}}, {2}), place + "ROTATION: the accessor's type does not fit");
  EXPECT_EQ(copies_outcome({{"TRANSLATION", three}, {"SCALE", three}}, {2, 1}),
            place + "SCALE: has another number of elements than earlier attributes");
  EXPECT_EQ(copies_outcome({{"TRANSLATION", three}, {"ROTATION", four}, {"SCALE", three}}, {0, 2, 2}),
            place + "ROTATION: has another number of elements than earlier attributes")
      << "none is a number too: the elements of the others are not in the first one's view";
  EXPECT_EQ(copies_outcome({{"TRANSLATION", three}, {"SCALE", three}}, {0, 0}), "read");
}

}  // namespace
}  // namespace frontmost
