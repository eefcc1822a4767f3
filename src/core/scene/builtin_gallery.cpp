// SPDX-License-Identifier: Apache-2.0
// The demo: a round stage with a tiled floor, and on it the subjects of this program. The teapot, two cubes through one
// another, a knot that hides itself, a vase, spheres, and a pane of glass to look through.
#include <array>
#include <cmath>

#include "scene/compose.h"
#include "scene/shapes.h"
#include "scene/turn.h"

namespace frontmost {
namespace {

// Two light and two dark tiles with a thin joint, each tile in a shade of its own.
Texture tiles() {
  constexpr int kTile = 128, kJoint = 2;
  Texture texture;
  texture.name = "tiles";
  texture.width = texture.height = 2 * kTile;
  for (int y = 0; y < texture.height; ++y)
    for (int x = 0; x < texture.width; ++x) {
      const int in_x = x % kTile, in_y = y % kTile;
      const bool joint = std::min(in_x, in_y) < kJoint || std::max(in_x, in_y) >= kTile - kJoint;
      const bool dark = (x / kTile + y / kTile) % 2 == 1;
      const int shade = x / kTile * 4;
      const glm::ivec3 rgb = joint  ? glm::ivec3(178, 172, 162)
                             : dark ? glm::ivec3(128, 139, 142)
                                    : glm::ivec3(229, 223, 211);
      texture.pixels.emplace_back(glm::u8vec4(rgb - shade, 255));
    }
  return texture;
}

// Sets texture coordinates for a texture seen from above, which repeats `repeats` times per unit of length.
void project_from_above(Mesh& mesh, double repeats) {
  mesh.texcoords = {};
  for (const glm::vec3& p : mesh.positions) mesh.texcoords.values.emplace_back(p.x * repeats, p.z * repeats);
}

double add_stage(Scene& scene) {
  const auto stone = add(scene, paint("limestone", 0xD8CFBF, 0.9f));
  const RoundSlab slab{.radius = 4.4, .height = 0.25, .bevel = 0.1},
      inlay{.radius = 4.05, .height = 0.02, .bevel = 0.01};
  place(scene, "stage", add(scene, "stage", round_slab(slab, 160), stone));
  scene.textures.push_back(tiles());
  Material material = paint("tiles", 0xFFFFFF, 0.35f);
  material.base_color_texture.texture = 0;
  Mesh mesh = round_slab(inlay, 160);
  project_from_above(mesh, 0.6);
  place(scene, "tiles", add(scene, "tiles", std::move(mesh), add(scene, std::move(material))),
        moved({0, slab.height, 0}));
  return slab.height + inlay.height;
}

void add_teapot(Scene& scene, double floor) {
  const auto stone = add(scene, paint("travertine", 0xE3D9C6, 0.9f));
  const auto glaze = add(scene, paint("teal glaze", 0x1F7A7D, 0.18f));
  const glm::dvec3 at{-1.2, floor, 0.75};
  const RoundSlab plinth{.radius = 1.25, .height = 0.22, .bevel = 0.05};
  place(scene, "plinth", add(scene, "plinth", round_slab(plinth, 96), stone), moved(at));
  place(scene, "teapot", add(scene, "teapot", teapot(12), glaze),
        moved(at + glm::dvec3(0, plinth.height, 0)) * turned(-1, 11) * scaled(0.52));
}

void add_knot(Scene& scene, double floor) {
  const auto marble = add(scene, paint("marble", 0xEEEBE4, 0.45f));
  const auto gold = add(scene, paint("gold", 0xF0B84A, 0.22f, 1.0f));
  const glm::dvec3 at{0.75, floor, -1.75};
  const RoundSlab column{.radius = 0.62, .height = 1.15, .bevel = 0.06};
  place(scene, "column", add(scene, "column", round_slab(column, 72), marble), moved(at));
  place(scene, "knot", add(scene, "knot", torus_knot({}), gold),
        moved(at + glm::dvec3(0, column.height + 0.95, 0)) * turned(1, 24) * tilted(1, 4) * scaled(0.6));
}

void add_cubes(Scene& scene, double floor) {
  const auto coral = add(scene, paint("coral", 0xDE5A3A, 0.5f));
  const auto ink = add(scene, paint("ink", 0x2B4C7E, 0.5f));
  const Mesh cube = box({-1, -1, -1}, {1, 1, 1});
  const glm::dmat4 group = moved({2.1, floor, -0.05}) * turned(1, 20) * scaled(0.46);
  place(scene, "coral cube", add(scene, "coral cube", cube, coral), group * moved({0, 1, 0}));
  place(scene, "ink cube", add(scene, "ink cube", cube, ink), group * moved({1.1, 1.7, -0.75}) * turned(1, 10));
}

void add_vase(Scene& scene, double floor) {
  // Foot, belly, neck and lip as (radius, height), from the lip down, joined by a smooth curve.
  constexpr int kSteps = 48;
  const auto outline = [](double t) {  // t from 0 at the lip to 1 at the foot: one Bezier curve of degree 4
    constexpr std::array<glm::dvec2, 5> p{{{0.44, 2.1}, {-0.05, 1.55}, {0.45, 1.45}, {1.15, 0.55}, {0.32, 0}}};
    std::array<glm::dvec2, 5> q = p;
    for (std::size_t n = 4; n > 1; --n)
      for (std::size_t i = 0; i < n; ++i) q[i] = q[i] * (1 - t) + q[i + 1] * t;
    const glm::dvec2 along = q[1] - q[0];
    return ProfilePoint{q[0].x * (1 - t) + q[1].x * t, q[0].y * (1 - t) + q[1].y * t,
                        glm::dvec2(0 - along.y, along.x) / std::sqrt(glm::dot(along, along))};
  };
  std::vector<ProfilePoint> profile;
  for (int i = kSteps; i >= 0; --i) {  // the inside, up to the lip, a little smaller
    const ProfilePoint p = outline(double(i) / kSteps);
    profile.push_back({p.radius - 0.05 * p.normal.x, p.height + (i == 0 ? 0.0 : 0.05), -p.normal});
  }
  const ProfilePoint deepest{profile.front().radius, profile.front().height, {0, 1}};
  profile.insert(profile.begin(), {{0, deepest.height, {0, 1}}, deepest});
  for (int i = 0; i <= kSteps; ++i) profile.push_back(outline(double(i) / kSteps));
  profile.push_back({profile.back().radius, 0, {0, -1}});
  profile.push_back({0, 0, {0, -1}});
  const auto glaze = add(scene, paint("cream glaze", 0xF1DFC0, 0.3f));
  place(scene, "vase", add(scene, "vase", lathe(profile, 80), glaze), moved({-2.35, floor, -1.7}));
}

void add_spheres(Scene& scene, double floor) {
  struct Ball {
    const char* name;
    std::uint32_t srgb;
    float roughness, metallic;
    double x, z, radius;
  };
  constexpr std::array<Ball, 4> kBalls{{{"silver ball", 0xE6E8EA, 0.12f, 1, 0.45, 2.35, 0.36},
                                        {"plum ball", 0x8C3A5B, 0.15f, 0, 1.2, 2.75, 0.24},
                                        {"sage ball", 0x8FAF8B, 0.9f, 0, -0.2, 3.1, 0.2},
                                        {"copper ball", 0xD98A6B, 0.35f, 1, -3.05, 0.6, 0.42}}};
  const Mesh ball = sphere(32);
  for (const Ball& b : kBalls) {
    const auto material = add(scene, paint(b.name, b.srgb, b.roughness, b.metallic));
    place(scene, b.name, add(scene, b.name, ball, material), moved({b.x, floor + b.radius, b.z}) * scaled(b.radius));
  }
}

void add_pane(Scene& scene, double floor) {
  const auto oak = add(scene, paint("oak", 0xA9773F, 0.65f));
  Material glass = paint("glass", 0x9FD3D6, 0.05f);
  glass.base_color.a = 0.35f;
  glass.alpha = Material::Alpha::blend;
  glass.double_sided = true;
  const auto glass_id = add(scene, std::move(glass));
  const glm::dmat4 at = moved({2.75, floor, 1.75}) * turned(-1, 9);
  place(scene, "foot", add(scene, "foot", box({-0.6, 0, -0.16}, {0.6, 0.14, 0.16}), oak), at);
  // The pane comes last, so that its ids follow those of everything seen through it.
  place(scene, "pane", add(scene, "pane", box({-0.5, 0.14, -0.025}, {0.5, 1.35, 0.025}), glass_id), at);
}

}  // namespace

Scene make_gallery() {
  Scene scene;
  const double floor = add_stage(scene);
  add_teapot(scene, floor);
  add_knot(scene, floor);
  add_cubes(scene, floor);
  add_vase(scene, floor);
  add_spheres(scene, floor);
  add_pane(scene, floor);
  scene.cameras.push_back(camera_at("visitor", {0.9, 4.7, 11.2}, {0, 0.75, 0.1}, 34));
  scene.cameras.push_back(camera_at("from the right", {5.6, 2.5, 5.0}, {0.3, 0.85, -0.1}, 42));
  scene.cameras.push_back(camera_at("from above", {0.3, 11, 3.5}, {0, 0, 0}, 46));
  return scene;
}

}  // namespace frontmost
