// SPDX-License-Identifier: Apache-2.0
// glTF piece by piece: small generated files with known answers.
#include <gmock/gmock.h>

#include "frontmost/files.h"
#include "io/models/gltf/data.h"
#include "io/models/gltf_maker.h"

namespace frontmost {
namespace {

using test::GltfMaker;
using test::load_glb;
using test::Type;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* indexed = R"({"attributes":{"POSITION":0},"indices":1})";

std::string error_of(const std::vector<std::byte>& bytes, ErrorCode code = ErrorCode::file_malformed) {
  try {
    (void)load(bytes, "t.glb");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_THAT(error.what(), testing::StartsWith("t.glb: "));
    return error.what();
  }
  return "no error";
}
std::string error_of(const GltfMaker& maker, ErrorCode code = ErrorCode::file_malformed) {
  return error_of(maker.glb(), code);
}

/// Five points on a line along x, enough for every kind of primitive.
GltfMaker points_maker() {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0});
  return maker;
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
  for (const auto& [mode, triangles] :
       {std::pair(4, std::vector<glm::uvec3>{{2, 1, 0}}),  // vertices 2 to 4; the others are not in use

        std::pair(5, std::vector<glm::uvec3>{{4, 3, 2}, {3, 1, 2}, {2, 1, 0}}),
        std::pair(6, std::vector<glm::uvec3>{{3, 2, 4}, {2, 1, 4}, {1, 0, 4}})}) {
    GltfMaker maker = points_maker();
    maker.shorts({4, 3, 2, 1, 0});
    maker.show(R"({"attributes":{"POSITION":0},"indices":1,"mode":)" + std::to_string(mode) + "}");
    const Scene scene = load_glb(maker);
    EXPECT_EQ(scene.meshes[0].triangles, triangles) << "mode " << mode;
    EXPECT_EQ(scene.warnings.size(), mode == 4 ? 1u : 0u) << "five corners are not whole triangles";
  }
}

TEST(Gltf, WithoutIndicesCornersFollowEachOther) {
  GltfMaker maker = points_maker();
  maker.show(R"({"attributes":{"POSITION":0},"mode":5})");
  EXPECT_THAT(load_glb(maker).meshes[0].triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 3, 2), glm::uvec3(2, 3, 4)));
}

TEST(Gltf, PointsAndLinesArePassedOver) {
  for (int mode = 0; mode < 4; ++mode) {
    GltfMaker maker = points_maker();
    maker.show(R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + "}");
    const Scene scene = load_glb(maker);
    EXPECT_EQ(triangle_count(scene), 0u);
    EXPECT_THAT(scene.warnings.at(0), HasSubstr("meshes[0].primitives[0]: "));
  }
}

/// Points and a strip of triangles over them, beside a primitive of lines.
std::string beside_triangles(const std::string& lines) {
  return R"({"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},)" + lines + "}";
}

TEST(Gltf, LinesBesideTrianglesAreEdges) {
  const auto mesh_of = [](const std::string& lines) {
    GltfMaker maker = points_maker();
    maker.shorts({4, 3, 2, 1});
    maker.show(beside_triangles(lines));
    const Scene scene = load_glb(maker);
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
    EXPECT_EQ(scene.meshes[0].triangles.size(), 3u);
    return scene.meshes[0];
  };
  EXPECT_THAT(mesh_of(R"("mode":1,"indices":1)").sharp_edges, ElementsAre(glm::uvec2(4, 3), glm::uvec2(2, 1)));
  EXPECT_THAT(mesh_of(R"("mode":3,"indices":1)").sharp_edges,
              ElementsAre(glm::uvec2(4, 3), glm::uvec2(3, 2), glm::uvec2(2, 1)));
  EXPECT_THAT(mesh_of(R"("mode":2,"indices":1)").sharp_edges,
              ElementsAre(glm::uvec2(4, 3), glm::uvec2(3, 2), glm::uvec2(2, 1), glm::uvec2(1, 4)));
  EXPECT_THAT(mesh_of(R"("mode":1)").sharp_edges, ElementsAre(glm::uvec2(0, 1), glm::uvec2(2, 3)));
  const Mesh smooth = mesh_of(R"("mode":1,"indices":1,"extensions":{"FRONTMOST_edges":{"smooth":true}})");
  EXPECT_EQ(smooth.sharp_edges.size(), 0u);
  EXPECT_THAT(smooth.smooth_edges, ElementsAre(glm::uvec2(4, 3), glm::uvec2(2, 1)));
  const Mesh round = mesh_of(R"("mode":1,"indices":1,"extensions":{"FRONTMOST_edges":{"circles":[)"
                             R"({"centre":[1,2,3],"axis":[0,1,0],"radius":4,"first":1,"count":1}]}})");
  ASSERT_EQ(round.edge_circles.size(), 1u);
  EXPECT_EQ(round.edge_circles[0].centre, glm::dvec3(1, 2, 3));
  EXPECT_EQ(round.edge_circles[0].radius, 4);
  EXPECT_EQ(round.edge_circles[0].first, 1u);
}

