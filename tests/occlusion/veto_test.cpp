// SPDX-License-Identifier: Apache-2.0
// Shows why ends of surfaces matter. Culling by hand over the same meshes must give the same answers. Without ends, a
// cell counts as covered if its middle is; rays must then find wrong answers, or the rays would prove nothing.
#include <gtest/gtest.h>

#include "occlusion/by_hand.h"
#include "occlusion/hidden_scene.h"
#include "occlusion/sight_rays.h"

namespace frontmost {
namespace {

using namespace test;

TEST(OcclusionVeto, WithoutTheEndsOfSurfacesWhatIsSeenIsSaidToBeHidden) {
  std::size_t wrong = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const Scene scene = hidden_scene(60, seed);
    const Surfaces surfaces(scene);
    const View view = random_view(97, 61, seed);
    const int cell = 1 + int(seed % 4);
    Occlusion occlusion(surfaces);
    const auto expected = occlusion.cull(view, {.cell = cell});
    const auto by_hand = sights_by_hand(surfaces, view, cell, Ends::count);
    ASSERT_TRUE(std::equal(expected.begin(), expected.end(), by_hand.begin())) << seed;
    wrong += wrong_sights(surfaces, view, sights_by_hand(surfaces, view, cell, Ends::are_forgotten), {4000, seed});
  }
  EXPECT_GT(wrong, 30u);
}

}  // namespace
}  // namespace frontmost
