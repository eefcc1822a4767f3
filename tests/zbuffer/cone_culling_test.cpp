// SPDX-License-Identifier: Apache-2.0
// Whole clusters that face away may be culled only if none of their triangles would be drawn. The area on the snapped
// screen decides, however small the triangles and however far the origin.

#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/meshes.h"
#include "support/oracle.h"
#include "support/same_visible.h"
#include "view/clip.h"
#include "zbuffer/frame_plan.h"

namespace frontmost::test {
namespace {

using namespace zbuffer_detail;

/// The scene scaled by `size` and moved to `place`.
Scene placed(Mesh mesh, double size, const glm::dvec3& place, bool is_mirrored) {
  Scene scene = scene_of(std::move(mesh));
  glm::dmat4& m = scene.instances[0].world_from_mesh;
  m = glm::dmat4(size);
  m[0][0] = is_mirrored ? -size : size;
  m[3] = glm::dvec4(place, 1);
  return scene;
}

/// A view of a ball of radius `size` about `place`, about `pixels` pixels wide.
View view_of_ball(Random& random, double size, const glm::dvec3& place, double pixels) {
  View view;
  view.width = 8 + random.below(60);
  view.height = 8 + random.below(60);
  const glm::dvec3 way = glm::normalize(glm::dvec3(random.point(1)) + glm::dvec3(0, 0, 1e-3));
  const double distance = size * (1.2 + 3 * random.unit());
  const glm::dvec3 aside = size * glm::dvec3(random.point(0.5f));
  view.world_from_eye = look_at(place + way * distance, place + aside, {0.1, 1, 0.2});
  const double per_pixel = 2 * size / pixels, x = per_pixel * view.width / 2, y = per_pixel * view.height / 2;
  const double near = 0.05 * size, far = 8 * size;
  view.projection = random.below(3) == 0 ? make_orthographic(-x, 0.8 * x, -y, y, {near, far})
                                         : make_projection(2 * std::atan(y / distance), x / y, {near, far});
  view.culling = random.below(2) ? Culling::back : Culling::front;
  return view;
}

std::vector<ClusterFate> fates(const Surfaces& surfaces, const View& view, bool with_cones, Isa isa) {
  const ClusterSet& set = cluster_set(surfaces);
  CullResult result;
  result.resize(set.clusters.size());
  const ScreenTransform transform(view);
  const CullInput input{set.boxes, with_cones ? &set.cones.get(set, {}) : nullptr, transform, view};
  cull_clusters(input, isa, 0, set.clusters.size(), result);
  std::vector<ClusterFate> fates;
  for (std::size_t i = 0; i < set.clusters.size(); ++i) fates.push_back(result.fate_of(i));
  return fates;
}

/// Whether any snapped triangle of a cluster is visible under the view's culling.
bool has_facing_triangle(const ClusterSet& set, const Cluster& cluster, const View& view) {
  const ScreenTransform t(view);
  std::vector<ScreenVertex> snapped;
  for (std::size_t v = cluster.first_vertex; v < cluster.first_vertex + cluster.vertex_count; ++v)
    snapped.push_back(snap(t, transform(t, {set.x[v], set.y[v], set.z[v]})));
  for (std::size_t i = cluster.first_triangle; i < cluster.first_triangle + cluster.triangle_count; ++i) {
    const ScreenVertex a = snapped[set.i0[i]], b = snapped[set.i1[i]], c = snapped[set.i2[i]];
    const std::int64_t area = std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(c.x - a.x) * (b.y - a.y);
    if (view.culling == Culling::back ? area < 0 : area > 0) return true;
  }
  return false;
}

struct Count {
  std::size_t culled = 0, facing_away = 0;
};

/// Culls with and without cones: clusters that only cones cull must hold no visible triangle.
Count check(const Surfaces& surfaces, const View& view, Isa isa) {
  const ClusterSet& set = cluster_set(surfaces);
  const std::vector<ClusterFate> without = fates(surfaces, view, false, isa), with = fates(surfaces, view, true, isa);
  Count count;
  for (std::size_t i = 0; i < without.size(); ++i) {
    if (with[i] != without[i]) {
      EXPECT_EQ(with[i], ClusterFate::culled);
      EXPECT_EQ(without[i], ClusterFate::whole);
      EXPECT_FALSE(has_facing_triangle(set, set.clusters[i], view)) << "cluster " << i;
      ++count.culled;
    }
    count.facing_away += without[i] == ClusterFate::whole && !has_facing_triangle(set, set.clusters[i], view);
  }
  return count;
}

TEST(ConeCulling, LeavesOutNothingThatFacesTheEye) {
  Count total;
  for (std::uint64_t seed = 0; seed < seeds(400); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::exp2(random.below(40) - 20);
    const glm::dvec3 place = glm::dvec3(random.point(1)) * size * (random.below(2) ? std::exp2(random.below(20)) : 0.0);
    const float roughness = std::exp2(-float(random.below(14)));
    const int steps = random.below(2) ? 12 : 40;
    const Scene scene = placed(bumpy_ball(steps, roughness / float(steps), seed), size, place, random.below(2));
    const Surfaces surfaces(scene);
    // A quarter of the circle has a fixed number of triangles: each takes a hundredth of a pixel to some tens of
    // pixels.
    const View view = view_of_ball(random, size, place, std::exp2(random.within(-1, 11)));
    for (const Isa isa : available_isas()) {
      const Count count = check(surfaces, view, isa);
      total.culled += count.culled;
      total.facing_away += count.facing_away;
    }
  }
  EXPECT_GT(total.culled, seeds(400)) << "of " << total.facing_away;
}

TEST(ConeCulling, EqualsTheOracle) {
  std::size_t seen = 0, culled = 0;
  for (std::uint64_t seed = 0; seed < seeds(60); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 1000);
    const glm::dvec3 place = glm::dvec3(random.point(1)) * (random.below(2) ? 1e4 : 0.0);
    const Scene scene = placed(bumpy_ball(12, 0.01f, seed), 1, place, random.below(2));
    const Surfaces surfaces(scene);
    const View view = view_of_ball(random, 1, place, std::exp2(random.within(1, 9)));
    culled += check(surfaces, view, Isa::best).culled;  // also makes the cones
    const Visible expected = oracle(surfaces, view);
    for (const PrimitiveId id : expected.primitives) seen += id != no_primitive;
    EXPECT_EQ(content_hash(draw_both_ways(surfaces, view)), content_hash(expected));
  }
  EXPECT_GT(seen, seeds(60) * 160);
  EXPECT_GT(culled, seeds(60) / 3);
}

TEST(ConeCulling, LeavesOutMostOfTheFarSideOfABall) {
  const Scene scene = scene_of(bumpy_ball(100, 0, 1));
  const Surfaces surfaces(scene);
  View view{900, 900, 1, look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}), make_projection(0.9, 1, {1, 10}), Culling::back};
  for (const Culling culling : {Culling::back, Culling::front}) {
    view.culling = culling;
    const Count count = check(surfaces, view, Isa::best);
    EXPECT_GT(count.culled, cluster_set(surfaces).clusters.size() / 5);
    EXPECT_GT(count.culled, count.facing_away * 8 / 10);
  }
}

