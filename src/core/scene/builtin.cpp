// SPDX-License-Identifier: Apache-2.0
// The built-in scenes by name, three small classics of visibility (the teapot, two cubes through one another, and three
// triangles in a ring), and the spheres.
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "scene/compose.h"
#include "scene/shapes.h"
#include "scene/turn.h"

namespace frontmost {
namespace {

constexpr std::array<std::string_view, 6> kNames{"teapot", "cubes", "cycle", "city", "spheres", "gallery"};
constexpr std::array<Scene (*)(), kNames.size()> kMakers{make_teapot, make_cubes,   make_cycle,
                                                         make_city,   make_spheres, make_gallery};

}  // namespace

std::span<const std::string_view> builtin_names() { return kNames; }

Scene builtin(std::string_view name) {
  // Scenes are the same to the bit on every machine, so the caller's rounding mode must not matter either.
  const IeeeScope ieee;
  std::string known;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) {
      Scene scene = kMakers[i]();
      scene.name = name;
      return scene;
    }
    known += (i == 0 ? "" : ", ") + std::string(kNames[i]);
  }
  throw Error(ErrorCode::bad_argument, "builtin:" + std::string(name), "", "no such scene; there are " + known);
}

Scene make_teapot() {
  Scene scene;
  const auto porcelain = add(scene, paint("porcelain", 0xEDE6D8, 0.28f));
  place(scene, "teapot", add(scene, "teapot", teapot(10), porcelain));
  scene.cameras.push_back(camera_at("classic", {2.6, 4.9, 8.4}, {0.2, 1.4, 0}, 32));
  return scene;
}

// The second cube is turned by the angle of the 3-4-5 triangle about y, and pushed half its width along every axis. So
// each cube cuts a corner out of the other, and no face lies in the plane of another one.
Scene make_cubes() {
  Scene scene;
  const auto clay = add(scene, paint("clay", 0xC8553D));
  const auto slate = add(scene, paint("slate", 0x3D6B8C));
  const Mesh cube = box({-1, -1, -1}, {1, 1, 1});
  place(scene, "clay cube", add(scene, "clay cube", cube, clay), moved({-0.5, 1, 0.25}));
  glm::dmat4 second = moved({0.75, 1.75, -0.5});
  second[0] = {0.8, 0, -0.6, 0};
  second[2] = {0.6, 0, 0.8, 0};
  place(scene, "slate cube", add(scene, "slate cube", cube, slate), second);
  scene.cameras.push_back(camera_at("corner", {2.2, 5.0, 8.4}, {0.15, 1.35, -0.3}, 30));
  return scene;
}

// Each triangle is a long wedge that gets nearer towards its tip. The tip lies over the base of the next triangle, all
// the way round, so any order of drawing gets one triangle wrong. Faces look along +z.
Scene make_cycle() {
  Scene scene;
  constexpr std::uint32_t kColors[3] = {0xD1495B, 0xEDAE49, 0x2E8B8B};
  const char* const names[3] = {"red", "yellow", "teal"};
  for (int k = 0; k < 3; ++k) {
    const auto paint_id = add(scene, paint(names[k], kColors[k]));
    scene.materials[paint_id].double_sided = true;
    const glm::dvec2 along = turn(k, 3), across{0 - along.y, along.x};
    const auto corner = [&](double forward, double sideways, double z) {
      return glm::vec3(glm::dvec3(along * forward + across * sideways, z));
    };
    Mesh mesh;
    mesh.positions = {corner(-1.3, -0.9, -0.35), corner(1.75, -0.5, 0.35), corner(-1.3, -0.1, -0.35)};
    mesh.triangles = {{0, 1, 2}};
    place(scene, names[k], add(scene, names[k], mesh, paint_id));
  }
  scene.cameras.push_back(camera_at("front", {0, 0, 7}, {0, 0, 0}, 36));
  return scene;
}

namespace {

struct Arm {
  const char* name;
  std::uint32_t srgb;
  bool metal;
};
constexpr std::array<Arm, 8> kArms{{{"coral", 0xE4572E, false},
                                    {"gold", 0xE9B44C, true},
                                    {"sage", 0x7FA084, false},
                                    {"copper", 0xD98A6B, true},
                                    {"ink", 0x2B4C7E, false},
                                    {"silver", 0xDDE1E4, true},
                                    {"plum", 0x8C4A6B, false},
                                    {"steel", 0x9FB4C4, true}}};
constexpr int kRings = 5;

}  // namespace

Scene make_spheres() {
  Scene scene;
  const auto plaster = add(scene, paint("plaster", 0xE8E4DC, 0.85f));
  const RoundSlab stage{.radius = 4.9, .height = 0.2, .bevel = 0.08};
  place(scene, "stage", add(scene, "stage", round_slab(stage, 128), plaster));
  const Mesh ball = sphere(24);
  for (int ring = 0; ring < kRings; ++ring)
    for (std::size_t a = 0; a < kArms.size(); ++a) {
      const Arm& arm = kArms[a];
      const int seed = ring * int(kArms.size()) + int(a) + 1;
      const std::string name = std::string(arm.name) + " " + std::to_string(ring + 1);
      const float roughness = 0.1f + 0.18f * float(ring);
      const auto material = add(scene, paint(name, arm.srgb, roughness, arm.metal ? 1.0f : 0.0f));
      // Seed n lies at n golden angles (0.381966 of a turn), sqrt(n) from the middle: no direction is favoured.
      const glm::dvec2 towards = turn(std::int64_t(seed) * 381966, 1000000) * (0.66 * std::sqrt(double(seed)));
      const double radius = 0.3 + 0.06 * ring;
      place(scene, name, add(scene, name, ball, material),
            moved({towards.x, stage.height + radius, towards.y}) * scaled(radius));
    }
  scene.cameras.push_back(camera_at("above", {0, 7.8, 9.6}, {0, 0.1, 0.35}, 38));
  scene.cameras.push_back(camera_at("low", {-6.4, 3.0, 7.2}, {0, 0.2, 0.2}, 40));
  return scene;
}

}  // namespace frontmost