TEST(Gltf, EdgesMayHaveVerticesOfTheirOwn) {
  GltfMaker maker = points_maker();
  maker.floats({7, 7, 7, 8, 8, 8});
  maker.show(R"({"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":1},"mode":1})");
  const Mesh mesh = load_glb(maker).meshes[0];
  ASSERT_EQ(mesh.positions.size(), 7u);
  EXPECT_THAT(mesh.sharp_edges, ElementsAre(glm::uvec2(5, 6)));
  EXPECT_EQ(mesh.positions[6], glm::vec3(8));
}

TEST(Gltf, WrongEdgesAreErrors) {
  const auto error = [](const std::string& lines) {
    GltfMaker maker = points_maker();
    maker.shorts({0, 9});
    maker.show(beside_triangles(lines));
    return error_of(maker);
  };
  EXPECT_THAT(error(R"("mode":1,"indices":1)"), HasSubstr("edge 0: vertex 9 does not exist, there are 5"));
  const auto circle = [&](const std::string& members) {
    return error(R"("mode":1,"extensions":{"FRONTMOST_edges":{"circles":[{)" + members + "}]}}");
  };
  EXPECT_THAT(circle(R"("axis":[0,0,1],"radius":1,"first":0,"count":9)"), HasSubstr("edges that do not exist"));
  EXPECT_THAT(circle(R"("axis":[0,0,1],"radius":1,"first":4294967294,"count":3)"),
              HasSubstr("edges that do not exist"));
  EXPECT_THAT(circle(R"("axis":[0,0,1],"first":0,"count":1)"), HasSubstr("no radius"));
  EXPECT_THAT(circle(R"("radius":"big")"), HasSubstr("radius"));
  EXPECT_THAT(circle(R"("axis":[0,0,1],"radius":1,"count":1)"), HasSubstr("edges that do not exist"));
  const std::string round = R"("FRONTMOST_edges":{"circles":[{"axis":[0,0,1],"radius":1,"first":1,"count":2}])";
  // The range may not reach into the next primitive, nor lie among smooth edges.
  EXPECT_THAT(error(R"("mode":1,"extensions":{)" + round + R"(}}},{"attributes":{"POSITION":0},"mode":1)"),
              HasSubstr("edges that do not exist"));
  EXPECT_THAT(error(R"("mode":3,"extensions":{)" + round + R"(,"smooth":true}})"), HasSubstr("or smooth ones"));
}

TEST(Gltf, PrimitivesBecomeOneMeshInOrder) {
  GltfMaker maker = points_maker();
  maker.shorts({2, 3, 4});
  maker.floats({0, 1, 1, 0, 0, 1}, "VEC3");  // two normals
  maker.floats({9, 9, 9, 8, 8, 8});          // two positions
  maker.accessor(std::vector<std::uint8_t>{0, 1, 0}, {"SCALAR", 5121, ""}, 3);
  maker.add("materials", R"({"name":"red"})");
  maker.show(indexed + std::string(R"(,{"attributes":{"POSITION":3,"NORMAL":2},"indices":4,"material":0},)") + indexed);
  const Mesh mesh = load_glb(maker).meshes[0];
  // The first and the last primitive share their vertices; only 2 to 4 are used.
  EXPECT_THAT(mesh.positions,
              ElementsAre(glm::vec3(2, 0, 0), glm::vec3(3, 0, 0), glm::vec3(4, 0, 0), glm::vec3(9), glm::vec3(8)));
  EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 3), glm::uvec3(0, 1, 2)));
  EXPECT_THAT(mesh.material_ids, ElementsAre(no_index, 0u, no_index));
  EXPECT_THAT(mesh.normals.values,
              ElementsAre(glm::vec3(0), glm::vec3(0), glm::vec3(0), glm::vec3(0, 1, 1), glm::vec3(0, 0, 1)));
}

TEST(Gltf, VertexColoursOfAllTypes) {
  const auto colour = [](auto numbers, int component, const char* shape) {
    GltfMaker maker;
    maker.floats({0, 0, 0});
    maker.shorts({0, 0, 0});
    maker.accessor(numbers, {shape, component, component == 5126 ? "" : R"(,"normalized":true)"}, 1);
    maker.show(R"({"attributes":{"POSITION":0,"COLOR_0":2},"indices":1})");
    return load_glb(maker).meshes[0].colors.values.at(0);
  };
  EXPECT_EQ(colour(std::vector<float>{0.25f, 0.5f, 1}, 5126, "VEC3"), glm::vec4(0.25f, 0.5f, 1, 1));
  EXPECT_EQ(colour(std::vector<float>{0.25f, 0.5f, 1, 0.75f}, 5126, "VEC4"), glm::vec4(0.25f, 0.5f, 1, 0.75f));
  EXPECT_EQ(colour(std::vector<std::uint8_t>{0, 51, 255}, 5121, "VEC3"), glm::vec4(0, 0.2f, 1, 1));
  EXPECT_EQ(colour(std::vector<std::uint8_t>{0, 51, 255, 102}, 5121, "VEC4"), glm::vec4(0, 0.2f, 1, 0.4f));
  EXPECT_EQ(colour(std::vector<std::uint16_t>{0, 13107, 65535}, 5123, "VEC3"), glm::vec4(0, 0.2f, 1, 1));
}

