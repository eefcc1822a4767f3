// SPDX-License-Identifier: Apache-2.0
// Counts the visible pixels of each object: visible_objects city.glb
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 2) throw Error(ErrorCode::bad_argument, "give MODEL");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, frame(surfaces, 640, 480));
  const auto pixels = count_pixels(id_image(surfaces, visible, IdKind::object), scene.instances.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
    std::printf("%8llu  %s\n", (unsigned long long)pixels[i], scene.instances[i].name.c_str());
} catch (const Error& error) {
  std::fprintf(stderr, "visible_objects: %s\n", error.what());
  return 1;
}
