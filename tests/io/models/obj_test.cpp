// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "base/srgb.h"
#include "model_bytes.h"
#include "support/models.h"

namespace frontmost {
namespace {

using test::error_of;
using test::load_text;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string square_corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// A temporary folder that the destructor removes.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "frontmost-obj-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }

  std::filesystem::path path;
};

TEST(Obj, SeparateIndicesNegativeIndicesAndFaces) {
  const Scene scene = load_text(square_corners +
                                "vt 0 0\nvt 1 0.25\nvn 0 0 1\nvn 0 0 -1\n"
                                "f 1/1/1 2/2/1 3/2/1 4/1/2\nf -4//-1 -3//-1 -2//-2\n");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(0, 1, 2)));
  EXPECT_THAT(mesh.face_ids, ElementsAre(0, 0, 1));
  EXPECT_THAT(mesh.normals.triangles, ElementsAre(glm::uvec3(0, 0, 0), glm::uvec3(0, 0, 1), glm::uvec3(1, 1, 0)));
  EXPECT_EQ(mesh.texcoords.values.at(1), glm::vec2(1, 0.75f));  // v goes down here
  // The second face has no texture coordinates; its vertices take a made-up one.
  EXPECT_THAT(mesh.texcoords.triangles, ElementsAre(glm::uvec3(0, 1, 1), glm::uvec3(0, 1, 0), glm::uvec3(2, 2, 2)));
  EXPECT_EQ(mesh.texcoords.values.size(), 3u);
}

TEST(Obj, EqualIndicesAreStoredOnce) {
  const Scene scene = load_text(square_corners + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\nf 1/1 2/2 3/3 4/4\n");
  EXPECT_TRUE(scene.meshes.at(0).texcoords.triangles.empty());
  EXPECT_EQ(scene.meshes[0].texcoords.values.size(), 5u);
}

TEST(Obj, ObjectsAndGroupsAreMeshesWithTheirOwnVertices) {
  const Scene scene =
      load_text("o unused\no first\n" + square_corners + "f 1 2 3\ng second part\nf 3 4 1\nf 3 2 1\ng\nf 4 1 2\n");
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.instances[0].name, "first");
  EXPECT_EQ(scene.instances[1].name, "second part");
  EXPECT_EQ(scene.instances[2].name, "first");
  EXPECT_THAT(scene.meshes[1].triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 3, 2)));
  EXPECT_THAT(scene.meshes[1].positions,
              ElementsAre(glm::vec3(1, 1, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 0), glm::vec3(1, 0, 0)));
  EXPECT_EQ(scene.meshes[2].positions.size(), 3u);
}

TEST(Obj, NamesThatStayStartNoMesh) {
  const Scene scene = load_text(square_corners + "g a\nf 1 2 3\ng a\nf 3 4 1\ns 1\nusemtl m\nf 1 2 4\n");
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 3u);
}

TEST(Obj, MaterialsByTriangle) {
  const Scene scene =
      load_text(square_corners + "f 1 2 3\nusemtl red\nf 1 2 3 4\nusemtl dark blue\nf 1 2 3\no next\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].name, "dark blue");
  EXPECT_THAT(scene.meshes[0].material_ids, ElementsAre(no_index, 0, 0, 1));
  EXPECT_THAT(scene.meshes[1].material_ids, ElementsAre(1));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("usemtl \"red\": 2 materials are not defined")));
}

TEST(Obj, VertexColors) {
  const Scene scene = load_text("v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0.5 0\nv 1 1 1 nan nan nan\nf 1 2 3\n");
  const auto& colors = scene.meshes.at(0).colors.values;
  EXPECT_THAT(colors, ElementsAre(glm::vec4(1), glm::vec4(1, 0, 0, 1), glm::vec4(0, linear_of_srgb16(32768), 0, 1),
                                  glm::vec4(1)));
  EXPECT_TRUE(load_text("v 0 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3").meshes.at(0).colors.empty());
}

TEST(Obj, FacesMayComeBeforeTheirVertices) {
  const Scene scene = load_text("f 1 2 3\nf 1 2 3 4\n" + square_corners);
  EXPECT_EQ(triangle_count(scene), 3u);
}

