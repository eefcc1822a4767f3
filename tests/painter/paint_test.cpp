// SPDX-License-Identifier: Apache-2.0
// Pictures painted from orders made by hand.
#include <algorithm>

#include "painter/painted.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// Cuts leave pieces without an edge long enough to have a direction. Such a piece covers its own place, and not the
/// whole pixel.
TEST(Paint, SliversOfCutsHoldNoSampleBesideThem) {
  Mesh mesh;
  for (const float z : {0.5f, 0.0f}) add_triangle(mesh, {-4, -4, z}, {4, -4, z}, {0, 6, z});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  PaintOrder order = painter(surfaces, view_from_above(true));
  ASSERT_EQ(ids_of(order), (std::vector<PrimitiveId>{1, 0}));
  const double left = 30.75, top = 30.875, width = 1.0 / 4096;
  order.polygons.push_back({1, 3, order.corners.size()});
  for (const glm::dvec2 at : {glm::dvec2(left, top), {left, top + width}, {left + width, top}})
    order.corners.push_back({glm::dvec3(at, 10), true});
  const Visible picture = paint(surfaces, order);
  EXPECT_EQ(std::count(picture.primitives.begin(), picture.primitives.end(), 1u), 0);
  EXPECT_EQ(check_agreement(surfaces, zbuffer(surfaces, order.view), picture).differing(), 0u);
}

}  // namespace
}  // namespace frontmost::test
