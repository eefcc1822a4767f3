// SPDX-License-Identifier: Apache-2.0
#include "base/srgb.h"
#include "model_bytes.h"

namespace frontmost {
namespace {

using test::ByteWriter;
using test::error_of;
using test::load_text;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corner_list = "property list uchar int vertex_indices\n";

std::string header(const std::string& elements, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

std::string square_with(const std::string& faces, int face_count) {
  return header("element vertex 4\n" + xyz + "element face " + std::to_string(face_count) + "\n" + corner_list) +
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + faces;
}

TEST(Ply, PolygonsRememberTheirFace) {
  const Scene scene = load_text(square_with("3 0 1 2\n4 0 1 2 3\n2 0 1\n3 2 3 0\n", 4));
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_THAT(mesh.triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(2, 3, 0)));
  EXPECT_THAT(mesh.face_ids, ElementsAre(0, 1, 1, 3));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 with fewer than three corners")));
  EXPECT_EQ(scene.up, Axis::y);
}

TEST(Ply, CloudsOfPointsAreCounted) {
  const Scene scene = load_text(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "0 0 0\n1 1 1\n");
  EXPECT_THAT(scene.warnings,
              testing::ElementsAre("model: the file holds no triangles; its 2 points are not drawn, because a "
                                   "point has no surface"));
}

TEST(Ply, TrianglesAloneNeedNoFaceIds) {
  const Scene scene = load_text(square_with("3 0 1 2\n3 2 3 0\n", 2));
  EXPECT_TRUE(scene.meshes.at(0).face_ids.empty());
  EXPECT_EQ(scene.meshes[0].face_of(1), 1u);
}

const std::string rich_elements =
    "element vertex 3\nproperty double x\nproperty float y\nproperty short z\n"
    "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
    "property uchar red\nproperty ushort green\nproperty float blue\nproperty uchar alpha\n"
    "element other 2\nproperty list uchar ushort data\nproperty char c\n"
    "element face 1\nproperty char flag\nproperty list ushort uint vertex_index\n";

void expect_rich(const Scene& scene) {
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0.5f, -3));
  EXPECT_EQ(mesh.normals.values.at(1), glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.texcoords.values.at(1), glm::vec2(0.25f, 0.25f));  // v goes down here
  const glm::vec4 color = mesh.colors.values.at(1);
  EXPECT_EQ(color.r, linear_of_srgb8(128));
  EXPECT_EQ(color.g, 1.0f);
  EXPECT_EQ(color.b, 0.0f);
  EXPECT_EQ(color.a, 51.0f / 255);
  EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(2, 1, 0)));
}

TEST(Ply, BothByteOrdersAndTextAgree) {
  for (const bool big : {false, true}) {
    ByteWriter out(big);
    out.text = header(rich_elements, big ? "binary_big_endian" : "binary_little_endian");
    for (int i = 0; i < 3; ++i) {
      out.put(double(i)).put(0.5f).put(std::int16_t(-3)).put({0.0f, 0.0f, 1.0f, 0.25f, 0.75f});
      out.put(std::uint8_t(128)).put(std::uint16_t(65535)).put(0.0f).put(std::uint8_t(51));
    }
    out.put(std::uint8_t(2)).put({std::uint16_t(7), std::uint16_t(8)}).put(std::int8_t(-1));
    out.put(std::uint8_t(0)).put(std::int8_t(-1));
    out.put(std::int8_t(1)).put(std::uint16_t(3)).put({2u, 1u, 0u});
    expect_rich(load_text(out.text));
  }
  std::string text = header(rich_elements);
  for (int i = 0; i < 3; ++i) text += std::to_string(i) + " 0.5 -3 0 0 1 .25 .75 128 65535 0 51\n";
  expect_rich(load_text(text + "2 7 8 -1\n0 -1\n1 3 2 1 0\n"));
}

// -- every type in every place
// ------------------------------------------------------------------------------------------

struct TypeName {
  const char* name;
  bool is_integer;
};
constexpr TypeName type_names[] = {{"char", true},  {"uchar", true},  {"short", true},    {"ushort", true},
                                   {"int", true},   {"uint", true},   {"float", false},   {"double", false},
                                   {"int8", true},  {"uint8", true},  {"int16", true},    {"uint16", true},
                                   {"int32", true}, {"uint32", true}, {"float32", false}, {"float64", false}};