TEST(Obj, CloudsOfPointsAreCounted) {
  const Scene vertices = load_text("v 0 0 0\nv 1 0 0 1 0 0\nv 2 0 0\n");
  EXPECT_THAT(vertices.warnings,
              ElementsAre("model: the file holds no triangles; its 3 points are not drawn, because a "
                          "point has no surface"));
  EXPECT_EQ(vertices.meshes.at(0).colors.values.at(1), glm::vec4(1, 0, 0, 1));
  const Scene points = load_text("o cloud\nv 0 0 0\nv 1 0 0\np 1\np 2\n");
  EXPECT_THAT(points.warnings, ElementsAre(HasSubstr("statements \"p\" are passed over"), HasSubstr("its 2 points")));
  EXPECT_EQ(points.instances.at(0).name, "cloud");
  EXPECT_THAT(load_text("vt 0 0\n").warnings, ElementsAre("model: the file holds no triangles"));
}

TEST(Obj, LinesAreEdgesOfTheirObject) {
  const std::string two = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\no a\nf 1 2 3\nl 1 2 3\no b\nf 2 3 4\nl -1 -2\nl 1 2\n";
  const Scene scene = load_text(two, ModelFormat::obj);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_THAT(scene.meshes[0].sharp_edges, testing::ElementsAre(glm::uvec2(0, 1), glm::uvec2(1, 2)));
  // The second line of b begins at a vertex that b lacks.
  EXPECT_THAT(scene.meshes[1].sharp_edges, testing::ElementsAre(glm::uvec2(2, 1)));
  const Scene one = load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 3 1\n", ModelFormat::obj);
  EXPECT_THAT(one.meshes[0].sharp_edges, testing::ElementsAre(glm::uvec2(2, 0)));
  // Before any face, lines belong to no object.
  const Scene early = load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\n", ModelFormat::obj);
  EXPECT_TRUE(early.meshes[0].sharp_edges.empty());
  EXPECT_THAT(early.warnings.at(0), testing::HasSubstr("\"l\" are passed over"));
  EXPECT_THAT(error_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 9\n", ModelFormat::obj),
              testing::HasSubstr("vertex index 9 is out of range, there are 3"));
}

TEST(Obj, LinesGoOnAfterABackslashAndCommentsEndThem) {
  const Scene scene = load_text("v 0 0 \\\n 0\r\nv 1 0 0#1\nv 0 1 0 # c\nf 1 2 \\\r\n 3\np 1 2\np 2 3\n# f 1 2 3\n");
  EXPECT_EQ(triangle_count(scene), 1u);
  EXPECT_THAT(scene.warnings, ElementsAre("model: line 7: statements \"p\" are passed over"));
}

TEST(Obj, ErrorsNameTheLine) {
  const auto error = [](const std::string& text) { return error_of(text, ModelFormat::obj); };
  EXPECT_EQ(error("v 0 0\n"), "model: line 1: a vertex needs three numbers");
  EXPECT_EQ(error("v 0 0 0\nvn 0 1 up\n"), "model: line 2: a normal needs three numbers");
  EXPECT_EQ(error("vt\n"), "model: line 1: a texture coordinate needs a number");
  EXPECT_EQ(error(square_corners + "f 1 2 5\nf 1 2 3\n"), "model: line 5: vertex index 5 is out of range, there are 4");
  EXPECT_EQ(error(square_corners + "f 1 2 0\n"), "model: line 5: vertex index out of range, there are 4 so far");
  EXPECT_EQ(error(square_corners + "f 1 2 -5\n"), "model: line 5: vertex index out of range, there are 4 so far");
  EXPECT_EQ(error(square_corners + "f 1 2 99999999999\n"),
            "model: line 5: vertex index out of range, there are 4 so far");
  EXPECT_EQ(error(square_corners + "f 1/1 2/1 3/1\n"),
            "model: line 5: texture coordinate index 1 is out of range, there are 0");
  EXPECT_EQ(error(square_corners + "f 1//1 2//1 3//1\n"), "model: line 5: normal index 1 is out of range, there are 0");
  EXPECT_EQ(error(square_corners + "f 1 2 x\n"), "model: line 5: not a corner of a face");
  EXPECT_EQ(error(square_corners + "f 1 2 3.5\n"), "model: line 5: not a corner of a face");
  EXPECT_EQ(error("\nbinary rubbish\n"), "model: line 2: not an OBJ statement");
}

