// SPDX-License-Identifier: Apache-2.0
// Spatial order of triangles, and packing and search of instances, runs and cells.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/random_scene.h"
#include "surfaces/cells.h"
#include "surfaces/spatial_order.h"

namespace frontmost::test {
namespace {

TEST(InstanceFinder, FindsWhatASearchFindsAlsoBetweenEmptyInstances) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    std::vector<PrimitiveId> first{0};
    for (int i = 0; i < 200; ++i) {
      // Many meshes have no triangles, some have hundreds: starting points every 64 ids fall on all kinds of places.
      const int kind = random.below(4);
      const int count = kind < 2 ? 0 : kind == 2 ? random.below(5) : random.below(300);
      first.push_back(first.back() + PrimitiveId(count));
    }
    if (first.back() == 0) continue;
    const InstanceFinder finder(first);
    for (PrimitiveId id = 0; id < first.back(); ++id) {
      const auto next = std::upper_bound(first.begin(), first.end(), id);
      ASSERT_EQ(finder.find(id), std::uint32_t(next - first.begin() - 1)) << seed << ": " << id;
    }
  }
}

TEST(TriangleRun, KeepsItsPartsToTheLastBit) {
  for (const PrimitiveId first : {0u, 1u, 0x7FFFFFFFu, 0x80000000u, no_primitive - 4})
    for (std::uint32_t count = 1; count <= TriangleRun::max_count; ++count)
      for (const std::uint32_t place : {0u, 1u, (1u << 30) - 1}) {
        const std::uint64_t packed = TriangleRun{first, count}.packed(place);
        const TriangleRun run = TriangleRun::unpacked(packed);
        EXPECT_EQ(run.first, first);
        EXPECT_EQ(run.count, count);
        EXPECT_EQ(std::uint32_t(packed >> 32) & ((1u << 30) - 1), place) << "the key that runs are sorted by";
      }
}

TEST(SpaceCell, UnpacksWhatWasPacked) {
  for (const std::uint32_t x : {0u, 1u, 512u, 1023u})
    for (const std::uint32_t y : {0u, 3u, 1023u})
      for (const std::uint32_t z : {0u, 700u, 1023u}) {
        const SpaceCell cell{x | y << SpaceCell::y_shift | z << SpaceCell::z_shift};
        EXPECT_EQ(cell.x(), x);
        EXPECT_EQ(cell.y(), y);
        EXPECT_EQ(cell.z(), z);
        EXPECT_TRUE(cell.is_near(cell));
      }
}

std::vector<PrimitiveId> first_primitives_of(const Scene& scene) {
  std::vector<PrimitiveId> first{0};
  for (const Instance& instance : scene.instances)
    first.push_back(first.back() + PrimitiveId(scene.meshes[instance.mesh].triangles.size()));
  return first;
}

TEST(SpatialOrder, HoldsEveryPrimitiveOnceInRunsOfOneInstance) {
  for (const Kind kind : all_kinds) {
    Scene scene = scene_of(random_mesh(kind, 500, 3));
    scene.meshes.push_back(random_mesh(Kind::soup, 333, 4));
    scene.meshes.emplace_back();  // none
    scene.instances.push_back({"empty", 2, glm::dmat4(1.0)});
    scene.instances.push_back({"second", 1, glm::dmat4(2.0)});
    scene.instances.push_back({"again", 0, glm::dmat4(0.5)});
    const std::vector<PrimitiveId> first = first_primitives_of(scene);
    const SpatialOrder order = spatial_order(place_scene(scene, {}), {});
    std::vector<int> seen(first.back(), 0);
    const InstanceFinder finder(first);
    for (const std::uint64_t bits : order.runs) {
      const TriangleRun run = TriangleRun::unpacked(bits);
      ASSERT_TRUE(run.count >= 1 && run.count <= TriangleRun::max_count);
      ASSERT_EQ(finder.find(run.first), finder.find(run.first + run.count - 1)) << "a run lies in one instance";
      for (std::uint32_t i = 0; i < run.count; ++i) ++seen[run.first + i];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size()));
    EXPECT_EQ(order.all_finite.size(), scene.instances.size());
  }
}

TEST(SpatialOrder, DoesNotDependOnThreadsOrInstructionSet) {
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 70'000, 3));
  const std::vector<PrimitiveId> first = first_primitives_of(scene);
  const SpatialOrder plain = spatial_order(place_scene(scene, {}), {.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas()) {
    const SpatialOrder other = spatial_order(place_scene(scene, {.isa = isa}), {.threads = 3, .isa = isa});
    ASSERT_EQ(other.runs.size(), plain.runs.size());
    EXPECT_TRUE(std::equal(plain.runs.begin(), plain.runs.end(), other.runs.begin())) << name(isa);
  }
}

// Neighbours in the order are neighbours in space: far nearer than random pairs.
TEST(SpatialOrder, BringsNeighboursTogether) {
  Scene scene = scene_of(random_mesh(Kind::tiny, 20'000, 9));  // in no order at all
  const std::vector<PrimitiveId> first = first_primitives_of(scene);
  const Mesh& mesh = scene.meshes[0];
  const auto place_of = [&](PrimitiveId id) { return mesh.positions[mesh.triangles[id].x]; };
  const SpatialOrder order = spatial_order(place_scene(scene, {}), {});
  double in_order = 0, in_file = 0;
  for (std::size_t i = 1; i < order.runs.size(); ++i)
    in_order += glm::distance(place_of(TriangleRun::unpacked(order.runs[i - 1]).first),
                              place_of(TriangleRun::unpacked(order.runs[i]).first));
  for (PrimitiveId id = 1; id < 20'000; ++id) in_file += glm::distance(place_of(id - 1), place_of(id));
  EXPECT_LT(in_order / double(order.runs.size()), 0.25 * in_file / 20'000);
}

TEST(SpatialOrder, TellsWhichInstancesHaveCornersThatAreNotFinite) {
  Scene scene = scene_of(random_mesh(Kind::soup, 50, 1));
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes[1].positions[7].y = std::nanf("");
  scene.instances.push_back({"broken", 1, glm::dmat4(1.0)});
  scene.instances.push_back({"whole", 0, glm::dmat4(1.0)});
  const SpatialOrder order = spatial_order(place_scene(scene, {}), {});
  EXPECT_NE(order.all_finite[0], 0);
  EXPECT_EQ(order.all_finite[1], 0);
  EXPECT_NE(order.all_finite[2], 0);
}

}  // namespace
}  // namespace frontmost::test
