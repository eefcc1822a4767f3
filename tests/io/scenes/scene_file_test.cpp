// SPDX-License-Identifier: Apache-2.0
// Scenes follow their scene file: models at their places, shared, renamed, counted and painted.
#include "io/scenes/scene_folder.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Instance& instance : scene.instances) names.push_back(instance.name);
  return names;
}

TEST(SceneFile, PlacesModelsInOrderAndSharesTheirMeshes) {
  SceneFolder folder;
  const Scene scene = folder.load_objects(R"({"model": "corner.off", "translation": [10, 0, 0]},
      {"model": "corner.stl", "name": "other"}, {"model": "./corner.off", "name": "first again"}, {"model": "corner.off"})");
  EXPECT_THAT(names_of(scene), ElementsAre("corner", "other", "first again", "corner"));
  EXPECT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[3].mesh);
  EXPECT_EQ(world_corners(scene)[1], glm::dvec3(11, 0, 0));
  EXPECT_EQ(world_corners(scene)[4], glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.source.format, ModelFormat::scene);
  EXPECT_EQ(scene.up, Axis::y) << "that of the first model";
  EXPECT_EQ(scene.source.files.size(), 3u) << "the scene file and two models, each once";
}

TEST(SceneFile, PosesAreMatricesByRowsAsThoseOfCameras) {
  SceneFolder folder;
  // A quarter turn about z, and a translation: x goes to y, y to -x.
  folder.write("pose.txt",
               "\xEF\xBB\xBF"
               "0 -1 0 7; 1 0 0 8\n0 0 1 9\n[0 0 0 1]\n");
  const auto corners = [&](const std::string& pose) {
    return world_corners(folder.load_objects(R"({"model": "corner.off", )" + pose + "}"));
  };
  const std::vector<glm::dvec3> expected = {{7, 8, 9}, {7, 9, 9}, {5, 8, 9}};
  EXPECT_EQ(corners(R"("pose": [0,-1,0,7, 1,0,0,8, 0,0,1,9, 0,0,0,1])"), expected);
  EXPECT_EQ(corners(R"("pose": [[0,-1,0,7], [1,0,0,8], [0,0,1,9]])"), expected);
  EXPECT_EQ(corners(R"("pose": "pose.txt", "pose_convention": "model-to-world")"), expected);
  EXPECT_EQ(corners(R"("pose": [0,1,0,-8, -1,0,0,7, 0,0,1,-9], "pose_convention": "world-to-model")"), expected);
  EXPECT_EQ(corners(R"("rotation": [0,-1,0, 1,0,0, 0,0,1], "translation": [7, 8, 9])"), expected);
  const std::vector<glm::dvec3> turned = corners(R"("rotation": [0, 0, 3, 3], "translation": [7, 8, 9])");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(glm::distance(turned[i], expected[i]), 1e-15);
  const std::vector<glm::dvec3> scaled = {{1, 0, 0}, {3, 0, 0}, {1, 6, 0}};
  EXPECT_EQ(corners(R"("scale": [2, 3, 4], "translation": [1, 0, 0])"), scaled) << "scaled first, moved last";
  EXPECT_EQ(corners(R"("scale": 3)")[2], glm::dvec3(0, 6, 0));
}

