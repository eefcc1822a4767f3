// SPDX-License-Identifier: Apache-2.0
// Every STL, PLY, OBJ and OFF file of the model collection gives its known outcome.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "frontmost/files.h"
#include "support/models.h"

namespace frontmost {
namespace {

struct Known {
  const char* path;
  std::uint64_t triangles;
  std::size_t vertices;
  std::size_t objects;
};

// The collection's table, measured with another program. Objects that share vertices of an OBJ file get vertices of
// their own (pandora, spider, regr). wallhole has 66 = sum of (corners - 2) triangles.
constexpr Known known_files[] = {
    {"organic/stanford-bunny.obj", 69451, 35947, 1},
    {"organic/stanford-bunny-ascii.ply", 69451, 35947, 1},
    {"organic/stanford-bunny-binary.stl", 69451, 208353, 1},
    {"organic/armadillo-86k.obj", 86482, 43243, 1},
    {"organic/lucy-100k.ply", 99970, 49987, 1},
    {"organic/dragon-800k.ply", 798504, 399683, 1},
    {"cad/fandisk.obj", 12946, 6475, 1},
    {"cad/rocker-arm.obj", 20088, 10044, 1},
    {"cad/featuretype.stl", 3476, 10428, 1},
    {"cad/cycloidal-drive.ply", 43368, 21384, 1},
    {"cad/propeller-ascii.stl", 7375, 22125, 1},
    {"cad/angle-block.stl", 704, 2112, 1},
    {"cad/crank-arm.stl", 8458, 25374, 1},
    {"cad/as1.stl", 9868, 29604, 1},
    {"cad/two-cylinders.stl", 1916, 5748, 1},
    {"cad/torus.stl", 28800, 86400, 1},
    {"scenes/pandora.obj", 60810, 57279, 206},
    {"objects/ycb-banana.obj", 15728, 7866, 1},
    {"objects/ycb-cracker-box.obj", 15728, 7866, 1},
    {"objects/ycb-power-drill.obj", 15728, 7866, 1},
    {"difficult/self-intersect-a.obj", 17160, 8582, 1},
    {"difficult/nonmanifold-crash.obj", 1442, 717, 1},
    {"difficult/box-not-manifold.obj", 12, 9, 1},
    {"difficult/soup.stl", 100, 300, 1},
    {"difficult/quadknot.obj", 2880, 1440, 1},
    {"difficult/wallhole.obj", 66, 92, 1},
    {"difficult/polygonfaces.obj", 3, 5, 1},
    {"difficult/handmade/cyclic-overlap-3.obj", 6, 12, 3},
    {"difficult/handmade/interpenetrating-planes.obj", 6, 12, 3},
    {"difficult/handmade/coplanar-duplicates.obj", 14, 32, 7},
    {"difficult/handmade/degenerate.obj", 9, 18, 5},
    {"difficult/handmade/concave-ngons.obj", 30, 40, 5},
    {"difficult/handmade/t-junction.obj", 8, 16, 3},
    {"difficult/handmade/nested-boxes.obj", 44, 88, 4},
    {"reference/teapot/teapot.obj", 2464, 1292, 1},
    {"loader/obj-spider.obj", 1368, 762, 19},
    {"loader/ply-Wuson.ply", 3732, 11184, 1},
    {"loader/stl-Spider_binary.stl", 1368, 4104, 1},
    {"loader/assimp-obj/box.obj", 12, 8, 1},
    {"loader/assimp-obj/box_longline.obj", 944, 8, 1},
    {"loader/assimp-obj/box_without_lineending.obj", 12, 8, 1},
    {"loader/assimp-obj/cube_mtllib_after_g.obj", 12, 8, 1},
    {"loader/assimp-obj/cube_with_vertexcolors.obj", 12, 8, 1},
    {"loader/assimp-obj/empty_mat.obj", 256, 130, 1},
    {"loader/assimp-obj/multiple_spaces.obj", 1, 4, 1},
    {"loader/assimp-obj/only_a_part_of_vertexcolors.obj", 3, 5, 1},
    {"loader/assimp-obj/regr_3429812.obj", 4, 10, 3},
    {"loader/assimp-obj/testline.obj", 0, 8, 1},
    {"loader/assimp-obj/testpoints.obj", 0, 8, 1},
    {"loader/assimp-invalid/malformed2.obj", 10, 8, 1},
    {"loader/assimp-ply/cube.ply", 12, 8, 1},
    {"loader/assimp-ply/cube_binary_header_with_RN_newline.ply", 12, 8, 1},
    {"loader/assimp-ply/cube_uv.ply", 12, 24, 1},
    {"loader/assimp-ply/points.ply", 0, 4, 1},
    {"loader/assimp-stl/formatDetection", 1, 3, 1},
    {"loader/assimp-stl/triangle.stl", 1, 3, 1},
    {"loader/assimp-stl/triangle_with_two_solids.stl", 2, 6, 2},
    {"loader/assimp-off/Cube.off", 12, 8, 1},
    {"loader/trimesh/comments.off", 12, 8, 1},
    {"loader/trimesh/cube_blender_uv.ply", 12, 24, 1},
    {"loader/trimesh/empty.obj", 0, 0, 0},
    {"loader/trimesh/emptyIO/ply_empty_header.ply", 0, 0, 1},
    {"loader/trimesh/emptyIO/stl_empty_bin.stl", 0, 0, 0},
    {"loader/trimesh/face_in_group_name.obj", 0, 1, 1},
    {"loader/trimesh/metadata.ply", 2, 4, 1},
    {"loader/trimesh/nancolor.obj", 12, 8, 1},
    {"loader/trimesh/negative_indices.obj", 12, 8, 1},
    {"loader/trimesh/plane.ply", 2, 4, 1},
    {"loader/trimesh/points_bin.ply", 0, 5, 1},
    {"loader/trimesh/singlevn.obj", 2, 4, 1},
    {"loader/trimesh/two_objects.obj", 16, 12, 2},
};

TEST(ModelFiles, AreReadWhole) {
  FRONTMOST_NEEDS_MODELS();
  for (const Known& known : known_files) {
    SCOPED_TRACE(known.path);
    const Scene scene = load(test::model(known.path));
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
    EXPECT_EQ(triangle_count(scene), known.triangles);
    EXPECT_EQ(vertices, known.vertices);
    EXPECT_EQ(scene.instances.size(), known.objects);
  }
}

TEST(ModelFiles, BrokenOnesNameFilePlaceAndReason) {
  FRONTMOST_NEEDS_MODELS();
  constexpr struct {
    const char *path, *reason;
  } broken[] = {
      {"loader/assimp-invalid/OutOfMemory.off", "line 2: 353535235358 vertices do not fit into the 293 bytes"},
      {"loader/assimp-invalid/empty.obj", "the file is empty"},
      {"loader/assimp-invalid/empty.ply", "the file is empty"},
      {"loader/assimp-off/invalid.off", "line 7: a face of 2 corners has too few"},
      {"loader/assimp-ply/issue623.ply", "line 14: vertex 0: the row has too few values"},
  };
  for (const auto& file : broken) {
    try {
      (void)load(test::model(file.path));
      ADD_FAILURE() << file.path << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_malformed);
      EXPECT_THAT(error.what(), testing::StartsWith(test::model(file.path) + ": "));
      EXPECT_THAT(error.what(), testing::HasSubstr(file.reason));
    }
  }
}

/// Vertices of all triangles, in order.
std::vector<glm::vec3> corners(const Scene& scene) {
  std::vector<glm::vec3> all;
  for (const Mesh& mesh : scene.meshes)
    for (const glm::uvec3& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) all.push_back(mesh.positions[t[k]]);
  return all;
}

TEST(ModelFiles, TheBunniesAgree) {
  FRONTMOST_NEEDS_MODELS();
  const Scene obj = load(test::model("organic/stanford-bunny.obj"));
  const Scene ply = load(test::model("organic/stanford-bunny-ascii.ply"));
  const Scene stl = load(test::model("organic/stanford-bunny-binary.stl"));
  EXPECT_EQ(obj.up, Axis::y);
  EXPECT_EQ(ply.up, Axis::y);
  EXPECT_EQ(stl.up, Axis::z);
  // The three files hold one scan, triangle by triangle. The OBJ was rounded to six decimals, and the STL was made from
  // it by a quarter turn about x in floats.
  const std::vector<glm::vec3> exact = corners(ply), rounded = corners(obj), turned = corners(stl);
  ASSERT_EQ(rounded.size(), exact.size());
  ASSERT_EQ(turned.size(), exact.size());
  float rounding = 0, turning = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    rounding = std::max(rounding, glm::length(rounded[i] - exact[i]));
    turning = std::max(turning, glm::length(turned[i] - glm::vec3(rounded[i].x, -rounded[i].z, rounded[i].y)));
  }
  EXPECT_LT(rounding, 1e-6f);
  EXPECT_LT(turning, 1e-7f);
}

}  // namespace
}  // namespace frontmost
