// SPDX-License-Identifier: Apache-2.0
// Invalid scenes are refused with a message that names the place; odd but valid scenes are accepted.
#include "scene/validate.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "support/refusal.h"

namespace frontmost {
namespace {

/// Two triangles with every field that holds numbers, all valid.
Scene good_scene() {
  Scene scene;
  scene.name = "part.glb";
  Mesh mesh;
  mesh.name = "plate";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.normals.values = {{0, 0, 1}};
  mesh.normals.triangles = {{0, 0, 0}, {0, 0, 0}};
  mesh.texcoords.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.material_ids = {0, 1};
  mesh.face_ids = {7, 7};
  scene.meshes = {mesh};
  scene.instances = {{"one", 0, glm::dmat4(1)}};
  scene.materials.resize(2);
  scene.materials[1].name = "steel";
  scene.materials[1].base_color_texture.texture = 0;
  scene.textures.resize(1);
  scene.textures[0].name = "scratches";
  scene.textures[0].width = 2;
  scene.textures[0].height = 1;
  scene.textures[0].pixels.resize(2);
  return scene;
}

std::string complaint(const Scene& scene, ErrorCode code = ErrorCode::file_malformed) {
  return test::refusal_of(code, [&] { validate(scene); });
}

struct Fault {
  const char* words;
  std::function<void(Scene&)> make;
};

TEST(Validate, NamesTheFileThePlaceAndTheReason) {
  const Fault faults[] = {
      {"part.glb: mesh 0 (plate): triangle 1: vertex 4 is out of range, there are 4",
       [](Scene& s) { s.meshes[0].triangles[1].z = 4; }},
      {"part.glb: mesh 0: triangle 0: vertex 4294967295 is out of range, there are 4",
       [](Scene& s) {
         s.meshes[0].name.clear();
         s.meshes[0].triangles[0].y = no_index;
       }},
      {"part.glb: mesh 0 (plate): triangle 1: normal 1 is out of range, there are 1",
       [](Scene& s) { s.meshes[0].normals.triangles[1].x = 1; }},
      {"part.glb: mesh 0 (plate): corners of normals do not match the triangles",
       [](Scene& s) { s.meshes[0].normals.triangles.pop_back(); }},
      {"part.glb: mesh 0 (plate): fewer texture coordinates than positions",
       [](Scene& s) { s.meshes[0].texcoords.values.pop_back(); }},
      {"part.glb: mesh 0 (plate): fewer colours than positions",
       [](Scene& s) { s.meshes[0].colors.values.assign(3, glm::vec4(1)); }},
      {"part.glb: mesh 0 (plate): material ids do not match the triangles",
       [](Scene& s) { s.meshes[0].material_ids.push_back(0); }},
      {"part.glb: mesh 0 (plate): material 2 does not exist", [](Scene& s) { s.meshes[0].material_ids[1] = 2; }},
      {"part.glb: mesh 0 (plate): face ids do not match the triangles",
       [](Scene& s) { s.meshes[0].face_ids.push_back(1); }},
      {"part.glb: mesh 0 (plate): a curved mesh has more than one material",
       [](Scene& s) { s.meshes[0].spheres.push_back({}); }},
      {"part.glb: mesh 0 (plate): fewer further texture coordinates than positions",
       [](Scene& s) {
         s.meshes[0].further_texcoords = {{}, {{{0, 0}}, {}}};
       }},
      {"part.glb: mesh 0 (plate): more than 4 sets of texture coordinates",
       [](Scene& s) { s.meshes[0].further_texcoords.resize(max_texcoord_sets); }},
      {"part.glb: material steel: texture 1 does not exist",
       [](Scene& s) { s.materials[1].base_color_texture.texture = 1; }},
      {"part.glb: material steel: texture 9 does not exist",
       [](Scene& s) { s.materials[1].occlusion_texture.texture = 9; }},
      {"part.glb: texture scratches: pixels do not match its size", [](Scene& s) { s.textures[0].pixels.pop_back(); }},
      {"part.glb: texture scratches: pixels do not match its size", [](Scene& s) { s.textures[0].height = -1; }},
      {"part.glb: instance 0: mesh 1 does not exist", [](Scene& s) { s.instances[0].mesh = 1; }},
      {"part.glb: instance 0: category 0 does not exist", [](Scene& s) { s.instances[0].category = 0; }},
  };
  EXPECT_EQ(complaint(good_scene()), "none");
  for (const Fault& fault : faults) {
    Scene scene = good_scene();
    fault.make(scene);
    EXPECT_EQ(complaint(scene), fault.words);
  }
}

TEST(Validate, EveryTextureOfAMaterialIsLookedAt) {
  Scene scene = good_scene();
  for (TextureUse* const use : texture_uses_of(scene.materials[0])) {
    use->texture = 1;
    EXPECT_EQ(complaint(scene), "part.glb: material : texture 1 does not exist");
    *use = {.texture = 0, .set = max_texcoord_sets - 1};
    EXPECT_EQ(complaint(scene), "none") << "the mesh need not have it";
    use->set = max_texcoord_sets;
    EXPECT_EQ(complaint(scene), "part.glb: material : texture coordinates 4, there are at most 4 sets");
    *use = {};
    EXPECT_EQ(complaint(scene), "none");
  }
}

TEST(Validate, OddScenesAreFine) {
  EXPECT_EQ(complaint(Scene{}), "none");
  Scene scene = good_scene();
  scene.meshes[0].positions[2] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  scene.meshes[0].triangles[1] = {0, 0, 0};
  scene.meshes[0].material_ids = {no_index, 1};
  scene.meshes[0].texcoords.values.resize(9);  // more than positions: the rest is never used
  scene.textures[0] = {};
  scene.meshes.emplace_back();  // without triangles, but with an instance
  scene.instances.push_back({"empty", 1, glm::dmat4(0)});
  EXPECT_EQ(complaint(scene), "none");
}

TEST(Validate, MoreTrianglesThanIdsAreALimit) {
  // 2^16 - 1 instances of 2^16 + 1 triangles have 2^32 - 1 triangles, which would use up the id that means "none".
  Scene scene;
  scene.name = "crowd";
  scene.meshes.resize(1);
  scene.meshes[0].positions.resize(1);
  scene.meshes[0].triangles.assign((1u << 16) + 1, glm::uvec3(0));
  scene.instances.assign((1u << 16) - 1, {"", 0, glm::dmat4(1)});
  EXPECT_EQ(triangle_count(scene), 4294967295u);
  EXPECT_EQ(complaint(scene, ErrorCode::limit_exceeded), "crowd: more than 4294967294 triangles over all instances");
  scene.meshes.emplace_back();
  scene.instances.back().mesh = 1;
  EXPECT_EQ(complaint(scene), "none");
}

TEST(Validate, WhoLooksAtVerticesAnywayMayLeaveThemOut) {
  Scene scene = good_scene();
  scene.meshes[0].triangles[0].x = 77;
  EXPECT_NO_THROW(validate_besides_vertices(scene));
  scene.meshes[0].face_ids.clear();
  scene.meshes[0].material_ids = {5};
  EXPECT_THROW(validate_besides_vertices(scene), Error);
}

TEST(Scene, AxesAreUnitVectorsAndTheirOpposites) {
  EXPECT_EQ(direction(Axis::x), glm::dvec3(1, 0, 0));
  EXPECT_EQ(direction(Axis::y), glm::dvec3(0, 1, 0));
  EXPECT_EQ(direction(Axis::z), glm::dvec3(0, 0, 1));
  EXPECT_EQ(direction(Axis::minus_x), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(direction(Axis::minus_y), glm::dvec3(0, -1, 0));
  EXPECT_EQ(direction(Axis::minus_z), glm::dvec3(0, 0, -1));
}

TEST(Scene, CountsOverInstancesAndPassesOverMeshesThatDoNotExist) {
  Scene scene = good_scene();
  scene.instances.push_back({"two", 0, glm::dmat4(2)});
  EXPECT_EQ(triangle_count(scene), 4u);
  scene.instances.push_back({"nowhere", 3, glm::dmat4(1)});
  EXPECT_EQ(triangle_count(scene), 4u);
  EXPECT_EQ(triangle_count(Scene{}), 0u);
}

TEST(Validate, NamesTheLightThatGivesNoLight) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto lit_by = [](const std::function<void(Light&)>& change) {
    Scene scene = good_scene();
    scene.lights.resize(2);
    scene.lights[1].name = "lamp";
    scene.lights[1].kind = Light::Kind::spot;
    change(scene.lights[1]);
    return complaint(scene);
  };
  const std::string who = "part.glb: light 1 (lamp): ";
  EXPECT_EQ(lit_by([](Light&) {}), "none");
  for (const double bad : {-1.0, nan, infinity}) {
    EXPECT_EQ(lit_by([&](Light& l) { l.intensity = bad; }), who + "its intensity is not a number of at least 0");
    EXPECT_EQ(lit_by([&](Light& l) { l.color.y = float(bad); }), who + "its colour is not three numbers of at least 0");
    EXPECT_EQ(lit_by([&](Light& l) { l.range = bad; }), who + "its range is not a positive number");
  }
  const std::string cones =
      "its cone angles are not between 0 and 90 degrees, or the inner one is greater than the outer one";
  EXPECT_EQ(lit_by([](Light& l) { l.inner_cone = 1; }), who + cones) << "reversed: the outer one is 45 degrees";
  EXPECT_EQ(lit_by([](Light& l) { l.outer_cone = 1.6; }), who + cones);
  EXPECT_EQ(lit_by([](Light& l) { l.outer_cone = 0; }), who + cones);
  EXPECT_EQ(lit_by([&](Light& l) { l.inner_cone = nan; }), who + cones);
  EXPECT_EQ(lit_by([](Light& l) { l.world_from_light[1] *= 2; }), who + "its placement is not rigid");
  EXPECT_EQ(lit_by([](Light& l) { l.world_from_light[2] = glm::dvec4(0); }), who + "its placement is not rigid");
  EXPECT_EQ(lit_by([&](Light& l) { l.world_from_light[3].x = nan; }), who + "its placement is not rigid");
}

TEST(Scene, AMeshThatIsAddedIsPlaced) {
  Scene scene = good_scene();
  Mesh mesh = scene.meshes[0];
  mesh.name = "added";
  mesh.material_ids.clear();
  EXPECT_EQ(add(scene, mesh, glm::dmat4(2)), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances.back().name, "added");
  EXPECT_EQ(scene.instances.back().mesh, scene.meshes.size() - 1);
  EXPECT_EQ(scene.instances.back().world_from_mesh, glm::dmat4(2));
  EXPECT_EQ(complaint(scene), "none");
}

TEST(Scene, AddedPartsCountOn) {
  Scene scene = good_scene();
  Scene part = good_scene();
  part.meshes[0].material_ids = {no_index, 1};
  part.meshes[0].further_texcoords = {part.meshes[0].texcoords};
  part.materials[1].volume.thickness_texture = {.texture = 0, .set = 1};
  part.cameras.emplace_back();
  part.lights.emplace_back();
  part.warnings = {"odd"};
  add(scene, part);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].material_ids, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(scene.meshes[1].material_ids, (std::vector<std::uint32_t>{no_index, 3}));
  EXPECT_EQ(scene.instances[1].mesh, 1u);
  EXPECT_EQ(scene.materials[3].base_color_texture.texture, 1u);
  EXPECT_EQ(scene.materials[3].volume.thickness_texture.texture, 1u);
  EXPECT_EQ(scene.materials[3].volume.thickness_texture.set, 1u);
  EXPECT_EQ(scene.meshes[1].texcoord_set(1)->values, scene.meshes[0].texcoords.values);
  EXPECT_FALSE(scene.materials[2].base_color_texture.is_set());
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"odd"});
  EXPECT_EQ(triangle_count(scene), 4u);
  EXPECT_EQ(complaint(scene), "none");
}

}  // namespace
}  // namespace frontmost