// The picture is the same before and after the cones are made.
TEST(ConeCulling, FramesStayTheSame) {
  const Scene scene = scene_of(bumpy_ball(60, 0.003f, 1));
  const Surfaces surfaces(scene);
  const View view{300,          200, 1, look_at({0, 1, 3}, {0, 0, 0}, {0, 1, 0}), make_projection(0.9, 1.5, {1, 10}),
                  Culling::back};
  ZBuffer buffer;
  const std::uint64_t first = content_hash(buffer.draw(surfaces, view));
  for (int i = 0; i < 20; ++i) EXPECT_EQ(content_hash(buffer.draw(surfaces, view)), first);
  EXPECT_NE(cluster_set(surfaces).cones.made(), nullptr);
}

// A ZBuffer that draws new surfaces every few frames makes cones for none of them.
TEST(ConeCulling, FramesOfEachSetAreCounted) {
  const Scene scene = scene_of(bumpy_ball(20, 0.003f, 1));
  const View view{300,          200, 1, look_at({0, 1, 3}, {0, 0, 0}, {0, 1, 0}), make_projection(0.9, 1.5, {1, 10}),
                  Culling::back};
  ZBuffer buffer;
  for (int i = 0; i < 12; ++i) {
    const Surfaces surfaces(scene);
    for (int frame = 0; frame < 3; ++frame) buffer.draw(surfaces, view);
    EXPECT_EQ(cluster_set(surfaces).cones.made(), nullptr) << i;
  }
}

}  // namespace
}  // namespace frontmost::test
