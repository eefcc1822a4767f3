// SPDX-License-Identifier: Apache-2.0
// Coverage masks against exact areas, and sums that must come out exactly.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "fragment_oracle.h"
#include "support/effort.h"
#include "support/flat_picture.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

int bits_of(std::uint64_t mask) { return __builtin_popcountll(mask); }

using Polygon = std::vector<glm::dvec2>;

/// The part of a convex polygon where coordinate `axis` is on the given side of a limit.
Polygon clipped(const Polygon& in, int axis, double limit, bool keep_greater) {
  Polygon out;
  const auto inside = [&](const glm::dvec2& p) { return keep_greater ? p[axis] >= limit : p[axis] <= limit; };
  for (std::size_t i = 0; i < in.size(); ++i) {
    const glm::dvec2 &a = in[i], &b = in[(i + 1) % in.size()];
    if (inside(a)) out.push_back(a);
    if (inside(a) != inside(b)) out.push_back(a + (b - a) * ((limit - a[axis]) / (b[axis] - a[axis])));
  }
  return out;
}

double area_in_pixel(const OracleTriangle& t, int x, int y) {
  const auto is_beside = [](const std::int64_t(&at)[3], std::int64_t pixel) {
    return *std::max_element(at, at + 3) < pixel * 256 || *std::min_element(at, at + 3) > (pixel + 1) * 256;
  };
  if (is_beside(t.x, x) || is_beside(t.y, y)) return 0;
  Polygon p;
  for (int k = 0; k < 3; ++k) p.push_back(glm::dvec2(double(t.x[k]), double(t.y[k])) / 256.0);
  p = clipped(clipped(clipped(clipped(p, 0, x, true), 0, x + 1, false), 1, y, true), 1, y + 1, false);
  double doubled = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2 &a = p[i], &b = p[(i + 1) % p.size()];
    doubled += a.x * b.y - a.y * b.x;
  }
  return doubled / 2;
}

View straight_view(int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.world_from_eye = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-1.2, 1.2, -1.2, 1.2, {0.5, 6});
  return view;
}

TEST(Coverage, IsNearTheExactArea) {
  // Errors at pixels cut by an edge. Measured: 0.068, 0.024, 0.0079 in the mean, and at most 0.43, 0.18, 0.073.
  const struct {
    int grid;
    double mean, worst;
  } bounds[] = {{2, 0.075, 0.5}, {4, 0.03, 0.25}, {8, 0.01, 0.11}};
  const Scene scene = scene_of(random_mesh(Kind::soup, 150, 5));
  const Surfaces surfaces(scene);
  const View view = straight_view(160, 160);
  const auto triangles = screen_triangles(surfaces, view);
  for (const auto& bound : bounds) {
    const FragmentLists lists = abuffer(surfaces, view, {bound.grid, 0.5f});
    double sum = 0, worst = 0;
    std::size_t cut = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x)
        for (const OracleTriangle& t : triangles) {
          const double area = area_in_pixel(t, x, y);
          if (area <= 0 || area >= 1) continue;
          int covered = 0;
          for (const Fragment& f : lists.at(x, y))
            if (f.primitive == t.id) covered += bits_of(f.mask);
          const double error = std::abs(covered / double(bound.grid * bound.grid) - area);
          sum += error;
          worst = std::max(worst, error);
          ++cut;
        }
    ASSERT_GT(cut, 5000u);
    EXPECT_LT(sum / double(cut), bound.mean) << bound.grid;
    EXPECT_LT(worst, bound.worst) << bound.grid;
    RecordProperty("mean_" + std::to_string(bound.grid), std::to_string(sum / double(cut)));
    RecordProperty("worst_" + std::to_string(bound.grid), std::to_string(worst));
  }
}

TEST(Coverage, OfASheetAddsUp) {
  // A sheet seen straight on covers every sub-sample inside exactly once.
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 400, 3));
  const Surfaces surfaces(scene);
  const View view = straight_view(97, 83);
  for (const int grid : {0, 2, 4, 8}) {
    const FragmentLists lists = abuffer(surfaces, view, {grid, 0.5f});
    std::size_t whole = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        std::uint64_t seen = 0;
        for (const Fragment& f : lists.at(x, y)) {
          ASSERT_EQ(seen & f.mask, 0u) << "covered twice in pixel " << x << ", " << y;
          seen |= f.mask;
        }
        whole += bits_of(seen) == int(lists.samples.size());
        // The grid reaches from -1 to 1, give or take its jitter.
        const bool is_inside = x > 12 && x < 84 && y > 10 && y < 72;
        if (!is_inside) continue;
        ASSERT_EQ(bits_of(seen), int(lists.samples.size())) << "hole in pixel " << x << ", " << y;
      }
    EXPECT_GT(whole, 4000u);
  }
}

TEST(Order, OfTrianglesDoesNotMatter) {
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Scene scene = scene_of(random_mesh(Kind::soup, 120, seed));
    std::vector<std::uint32_t> order(scene.meshes[0].triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[std::size_t(random.below(int(i) + 1))]);
    Scene reordered = scene;
    std::vector<glm::vec4> colors, reordered_colors;
    for (std::size_t i = 0; i < order.size(); ++i)
      colors.push_back({random.unit(), random.unit(), random.unit(), random.unit()});
    for (std::size_t i = 0; i < order.size(); ++i) {
      reordered.meshes[0].triangles[i] = scene.meshes[0].triangles[order[i]];
      reordered_colors.push_back(colors[order[i]]);
    }
    const View view = random_view(random, 120, 90);
    const Scene one = painted(scene, colors), two = painted(reordered, reordered_colors);
    const Surfaces a(one), b(two);
    const AbufferOptions options{seed % 2 ? 4 : 8};
    const FragmentLists lists = abuffer(a, view, options), others = abuffer(b, view, options);
    ASSERT_EQ(lists.fragments.size(), others.fragments.size());
    for (std::size_t i = 0; i < lists.fragments.size(); ++i) {
      ASSERT_EQ(lists.fragments[i].primitive, order[others.fragments[i].primitive]);
      ASSERT_EQ(lists.fragments[i].mask, others.fragments[i].mask);
      ASSERT_EQ(lists.fragments[i].key, others.fragments[i].key);
    }
    EXPECT_EQ(content_hash(flat_picture(a, view, options)), content_hash(flat_picture(b, view, options)));
  }
}

}  // namespace
}  // namespace frontmost::test
