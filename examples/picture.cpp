// SPDX-License-Identifier: Apache-2.0
// The whole path on one page: a model file in, a picture out.
//
//   picture engine.glb engine.png
#include <frontmost/frontmost.h>

#include <cstdio>

int main(int argument_count, char** arguments) {
  using namespace frontmost;
  if (argument_count != 3) {
    std::fprintf(stderr, "usage: picture MODEL PICTURE\n");
    return 2;
  }
  try {
    const Scene scene = load(arguments[1]);
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 640, 480, {.samples = 4});
    const Visible visible = zbuffer(surfaces, view);
    save(shade(surfaces, visible), arguments[2]);
  } catch (const Error& error) {
    std::fprintf(stderr, "picture: %s\n", error.what());
    return 1;
  }
}
