// SPDX-License-Identifier: Apache-2.0
// Scenes to compare methods on: random, but equal on every machine.
#pragma once

#include <cstdint>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "support/seeds.h"

namespace frontmost::test {

/// Random numbers that do not depend on the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(noted_seed(seed) * 0x9E3779B97F4A7C15u + 0x1234567) {}
  std::uint32_t next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return std::uint32_t(state_ >> 32) ^ std::uint32_t(state_ >> 13);
  }
  int below(int n) { return int(next() % std::uint32_t(n)); }
  float unit() { return float(next() >> 8) / 16777216.0f; }
  float within(float low, float high) { return low + (high - low) * unit(); }
  glm::vec3 point(float reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }

 private:
  std::uint64_t state_;
};

/// A scene of one mesh with one instance.
inline Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.name = "test";
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({"object", 0, glm::dmat4(1.0)});
  return scene;
}

inline void add_triangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto n = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.push_back({n, n + 1, n + 2});
}

/// In `sheets`, large triangles lie one behind the other, up to a unit or a rounding error apart, by seed.
enum class Kind { soup, tiny, slivers, fan, shared_grid, huge, coplanar, through_eye, sheets };
inline constexpr Kind all_kinds[] = {Kind::soup, Kind::tiny,     Kind::slivers,     Kind::fan,   Kind::shared_grid,
                                     Kind::huge, Kind::coplanar, Kind::through_eye, Kind::sheets};

/// Triangles within about a unit of the origin; huge ones extend far beyond. Each statement draws one random number, as
/// compilers evaluate arguments in different orders.
inline Mesh random_mesh(Kind kind, int count, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 p = random.point(1);
    switch (kind) {
      case Kind::soup:
      case Kind::tiny: {
        const float reach = kind == Kind::soup ? 0.4f : 0.02f;
        const glm::vec3 third = p + random.point(reach), second = p + random.point(reach);
        add_triangle(mesh, p, second, third);
        break;
      }
      case Kind::slivers: {
        const glm::vec3 q = random.point(1);
        const glm::vec3 aside = random.point(1e-3f);
        add_triangle(mesh, p, q, p + (q - p) * random.unit() + aside);
        break;
      }
      case Kind::fan: add_triangle(mesh, {0.1f, 0.2f, 0.3f}, p, random.point(1)); break;
      case Kind::huge:
      case Kind::through_eye: {
        const float reach = kind == Kind::huge ? 1e6f : 8.0f;
        const glm::vec3 third = random.point(reach), second = random.point(reach), first = random.point(reach);
        add_triangle(mesh, first, second, third);
        break;
      }
      case Kind::coplanar: {
        const auto on_grid = [&] {
          const int y = random.below(9), x = random.below(9);
          return glm::vec3(float(x) / 8, float(y) / 8, 0.25f);
        };
        const glm::vec3 third = on_grid(), second = on_grid(), first = on_grid();
        add_triangle(mesh, first, second, third);
        break;
      }
      case Kind::sheets: {
        const float lean = float(seed % 2), gap = std::ldexp(1.0f, -int(seed % 25));
        const auto corner = [&](float x, float y) {
          const glm::vec3 aside = random.point(0.05f) * glm::vec3(1, 1, 0);
          return glm::vec3(x, y, lean * x + gap * random.unit()) + aside;
        };
        const glm::vec3 third = corner(0, 2), second = corner(2, -2), first = corner(-2, -2);
        add_triangle(mesh, first, second, third);
        break;
      }
      case Kind::shared_grid: break;
    }
  }
  if (kind == Kind::shared_grid) {
    const int side = 1 + int(std::sqrt(double(count) / 2));
    for (int j = 0; j <= side; ++j)
      for (int i = 0; i <= side; ++i)
        mesh.positions.push_back({2 * float(i) / float(side) - 1 + random.within(-0.3f, 0.3f) / float(side),
                                  2 * float(j) / float(side) - 1 + random.within(-0.3f, 0.3f) / float(side),
                                  random.within(-0.2f, 0.2f)});
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const auto a = std::uint32_t(j * (side + 1) + i), b = a + 1, c = a + std::uint32_t(side) + 1, d = c + 1;
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
  }
  return mesh;
}

/// A view of the unit cube about the origin from a random side.
inline View random_view(Random& random, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  const double distance = 2.0 + random.unit();
  const glm::dvec3 eye = glm::normalize(glm::dvec3(random.point(1)) + glm::dvec3(0, 0, 1e-3)) * distance;
  view.world_from_eye = look_at(eye, glm::dvec3(random.point(0.3f)), {0, 1, 0});
  view.projection = random.below(3) == 0
                        ? make_orthographic(-1.3, 1.1, -0.9, 1.2, {0.5, 6})
                        : make_projection(0.9, double(width) / height,
                                          {0.5, random.below(2) ? 6 : std::numeric_limits<double>::infinity()});
  return view;
}

/// Gives some triangles a double-sided material, some a one-sided one and some none. Every eighth seed makes all
/// double-sided, and the next seed none.
inline void add_random_sides(Scene& scene, std::uint64_t seed) {
  Random random(seed + 300);
  scene.materials.resize(2);
  scene.materials[1].double_sided = true;
  for (Mesh& mesh : scene.meshes) {
    mesh.material_ids.assign(mesh.triangles.size(), seed % 8 == 0 ? 1 : 0);
    if (seed % 8 < 2) continue;
    for (std::uint32_t& id : mesh.material_ids) id = random.below(5) == 0 ? no_index : std::uint32_t(random.below(2));
    // A mesh of one material stores it once.
    if (random.below(3) == 0) mesh.material_ids.assign(1, std::uint32_t(random.below(2)));
  }
}

/// A scene of one kind and a view of it, of any size up to 200 x 170, with and without culling, with one sample or
/// four.
struct RandomCase {
  Scene scene;
  View view;
};
inline RandomCase random_case(Kind kind, std::uint64_t seed, std::uint64_t salt = 100) {
  Random random(seed + salt);
  const bool covers_little = kind == Kind::tiny || kind == Kind::slivers;
  RandomCase made{scene_of(random_mesh(kind, (30 + random.below(300)) * (covers_little ? 6 : 1), seed)), {}};
  const int width = 1 + random.below(200), height = 1 + random.below(170);
  made.view = random_view(random, width, height);
  made.view.culling = Culling(random.below(3));
  made.view.samples = seed % 4 == 3 ? 4 : 1;
  return made;
}

}  // namespace frontmost::test
