// SPDX-License-Identifier: Apache-2.0
// A shaded figure of polygons: figure engine.glb engine.svg engine.pdf
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 4) throw Error(ErrorCode::bad_argument, "give MODEL SVG PDF");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const Figure figure = draw_figure(surfaces, frame(surfaces, 640, 480));
  save(figure, arguments[2]);
  save(figure, arguments[3]);
} catch (const Error& error) {
  std::fprintf(stderr, "figure: %s\n", error.what());
  return 1;
}