TEST(Obj, MaterialLibraries) {
  const Folder folder;
  const std::string path =
      folder.write("model.obj", "mtllib sub/a library.mtl\n" + square_corners +
                                    "usemtl paint\nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl later\nf 1 2 3\n");
  folder.write(
      "sub/a library.mtl",
      "# c\nnewmtl paint\nKd 0.5 0 1 # c\nNs 98\nPm 0.25\nKe 1\nmap_Kd -s 2 3 1 -o 0.1 0.2 -clamp on none.png\n"
      "newmtl glass\nd 0.25\nPr 2\nKd spectral f.rfl\nnewmtl unused\nTr 0.75\nillum 2\n");
  const Scene scene = load(path);
  ASSERT_EQ(scene.materials.size(), 4u);
  const Material& paint = scene.materials[0];
  EXPECT_EQ(paint.name, "paint");
  EXPECT_EQ(paint.base_color, glm::vec4(linear_of_srgb16(32768), 0, 1, 1));
  EXPECT_FLOAT_EQ(paint.roughness, 0.14142136f);
  EXPECT_EQ(paint.metallic, 0.25f);
  EXPECT_EQ(paint.emissive, glm::vec3(1));
  EXPECT_EQ(paint.base_color_texture.scale, glm::vec2(2, 3));
  EXPECT_FLOAT_EQ(paint.base_color_texture.offset.y, 1 - 3 - 0.2f);
  EXPECT_EQ(scene.materials[2].name, "unused");
  EXPECT_EQ(scene.materials[2].base_color.a, 0.25f);
  const Material& glass = scene.materials[1];
  EXPECT_EQ(glass.alpha, Material::Alpha::blend);
  EXPECT_EQ(glass.base_color, glm::vec4(1, 1, 1, 0.25f));
  EXPECT_EQ(glass.roughness, 1.0f);
  EXPECT_THAT(scene.warnings, ElementsAre(path + ": material paint: texture left out: sub/none.png: cannot be found",
                                          HasSubstr("usemtl \"later\": 1 material is not defined")));
}

TEST(Obj, TheSceneTellsWhatItWasReadFrom) {
  const Folder folder;
  const std::string library = folder.write("m.mtl", "newmtl lamp\nKd 0 0 0\n");
  const std::string path = folder.write("model.obj", "mtllib m.mtl\n" + square_corners + "usemtl lamp\nf 1 2 3\n");
  Scene scene;
  add(scene, load(path));
  EXPECT_EQ(scene.source.format, ModelFormat::obj);
  EXPECT_EQ(scene.source.metres_per_unit, std::nullopt);
  EXPECT_THAT(scene.source.files, ElementsAre(std::filesystem::canonical(library), std::filesystem::canonical(path)));
  add(scene, load(path));
  EXPECT_EQ(scene.source.files.size(), 4u);
  EXPECT_EQ(builtin("cubes").source.format, std::nullopt);
}

TEST(Obj, WithoutItsTextureNothingGlows) {
  const Folder folder;
  const std::string path = folder.write("model.obj", "mtllib m.mtl\n" + square_corners + "usemtl lamp\nf 1 2 3\n");
  for (const char* lines : {"Ke 1 1 1\nmap_Ke none.png\n", "map_Ke none.png\nKe 1 1 1\n", "map_Ke none.png\n"}) {
    folder.write("m.mtl", std::string("newmtl lamp\nKd 0 0 0\nmap_Kd none.png\n") + lines);
    const Scene scene = load(path);
    EXPECT_EQ(scene.materials.at(0).emissive, glm::vec3(0)) << lines;
    EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1)) << "nor is all of it black";
    EXPECT_THAT(scene.warnings,
                ElementsAre(path + ": material lamp: texture left out: none.png: cannot be found",
                            path + ": material lamp: the emissive texture is missing, so the material does not glow"));
  }
}

