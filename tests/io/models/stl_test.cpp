// SPDX-License-Identifier: Apache-2.0
#include "model_bytes.h"

namespace frontmost {
namespace {

using test::ByteWriter;
using test::error_of;
using test::load_text;
using testing::ElementsAre;
using testing::HasSubstr;

/// Triangle k has vertices (k, 0, 0), (k + 1, 0, 0), (k, 1, 0), and k in its last two bytes.
std::string binary_stl(const std::string& header, std::uint32_t promised, std::uint32_t count) {
  ByteWriter out;
  out.text = header;
  out.text.resize(80, ' ');
  out.put(promised);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto x = float(k);
    out.put({9.0f, 9.0f, 9.0f, x, 0.0f, 0.0f, x + 1, 0.0f, 0.0f, x, 1.0f, 0.0f}).put(std::uint16_t(k));
  }
  return out.text;
}

std::string facet(const std::string& x) {
  return "facet normal 0 0 1\n  outer loop\n    vertex " + x +
         " 0 0\n    vertex 1 0 0\n    vertex 0 1 0\n  endloop\nendfacet\n";
}

TEST(Stl, BinaryKeepsOrderCountAndCorners) {
  // The file is longer than one block of the reader.
  const std::uint32_t count = 20'001;
  const Scene scene = load_text(binary_stl("made by hand", count, count), ModelFormat::stl);
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.triangles.size(), count);
  ASSERT_EQ(mesh.positions.size(), 3 * count);
  for (std::uint32_t k = 0; k < count; ++k) {
    ASSERT_EQ(mesh.triangles[k], glm::uvec3(3 * k, 3 * k + 1, 3 * k + 2));
    ASSERT_EQ(mesh.positions[3 * k], glm::vec3(k, 0, 0));
    ASSERT_EQ(mesh.positions[3 * k + 2], glm::vec3(k, 1, 0));
  }
  EXPECT_EQ(scene.instances.at(0).name, "made by hand");
  EXPECT_EQ(scene.up, Axis::z);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Stl, BinaryFilesMayStartWithSolid) {
  const Scene scene = load_text(binary_stl("solid part one", 5, 5));
  EXPECT_EQ(triangle_count(scene), 5u);
  EXPECT_EQ(scene.meshes[0].name, "part one");
  // The keyword does not decide either if the file's size leaves the format open.
  EXPECT_EQ(triangle_count(load_text(binary_stl("solid part one", 5, 5) + "tail")), 5u);
}

TEST(Stl, CountsThatDoNotFitTheSize) {
  EXPECT_EQ(error_of(binary_stl("x", 10, 4), ModelFormat::stl),
            "model: triangle 4: the file ends here, but its header promises 10 triangles");
  EXPECT_THAT(error_of(binary_stl("solid x", 10, 4), ModelFormat::stl), HasSubstr("promises 10"));
  const Scene more = load_text(binary_stl("x", 3, 4), ModelFormat::stl);
  EXPECT_EQ(triangle_count(more), 3u);
  EXPECT_THAT(more.warnings, ElementsAre("model: byte 234: 50 bytes after the last triangle were passed over"));
  for (const std::uint32_t open : {0u, 0xFFFFFFFFu}) {
    const Scene streamed = load_text(binary_stl("x", open, 4), ModelFormat::stl);
    EXPECT_EQ(triangle_count(streamed), 4u);
    EXPECT_EQ(streamed.warnings.size(), 1u);
  }
  EXPECT_THAT(error_of(std::string(83, '\1'), ModelFormat::stl), HasSubstr("byte 83"));
  EXPECT_EQ(error_of("", ModelFormat::stl), "model: the file is empty");
}

TEST(Stl, AnEmptyBinaryFileIsASceneWithAWarning) {
  const Scene scene = load_text(binary_stl("x", 0, 0), ModelFormat::stl);
  EXPECT_EQ(triangle_count(scene), 0u);
  EXPECT_THAT(scene.warnings, ElementsAre("model: the file holds no triangles"));
}

TEST(Stl, AsciiSolidsAreObjects) {
  const Scene scene = load_text("solid first part\n" + facet("0") + facet("0.5") + "endsolid first part\r\nSOLID\r\n" +
                                facet("2e0") + "EndSolid");
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "first part");
  EXPECT_EQ(scene.instances[1].name, "");
  EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions[3], glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(scene.meshes[1].positions[0], glm::vec3(2, 0, 0));
}

TEST(Stl, AsciiMayStandOnOneLineWithNormalsThatAreNone) {
  const Scene scene = load_text(
      "solid\nfacet normal nan -nan(ind) x outer loop vertex 0 0 0 vertex 1 0 0 vertex nan inf -1 endloop endfacet "
      "endsolid");
  EXPECT_EQ(triangle_count(scene), 1u);
  EXPECT_TRUE(std::isnan(scene.meshes[0].positions[2].x));
}