TEST(SceneFile, UnitsAreScaledAndModelsTurnedOnlyWhereTheFileSaysSo) {
  SceneFolder folder;
  const std::string objects = R"("objects": [{"model": "metre.gltf"}, {"model": "corner.stl"}])";
  const Scene plain = folder.load_scene("{" + objects + "}");
  EXPECT_EQ(world_corners(plain)[1], glm::dvec3(1, 0, 0));
  EXPECT_EQ(plain.source.metres_per_unit, 1.0) << "the first model's";
  EXPECT_THAT(plain.warnings, ElementsAre(HasSubstr("objects[1].model: its unit is not that of the first model")));
  const Scene scaled = folder.load_scene(R"({"metres_per_unit": 0.001, "up": "z", )" + objects + "}");
  EXPECT_EQ(world_corners(scaled)[1], glm::dvec3(1000, 0, 0)) << "glTF is in metres";
  EXPECT_EQ(world_corners(scaled)[4], glm::dvec3(1, 0, 0)) << "STL says no unit, so it has the scene's";
  EXPECT_EQ(scaled.source.metres_per_unit, 0.001);
  EXPECT_EQ(scaled.up, Axis::z);
  EXPECT_THAT(scaled.warnings, testing::IsEmpty());
  const Scene told = folder.load_scene(R"({"metres_per_unit": 0.001, "up": "z", "objects": [
      {"model": "metre.gltf", "metres_per_unit": 0.01, "up": "y"}, {"model": "corner.stl", "up": "z"}]})");
  // y goes to z; a y-up model's front, towards z, goes to -y.
  EXPECT_EQ(world_corners(told)[1], glm::dvec3(10, 0, 0));
  EXPECT_EQ(world_corners(told)[2], glm::dvec3(0, 0, 20));
  EXPECT_EQ(world_corners(told)[5], glm::dvec3(0, 2, 0));
}

TEST(SceneFile, EveryAxisTurnsToEveryOther) {
  SceneFolder folder;
  const std::string axes[] = {"x", "y", "z", "-x", "-y", "-z"};
  for (int from = 0; from < 6; ++from)
    for (int to = 0; to < 6; ++to) {
      const Scene scene = folder.load_scene(
          R"({"up": ")" + axes[to] + R"(", "objects": [{"model": "corner.off", "up": ")" + axes[from] + R"("}]})");
      const glm::dmat4& turn = scene.instances[0].world_from_mesh;
      EXPECT_EQ(glm::dvec3(turn * glm::dvec4(direction(Axis(from)), 0)), direction(Axis(to))) << from << " to " << to;
      EXPECT_EQ(glm::determinant(turn), 1) << from << " to " << to;
    }
}

TEST(SceneFile, CategoriesAreListedOrCountedAsTheyCome) {
  SceneFolder folder;
  const std::string objects = R"("objects": [{"model": "corner.off", "category": "bowl"}, {"model": "corner.off"},
      {"model": "corner.off", "category": "cup"}, {"model": "corner.off", "category": "bowl"}])";
  const Scene counted = folder.load_scene("{" + objects + "}");
  ASSERT_EQ(counted.categories.size(), 2u);
  EXPECT_EQ(counted.categories[0].name, "bowl");
  EXPECT_EQ(counted.categories[0].number, 1u);
  EXPECT_EQ(counted.instances[0].category, 0u);
  EXPECT_EQ(counted.instances[1].category, no_index);
  EXPECT_EQ(counted.instances[2].category, 1u);
  const Scene listed = folder.load_scene(R"({"categories": ["cup", {"name": "bowl", "number": 17}], )" + objects + "}");
  EXPECT_EQ(listed.categories[0].number, 1u);
  EXPECT_EQ(listed.categories[listed.instances[3].category].number, 17u);
  EXPECT_THAT(folder.error_of(R"({"categories": ["cup"], )" + objects + "}"),
              testing::StrEq(R"(objects[0].category: "bowl" is none of the file's categories)"));
}

TEST(SceneFile, MaterialsReplaceThoseOfModelsAllOrByName) {
  SceneFolder folder;
  const Scene scene = folder.load_scene(R"({"materials": {"red": {"color": "#ff0000", "roughness": 0.2, "opacity": 0.5},
      "gold": {"color": [1, 0.5, 0], "metallic": 1, "unlit": true}}, "objects": [
      {"model": "pair.obj"}, {"model": "pair.obj", "material": "red"}, {"model": "pair.obj", "material": {"glass": "gold"}},
      {"model": "pair.obj", "material": "red"}]})");
  EXPECT_EQ(scene.meshes.size(), 3u) << "one for each look";
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[3].mesh);
  const auto material = [&](int object, std::uint32_t triangle) {
    return scene.materials[scene.meshes[scene.instances[object].mesh].material_of(triangle)];
  };
  EXPECT_EQ(material(0, 0).name, "steel");
  EXPECT_EQ(material(0, 1).name, "glass");
  EXPECT_EQ(material(1, 0).name, "red");
  EXPECT_EQ(material(1, 1).base_color, glm::vec4(1, 0, 0, 0.5f));
  EXPECT_EQ(material(1, 1).alpha, Material::Alpha::blend);
  EXPECT_EQ(material(1, 1).roughness, 0.2f);
  EXPECT_EQ(material(2, 0).name, "steel");
  EXPECT_EQ(material(2, 1).name, "gold");
  EXPECT_EQ(material(2, 1).metallic, 1);
  EXPECT_TRUE(material(2, 1).unlit);
  EXPECT_NEAR(material(2, 1).base_color.g, 0.2140, 1e-4) << "colours are sRGB";
}

