// SPDX-License-Identifier: Apache-2.0
// Errors in a scene file are reported with file, place and reason. Malicious files are refused before they take memory
// or lead outside their folder.
#include <sys/stat.h>
#include <unistd.h>

#include "io/scenes/scene_folder.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SceneErrors, NameThePlaceAndTheReason) {
  SceneFolder folder;
  const auto error = [&](const std::string& text) { return folder.error_of(text); };
  EXPECT_EQ(error("{}"), "JSON: 'objects' is missing");
  EXPECT_EQ(error(R"({"objects": {}})"), "objects: an array is expected, not object");
  EXPECT_THAT(error(R"({"objects": [})"), StartsWith("JSON: parse error at line 1, column 14"));
  EXPECT_EQ(error(R"({"objects": [], "view": 1})"),
            R"(JSON: "view" is not known here; known are objects, up, metres_per_unit, categories, materials)");
  EXPECT_EQ(error(R"({"objects": [], "up": "w"})"), R"(up: "w" is not an axis; expected x, y, z, -x, -y or -z)");
  EXPECT_EQ(error(R"({"objects": [], "metres_per_unit": 0})"),
            "metres_per_unit: the number is not between 1e-12 and 1e12");
  EXPECT_EQ(error(R"({"objects": [], "categories": ["a", "a"]})"), "categories[1]: the name is there twice");
  EXPECT_EQ(error(R"({"objects": [], "categories": ["a", {"name": "b", "number": 1}]})"),
            "categories[1]: the number is there twice");
  EXPECT_EQ(error(R"({"objects": [], "materials": {"red": {"color": "red"}}})"),
            R"(materials.red.color: "red" is not a colour; expected #rgb, #rrggbb or three numbers from 0 to 1)");
  EXPECT_EQ(error(R"({"objects": [], "materials": {"red": {"opacity": 2}}})"),
            "materials.red.opacity: the number is not between 0 and 1");
  const auto object = [&](const std::string& text) { return folder.error_of_object(text); };
  EXPECT_EQ(object("{}"), "objects[0]: 'model' is missing");
  EXPECT_EQ(object(R"({"model": "corner.off", "name": ""})"), "objects[0].name: the name is empty");
  EXPECT_EQ(object(R"({"model": "corner.off", "up": "z"})"), "objects[0].up: the scene file has no up axis");
  EXPECT_EQ(object(R"({"model": "corner.off", "metres_per_unit": 1})"),
            "objects[0].metres_per_unit: the scene file has no unit");
  EXPECT_EQ(object(R"({"model": "corner.off", "material": "red"})"),
            R"(objects[0].material: "red" is none of the file's materials)");
  EXPECT_EQ(error(R"({"materials": {"red": {}}, "objects": [{"model": "pair.obj", "material": {"brass": "red"}}]})"),
            R"(objects[0].material: the model has no material "brass")");
  EXPECT_EQ(object(R"({"model": "corner.off", "parts": "both"})"),
            R"(objects[0].parts: "both" is not allowed; expected "together" or "apart")");
  EXPECT_EQ(object(R"({"model": "builtin:spheres"})"),
            R"(objects[0].model: has several curved objects, which cannot be one; say "parts": "apart")");
}

