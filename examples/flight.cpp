// SPDX-License-Identifier: Apache-2.0
// A camera flown around a model; frames share their memory: flight city.glb
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 2) throw Error(ErrorCode::bad_argument, "give MODEL");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const glm::dvec3 middle = surfaces.bounds().centre(), up = direction(scene.up);
  View view = frame(surfaces, 640, 480);
  ZBuffer buffer;
  for (int i = 0; i < 300; ++i) {
    const Visible& visible = buffer.draw(surfaces, view);
    if (i % 100 == 0) std::printf("frame %d: %016llx\n", i, (unsigned long long)content_hash(visible));
    const glm::dvec3 eye = view.eye() + 0.02 * glm::distance(view.eye(), middle) * view.right();
    view = view.looking(eye, middle, up).enclosing(surfaces.bounds());
  }
} catch (const Error& error) {
  std::fprintf(stderr, "flight: %s\n", error.what());
  return 1;
}
