// SPDX-License-Identifier: Apache-2.0
// The nearest surfaces, and the surfaces seen behind them through glass: glass_layers table.glb nearest.exr behind.exr
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 4) throw Error(ErrorCode::bad_argument, "give MODEL NEAREST BEHIND");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const std::vector<Visible> layers = visible_layers(surfaces, frame(surfaces, 640, 480), 2);
  for (int i = 0; i < 2; ++i) {
    save(depth_image(layers[std::size_t(i)]), arguments[2 + i]);
    std::size_t pixels = 0;
    for (const PrimitiveId id : layers[std::size_t(i)].primitives) pixels += id != no_primitive;
    std::printf("layer %d covers %zu pixels\n", i, pixels);
  }
} catch (const Error& error) {
  std::fprintf(stderr, "glass_layers: %s\n", error.what());
  return 1;
}