TEST(SceneErrors, PosesAreNumbersThatPlaceSomething) {
  SceneFolder folder;
  folder.write("nan.txt", "1 0 0 nan 0 1 0 0 0 0 1 0");
  const auto error = [&](const std::string& pose) {
    return folder.error_of_object(R"({"model": "corner.off", )" + pose + "}");
  };
  EXPECT_EQ(error(R"("pose": [1, 2])"), "objects[0].pose: 2 numbers; a pose is 16 (or 12), row by row");
  EXPECT_EQ(error(R"("pose": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2])"), "objects[0].pose: the last row is not 0 0 0 1");
  EXPECT_EQ(error(R"("pose": [1,0,0,0, 1,0,0,0, 0,0,1,0])"), "objects[0].pose: the pose is singular, or too large");
  EXPECT_EQ(error(R"("pose": [1,0,0,1e31, 0,1,0,0, 0,0,1,0])"),
            "objects[0].pose[3]: the number is not between -1e30 and 1e30");
  EXPECT_THAT(error(R"("pose": [1e999,0,0,0, 0,1,0,0, 0,0,1,0])"), HasSubstr("number overflow"));
  EXPECT_THAT(error(R"("pose": [NaN,0,0,0, 0,1,0,0, 0,0,1,0])"), StartsWith("JSON: parse error"));
  EXPECT_EQ(error(R"("pose": [null,0,0,0, 0,1,0,0, 0,0,1,0])"), "objects[0].pose[0]: an array is expected, not null");
  EXPECT_EQ(error(R"("pose": "nan.txt")"),
            R"(objects[0].pose: "nan" in that file is not a number between -1e30 and 1e30)");
  EXPECT_THAT(error(R"("pose": "none.txt")"), HasSubstr("none.txt: cannot be found"));
  EXPECT_EQ(error(R"("pose": [1,0,0,0, 0,1,0,0, 0,0,1,0], "scale": 2)"),
            "objects[0].pose: is given beside scale; give only one of them");
  EXPECT_EQ(error(R"("pose_convention": "model-to-world")"), "objects[0].pose_convention: there is no pose");
  EXPECT_EQ(error(R"("pose": [1,0,0,0, 0,1,0,0, 0,0,1,0], "pose_convention": "opencv")"),
            "objects[0].pose_convention: must be model-to-world or world-to-model");
  EXPECT_EQ(error(R"("rotation": [0, 0, 0, 0])"), "objects[0].rotation: the quaternion is zero");
  EXPECT_EQ(error(R"("rotation": [1,0,0, 0,1,0, 0,0,2])"), "objects[0].rotation: is not a rotation");
  EXPECT_EQ(error(R"("rotation": [1,0,0, 0,1,0, 0,0,-1])"), "objects[0].rotation: mirrors; expected a rotation");
  EXPECT_EQ(error(R"("scale": 0)"), "objects[0].scale: the pose is singular, or too large");
}

TEST(SceneErrors, KeysThatAreThereTwiceAreRefusedWhereverTheyAre) {
  SceneFolder folder;
  EXPECT_EQ(folder.error_of(R"({"objects": [], "up": "z", "objects": []})"), R"(JSON: "objects" is there twice)");
  EXPECT_EQ(folder.error_of_object(R"({"model": "corner.off"}, {"model": "corner.off", "name": "a", "name": "b"})"),
            R"(objects[1]: "name" is there twice)");
  EXPECT_EQ(
      folder.error_of(R"({"objects": [], "materials": {"a": {"color": "#fff", "unlit": true, "color": "#000"}}})"),
      R"(materials.a: "color" is there twice)");
}

TEST(SceneErrors, ModelsThatCannotBeReadAreNamedWithTheirObject) {
  SceneFolder folder;
  folder.write("broken.stl", std::string(90, 'x'));
  folder.write("bracket.step", "ISO-10303-21;");
  const auto error = [&](const std::string& model) { return folder.error_of_object(R"({"model": ")" + model + "\"}"); };
  EXPECT_EQ(error("absent.stl"), "objects[0].model: absent.stl: cannot be found");
  EXPECT_THAT(error("broken.stl"), StartsWith("objects[0].model: broken.stl: "));
  EXPECT_THAT(error("bracket.step"), AllOf(StartsWith("objects[0].model: bracket.step: STEP"), HasSubstr("gmsh")));
  EXPECT_THAT(error("builtin:castle"), StartsWith("objects[0].model: "));
  EXPECT_EQ(error(""), "objects[0].model: not a file name");
  EXPECT_EQ(error("-"), "objects[0].model: -: cannot be found") << "standard input is not for scene files";
}

TEST(SceneErrors, NothingOutsideTheFolderIsOpened) {
  SceneFolder folder;
  ASSERT_EQ(::symlink("/etc/passwd", folder.file("link.off").c_str()), 0);
  ASSERT_EQ(::symlink("/dev/zero", folder.file("zero.off").c_str()), 0);
  ASSERT_EQ(::mkfifo(folder.file("pipe.off").c_str(), 0600), 0);
  const auto error = [&](const std::string& model) { return folder.error_of_object(R"({"model": ")" + model + "\"}"); };
  for (const char* const outside : {"../model.stl", "/etc/passwd", "a/../../b.stl", "C:\\\\a.stl"})
    EXPECT_THAT(error(outside), HasSubstr("lies outside the scene file's folder")) << outside;
  EXPECT_THAT(error("link.off"), HasSubstr("is a link to a place outside"));
  EXPECT_THAT(error("zero.off"), HasSubstr("is a link to a place outside"));
  EXPECT_THAT(error("pipe.off"), HasSubstr("is not an ordinary file"));
  EXPECT_THAT(refusal_of(ErrorCode::file_unreadable,
                         [] {
                           const std::string text = R"({"objects": [{"model": "corner.off"}]})";
                           (void)load(std::as_bytes(std::span(text)), "memory");
                         }),
              StartsWith("memory: objects[0].model: corner.off: files named inside a model are not read"));
}

