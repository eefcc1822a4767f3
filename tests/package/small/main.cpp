// SPDX-License-Identifier: Apache-2.0
// A z-buffer of meshes that the program generates, with the parts core and methods only.
#include <frontmost/core.h>
#include <frontmost/methods.h>

#include <cstdio>

int main() {
  frontmost::Scene scene;
  scene.meshes.push_back({.positions = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}}, .triangles = {{0, 1, 2}}});
  scene.instances.push_back({.mesh = 0});
  frontmost::Instance nearer{.mesh = 0};
  nearer.world_from_mesh[3] = {0.5, -1, 0.5, 1};
  scene.instances.push_back(nearer);
  const frontmost::Surfaces surfaces(scene);
  const frontmost::View view = frontmost::frame(surfaces, 24, 12);
  const frontmost::Visible visible = frontmost::zbuffer(surfaces, view);
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const frontmost::PrimitiveId id = visible.primitives[std::size_t(y * view.width + x)];
      std::putchar(id == frontmost::no_primitive ? '.' : char('0' + id));
    }
    std::putchar('\n');
  }
}