TEST(Gltf, QuantisedPositionsAndNormals) {
  GltfMaker maker;
  maker.set("extensionsRequired", R"(["KHR_mesh_quantization"])");
  maker.accessor(std::vector<std::int16_t>{-32768, -3, 32767, 0}, {"VEC3", 5122, ""}, 1);
  maker.shorts({0, 0, 0});
  maker.accessor(std::vector<std::int8_t>{-128, 0, 127, 0}, {"VEC3", 5120, R"(,"normalized":true)"}, 1);
  maker.show(R"({"attributes":{"POSITION":0,"NORMAL":2},"indices":1})");
  const Mesh mesh = load_glb(maker).meshes[0];
  EXPECT_EQ(mesh.positions.at(0), glm::vec3(-32768, -3, 32767));
  EXPECT_EQ(mesh.normals.values.at(0), glm::vec3(-1, 0, 1));
}

TEST(Gltf, InterleavedVerticesAreTakenByStride) {
  GltfMaker maker;
  const std::vector<float> numbers = {0, 0, 0, 7, 7, 1, 0, 0, 8, 8, 0, 1, 0, 9, 9};
  maker.view(numbers.data(), numbers.size() * 4, R"(,"byteStride":20)");
  maker.bare_accessor({"VEC3", 5126, ""}, 3, R"(,"bufferView":0)");
  maker.bare_accessor({"VEC2", 5126, ""}, 3, R"(,"bufferView":0,"byteOffset":12)");
  maker.show(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1}})");
  const Mesh mesh = load_glb(maker).meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(mesh.texcoords.values, ElementsAre(glm::vec2(7), glm::vec2(8), glm::vec2(9)));
}

TEST(Gltf, SparseAccessorsReplaceElements) {
  GltfMaker maker;
  const std::vector<std::uint16_t> places = {1, 4};
  const std::vector<float> values = {5, 5, 5, 6, 6, 6};
  maker.view(places.data(), 4);
  maker.view(values.data(), 24);
  const std::string sparse =
      R"(,"sparse":{"count":2,"indices":{"bufferView":0,"componentType":5123},"values":{"bufferView":1}})";
  maker.bare_accessor({"VEC3", 5126, ""}, 6, sparse);
  maker.shorts({3, 4, 5});
  maker.show(indexed);
  // Without a buffer view all other elements are zero. Only vertices 3 to 5 are in use.
  EXPECT_THAT(load_glb(maker).meshes[0].positions, ElementsAre(glm::vec3(0), glm::vec3(6), glm::vec3(0)));
}