TEST(SceneFile, PartsAreOneObjectUnlessTheyStayApart) {
  SceneFolder folder;
  const Scene scene = folder.load_objects(R"({"model": "pair.obj", "name": "pair", "category": "thing"},
      {"model": "pair.obj", "name": "pair", "parts": "apart", "translation": [0, 0, 0], "category": "thing"})");
  EXPECT_THAT(names_of(scene), ElementsAre("pair", "pair/left", "pair/right"));
  for (const Instance& instance : scene.instances) EXPECT_EQ(instance.category, 0u);
  const std::vector<glm::dvec3> corners = world_corners(scene);
  ASSERT_EQ(corners.size(), 12u);
  EXPECT_TRUE(std::equal(corners.begin(), corners.begin() + 6, corners.begin() + 6));
}

TEST(SceneFile, CamerasAndLightsComeWithTheirModels) {
  SceneFolder folder;
  folder.write("lamp.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 3, "range": 5}]}},
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}}],
      "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 1, 0]}, {"camera": 0}]})");
  const Scene scene = folder.load_objects(R"({"model": "lamp.gltf", "scale": 2, "rotation": [0,-1,0, 1,0,0, 0,0,1]},
                                             {"model": "lamp.gltf"})");
  ASSERT_EQ(scene.lights.size(), 2u);
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(glm::dvec3(scene.lights[0].world_from_light[3]), glm::dvec3(-2, 0, 0));
  EXPECT_EQ(scene.lights[0].intensity, 12) << "twice as far away, as bright as before";
  EXPECT_EQ(scene.lights[0].range, 10);
  EXPECT_EQ(glm::dvec3(scene.cameras[0].world_from_eye[0]), glm::dvec3(0, 1, 0)) << "turned, and no longer scaled";
  EXPECT_EQ(scene.cameras[0].near, 1.0);
  EXPECT_EQ(scene.lights[1].intensity, 3);
}

TEST(SceneFile, ModelsFarFromZeroKeepTheirDetails) {
  SceneFolder folder;
  folder.write("survey.obj", "v 5400000.25 3 0\nv 5400100.5 3 0\nv 5400000.25 90 7\nf 1 2 3\n");
  const Scene scene = folder.load_objects(R"({"model": "survey.obj", "translation": [0, 1, 0]})");
  EXPECT_EQ(scene.origin, glm::dvec3(5400000, 0, 0));
  EXPECT_EQ(world_corners(scene)[0], glm::dvec3(5400000.25, 4, 0));
}

TEST(SceneFile, AreKnownByTheirContentWhereThereIsNoName) {
  const std::string text = R"({"objects": [{"model": "builtin:cubes", "name": "cubes"}]})";
  const Scene scene = load(std::as_bytes(std::span(text)), "memory");
  EXPECT_EQ(scene.source.format, ModelFormat::scene);
  EXPECT_EQ(scene.instances.size(), 1u);
  const std::vector<glm::dvec3> one = world_corners(scene), both = world_corners(builtin("cubes"));
  ASSERT_EQ(one.size(), both.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_LT(glm::distance(one[i], both[i]), 1e-6) << i;
}

}  // namespace
}  // namespace frontmost::test