TEST(Obj, AGreyBesideATextureDoesNotDarkenItAndAHueDoes) {
  const Folder folder;
  const std::string path = folder.write("model.obj", "mtllib m.mtl\n" + square_corners + "usemtl wall\nf 1 2 3\n");
  save(Image{1, 1, {{"R", Buffer<float>(1, 1.0f)}, {"G", Buffer<float>(1, 1.0f)}, {"B", Buffer<float>(1, 1.0f)}}},
       (folder.path / "wall.png").string());
  const auto base_color = [&](const std::string& lines) {
    folder.write("m.mtl", "newmtl wall\n" + lines);
    return load(path).materials.at(0).base_color;
  };
  EXPECT_EQ(base_color("Kd 0.64 0.64 0.64\nmap_Kd wall.png\n"), glm::vec4(1));
  EXPECT_EQ(base_color("map_Kd wall.png\nKd 0.8\nd 0.5\n"), glm::vec4(1, 1, 1, 0.5f));
  EXPECT_EQ(base_color("map_Kd wall.png\nKd 0 0 0\n"), glm::vec4(1));
  EXPECT_EQ(base_color("Kd 1 0 0\nmap_Kd wall.png\n"), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(base_color("Kd 0.5 0.5 0.5\nmap_Kd none.png\n"), glm::vec4(glm::vec3(linear_of_srgb16(32768)), 1));
}

TEST(Obj, AByteOrderMarkHidesNoStatement) {
  const Folder folder;
  folder.write("m.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  const Scene scene =
      load(folder.write("model.obj", "\xEF\xBB\xBFmtllib m.mtl\n" + square_corners + "usemtl red\nf 1 2 3\n"));
  EXPECT_EQ(scene.materials.at(0).base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_TRUE(scene.warnings.empty());
}

/// A square with one material, and images for it.
class TexturedSquare {
 public:
  TexturedSquare() { write("model.obj", "mtllib m.mtl\n" + square_corners + "usemtl leaf\nf 1 2 3 4\n"); }
  void write(const std::string& name, const std::string& text) { folder_.write(name, text); }
  /// Writes a grey picture, row by row, or a red one with these alphas.
  void picture(const std::string& name, int width, const std::vector<float>& values, bool are_alphas = false) {
    const int height = int(values.size()) / width;
    Buffer<float> grey(values.size(), 0.0f), red(values.size(), 0.0f);
    std::copy(values.begin(), values.end(), grey.begin());
    Image image{width, height, {{"R", grey}, {"G", grey}, {"B", grey}}};
    if (are_alphas) image.channels = {{"R", grey}, {"G", red}, {"B", red}, {"A", grey}};
    save(image, (folder_.path / name).string());
  }
  Scene load_with(const std::string& lines) {
    write("m.mtl", "newmtl leaf\n" + lines + "newmtl other\n");
    return load((folder_.path / "model.obj").string());
  }

 private:
  Folder folder_;
};

std::vector<int> alphas_of(const Scene& scene) {
  std::vector<int> alphas;
  for (const glm::u8vec4& pixel : scene.textures.at(scene.materials.at(0).base_color_texture.texture).pixels)
    alphas.push_back(pixel.a);
  return alphas;
}

TEST(Obj, MapDOfTheSameFileByAnotherNameIsThatFile) {
  TexturedSquare square;
  square.picture("wood.png", 1, {0.2f, 0.9f});
  const Scene scene = square.load_with("map_Kd wood.png\nmap_d ./wood.png\n");
  EXPECT_EQ(scene.materials.at(0).alpha, Material::Alpha::opaque);
  EXPECT_EQ(square.load_with("map_d\nKd 1 0 0\n").materials.at(0).base_color, glm::vec4(1, 0, 0, 1));
}

TEST(Obj, MapDIsTheAlphaOfTheColours) {
  TexturedSquare square;
  square.picture("red.png", 1, {1, 1}, true);
  square.picture("mask.png", 4, {0, 0, 1, 1});
  Scene scene = square.load_with("Kd 0.5 0.5 0.5\nmap_Kd -s 2 2 red.png\nmap_d -imfchan l mask.png\n");
  EXPECT_THAT(scene.warnings, ElementsAre());
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].width, 4);
  EXPECT_EQ(scene.textures[0].height, 2);
  EXPECT_THAT(alphas_of(scene), ElementsAre(0, 0, 255, 255, 0, 0, 255, 255));
  for (const glm::u8vec4& pixel : scene.textures[0].pixels) EXPECT_EQ(glm::u8vec3(pixel), glm::u8vec3(255, 0, 0));
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::mask);
  EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1));
  EXPECT_EQ(scene.materials[0].base_color_texture.scale, glm::vec2(2));
  // The smaller image gives the alphas. They are interpolated, and the file's own values choose the mode.
  square.picture("small.png", 2, {0, 1});
  square.picture("wide.png", 4, {1, 1, 1, 1}, true);
  scene = square.load_with("map_d small.png\nmap_Kd -clamp on wide.png\n");
  EXPECT_THAT(alphas_of(scene), ElementsAre(0, 64, 191, 255));
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::mask);
  // With a factor, half of it is not a threshold for holes.
  scene = square.load_with("map_d mask.png\nmap_Kd red.png\nd 0.4\n");
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::blend);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 1, 1, 0.4f));
}

TEST(Obj, MapDWithoutColoursLeavesKd) {
  TexturedSquare square;
  square.picture("mask.png", 2, {0, 1});
  for (const std::string before : {"", "map_Kd none.png\n"}) {
    const Scene scene = square.load_with(before + "Kd 1 0 0\nmap_d -s 3 3 mask.png\n");
    EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::mask);
    EXPECT_EQ(scene.materials[0].base_color_texture.scale, glm::vec2(before.empty() ? 3 : 1));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_THAT(scene.textures[0].pixels, ElementsAre(glm::u8vec4(255, 255, 255, 0), glm::u8vec4(255)));
    EXPECT_EQ(scene.warnings.size(), before.empty() ? 0u : 1u);
  }
  EXPECT_EQ(square.load_with("Kd 0\nmap_d mask.png\n").materials[0].base_color, glm::vec4(0, 0, 0, 1));
}