/// MAT2 of bytes, MAT3 of bytes and MAT3 of shorts have padding between columns, and none after the last one.
TEST(Gltf, MatricesArePaddedByColumn) {
  const struct {
    Type type;
    std::vector<std::uint8_t> bytes;
    std::vector<float> numbers;
  } cases[] = {
      {{"MAT2", 5121}, {1, 2, 9, 9, 3, 4, 9, 9, 5, 6, 9, 9, 7, 8}, {1, 2, 3, 4, 5, 6, 7, 8}},
      {{"MAT3", 5120}, {1, 2, 3, 9, 4, 5, 6, 9, 7, 8, 9}, {1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {{"MAT3", 5123}, {1, 0, 2, 0, 3, 0, 9, 9, 4, 0, 5, 0, 6, 0, 9, 9, 7, 0, 8, 0, 9, 0}, {1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {{"MAT4", 5121},
       {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
       {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}}};
  for (const auto& c : cases) {
    const std::size_t width = c.type.shape[3] == '2' ? 4 : c.type.shape[3] == '3' ? 9 : 16;
    const std::size_t count = c.numbers.size() / width;
    GltfMaker maker = points_maker();
    const int id = maker.accessor(c.bytes, c.type, count);
    maker.show(R"({"attributes":{"POSITION":0}})");
    EXPECT_EQ(triangle_count(load_glb(maker)), 1u) << c.type.shape << " of " << c.type.component;

    const std::vector<std::byte> glb = maker.glb();
    const ModelSource source("t.glb", {});
    const gltf::Container container = gltf::open_container(glb, source);
    const gltf::JsonDocument document(container.json, source);
    const gltf::Data data(gltf::JsonValue(document, source), container);
    std::vector<float> out(c.numbers.size());
    gltf::read_floats(data.accessor(std::uint32_t(id)), {0, count}, int(width), out.data());
    EXPECT_EQ(out, c.numbers) << c.type.shape << " of " << c.type.component;

    std::vector<std::uint8_t> short_by_one = c.bytes;
    short_by_one.pop_back();
    GltfMaker truncated = points_maker();
    truncated.accessor(short_by_one, c.type, count);
    EXPECT_THAT(error_of(truncated), HasSubstr("are not within bufferViews[1]"));
  }
  GltfMaker maker = points_maker();
  maker.accessor(std::vector<float>(20), {"MAT2", 5126}, 5);
  maker.show(R"({"attributes":{"POSITION":0,"COLOR_0":1}})");
  EXPECT_THAT(error_of(maker), HasSubstr("COLOR_0: holds matrices, which are not allowed here"))
      << "four numbers, but no colour";
}

TEST(Gltf, IndicesWithoutBufferViewAreZero) {
  GltfMaker maker = points_maker();
  maker.bare_accessor({"SCALAR", 5125, ""}, 3);
  maker.show(indexed);
  EXPECT_THAT(load_glb(maker).meshes[0].triangles, ElementsAre(glm::uvec3(0)));
}

TEST(Gltf, SparseIndicesMustRise) {
  for (const std::vector<std::uint16_t>& places : {std::vector<std::uint16_t>{1, 1}, {2, 1}, {1, 6}}) {
    GltfMaker maker;
    maker.view(places.data(), 4);
    maker.view(std::vector<float>(6).data(), 24);
    maker.bare_accessor(
        {"VEC3", 5126, ""}, 6,
        R"(,"sparse":{"count":2,"indices":{"bufferView":0,"componentType":5123},"values":{"bufferView":1}})");
    maker.show(R"({"attributes":{"POSITION":0}})");
    const std::string error = error_of(maker);
    EXPECT_THAT(error, HasSubstr("accessors[0].sparse.indices: index 1 is "));
    EXPECT_THAT(error, AnyOf(HasSubstr(", which is not greater than the index before"),
                             HasSubstr(", which is not below the accessor's count")));
  }
}

// ---- Nodes ----

GltfMaker triangle_maker() {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.add("meshes", R"({"name":"tri","primitives":[{"attributes":{"POSITION":0}}]})");
  return maker;
}

TEST(Gltf, NodesArePlacedByAllTheirParents) {
  GltfMaker maker = triangle_maker();
  maker.add("nodes", R"({"children":[1,2],"translation":[10,0,0],"scale":[2,2,2]})");
  // A quarter turn about z, not normalised.
  maker.add("nodes", R"({"name":"turned","mesh":0,"rotation":[0,0,3,3],"translation":[1,0,0]})");
  maker.add("nodes", R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "turned");
  EXPECT_EQ(scene.instances[1].name, "tri");
  const glm::dvec4 turned = scene.instances[0].world_from_mesh * glm::dvec4(1, 0, 0, 1);
  EXPECT_LT(glm::distance(turned, glm::dvec4(12, 2, 0, 1)), 1e-12);
  const glm::dvec4 mirrored = scene.instances[1].world_from_mesh * glm::dvec4(1, 0, 0, 1);
  EXPECT_EQ(mirrored, glm::dvec4(18, 12, 14, 1));
}

TEST(Gltf, OnlyTheChosenSceneIsShown) {
  GltfMaker maker = triangle_maker();
  for (const char* name : {"a", "b", "c"}) maker.add("nodes", std::string(R"({"mesh":0,"name":")") + name + "\"}");
  const auto shown = [](const GltfMaker& m) {
    std::string names;
    for (const Instance& instance : load(m.glb(), "t.glb").instances) names += instance.name;
    return names;
  };
  EXPECT_EQ(shown(maker), "abc") << "no scenes: everything";
  maker.add("scenes", R"({"nodes":[2]})");
  maker.add("scenes", R"({"nodes":[1,0]})");
  EXPECT_EQ(shown(maker), "c") << "the first scene by default";
  maker.set("scene", "1");
  EXPECT_EQ(shown(maker), "ba") << "roots in the scene's order";
  maker.set("scene", "2");
  EXPECT_THAT(error_of(maker), HasSubstr("scene: 2 does not exist, there are 2"));
}

TEST(Gltf, HiddenNodesHideWhatIsBelowThemButForCameras) {
  GltfMaker maker = triangle_maker();
  maker.set("extensionsRequired", R"(["KHR_node_visibility"])");
  maker.set("extensions", R"({"KHR_lights_punctual":{"lights":[{"type":"point"}]}})");
  maker.add("cameras", R"({"type":"perspective","perspective":{"yfov":1,"znear":1}})");
  const auto visible = [](const char* value) {
    return std::string(R"("extensions":{"KHR_node_visibility":{"visible":)") + value + "}}";
  };
  maker.add("nodes", R"({"name":"seen","mesh":0,"children":[1],)" + visible("true") + "}");
  maker.add("nodes", R"({"children":[2,3,4],)" + visible("false") + "}");
  maker.add("nodes", R"({"name":"below","mesh":0,)" + visible("true") + "}");
  maker.add("nodes", R"({"camera":0})");
  maker.add("nodes", R"({"extensions":{"KHR_lights_punctual":{"light":0}}})");
  maker.add("nodes", R"({"name":"default","mesh":0,"extensions":{"KHR_node_visibility":{}}})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "seen");
  EXPECT_EQ(scene.instances[1].name, "default");
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 0u);
  EXPECT_THAT(scene.warnings, ElementsAre("t.glb: KHR_node_visibility: the file hides 4 of 6 nodes"));
  EXPECT_THAT(scene.source.hidden, ElementsAre("below")) << "others have nothing to show";
  maker.add("nodes", "{" + visible("0") + "}");
  EXPECT_THAT(error_of(maker), HasSubstr("nodes[6].extensions.KHR_node_visibility.visible"));
}

TEST(Gltf, LoopsAndSecondParentsAreErrors) {
  const auto tree = [](std::vector<std::string> children) {
    GltfMaker maker;
    for (const std::string& list : children) maker.add("nodes", R"({"children":[)" + list + "]}");
    return error_of(maker);
  };
  EXPECT_THAT(tree({"0"}), HasSubstr("nodes[0]: is part of a loop"));
  EXPECT_THAT(tree({"", "2", "1"}), HasSubstr("nodes[1]: is part of a loop"));
  EXPECT_THAT(tree({"2", "2", ""}), HasSubstr("nodes[2]: is a child of both nodes[0] and nodes[1]"));
  EXPECT_THAT(tree({"1,1", ""}), HasSubstr("nodes[1]: is a child of both nodes[0] and nodes[0]"));
  EXPECT_THAT(tree({"7"}), HasSubstr("nodes[0].children[0]: 7 does not exist, there are 1"));
}

TEST(Gltf, DeepTreesNeedNoStack) {
  GltfMaker maker = triangle_maker();
  constexpr int depth = 100000;
  for (int i = 0; i < depth; ++i)
    maker.add("nodes", R"({"translation":[1,0,0],"children":[)" + std::to_string(i + 1) + "]}");
  maker.add("nodes", R"({"mesh":0})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.origin.x + scene.instances[0].world_from_mesh[3].x, depth);
}

TEST(Gltf, TransformsMustBeFinite) {
  GltfMaker maker = triangle_maker();
  maker.add("nodes", R"({"scale":[1e300,1,1],"children":[1]})");
  maker.add("nodes", R"({"scale":[1e300,1,1],"mesh":0})");
  EXPECT_THAT(error_of(maker), HasSubstr("nodes[1]: its transform is not finite"));
}

TEST(Gltf, CopiesOfOneNode) {
  GltfMaker maker = triangle_maker();
  maker.floats({1, 2, 3, 4, 5, 6});
  maker.accessor(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 127, 0}, {"VEC4", 5120, R"(,"normalized":true)"}, 2);
  maker.set("extensionsRequired", R"(["EXT_mesh_gpu_instancing"])");
  maker.add("nodes", R"({"mesh":0,"name":"n","translation":[0,0,10],"extensions":{"EXT_mesh_gpu_instancing":
      {"attributes":{"TRANSLATION":1,"ROTATION":2}}}})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[1].name, "n[1]");
  EXPECT_EQ(scene.instances[0].world_from_mesh * glm::dvec4(1, 0, 0, 1), glm::dvec4(2, 2, 13, 1));
  EXPECT_EQ(scene.instances[1].world_from_mesh * glm::dvec4(1, 0, 0, 1), glm::dvec4(3, 5, 16, 1));
}

TEST(Gltf, CamerasHaveRigidPoses) {
  GltfMaker maker;
  maker.add("cameras", R"({"type":"perspective","perspective":{"yfov":0.5,"znear":0.1,"aspectRatio":1.5}})");
  maker.add("cameras", R"({"type":"orthographic","orthographic":{"xmag":4,"ymag":2,"znear":0,"zfar":9}})");
  maker.add("cameras", R"({"type":"perspective","perspective":{"yfov":0,"znear":0.1}})");
  maker.add("nodes", R"({"camera":0,"name":"eye","translation":[1,2,3],"scale":[5,-6,7],"rotation":[0,1,0,0]})");
  maker.add("nodes", R"({"camera":1})");
  maker.add("nodes", R"({"camera":2})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& eye = scene.cameras[0];
  EXPECT_EQ(eye.name, "eye");
  EXPECT_EQ(eye.vertical, 0.5);
  EXPECT_EQ(eye.aspect, 1.5);
  EXPECT_EQ(eye.near, 0.1);
  EXPECT_FALSE(eye.far.has_value());
  EXPECT_NEAR(glm::determinant(glm::dmat3(eye.world_from_eye)), 1, 1e-12);
  EXPECT_LT(glm::distance(eye.world_from_eye[2], glm::dvec4(0, 0, -1, 0)), 1e-12) << "half a turn about y";
  EXPECT_EQ(eye.world_from_eye[3], glm::dvec4(1, 2, 3, 1));
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_EQ(scene.cameras[1].vertical, 4);
  EXPECT_EQ(scene.cameras[1].aspect, 2.0);
  EXPECT_FALSE(scene.cameras[1].near.has_value());
  EXPECT_THAT(scene.warnings.at(0), HasSubstr("cameras[2]"));
}

// ---- Poses ----

TEST(Gltf, SkinsArePosedByTheirJoints) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {"VEC4", 5121, ""}, 3);
  maker.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.25f, 0, 0}, "VEC4");
  maker.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -5, 1},
               "MAT4");
  maker.floats({0, 0, 1, 0, 0, 1, 0, 0, 1});
  maker.add("meshes", R"({"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2,"NORMAL":4}}]})");
  maker.add("skins", R"({"joints":[1,2],"inverseBindMatrices":3})");
  maker.add("nodes", R"({"mesh":0,"skin":0,"translation":[100,100,100]})");
  maker.add("nodes", R"({"translation":[0,0,1]})");
  maker.add("nodes", R"({"translation":[0,4,5],"rotation":[1,0,0,0]})");  // half a turn about x
  maker.add("scenes", R"({"nodes":[0]})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].world_from_mesh, glm::dmat4(1.0)) << "the node of a skinned mesh does not move it";
  const Mesh& mesh = scene.meshes[0];
  // Joint 0 lifts by one. Joint 1 turns z -5 about x to z 5, and moves by (0, 4, 5). The last vertex takes half of
  // each, although its weights only sum to a half.
  EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(0, 0, 1), glm::vec3(1, 4, 10), glm::vec3(0, 2, 5.5f)));
  EXPECT_EQ(mesh.normals.values[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals.values[1], glm::vec3(0, 0, -1));
}

