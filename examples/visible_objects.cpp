// SPDX-License-Identifier: Apache-2.0
// Which objects can be seen from here, and how many pixels each one covers.
//
//   visible_objects city.glb
#include <frontmost/frontmost.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

int main(int argument_count, char** arguments) {
  using namespace frontmost;
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: visible_objects MODEL\n");
    return 2;
  }
  try {
    const Scene scene = load(arguments[1]);
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, frame(surfaces, 640, 480));

    std::vector<std::size_t> pixels(scene.instances.size());
    for (const PrimitiveId id : visible.primitives) {
      if (id != no_primitive) ++pixels[surfaces.source(id).instance];
    }
    std::vector<std::size_t> order(pixels.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pixels[a] > pixels[b]; });
    for (const std::size_t i : order) std::printf("%8zu  %s\n", pixels[i], scene.instances[i].name.c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "visible_objects: %s\n", error.what());
    return 1;
  }
}
