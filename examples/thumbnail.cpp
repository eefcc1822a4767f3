// SPDX-License-Identifier: Apache-2.0
// A thumbnail of a model file: thumbnail engine.glb engine.png
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 3) throw Error(ErrorCode::bad_argument, "give MODEL PICTURE");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 256, 256, {.samples = 4});
  save(shade(surfaces, zbuffer(surfaces, view)), arguments[2]);
} catch (const Error& error) {
  std::fprintf(stderr, "thumbnail: %s\n", error.what());
  return 1;
}
