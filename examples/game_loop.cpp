// SPDX-License-Identifier: Apache-2.0
// A street with moving boxes and a moving camera, where only objects that may be seen are drawn: game_loop city.glb
// [FRAMES]
#include <frontmost/frontmost.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 2 && count != 3) throw Error(ErrorCode::bad_argument, "give MODEL and, if you like, a number of frames");
  const int frames = count == 3 ? std::atoi(arguments[2]) : 120;
  Scene scene = load(arguments[1]);
  const Box town = Surfaces(scene).bounds();
  const glm::dvec3 middle = town.centre(), size = glm::dvec3(town.high) - glm::dvec3(town.low);

  // A hundred boxes drive around the middle, each on its own circle.
  const auto first_car = std::uint32_t(scene.instances.size()), cars = 100u;
  scene.meshes.push_back(builtin("cubes").meshes[0]);
  scene.meshes.back().material_ids.clear();
  for (std::uint32_t i = 0; i < cars; ++i)
    scene.instances.push_back({"car " + std::to_string(i), std::uint32_t(scene.meshes.size() - 1)});

  Surfaces surfaces(scene);
  Occlusion occlusion(surfaces);
  const glm::dvec3 up = direction(scene.up), across(up.y, up.z, up.x), along = glm::cross(up, across);
  const glm::dvec3 ground = middle - 0.46 * size * up;  // a little above the ground
  const auto on_circle = [&](double radius, double angle) {
    return radius * size * (std::cos(angle) * across + std::sin(angle) * along);
  };
  std::size_t drawn = 0, saved = 0;
  std::chrono::duration<double, std::milli> moving{0}, culling{0};
  for (int frame = 0; frame < frames; ++frame) {
    const auto start = std::chrono::steady_clock::now();
    for (std::uint32_t i = 0; i < cars; ++i) {
      glm::dmat4 place(0.002 * glm::length(size));
      place[3] = glm::dvec4(ground + on_circle(0.1 + 0.004 * i, 0.01 * frame + 0.7 * i), 1.0);
      surfaces.move(scene, first_car + i, place);
    }
    const auto moved = std::chrono::steady_clock::now();
    const glm::dvec3 eye = ground + on_circle(0.3, -0.004 * frame);
    const View view = make_view(0.9, 1280, 720).looking(eye, ground, up).enclosing(town);
    for (const ObjectSight sight : occlusion.cull(view)) {
      drawn += sight == ObjectSight::may_be_seen;  // here a game hands the object to its renderer
      saved += sight == ObjectSight::hidden;       // in the view volume, but behind other objects
    }
    const auto culled = std::chrono::steady_clock::now();
    moving += moved - start;
    culling += culled - moved;
  }
  const double all = double(surfaces.scene().instances.size()) * frames;
  std::printf("of %zu objects, %.1f %% are to be drawn; %.1f %% are hidden, the rest is beside the picture\n",
              surfaces.scene().instances.size(), 100 * double(drawn) / all, 100 * double(saved) / all);
  std::printf("a frame: %.3f ms to move %u boxes, %.3f ms to cull\n", moving.count() / frames, cars,
              culling.count() / frames);
} catch (const Error& error) {
  std::fprintf(stderr, "game_loop: %s\n", error.what());
  return 1;
}
