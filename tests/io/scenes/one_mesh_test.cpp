// SPDX-License-Identifier: Apache-2.0
// Joining the objects of a model into one mesh keeps vertices, attributes, materials and polygons.
#include <gtest/gtest.h>

#include "io/scenes/scene_file.h"
#include "io/scenes/scene_folder.h"

namespace frontmost::test {
namespace {

/// A quad of two triangles and a lone triangle, placed three times: unchanged, mirrored, and turned and enlarged.
Scene model_of_parts() {
  Scene scene;
  scene.name = "model";
  scene.materials.resize(3);
  Mesh quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  quad.face_ids = {0, 0};
  quad.material_ids = {1};
  quad.normals.values.assign(4, glm::vec3(0, 0, 1));
  quad.texcoords.values = {{0, 0}, {1, 0}, {1, 1}};
  quad.texcoords.triangles = {{0, 1, 2}, {2, 1, 0}};
  Mesh lone;
  lone.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 1}};
  lone.triangles = {{0, 1, 2}};
  lone.material_ids = {2};
  lone.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  lone.further_texcoords.resize(2);
  lone.further_texcoords[1].values = {{5, 5}, {6, 6}, {7, 7}};
  scene.meshes = {quad, lone};
  scene.instances = {{"quad", 0}, {"mirrored", 0}, {"lone", 1}};
  scene.instances[1].world_from_mesh[0][0] = -1;
  scene.instances[2].world_from_mesh = glm::dmat4({0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {4, 5, 6, 1});
  return scene;
}

TEST(OneMesh, HasTheTrianglesOfAllPartsInTheirOrder) {
  const Scene model = model_of_parts();
  Scene one;
  one.materials = model.materials;
  add(one, one_mesh(model));
  EXPECT_NO_THROW(validate(one));
  EXPECT_EQ(world_corners(one), world_corners(model));
  const Mesh& mesh = one.meshes[0];
  EXPECT_EQ(mesh.material_ids, (std::vector<std::uint32_t>{1, 1, 1, 1, 2}));
  EXPECT_EQ(mesh.face_ids, (std::vector<std::uint32_t>{0, 0, 1, 1, 2}));
}

TEST(OneMesh, KeepsStatedEdgesAndCircles) {
  Scene model = model_of_parts();
  model.meshes[0].sharp_edges = {{0, 1}, {1, 2}};
  model.meshes[0].edge_circles = {{{0.5, 0.5, 0}, {0, 0, 1}, 0.75, 1, 1}};
  model.meshes[1].smooth_edges = {{0, 2}};
  model.meshes[1].sharp_edges = {{1, 2}};
  model.meshes[1].edge_circles = {{{0, 1, 0}, {0, 0, 1}, 3, 0, 1}};
  Scene one;
  one.materials = model.materials;
  add(one, one_mesh(model));
  EXPECT_NO_THROW(validate(one));
  const Mesh& mesh = one.meshes[0];
  EXPECT_EQ(mesh.sharp_edges, (std::vector<glm::uvec2>{{0, 1}, {1, 2}, {4, 5}, {5, 6}, {9, 10}}));
  EXPECT_EQ(mesh.smooth_edges, (std::vector<glm::uvec2>{{8, 10}}));
  ASSERT_EQ(mesh.edge_circles.size(), 3u);
  EXPECT_EQ(mesh.edge_circles[1].centre, glm::dvec3(-0.5, 0.5, 0));
  EXPECT_EQ(mesh.edge_circles[1].first, 3u);
  EXPECT_EQ(mesh.edge_circles[2].centre, glm::dvec3(2, 5, 6)) << "turned, enlarged and moved";
  EXPECT_EQ(mesh.edge_circles[2].radius, 6);
  EXPECT_EQ(mesh.edge_circles[2].first, 4u);
  model.instances[2].world_from_mesh[0] *= 3;
  EXPECT_EQ(one_mesh(model).edge_circles.size(), 2u) << "an ellipse is no circle";
}

TEST(OneMesh, TurnsNormalsAndFillsWhatIsMissing) {
  const Scene model = model_of_parts();
  const Mesh mesh = one_mesh(model);
  const auto normal = [&](std::uint32_t t, int k) { return mesh.normals.values[mesh.corners(mesh.normals, t)[k]]; };
  EXPECT_EQ(normal(0, 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(normal(2, 0), glm::vec3(0, 0, 1)) << "mirrored across the plane that it is in";
  EXPECT_EQ(normal(4, 0), glm::vec3(0)) << "missing";
  const auto color = [&](std::uint32_t t, int k) { return mesh.colors.values[mesh.corners(mesh.colors, t)[k]]; };
  EXPECT_EQ(color(0, 0), glm::vec4(1));
  EXPECT_EQ(color(4, 1), glm::vec4(0, 1, 0, 1));
  const auto place = [&](std::uint32_t t, int k) { return mesh.texcoords.values[mesh.corners(mesh.texcoords, t)[k]]; };
  EXPECT_EQ(place(1, 0), glm::vec2(1, 1));
  EXPECT_EQ(place(2, 1), glm::vec2(1, 1)) << "the corners of mirrored triangles have changed places";
  EXPECT_EQ(place(4, 2), glm::vec2(0));
  EXPECT_EQ(mesh.texcoord_set(1), nullptr);
  ASSERT_NE(mesh.texcoord_set(2), nullptr);
  EXPECT_EQ(mesh.texcoord_set(2)->values[mesh.corners(*mesh.texcoord_set(2), 4)[2]], glm::vec2(7, 7));
}

TEST(OneMesh, MirrorsTurnNormalsAsTheyTurnSurfaces) {
  Scene model = model_of_parts();
  model.instances = {{"mirrored", 0}};
  model.instances[0].world_from_mesh = glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -2, 0}, {0, 0, 0, 1});
  const Mesh mesh = one_mesh(model);
  EXPECT_EQ(mesh.normals.values[0], glm::vec3(0, 0, -1)) << "what was outside stays outside";
  const std::vector<glm::dvec3> corners = [&] {
    Scene one;
    one.materials = model.materials;
    add(one, mesh);
    return world_corners(one);
  }();
  EXPECT_LT(glm::cross(corners[1] - corners[0], corners[2] - corners[0]).z, 0) << "and so do the corners' turns";
}

}  // namespace
}  // namespace frontmost::test
