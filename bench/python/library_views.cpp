// SPDX-License-Identifier: Apache-2.0
// The library's own time for the work of bench/python/module.py. `library_views MODEL VIEWS` prints processor
// milliseconds per view, for drawing and for drawing with planar depths, at 640x480 on one thread.
#include <frontmost/frontmost.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

int main(int argument_count, char** arguments) {
  using namespace frontmost;
  if (argument_count != 3) return 2;
  const Scene scene = load(arguments[1]);
  const int views = std::atoi(arguments[2]);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 640, 480);
  const Execution one{1};
  ZBuffer buffer;
  for (int i = 0; i < 20; ++i) buffer.draw(surfaces, view, one);
  const std::clock_t begin = std::clock();
  for (int i = 0; i < views; ++i) buffer.draw(surfaces, view, one);
  const std::clock_t middle = std::clock();
  float nearest = 0;
  for (int i = 0; i < views; ++i) nearest += depth_image(buffer.draw(surfaces, view, one)).channels[0].floats()[0];
  const std::clock_t end = std::clock();
  const auto ms = [&](std::clock_t from, std::clock_t to) {
    return 1000.0 * double(to - from) / CLOCKS_PER_SEC / views;
  };
  std::printf("%.4f %.4f %d\n", ms(begin, middle), ms(middle, end), nearest > 0);
}
