// SPDX-License-Identifier: Apache-2.0
// Forty spheres set out like the seeds of a sunflower. Neighbours along an arm share a colour, every other arm is of
// metal, and the spheres go from polished to matte from the middle outwards.
#include <cmath>

#include "scene/compose.h"
#include "scene/shapes.h"
#include "scene/turn.h"

namespace frontmost {
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
