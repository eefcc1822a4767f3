// SPDX-License-Identifier: Apache-2.0
// From ids through triangle set-up to fragments: attributes, instances, and the choice of large primitives.
#include "shade/geometry/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "frontmost/zbuffer.h"
#include "shade/support.h"
#include "support/interpolation.h"

namespace frontmost::shading {
namespace {

using namespace test;

TriangleSetup set_up_one(const TriangleSource& source, PrimitiveId id, const glm::vec2& reference) {
  std::vector<TriangleSetup> setups(1);
  const NewTriangle triangle{id, 0, reference};
  source.set_up({&triangle, 1}, setups);
  return setups[0];
}

/// Owns everything that a TriangleSource borrows.
struct World {
  Scene scene;
  Surfaces surfaces;
  Visible visible;
  BitSet large;
  TriangleStore store;
  TriangleSource source;

  explicit World(Scene s, const View& view = front_view())
      : scene(std::move(s)),
        surfaces(scene),
        visible(zbuffer(surfaces, view)),
        large(large_primitives(surfaces.primitive_count(), visible, {})),
        store(surfaces),
        source(store, view, &large) {
    store.smooth(large, {});
  }

  [[nodiscard]] TriangleSetup set_up(PrimitiveId id, const glm::vec2& reference = {32, 32}) const {
    return set_up_one(source, id, reference);
  }
};

TEST(SeenPrimitives, AreThoseThatHoldASample) {
  Scene scene = scene_of(square());
  scene.instances.push_back({"hidden", 0, glm::dmat4(0.5)});
  scene.instances[1].world_from_mesh[3] = {0, 0, -1, 1};
  scene.instances.push_back({"beside", 0, glm::dmat4(0.5)});
  scene.instances[2].world_from_mesh[3] = {1.5, 1.5, 0, 1};
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view(64, 4));
  for (const int threads : {1, 3}) {
    const BitSet seen = seen_primitives(surfaces.primitive_count(), visible.primitives, {.threads = threads});
    for (PrimitiveId id = 0; id < 6; ++id) {
      bool expected = false;
      for (const PrimitiveId other : visible.primitives) expected = expected || other == id;
      EXPECT_EQ(seen.contains(id), expected) << id;
    }
    EXPECT_FALSE(seen.contains(2));
  }
}

TEST(SeenMaterials, OfWholeMeshesAndOfSingleTriangles) {
  Scene scene = scene_of(square());
  scene.materials.assign(4, Material{});
  scene.meshes[0].material_ids = {2, no_index};
  scene.meshes.push_back(square());
  scene.meshes[1].material_ids = {1};
  scene.instances.push_back({"hidden", 1, glm::dmat4(0.5)});
  scene.instances[1].world_from_mesh[3] = {0, 0, -1, 1};
  const Surfaces surfaces(scene);
  const BitSet seen = seen_primitives(surfaces.primitive_count(), zbuffer(surfaces, front_view()).primitives, {});
  BitSet known(surfaces.primitive_count());
  EXPECT_EQ(seen_materials(surfaces, seen, known), (std::vector<bool>{false, false, true, false}));
  known.add_all(seen);
  EXPECT_TRUE(known.holds(seen));
  EXPECT_EQ(seen_materials(surfaces, seen, known), std::vector<bool>(4)) << "nothing is new";
  known.clear(surfaces.primitive_count());
  BitSet all(surfaces.primitive_count());
  for (std::size_t id = 0; id < surfaces.primitive_count(); ++id) all.add(id);
  EXPECT_EQ(seen_materials(surfaces, all, known), (std::vector<bool>{false, true, true, false}));
}

TEST(LargePrimitives, CoverThreePixelsInARowOrAroundACorner) {
  const Scene scene = scene_of(square());
  const Surfaces surfaces(scene);
  Visible visible;
  visible.view = front_view(8);
  const auto is_large = [&](std::initializer_list<glm::ivec2> pixels) {
    visible.primitives = Buffer<PrimitiveId>(64, no_primitive);
    visible.keys = Buffer<float>(64, 0.5f);
    for (const glm::ivec2& p : pixels) visible.primitives[visible.index(p.x, p.y)] = 1;
    return large_primitives(surfaces.primitive_count(), visible, {}).contains(1);
  };
  EXPECT_FALSE(is_large({{3, 3}}));
  EXPECT_FALSE(is_large({{3, 3}, {4, 3}}));
  EXPECT_FALSE(is_large({{3, 3}, {3, 4}}));
  EXPECT_FALSE(is_large({{3, 3}, {4, 4}, {5, 5}}));
  EXPECT_FALSE(is_large({{7, 3}, {0, 4}, {1, 4}}));  // rows do not continue into the next
  EXPECT_TRUE(is_large({{3, 3}, {4, 3}, {5, 3}}));
  EXPECT_TRUE(is_large({{0, 0}, {0, 1}, {0, 2}}));
  EXPECT_TRUE(is_large({{3, 3}, {2, 4}, {3, 4}}));
}

TEST(TriangleSource, MeshesWithoutNormalsAreSmoothOnlyWhereLarge) {
  // A roof of two squares that meet at 30 degrees, welded by position.
  Mesh roof;
  roof.positions = {{-1, -1, 0},     {0, -1, 0.268f}, {0, 1, 0.268f}, {-1, 1, 0},
                    {0, -1, 0.268f}, {1, -1, 0},      {1, 1, 0},      {0, 1, 0.268f}};
  roof.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const World world(scene_of(roof));
  ASSERT_TRUE(world.large.contains(0));
  const TriangleSetup large = world.set_up(0);
  EXPECT_TRUE(large.is_smooth);
  EXPECT_NEAR(large.normal[1].x, 0.0f, 0.02f);  // on the ridge: straight up
  EXPECT_LT(large.normal[0].x, -0.2f);          // at the eaves: the face's own normal
  const TriangleSource flat(world.store, front_view(), nullptr);
  const TriangleSetup setup = set_up_one(flat, 0, {32, 32});
  EXPECT_FALSE(setup.is_smooth);
  EXPECT_EQ(setup.normal[1], setup.plane_normal);
}

TEST(TriangleSource, NormalsOfAMeshAreTurnedTogetherToTheViewer) {
  Mesh mesh = square();
  mesh.normals.values.assign(4, glm::vec3(0.6f, 0, -0.8f));  // the winding faces the eye, the normals face away
  mesh.normals.values[1] = {1, 0, 0.1f};                     // one leans to the eye
  const TriangleSetup setup = World(scene_of(mesh)).set_up(0);
  EXPECT_LT(glm::length(setup.normal[0] - glm::vec3(-0.6f, 0, 0.8f)), 1e-6f);
  EXPECT_LT(setup.normal[1].z, 0.0f);
  EXPECT_FALSE(setup.is_backside);
}

TEST(TriangleSource, MissingNormalsAreThePlanes) {
  Mesh mesh = square();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.normals.values = {{0, 0, 0}, {nan, 0, 0}, {1, 0, 1}, {0, 0, 5}};
  const TriangleSetup setup = World(scene_of(mesh)).set_up(0);
  EXPECT_EQ(setup.normal[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(setup.normal[1], glm::vec3(0, 0, 1));
  EXPECT_NEAR(setup.normal[2].x, std::sqrt(0.5f), 1e-6f);
}

TEST(TriangleSource, AttributesFollowTheirOwnIndices) {
  Mesh mesh = square();
  mesh.texcoords.values = {{0.5f, 0.25f}, {1, 1}};
  mesh.texcoords.triangles = {{0, 1, 0}, {1, 1, 0}};
  mesh.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  const World world(scene_of(mesh));
  const TriangleSetup setup = world.set_up(1, {28, 28});
  EXPECT_EQ(setup.triangle, 1u);
  EXPECT_EQ(setup.texcoord[0][0], glm::vec2(1, 1));
  EXPECT_EQ(setup.texcoord[0][2], glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(setup.color[1], glm::vec4(0, 0, 1, 1));
}

TEST(TriangleSource, TextureCoordinatesCanBeLeftOut) {
  const World world(scene_of(square()));
  EXPECT_TRUE(world.set_up(0).has_texcoord[0]);
  const TriangleSource without(world.store, world.visible.view, &world.large, false);
  EXPECT_FALSE(set_up_one(without, 0, {32, 32}).has_texcoord[0]);
}

TEST(TriangleSource, InstancesKnowWhichSideIsSeen) {
  Scene scene = scene_of(square());
  for (const auto& [axes, is_backside] : {std::pair(glm::dvec3(1, 1, 1), false),
                                          {glm::dvec3(-1, 1, 1), false},
                                          {glm::dvec3(-1, 1, -1), true},
                                          {glm::dvec3(1, -1, -1), true},
                                          {glm::dvec3(1, 1, -1), true}}) {
    for (int k = 0; k < 3; ++k) {
      scene.instances[0].world_from_mesh[k] = glm::dvec4(0);
      scene.instances[0].world_from_mesh[k][k] = axes[k];
    }
    EXPECT_EQ(World(scene).set_up(0).is_backside, is_backside) << axes.x << axes.y << axes.z;
  }
}

TEST(InterpolateGeometry, AgreesWithTheFormulaOneByOne) {
  Mesh mesh = square();
  mesh.normals.values = {{-0.3f, -0.3f, 1}, {0.3f, -0.3f, 1}, {0.3f, 0.3f, 1}, {-0.3f, 0.3f, 1}};
  mesh.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 1}, {1, 1, 1, 0}};
  View view = front_view();
  view.projection = make_projection(0.5, 1, {1, 20});
  const World world(scene_of(mesh), view);
  const auto batch = std::make_unique<FragmentBatch>();
  const std::vector<TriangleSetup> setups{world.set_up(0, {36, 36}), world.set_up(1, {28, 28})};
  // Runs of 23, 1 and 16 fragments.
  for (int i = 0; i < 40; ++i) {
    const int triangle = i < 23 ? 0 : i < 24 ? 1 : 0;
    batch->coverage.triangle[i] = std::uint16_t(triangle);
    batch->coverage.screen.set(i, triangle == 0 ? glm::vec2(34 + i % 7, 36 + i % 5) : glm::vec2(26, 25));
  }
  batch->coverage.count = 40;
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    interpolate_geometry(world.source.rays(), setups, *batch, isa);
    for (int i = 0; i < 40; ++i) {
      const TriangleSetup& t = setups[batch->coverage.triangle[i]];
      const glm::vec2 screen = batch->coverage.screen.at(i);
      const Barycentric b = barycentric(t, screen.x, screen.y);
      const Geometry& g = batch->geometry;
      const glm::vec3 point = interpolate(t.corner, b.weight);
      ASSERT_EQ(g.position.at(i), point) << i;
      ASSERT_LT(glm::length(g.to_viewer.at(i) + glm::normalize(point)), 1e-6f);
      ASSERT_LT(glm::length(g.normal.at(i) - glm::normalize(interpolate(t.normal, b.weight))), 1e-6f);
      const glm::vec2 texcoord = interpolate(t.texcoord[0], b.weight);
      const Gradient change = gradient(t, t.texcoord[0], texcoord, b);
      ASSERT_EQ(g.texcoord.value.at(i), texcoord);
      ASSERT_EQ(g.texcoord.dx.at(i), change.dx);
      ASSERT_EQ(g.texcoord.dy.at(i), change.dy);
      ASSERT_EQ(glm::vec4(g.color.at(i), g.alpha[i]), interpolate(t.color, b.weight));
      ASSERT_EQ(g.plane_normal.at(i), t.plane_normal);
      // Diverging normals mean a bulge: the lifted point is in front of the flat one.
      ASSERT_GT(g.smooth_position.at(i).z, point.z);
    }
  }
}

}  // namespace
}  // namespace frontmost::shading