/// Writes a whole number as a type of PLY.
void put_as(const std::string& type, int value, ByteWriter& out) {
  if (type == "char" || type == "int8") out.put(std::int8_t(value));
  if (type == "uchar" || type == "uint8") out.put(std::uint8_t(value));
  if (type == "short" || type == "int16") out.put(std::int16_t(value));
  if (type == "ushort" || type == "uint16") out.put(std::uint16_t(value));
  if (type == "int" || type == "int32") out.put(std::int32_t(value));
  if (type == "uint" || type == "uint32") out.put(std::uint32_t(value));
  if (type == "float" || type == "float32") out.put(float(value));
  if (type == "double" || type == "float64") out.put(double(value));
}

/// A triangle and a quad over five vertices on a parabola.
std::string of_types(const std::string& place, const std::string& count, const std::string& corner, bool big) {
  ByteWriter out(big);
  out.text = header("element vertex 5\nproperty " + place + " x\nproperty " + place + " y\nproperty " + place +
                        " z\nelement face 2\nproperty list " + count + " " + corner + " vertex_indices\n",
                    big ? "binary_big_endian" : "binary_little_endian");
  for (int i = 0; i < 5; ++i)
    for (const int coordinate : {i, i * i, 100 - i}) put_as(place, coordinate, out);
  for (const std::vector<int>& face : {std::vector<int>{0, 1, 4}, std::vector<int>{1, 2, 3, 4}}) {
    put_as(count, int(face.size()), out);
    for (const int vertex : face) put_as(corner, vertex, out);
  }
  return out.text;
}

TEST(Ply, EveryTypeServesAsPlaceCountAndCorner) {
  for (const bool big : {false, true})
    for (const TypeName& type : type_names) {
      SCOPED_TRACE(std::string(type.name) + (big ? ", big" : ", little"));
      const std::string whole = type.is_integer ? type.name : "uchar";
      const Mesh mesh = load_text(of_types(type.name, whole, whole, big)).meshes.at(0);
      ASSERT_EQ(mesh.positions.size(), 5u);
      for (int i = 0; i < 5; ++i) EXPECT_EQ(mesh.positions[std::size_t(i)], glm::vec3(i, i * i, 100 - i));
      EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 4), glm::uvec3(1, 2, 3), glm::uvec3(1, 3, 4)));
      EXPECT_THAT(mesh.face_ids, ElementsAre(0, 1, 1));
    }
}

TEST(Ply, CountsAndCornersAreWholeNumbers) {
  for (const char* type : {"float", "double"}) {
    EXPECT_EQ(error_of(of_types("float", "uchar", type, false), ModelFormat::ply),
              "model: header: the corners of element \"face\" must be integers");
    EXPECT_THAT(error_of(of_types("float", type, "int", false), ModelFormat::ply), HasSubstr("line 8: "));
  }
}

TEST(Ply, NegativeNumbersOfEveryWidthAreOutOfRange) {
  for (const char* type : {"char", "short", "int"}) {
    ByteWriter out;
    out.text = header(
        "element vertex 3\n" + xyz + "element face 1\nproperty list uchar " + std::string(type) + " vertex_indices\n",
        "binary_little_endian");
    for (int i = 0; i < 9; ++i) out.put(float(i));
    out.put(std::uint8_t(3));
    for (const int corner : {0, 1, -2}) put_as(type, corner, out);
    EXPECT_THAT(error_of(out.text, ModelFormat::ply), HasSubstr("face 0: vertex -2 is out of range, there are 3"));
    ByteWriter lengths;
    lengths.text = header(
        "element vertex 0\n" + xyz + "element face 1\nproperty list " + std::string(type) + " uchar vertex_indices\n",
        "binary_little_endian");
    put_as(type, -1, lengths);
    EXPECT_THAT(error_of(lengths.text, ModelFormat::ply), HasSubstr("face 0: the length of a list is negative"));
  }
}

TEST(Ply, StripsTurnEverySecondTriangle) {
  const Scene scene = load_text(header("element vertex 5\n" + xyz + "element tristrips 1\n" + corner_list) +
                                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 2 1 0\n");
  EXPECT_THAT(scene.meshes.at(0).triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(2, 1, 3), glm::uvec3(2, 3, 4), glm::uvec3(2, 1, 0)));
}