/// Two primitives, the first with joints, below a node that moves them; returns vertices in the file's coordinates.
std::vector<glm::dvec3> skinned_vertices(const std::string& translation) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0.3f, 0, 0, 1, 0.7f});
  maker.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {"VEC4", 5121, ""}, 3);
  maker.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.25f, 0, 0}, "VEC4");
  maker.add(
      "meshes",
      R"({"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}},{"attributes":{"POSITION":0}}]})");
  maker.add("skins", R"({"joints":[2,3]})");
  maker.add("nodes", R"({"mesh":0,"skin":0})");
  maker.add("nodes", R"({"translation":[)" + translation + R"(],"children":[2,3]})");
  maker.add("nodes", R"({"translation":[0,0,1]})");
  maker.add("nodes", R"({"translation":[0,4.1,5],"rotation":[1,0,0,0]})");
  maker.add("scenes", R"({"nodes":[0,1]})");
  const Scene scene = load_glb(maker);
  std::vector<glm::dvec3> vertices;
  for (const glm::vec3& p : scene.meshes.at(0).positions)
    vertices.emplace_back(scene.origin + glm::dvec3(scene.instances.at(0).world_from_mesh * glm::dvec4(p, 1)));
  return vertices;
}

TEST(Gltf, SkinnedMeshesFarFromZeroKeepTheirShape) {
  const std::vector<glm::dvec3> home = skinned_vertices("0,0,0");
  ASSERT_EQ(home.size(), 6u);
  const std::pair<const char*, glm::dvec3> moves[] = {{"100000000,-20000000,3000000", {1e8, -2e7, 3e6}},
                                                      {"5400123.4567,1234567.891,0", {5400123.4567, 1234567.891, 0}}};
  for (const auto& [text, move] : moves) {
    const std::vector<glm::dvec3> far = skinned_vertices(text);
    ASSERT_EQ(far.size(), 6u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(glm::length(far[i] - move - home[i]), 4e-6) << text << ", vertex " << i;
    // Vertices without joints stay at their place in the file, as exactly as floats far away allow.
    for (std::size_t i = 3; i < 6; ++i) EXPECT_LT(glm::length(far[i] - home[i]), 8) << text << ", vertex " << i;
  }
}

TEST(Gltf, JointsThatTheSkinLacksAreErrors) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.accessor(std::vector<std::uint8_t>{0, 9, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, {"VEC4", 5121, ""}, 3);
  maker.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  maker.add("meshes", R"({"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]})");
  maker.add("skins", R"({"joints":[0]})");
  maker.add("nodes", R"({"mesh":0,"skin":0})");
  EXPECT_THAT(error_of(maker), HasSubstr("meshes[0].primitives[0].attributes.JOINTS_0: vertex 1 uses joint 1"));
}

