// SPDX-License-Identifier: Apache-2.0
// The largest possible image, where fixed point and guard band reach their limits. Takes two gigabytes and a few
// seconds.

#include <gtest/gtest.h>

#include "frontmost/zbuffer.h"
#include "support/oracle.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

constexpr int kLargestSide = 16384;

/// Some rows of the picture, sample by sample, by the oracle's rules.
class RowOracle {
 public:
  RowOracle(const Surfaces& surfaces, const View& view) : transform_(view) {
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const ClippedPolygon polygon = clip_triangle(transform_, surfaces.corners(id));
      for (std::size_t k = 2; k < std::size_t(polygon.count); ++k)
        add(id, {polygon.corners[0], polygon.corners[k - 1], polygon.corners[k]});
    }
  }

  [[nodiscard]] PrimitiveId at(int x, int y) const {
    PrimitiveId best = no_primitive;
    float best_key = -1;
    for (const OracleTriangle& t : triangles_) {
      const std::int64_t px = 256 * std::int64_t(x) + 128, py = 256 * std::int64_t(y) + 128;
      if (!oracle_covers(t, px, py)) continue;
      const float key = oracle_key(t, px, py);
      if (key > best_key) best_key = key, best = t.id;
    }
    return best;
  }

 private:
  void add(PrimitiveId id, const std::array<ScreenVertex, 3>& corners) {
    OracleTriangle t{};
    t.id = id;
    for (std::size_t v = 0; v < 3; ++v) {
      t.x[v] = corners[v].x + transform_.centre_x;
      t.y[v] = corners[v].y + transform_.centre_y;
      t.key[v] = corners[v].key;
    }
    if (oracle_area(t) < 0) std::swap(t.x[1], t.x[2]), std::swap(t.y[1], t.y[2]), std::swap(t.key[1], t.key[2]);
    if (oracle_area(t) != 0) triangles_.push_back(t);
  }

  ScreenTransform transform_;
  std::vector<OracleTriangle> triangles_;
};

TEST(LargestImage, ComesOutRightInEveryCorner) {
  Mesh mesh;
  // Triangles beyond the picture on all sides, intersecting, and one that just fits.
  add_triangle(mesh, {-3, -2, 0.3f}, {4, -1, -0.6f}, {0.1f, 5, 0.2f});
  add_triangle(mesh, {-1, 1, -0.5f}, {-1, -1, 0.5f}, {1, 1, 0.1f});
  add_triangle(mesh, {0.5f, -0.5f, 0.8f}, {0.50001f, -0.49999f, 0.8f}, {0.5f, -0.49998f, 0.8f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const View view{kLargestSide,
                  kLargestSide,
                  1,
                  look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}),
                  make_frustum(-0.4, 0.4, -0.4, 0.4, {1, 9}),
                  {}};
  const Visible visible = zbuffer(surfaces, view);
  const RowOracle oracle(surfaces, view);
  std::size_t seen[4] = {};
  for (int y : {0, 1, 127, 128, 4095, 8191, 8192, 8193, 12000, 16256, 16382, 16383})
    for (int x = 0; x < kLargestSide; ++x) {
      const PrimitiveId id = visible.primitives[visible.index(x, y)];
      ASSERT_EQ(id, oracle.at(x, y)) << x << ", " << y;
      ++seen[id == no_primitive ? 3 : id];
    }
  EXPECT_GT(seen[0], 10'000u);
  EXPECT_GT(seen[1], 10'000u);
}

}  // namespace
}  // namespace frontmost::test
