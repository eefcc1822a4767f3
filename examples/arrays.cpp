// SPDX-License-Identifier: Apache-2.0
// Draws arrays of positions and triangles: arrays pyramid.png
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 2) throw Error(ErrorCode::bad_argument, "give PICTURE");
  Mesh mesh;
  mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1.5, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}};
  Scene scene;
  add(scene, mesh);
  const Surfaces surfaces(scene);
  save(shade(surfaces, zbuffer(surfaces, frame(surfaces, 640, 480, {.samples = 4}))), arguments[1]);
} catch (const Error& error) {
  std::fprintf(stderr, "arrays: %s\n", error.what());
  return 1;
}