TEST(Stl, AsciiErrorsNameTheLine) {
  const auto error = [](const std::string& text) { return error_of(text, ModelFormat::stl); };
  EXPECT_EQ(error("solid a\n" + facet("zero") + "endsolid"), "model: line 4: a vertex needs three numbers");
  EXPECT_EQ(error("solid a\n" + facet("0")), "model: line 9: the file ends within a solid, before \"endsolid\"");
  EXPECT_EQ(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop"),
            "model: line 5: \"endloop\" where \"vertex\" was expected");
  EXPECT_EQ(error("solid a\nface"), "model: line 2: \"face\" where \"facet\" or \"endsolid\" was expected");
  EXPECT_EQ(error("solid a\nsolid b\n"), "model: line 2: \"solid\" within a solid");
  EXPECT_EQ(error("just text"), "model: line 1: the file looks like a text STL, but does not start with \"solid\"");
  EXPECT_THAT(error("solid a\nfacet normal 0 0"), HasSubstr("the file ends within a triangle"));
}

TEST(Stl, FacetsBehindASolidBelongToNone) {
  const std::string solid = "solid one\n" + facet("0") + "endsolid one\n";
  EXPECT_EQ(triangle_count(load_text(solid, ModelFormat::stl)), 1u);
  EXPECT_EQ(error_of(solid + facet("0"), ModelFormat::stl), "model: line 10: \"facet\" outside a solid");
  EXPECT_EQ(triangle_count(load_text(solid + "solid two\n" + facet("0") + "endsolid\n", ModelFormat::stl)), 2u);
}

/// Colours of triangles with these last two bytes.
std::vector<glm::vec4> colors_of(const std::string& header, const std::vector<std::uint16_t>& attributes) {
  std::string text = binary_stl(header, std::uint32_t(attributes.size()), std::uint32_t(attributes.size()));
  for (std::size_t i = 0; i < attributes.size(); ++i) std::memcpy(&text[84 + 50 * i + 48], &attributes[i], 2);
  const Scene scene = load_text(text, ModelFormat::stl);
  EXPECT_TRUE(scene.warnings.empty());
  const Mesh& mesh = scene.meshes.at(0);
  std::vector<glm::vec4> colors;
  if (mesh.colors.empty()) return colors;
  for (std::uint32_t t = 0; t < attributes.size(); ++t) {
    const glm::uvec3& corners = mesh.corners(mesh.colors, t);
    EXPECT_TRUE(corners.x == corners.y && corners.x == corners.z);
    colors.push_back(mesh.colors.values.at(corners.x));
  }
  return colors;
}

TEST(Stl, AttributesAreColors) {
  const glm::vec4 white(1), red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 1), black(0, 0, 0, 1);
  EXPECT_THAT(colors_of("VisCAM", {0xFC00, 0x83E0, 0x801F, 0x8000, 0x7FFF, 0}),
              ElementsAre(red, green, blue, black, white, white));
  const std::string magics("COLOR=\0\xff\0\xff,MATERIAL=", 20);
  EXPECT_THAT(colors_of(magics, {0x8000, 0x001F, 0x7C00, 0xFFFF, 0}), ElementsAre(green, red, blue, green, black));
  EXPECT_THAT(colors_of("part COLOR=" + std::string("\0\0\xff\0", 4), {0x8000}), ElementsAre(blue));
  const std::string meshlab("COLOR=\x7f\x7f\x7f MATERIAL=", 19);
  EXPECT_THAT(colors_of(meshlab, {0x801F, 0xFC00}), ElementsAre(red, blue));
  for (const std::string& header : {std::string("a part"), magics, meshlab})
    EXPECT_TRUE(colors_of(header, {0, 0, 0}).empty());
  EXPECT_TRUE(colors_of("a part", {1, 0x7FFF, 17}).empty()) << "no colours, whatever they are";
  EXPECT_TRUE(colors_of(std::string(74, ' ') + "COLOR=", {1}).empty()) << "the header ends before the colour";
  // The colours begin in a later block of the reader.
  std::vector<std::uint16_t> many(20'001, 0);
  many.back() = 0x801F;
  EXPECT_THAT(colors_of("a part", many), testing::AllOf(testing::SizeIs(many.size()), testing::Contains(blue)));
}

TEST(Stl, HeadersSayNothingOfPlaces) {
  const Scene plain = load_text(binary_stl("made by hand", 50, 50), ModelFormat::stl);
  const Scene other = load_text(binary_stl("COLOR=\xff\xff\xff\xff", 50, 50), ModelFormat::stl);
  EXPECT_EQ(plain.meshes.at(0).positions, other.meshes.at(0).positions);
  EXPECT_EQ(plain.meshes.at(0).triangles, other.meshes.at(0).triangles);
}

}  // namespace
}  // namespace frontmost
