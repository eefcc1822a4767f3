// SPDX-License-Identifier: Apache-2.0
#include "base/srgb.h"
#include "model_bytes.h"

namespace frontmost {
namespace {

using test::error_of;
using test::load_text;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Off, PolygonsCommentsAndFaceColors) {
  const Scene scene = load_text(
      "# before\nOFF # the keyword\n\n4 4 0\n0 0 0\n1 0 0 # a vertex\n1 1 0\n\n0 1 0\n"
      "3 0 1 2\n4 0 1 2 3 255 0 0\n3 0 1 2 0 128 0 51\n2 0 1\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_THAT(mesh.face_ids, ElementsAre(0, 1, 1, 2));
  const auto color = [&](std::uint32_t triangle) {
    return mesh.colors.values.at(mesh.corners(mesh.colors, triangle).x);
  };
  EXPECT_EQ(color(0), glm::vec4(1));
  EXPECT_EQ(color(1), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(color(2), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(color(3), glm::vec4(0, linear_of_srgb8(128), 0, 51.0f / 255));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 with fewer than three corners")));
}

TEST(Off, VertexColorsNormalsAndTexcoords) {
  const Scene floats = load_text("COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 .5\n0 1 0 0 0 1\n3 0 1 2 0 0 0\n");
  EXPECT_THAT(floats.meshes.at(0).colors.values,
              ElementsAre(glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 0.5f), glm::vec4(0, 0, 1, 1)));
  const Scene all = load_text(
      "STCNOFF 3 1 3\n0 0 0 0 0 1 255 0 0 255 0 0.25\n1 0 0 0 0 1 0 255 0 255 1 0\n0 1 0 0 0 1 0 0 255 255 0 1\n3 0 1 "
      "2\n");
  const Mesh& mesh = all.meshes.at(0);
  EXPECT_EQ(mesh.normals.values.at(2), glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.texcoords.values.at(0), glm::vec2(0, 0.75f));
  EXPECT_EQ(mesh.colors.values.at(1), glm::vec4(0, 1, 0, 1));
}

TEST(Off, KeywordAndEdgeCountMayBeMissing) {
  EXPECT_EQ(triangle_count(load_text("3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", ModelFormat::off)), 1u);
}

// Files of ModelNet40 have counts without a blank.
TEST(Off, CountsMayFollowTheKeywordWithoutABlank) {
  const std::string rows = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* keyword : {"OFF", "OFF ", "COFF", "NCSTOFF"})
    EXPECT_THAT(error_of(std::string(keyword) + "1 1 0\n0 0 0  1 0 0  0 1\n3 0 0 1\n", std::nullopt),
                HasSubstr("vertex 1 is out of range"))
        << keyword;
  EXPECT_EQ(triangle_count(load_text("OFF" + rows)), 1u);
}

TEST(Off, PrefixesComeInAnyOrder) {
  // Number order of Geomview, which Open3D writes; and that of MeshLab: colour, normal, texture coordinates.
  const std::string count = " 1 0 0\n";
  for (const std::string& text :
       {"CNOFF" + count + "0 0 0  0 0 1  255 0 0 255", "NCOFF" + count + "0 0 0  0 0 1  255 0 0 255",
        "NCOFF" + count + "0 0 0  255 0 0 255  0 0 1", "NCSTOFF" + count + "0 0 0  255 0 0 255  0 0 1  0.5 0.5",
        "NCOFF" + count + "0 0 0  0 0 1  1.0 0 0 0.5", "NSTCOFF" + count + "0 0 0  0 0 1  1 0 0  0.5 0.5"}) {
    const Scene scene = load_text(text);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_THAT(mesh.normals.values, ElementsAre(glm::vec3(0, 0, 1))) << text;
    EXPECT_EQ(glm::vec3(mesh.colors.values.at(0)), glm::vec3(1, 0, 0)) << text;
    EXPECT_EQ(mesh.texcoords.values.size(), text.find("ST") == std::string::npos ? 0u : 1u);
  }
  for (const char* keyword : {"4OFF", "nOFF", "4nOFF", "C4OFF", "N4CnOFF"})
    EXPECT_THAT(error_of(keyword + count + "0 0 0 0\n", std::nullopt), HasSubstr("four-dimensional and binary OFF"))
        << keyword;
  for (const char* keyword : {"SOFF", "XOFF", "OF", "COF F", "coff"})
    EXPECT_THAT(error_of(keyword + count, ModelFormat::off), HasSubstr("where \"OFF\" was expected")) << keyword;
}

TEST(Off, ColorsThatTheKeywordDoesNotNameAreReadOrTold) {
  const auto scene_of = [](const std::string& a, const std::string& b) {
    return load_text("OFF\n2 0 0\n0 0 0 " + a + "\n1 0 0 " + b + "\n");
  };
  const auto colors = [&](const std::string& a, const std::string& b) {
    return scene_of(a, b).meshes.at(0).colors.values;
  };
  EXPECT_THAT(colors("255 0 0", "0 255 0 # green"), ElementsAre(glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1)));
  EXPECT_THAT(colors("1 0 0 1", "0 0 1 0.5"), ElementsAre(glm::vec4(1, 0, 0, 1), glm::vec4(0, 0, 1, 0.5f)));
  EXPECT_TRUE(scene_of("", "").warnings.size() == 1) << "no triangles";
  // A normal, a texture coordinate or a colour for only one vertex.
  for (const auto& [a, b] : {std::pair{"0 0 1", "0 0.6 0.8"},
                             {"-0.5 0.5 0.5", "1 0 0"},
                             {"0.5 0.5", "1 1"},
                             {"255 0 0", ""},
                             {"1 2 3 4 5", "1 2 3 4 5"}}) {
    const Scene scene = scene_of(a, b);
    EXPECT_TRUE(scene.meshes.at(0).colors.empty()) << a;
    EXPECT_THAT(scene.warnings,
                testing::Contains(HasSubstr("vertices: the numbers after the coordinates are not read")))
        << a;
  }
}

TEST(Off, ErrorsNameTheLine) {
  const auto error = [](const std::string& text) { return error_of(text, ModelFormat::off); };
  EXPECT_EQ(error("OBJ\n"), "model: line 1: \"OBJ\" where \"OFF\" was expected");
  EXPECT_EQ(error("OFF\n"), "model: line 2: the number of vertices was expected");
  EXPECT_THAT(error("OFF BINARY\n"), HasSubstr("binary OFF files are not supported"));
  EXPECT_THAT(error("4OFF\n1 1 1\n"), HasSubstr("not supported"));
  EXPECT_EQ(error("OFF\n1 0 0\n0 0\n"), "model: line 4: the file ends within the vertices");
  EXPECT_EQ(error("OFF\n1 0 0\n0 x 0\n"), "model: line 3: not a number");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0\n3 0 0 1\n"), "model: line 4: vertex 1 is out of range, there are 1");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0\n3 0 0\n"), "model: line 4: a face of 3 corners has too few");
  EXPECT_EQ(error("OFF\n1 2 0\n0 0 0\n3 0 0 0\n"), "model: line 5: the file ends before face 1");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0\n999999999 0\n"), "model: line 4: the file ends within the face");
  EXPECT_THAT(error("OFF\n4000000000 1 0\n0 0 0\n"), HasSubstr("4000000000 vertices do not fit"));
  EXPECT_THAT(error("OFF\n1 4000000000 0\n0 0 0\n"), HasSubstr("4000000000 faces do not fit"));
  EXPECT_THAT(error("OFF\n-1 1 0\n0 0 0\n"), HasSubstr("a negative number of vertices"));
}

}  // namespace
}  // namespace frontmost
