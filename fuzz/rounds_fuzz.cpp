// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary triangles, and tubes joined to them, to the search for rounds. The search must not crash or hang;
// each find is round, or regular, and made of existing triangles; threads change no bit. Input:
// support/geometry_fuzz.h.
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// A tube about the z axis with `sides` sides, and a floor if wanted; some vertices coincide with the first vertices of
/// the mesh.
void add_tube(Mesh& mesh, std::uint32_t sides, float radius, float height, bool has_floor, std::uint32_t moved) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (std::uint32_t i = 0; i < sides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * float(i) / float(sides);
    for (const float z : {0.0f, height})
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % sides);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
    if (has_floor) mesh.triangles.emplace_back(b, a, first + 2 * sides);
  }
  if (has_floor) mesh.positions.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < std::min({moved, first, 2 * sides}); ++i) mesh.positions[i] = mesh.positions[first + i];
}

void check_triangles(const Rounds& all, std::uint32_t first, std::uint32_t count, const Surfaces& surfaces) {
  require(count > 0 && first + count <= all.triangles.size());
  for (std::uint32_t i = first; i < first + count; ++i) {
    require(all.triangles[i] < surfaces.primitive_count());
    require(i == first || all.triangles[i - 1] < all.triangles[i]);
  }
}

void check(const Rounds& all, const Surfaces& surfaces) {
  constexpr double least = 160 * std::numbers::pi / 180, rounding = 1e-9;
  for (const Round& round : all.rounds) {
    require(std::isfinite(round.radius) && round.radius > 0);
    require(std::abs(glm::length(round.axis) - 1) < rounding);
    require(round.turn >= least && round.turn <= 2 * std::numbers::pi + rounding);
    if (round.kind == RoundKind::circle) require(round.from == round.to);
    for (int k = 0; k < 3; ++k) require(std::isfinite(round.from[k]) && std::isfinite(round.to[k]));
    require(std::isfinite(round.depth) && round.depth >= 0);
    require(round.depth == 0 || (round.kind == RoundKind::cylinder && round.is_hollow));
    check_triangles(all, round.first, round.count, surfaces);
  }
  for (const Flats& flats : all.flats) {
    require(std::isfinite(flats.width) && flats.width > 0);
    require(flats.sides == 4 || flats.sides == 6);
    require(std::abs(glm::length(flats.side) - 1) < rounding);
    for (int k = 0; k < 3; ++k) require(std::isfinite(flats.from[k]) && std::isfinite(flats.to[k]));
    check_triangles(all, flats.first, flats.count, surfaces);
  }
}

bool equal(const Rounds& a, const Rounds& b) {
  const bool has_equal_flats =
      std::equal(a.flats.begin(), a.flats.end(), b.flats.begin(), b.flats.end(), [](const Flats& x, const Flats& y) {
        return x.from == y.from && x.to == y.to && x.side == y.side && x.width == y.width && x.sides == y.sides &&
               x.first == y.first && x.count == y.count;
      });
  return has_equal_flats && a.triangles == b.triangles &&
         std::equal(a.rounds.begin(), a.rounds.end(), b.rounds.begin(), b.rounds.end(),
                    [](const Round& x, const Round& y) {
                      return x.kind == y.kind && x.from == y.from && x.to == y.to && x.axis == y.axis &&
                             x.radius == y.radius && x.turn == y.turn && x.is_hollow == y.is_hollow &&
                             x.first == y.first && x.count == y.count && x.depth == y.depth;
                    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::optional<test::FuzzInput> input = test::read_input(data, size);
  if (!input) return 0;
  auto& [bytes, scene] = *input;
  if (bytes.spare & 1) {
    // Every fourth tube is a hexagon or a square.
    const std::uint32_t sides = bytes.fov % 4 == 0 ? 4 + bytes.fov / 4 % 2 * 2 : 3 + bytes.fov % 96;
    add_tube(scene.meshes[0], sides, bytes.eye_x, bytes.eye_y, bytes.fov & 128, bytes.spare / 2);
  }
  try {
    const Surfaces surfaces(scene);
    const Rounds rounds = find_rounds(surfaces, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    check(rounds, surfaces);
    require(equal(rounds, find_rounds(surfaces, {.threads = 1, .isa = Isa::scalar, .watch = nullptr})));
  } catch (const Error&) {
    // Positions that no scene may have are a documented error.
  }
  return 0;
}