TEST(Gltf, MorphTargetsApplyWithTheirDefaultWeights) {
  GltfMaker maker;
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.floats({0, 0, 8, 0, 0, 8, 0, 0, 8});
  maker.floats({1, 0, 0, 1, 0, 0, 1, 0, 0});
  maker.add(
      "meshes",
      R"({"weights":[0.5,0],"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},{"POSITION":2}]}]})");
  maker.add("nodes", R"({"mesh":0})");
  maker.add("nodes", R"({"mesh":0,"weights":[0,2]})");
  maker.add("nodes", R"({"mesh":0,"weights":[0.5,0]})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.meshes.size(), 2u) << "equal poses share one mesh";
  EXPECT_EQ(scene.meshes[scene.instances[0].mesh].positions[1], glm::vec3(1, 0, 4));
  EXPECT_EQ(scene.meshes[scene.instances[1].mesh].positions[1], glm::vec3(3, 0, 0));
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
}

// ---- Errors ----

TEST(Gltf, IndexOutOfRangeNamesItsPlace) {
  GltfMaker maker = points_maker();
  maker.shorts({0, 1, 2, 3, 4, 5});
  maker.show(indexed);
  EXPECT_THAT(error_of(maker),
              HasSubstr("meshes[0].primitives[0].indices: triangle 1: vertex 5 does not exist, there are 5"));
}