TEST(Ply, FaceColorsAndWedges) {
  const Scene scene =
      load_text(header("comment TextureFile nowhere.png\nelement vertex 4\n" + xyz + "element face 2\n" + corner_list +
                       "property list uchar float texcoord\nproperty uchar red\nproperty uchar green\n"
                       "property uchar blue\n") +
                "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                "4 0 1 2 3 8 0 0 1 0 1 1 0 1 255 0 0\n3 0 1 2 0 0 255 0\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(mesh.colors.values.at(mesh.corners(mesh.colors, 1)[k]), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(mesh.colors.values.at(mesh.corners(mesh.colors, 2)[k]), glm::vec4(0, 1, 0, 1));
  }
  EXPECT_EQ(mesh.texcoords.values.at(mesh.corners(mesh.texcoords, 1)[1]), glm::vec2(1, 0));
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(mesh.material_of(2), 0u);
  EXPECT_FALSE(scene.materials[0].base_color_texture.is_set());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("nowhere.png")));
}

TEST(Ply, LineEndsOfEverySystem) {
  const std::string unix_text = square_with("3 0 1 2\n", 1);
  for (const std::string& end : {std::string("\r\n"), std::string("\r")}) {
    std::string text;
    for (const char c : unix_text) text += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(triangle_count(load_text(text)), 1u);
  }
  // After a header of single \r line ends, a binary row may start with the byte 10, which reading \r\n would swallow.
  ByteWriter out;
  out.text =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\rproperty uchar y\rproperty uchar "
      "z\rend_header\r";
  out.put({std::uint8_t(10), std::uint8_t(2), std::uint8_t(3)});
  EXPECT_EQ(load_text(out.text).meshes.at(0).positions.at(0), glm::vec3(10, 2, 3));
}

TEST(Ply, ErrorsNameHeaderLineOrRow) {
  const auto error = [](const std::string& text) { return error_of(text, ModelFormat::ply); };
  EXPECT_EQ(error("plx\n"), "model: line 1: a PLY file starts with \"ply\"");
  EXPECT_EQ(error("ply\nformat ascii 2.0\n"), "model: line 2: only PLY version 1.0 is supported");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\n"),
            "model: line 4: unknown type \"real\"");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nproperty float x\n"), "model: line 3: a property before the first element");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex -3\n"), "model: line 3: an element needs a name and a count");
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 3\n"), HasSubstr("before \"end_header\""));
  EXPECT_EQ(error("ply\nend_header\n"), "model: line 2: the header names no format");
  EXPECT_EQ(error(square_with("3 0 1 4\n", 1)), "model: line 14: face 0: vertex 4 is out of range, there are 4");
  EXPECT_EQ(error(square_with("3 0 1 -1\n", 1)), "model: line 14: face 0: vertex -1 is out of range, there are 4");
  EXPECT_EQ(error(square_with("3 0 1\n3 0 1 2\n", 2)), "model: line 14: face 0: the row has too few values");
  EXPECT_EQ(error(square_with("-3 0 1 2\n", 1)), "model: line 14: face 0: the length of a list is negative");
  EXPECT_THAT(error(square_with("3 0 1 2\n", 2)), HasSubstr("face 1: the file ends before this row"));
  EXPECT_EQ(error(header("element face 1\n" + corner_list + "element vertex 1\n" + xyz) + "3 0 1 2\n0 0 0\n"),
            "model: line 10: face 0: vertex 0 is out of range, there are 0 before the faces");
  EXPECT_EQ(error(header("element vertex 1\nproperty float x\n") + "1\n"),
            "model: header: vertices need the properties x, y and z");
}

TEST(Ply, CountsAreHeldAgainstTheSizeBeforeMemoryIsAskedFor) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string many = header("element vertex 4000000000\n" + xyz, format);
    EXPECT_THAT(error_of(many + std::string(100, '1'), ModelFormat::ply),
                HasSubstr("4000000000 rows of element \"vertex\""));
    const std::string lists =
        header("element vertex 0\n" + xyz + "element face 1\nproperty list uint int vertex_indices\n", format);
    ByteWriter out;
    out.text = lists;
    EXPECT_THAT(error_of(*format == 'a' ? lists + "4000000000 1\n" : out.put(0xF0F0F0F0u).text, ModelFormat::ply),
                HasSubstr("the file ends within the row"));
  }
}

}  // namespace
}  // namespace frontmost
