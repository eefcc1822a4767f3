// SPDX-License-Identifier: Apache-2.0
// The library's own time for what bench/python/module.py does: library_views MODEL VIEWS prints milliseconds a view of
// drawing, and of drawing and planar depths, at 640x480 on one thread.
#include <frontmost/frontmost.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argument_count, char** arguments) {
  using namespace frontmost;
  using Clock = std::chrono::steady_clock;
  if (argument_count != 3) return 2;
  const Scene scene = load(arguments[1]);
  const int views = std::atoi(arguments[2]);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 640, 480);
  const Execution one{1};
  ZBuffer buffer;
  for (int i = 0; i < 20; ++i) buffer.draw(surfaces, view, one);
  const auto begin = Clock::now();
  for (int i = 0; i < views; ++i) buffer.draw(surfaces, view, one);
  const auto middle = Clock::now();
  float nearest = 0;
  for (int i = 0; i < views; ++i) nearest += depth_image(buffer.draw(surfaces, view, one)).channels[0].floats()[0];
  const auto end = Clock::now();
  const auto ms = [&](auto from, auto to) {
    return std::chrono::duration<double, std::milli>(to - from).count() / views;
  };
  std::printf("%.4f %.4f %d\n", ms(begin, middle), ms(middle, end), nearest > 0);
}