TEST(Gltf, AccessorsAreHeldAgainstTheirViews) {
  const auto accessor = [](const std::string& members) {
    GltfMaker maker = points_maker();  // 60 bytes
    maker.add("accessors", members);
    return error_of(maker);
  };
  const std::string vec3 = R"("type":"VEC3","componentType":5126,"bufferView":0)";
  EXPECT_EQ(accessor("{" + vec3 + R"(,"count":5})"), "no error");
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":6})"), HasSubstr("accessors[1]: 6 elements"));
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":5,"byteOffset":4})"),
              HasSubstr("accessors[1]: 5 elements from byte 4"));
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":1,"byteOffset":18446744073709551615})"), HasSubstr("accessors[1]"));
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":-1})"), HasSubstr("accessors[1].count: a whole number"));
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":1.5})"), HasSubstr("accessors[1].count: a whole number"));
  EXPECT_THAT(accessor("{" + vec3 + R"(,"count":"5"})"),
              HasSubstr("accessors[1].count: a number is expected, not string"));
  EXPECT_THAT(accessor(R"({"type":"VEC3","componentType":5126,"bufferView":4294967296,"count":1})"),
              HasSubstr("accessors[1].bufferView: 4294967296 does not exist"));
  EXPECT_EQ(accessor(R"({"type":"VEC5","componentType":5126,"count":1})"), "no error") << "unknown, and unused";
}

TEST(Gltf, GiganticCountsAreRefusedBeforeMemoryIsAskedFor) {
  GltfMaker maker;
  maker.bare_accessor({"VEC3", 5126, ""}, 4000000000u);
  maker.show(R"({"attributes":{"POSITION":0}})");
  EXPECT_THAT(error_of(maker, ErrorCode::limit_exceeded), HasSubstr("meshes[0].primitives[0]: "));
  GltfMaker larger;
  larger.bare_accessor({"VEC3", 5126, ""}, std::size_t(1) << 60);
  EXPECT_THAT(error_of(larger, ErrorCode::limit_exceeded), HasSubstr("accessors[0]: "));
}

TEST(Gltf, AFewBytesSharedByManyAreRefused) {
  GltfMaker maker;
  maker.bare_accessor({"VEC3", 5126, ""}, 3000000);
  std::string primitives;
  for (int i = 0; i < 1000; ++i) primitives += R"({"attributes":{"POSITION":0}},)";
  maker.show(primitives + R"({"attributes":{"POSITION":0}})");
  EXPECT_THAT(error_of(maker, ErrorCode::limit_exceeded), HasSubstr("than a file of this size can hold"));
}

TEST(Gltf, RequiredExtensionsThatWeLackAreNamed) {
  GltfMaker maker = triangle_maker();
  maker.set("extensionsUsed", R"(["KHR_audio","KHR_texture_transform","EXT_other"])");
  EXPECT_THAT(load_glb(maker).warnings,
              ElementsAre(HasSubstr("KHR_audio"), HasSubstr("EXT_other"), HasSubstr("no triangles")));
  maker.set("extensionsRequired", R"(["KHR_texture_transform","KHR_audio","EXT_other"])");
  EXPECT_THAT(error_of(maker, ErrorCode::unsupported), HasSubstr("extensionsRequired: KHR_audio, EXT_other: "));
}

