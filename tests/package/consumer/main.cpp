// SPDX-License-Identifier: Apache-2.0
// Ten lines against the installed library.
#include <frontmost/frontmost.h>

#include <cstdio>

int main() {
  const frontmost::Scene scene = frontmost::load("builtin:teapot");
  const frontmost::Surfaces surfaces(scene);
  const frontmost::Visible visible = frontmost::zbuffer(surfaces, frontmost::frame(surfaces, 64, 48));
  frontmost::save(frontmost::depth_image(visible), "depth.png");
  std::printf("frontmost %s sees %016llx\n", FRONTMOST_VERSION, (unsigned long long)frontmost::content_hash(visible));
}