TEST(SceneErrors, OtherFoldersAreReadFromWhereTheyAreAllowed) {
  SceneFolder folder;
  const auto sub = [&](const std::string& name) {
    std::filesystem::create_directories(folder.path() / name);
    return folder.file(name);
  };
  const std::string parts = sub("parts/deep"), scenes = sub("scenes");
  folder.write("parts/deep/corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
  folder.write("parts/pose.txt", "1 0 0 7  0 1 0 0  0 0 1 0");
  folder.write("partsonly.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
  ASSERT_EQ(::symlink("/etc/passwd", folder.file("parts/link.off").c_str()), 0);
  const auto error = [&](const std::string& model, const std::vector<std::string>& allowed) -> std::string {
    folder.write("scenes/scene.json", R"({"objects": [{"model": ")" + model + R"(", "pose": "../parts/pose.txt"}]})");
    LoadOptions options;
    options.allow_outside = allowed;
    try {
      const Scene scene = load(folder.file("scenes/scene.json"), options);
      EXPECT_EQ(scene.instances[0].world_from_mesh[3].x, 7);
      EXPECT_EQ(scene.source.files.size(), 3u);
      return "read";
    } catch (const Error& e) {
      return e.what();
    }
  };
  const std::string relative = "../parts/deep/corner.off", absolute = parts + "/corner.off";
  for (const std::string& model : {relative, absolute}) {
    EXPECT_THAT(error(model, {}), HasSubstr("unless --allow-outside names the folder"));
    EXPECT_THAT(error(model, {scenes}), HasSubstr("unless --allow-outside names the folder"));
    EXPECT_EQ(error(model, {folder.file("parts")}), "read");
    EXPECT_EQ(error(model, {scenes, folder.file("parts/deep/..")}), "read");
  }
  EXPECT_THAT(error("../parts/link.off", {folder.file("parts")}), HasSubstr("lies outside the scene file's folder"));
  EXPECT_THAT(error("../partsonly.off", {folder.file("parts")}), HasSubstr("lies outside the scene file's folder"));
  EXPECT_THAT(error(relative, {folder.file("absent")}), HasSubstr("absent: not a folder; --allow-outside"));
  // Files of other formats name files by themselves, whoever wrote them, so the option does not apply to them.
  folder.write("scenes/m.obj", "mtllib ../pair.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  LoadOptions options;
  options.allow_outside = {folder.path().string()};
  EXPECT_THAT(load(folder.file("scenes/m.obj"), options).warnings,
              testing::ElementsAre(HasSubstr("lies outside the model's folder")));
}

TEST(SceneErrors, SceneFilesPlaceNoSceneFilesSoThereAreNoCycles) {
  SceneFolder folder;
  folder.write("other.json", R"({"objects": []})");
  EXPECT_EQ(folder.error_of_object(R"({"model": "scene.json"})"),
            "objects[0].model: scene.json: is a scene file; a scene file can place only models");
  EXPECT_EQ(folder.error_of_object(R"({"model": "other.json"})"),
            "objects[0].model: other.json: is a scene file; a scene file can place only models");
}

TEST(SceneErrors, CountsAreLimitedBeforeMemoryIsAskedFor) {
  SceneFolder folder;
  std::string many = "{}";
  for (int i = 0; i < (1 << 20); ++i) many += ",{}";
  EXPECT_EQ(folder.error_of_object(many), "objects: 1048577 are more than 1048576");
  EXPECT_THAT(folder.error_of(R"({"objects": )" + std::string(300, '[')), HasSubstr("nested deeper than 256"));
  // Each reference takes some thirty bytes, and would give a hundred and twenty thousand triangles.
  std::string cities = R"({"model": "builtin:city"})";
  for (int i = 0; i < 2000; ++i) cities += R"(,{"model": "builtin:city"})";
  EXPECT_THAT(folder.error_of_object(cities), HasSubstr("far more than a file of this size can hold"));
  std::string copies;
  for (int i = 0; i < 400; ++i)
    copies += std::string(i ? "," : "") + R"({"model": "builtin:city", "material": "m)" + std::to_string(i) + "\"}";
  std::string looks;
  for (int i = 0; i < 400; ++i) looks += std::string(i ? "," : "") + "\"m" + std::to_string(i) + "\": {}";
  EXPECT_THAT(folder.error_of(R"({"materials": {)" + looks + R"(}, "objects": [)" + copies + "]}"),
              HasSubstr("far more than a file of this size can hold"));
}

}  // namespace
}  // namespace frontmost::test
