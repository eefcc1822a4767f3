// SPDX-License-Identifier: Apache-2.0
// Finds which of a thousand places a watcher sees: line_of_sight city.glb
#include <frontmost/frontmost.h>

#include <algorithm>
#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 2) throw Error(ErrorCode::bad_argument, "give MODEL");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  const Box& box = surfaces.bounds();
  std::vector<Segment> lines;
  for (int i = 0; i < 1000; ++i)
    lines.push_back({box.high, glm::mix(box.low, box.high, glm::vec3(i % 10, i / 10 % 10, i / 100) / 9.0f)});
  std::vector<std::uint8_t> clear(lines.size());
  are_clear(index, lines, clear);
  std::printf("%td of 1000 places are seen\n", std::count(clear.begin(), clear.end(), 1));
} catch (const Error& error) {
  std::fprintf(stderr, "line_of_sight: %s\n", error.what());
  return 1;
}