TEST(Obj, TheValuesOfMapDChooseTheAlphaMode) {
  TexturedSquare square;
  square.picture("soft.png", 3, {0, 0.5f, 1});
  square.picture("full.png", 2, {1, 0.99f});
  square.picture("grey.png", 2, {0, 1});
  square.picture("cut.png", 2, {0, 1}, true);
  square.picture("glass.png", 2, {0.5f, 1}, true);
  const auto mode = [&](const std::string& lines) { return square.load_with(lines).materials[0].alpha; };
  EXPECT_EQ(mode("map_d soft.png\n"), Material::Alpha::blend);
  EXPECT_EQ(mode("map_d full.png\n"), Material::Alpha::opaque);
  EXPECT_EQ(square.load_with("map_d full.png\n").textures.size(), 0u);
  // If an image has an alpha channel, its alpha counts, whatever its colours are.
  EXPECT_EQ(mode("map_d cut.png\n"), Material::Alpha::mask);
  EXPECT_EQ(mode("map_Kd grey.png\nmap_d glass.png\n"), Material::Alpha::blend);
  // If both maps use one file, only its alpha counts.
  EXPECT_EQ(mode("map_Kd cut.png\nmap_d cut.png\n"), Material::Alpha::mask);
  EXPECT_EQ(mode("map_Kd glass.png\nmap_d glass.png\n"), Material::Alpha::blend);
  EXPECT_EQ(mode("map_Kd grey.png\nmap_d grey.png\n"), Material::Alpha::opaque);
  EXPECT_EQ(mode("map_Kd cut.png\n"), Material::Alpha::opaque);
}

TEST(Obj, AMapDThatCannotBeUsedIsAWarning) {
  TexturedSquare square;
  square.picture("grey.png", 1, {0.5f});
  Scene scene = square.load_with("map_Kd grey.png\nmap_d none.png\n");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("material leaf: texture left out: none.png: cannot be found")));
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::opaque);
  EXPECT_TRUE(scene.materials[0].base_color_texture.is_set());
  // The files are short, but a row and a column together would need a gigabyte.
  square.picture("row.png", 16384, std::vector<float>(16384, 0.0f));
  square.picture("column.png", 1, std::vector<float>(16384, 0.0f));
  scene = square.load_with("map_Kd row.png\nmap_d column.png\n");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("column.png: the textures together have too many pixels")));
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::opaque);
  EXPECT_EQ(scene.textures.at(0).height, 1);
}

TEST(Obj, ABrokenLibraryIsAWarning) {
  const Folder folder;
  folder.write("broken.mtl", "newmtl a\nd much\n");
  const std::string path = folder.write("model.obj", "mtllib broken.mtl\n" + square_corners + "f 1 2 3\n");
  const Scene scene = load(path);
  EXPECT_EQ(triangle_count(scene), 1u);
  EXPECT_THAT(scene.warnings,
              ElementsAre(path + ": line 1: material library left out: broken.mtl: line 2: a number was expected"));
}

TEST(Obj, NothingOutsideTheFolderIsRead) {
  const Folder folder;
  folder.write("outside.mtl", "newmtl secret\n");
  std::filesystem::create_directories(folder.path / "model");
  std::filesystem::create_symlink("../outside.mtl", folder.path / "model" / "link.mtl");
  for (const std::string& name :
       {std::string("../outside.mtl"), (folder.path / "outside.mtl").string(), std::string("link.mtl"),
        std::string("..\\outside.mtl"), std::string("sub/../../outside.mtl"), std::string("C:\\outside.mtl"),
        std::string("/dev/zero"), std::string(".")}) {
    const Scene scene = load(folder.write("model/model.obj", "mtllib " + name + "\n" + square_corners + "f 1 2 3\n"));
    EXPECT_EQ(triangle_count(scene), 1u);
    EXPECT_TRUE(scene.materials.empty()) << name;
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("left out"))) << name;
  }
}

TEST(Obj, TheBananaHasItsTexture) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("objects/ycb-banana.obj"));
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.materials.at(0).base_color_texture.texture, 0u);
  EXPECT_EQ(scene.materials[0].name, "material_0.016");
  EXPECT_GT(scene.textures[0].width, 0);
  EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace frontmost
