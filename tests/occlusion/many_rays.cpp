// SPDX-License-Identifier: Apache-2.0
// usage: occlusion_rays RAYS [FIRST]
// Casts at least RAYS rays into random scenes, from scene number FIRST on, and counts rays whose first hit is an object
// that culling calls hidden or outside. The exit status is 0 if there is none.
#include <cstdio>
#include <cstdlib>

#include "occlusion/hidden_scene.h"
#include "occlusion/sight_rays.h"

using namespace frontmost;
using namespace frontmost::test;

int main(int count, char** arguments) {
  constexpr int rays_in_scene = 40000;
  const std::uint64_t most = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1'000'000;
  std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 0;
  std::uint64_t rays = 0, hidden = 0, wrong = 0;
  for (; rays < most; rays += rays_in_scene, ++seed) {
    const Scene scene = hidden_scene(60, seed);
    const Surfaces surfaces(scene);
    const View view = random_view(97, 61, seed);
    Occlusion occlusion(surfaces);
    const auto sights = occlusion.cull(view, {.cell = 1 + int(seed % 4)});
    for (const ObjectSight sight : sights) hidden += sight == ObjectSight::hidden;
    wrong += wrong_sights(surfaces, view, sights, {rays_in_scene, seed});
  }
  std::printf("%llu rays, %llu objects hidden, %llu rays meet what is said not to be seen\n",
              static_cast<unsigned long long>(rays), static_cast<unsigned long long>(hidden),
              static_cast<unsigned long long>(wrong));
  return wrong == 0 && hidden > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