TEST(Gltf, OtherVersionsAreNamed) {
  const auto version = [](const std::string& asset) {
    return error_of(test::byte_vector(R"({"asset":)" + asset + "}"), ErrorCode::unsupported);
  };
  EXPECT_THAT(version(R"({"version":"1.0"})"), HasSubstr("asset.version: glTF 1.0"));
  EXPECT_THAT(version(R"({"version":"2.1","minVersion":"2.1"})"), HasSubstr("asset.minVersion: glTF 2.1"));
  EXPECT_NO_THROW((void)load(test::byte_vector(R"({"asset":{"version":"2.1","minVersion":"2.0"}})"), "t.gltf"));
}

TEST(Gltf, DataUrisHoldBuffers) {
  // Three vertices (0 0 0, 1 0 0, 0 1 0) as bytes, in base64 and with percent escapes.
  for (const char* uri :
       {"data:application/octet-stream;base64,AAAAAAABAAAAAAEA", "data:,%00%00%00%00%01%00%00%00%00%01%00%00"}) {
    const std::string text =
        std::string(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":")") + uri +
        R"("}],"bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4}],"accessors":[{"bufferView":0,"count":3,
        "type":"VEC3","componentType":5121}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
    const Scene scene = load(test::byte_vector(text), "t.gltf");
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
  }
  const auto refused = [](const std::string& uri) {
    return error_of(
        test::byte_vector(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":")" + uri + "\"}]}"));
  };
  EXPECT_THAT(refused("data:;base64,A?=="), HasSubstr("buffers[0].uri: character 1"));
  EXPECT_THAT(refused("data:;base64,A"), HasSubstr("buffers[0].uri: base64"));
  EXPECT_THAT(refused("data:"), HasSubstr("buffers[0].uri: a data URI without a comma"));
  EXPECT_THAT(refused("data:,"), HasSubstr("byteLength is 1"));
}

TEST(Gltf, FilesAreNotReadForModelsInMemory) {
  const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"..%2Fsecret%20file.bin"}]})";
  EXPECT_THAT(error_of(test::byte_vector(text), ErrorCode::file_unreadable), HasSubstr("../secret file.bin"));
}

TEST(Gltf, DeeplyNestedJsonIsRefused) {
  const std::string open(1000000, '[');
  EXPECT_THAT(error_of(test::byte_vector(R"({"asset":)" + open), ErrorCode::limit_exceeded),
              HasSubstr("nested deeper"));
  EXPECT_THAT(error_of(test::byte_vector(R"({"asset":"[[[[)")), HasSubstr("JSON: parse error"));
}

// ---- Every prefix, and many mutations ----

GltfMaker rich_maker() {
  GltfMaker maker = triangle_maker();
  maker.shorts({0, 1, 2});
  maker.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {"VEC4", 5121, ""}, 3);
  maker.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
  maker.add("materials", R"({"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})");
  maker.add("meshes", R"({"weights":[1],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},
      "indices":1,"material":0,"targets":[{"POSITION":0}]},{"attributes":{"POSITION":0},"mode":5,"targets":[{}]}]})");
  maker.add("skins", R"({"joints":[1,2]})");
  maker.add("cameras", R"({"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}})");
  maker.add("nodes", R"({"children":[1,2],"mesh":1,"skin":0})");
  maker.add("nodes", R"({"mesh":0,"scale":[1,-1,1]})");
  maker.add("nodes", R"({"camera":0,"mesh":1,"weights":[0.5]})");
  maker.add("scenes", R"({"nodes":[0]})");
  return maker;
}

TEST(Gltf, EveryPrefixIsAnError) {
  const std::vector<std::byte> bytes = rich_maker().glb();
  EXPECT_NO_THROW((void)load(bytes, "t.glb"));
  for (std::size_t n = 1; n < bytes.size(); ++n) {
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    LoadOptions options;
    options.format = ModelFormat::gltf;
    EXPECT_THROW((void)load(prefix, "t.glb", options), Error) << n << " bytes";
  }
}

TEST(Gltf, MutationsEndInASceneOrAnError) {
  const std::vector<std::byte> seed = rich_maker().glb();
  std::uint32_t random = 7;
  const auto next = [&random] { return (random = random * 1664525u + 1013904223u) >> 8; };
  std::size_t read = 0, refused = 0;
  constexpr std::string_view digits = "0123456789-.e\",[]{}";
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes = seed;
    for (int change = 0; change <= round % 3; ++change) {
      const bool plausible = next() % 4 != 0;  // otherwise most mutations would only break the JSON
      bytes[next() % bytes.size()] = plausible ? std::byte(digits[next() % digits.size()]) : std::byte(next());
    }
    try {
      const Scene scene = load(bytes, "t.glb");
      ++read;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 100u);
  EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace frontmost
