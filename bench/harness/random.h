// SPDX-License-Identifier: Apache-2.0
// Random numbers and noise that are the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace frontmost::bench {

/// SplitMix64 (G. Steele, D. Lea, C. Flood. Fast Splittable Pseudorandom Number Generators. 2014).
struct Random {
  std::uint64_t state;

  std::uint64_t next() {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  float unit() { return float(next() >> 40) * 0x1p-24f; }
};

/// A value in [-1, 1) for every point of the integer lattice.
inline float lattice_value(int x, int y, int z) {
  Random random{std::uint64_t(std::uint32_t(x)) * 0x9E3779B1u ^ std::uint64_t(std::uint32_t(y)) * 0x85EBCA77C2B2u ^
                std::uint64_t(std::uint32_t(z)) * 0x27D4EB2F165667u};
  return random.unit() * 2 - 1;
}

/// Value noise: smooth between the lattice points.
inline float noise(const glm::vec3& p) {
  const glm::vec3 cell = glm::floor(p), f = p - cell, ease = f * f * (3.0f - 2.0f * f);
  const int x = int(cell.x), y = int(cell.y), z = int(cell.z);
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const auto row = [&](int dy, int dz) {
    return mix(lattice_value(x, y + dy, z + dz), lattice_value(x + 1, y + dy, z + dz), ease.x);
  };
  return mix(mix(row(0, 0), row(1, 0), ease.y), mix(row(0, 1), row(1, 1), ease.y), ease.z);
}

/// Octaves of noise, each twice as fine and half as strong.
inline float fractal(glm::vec3 p, int octaves) {
  float sum = 0, gain = 0.5f;
  for (int i = 0; i < octaves; ++i, gain *= 0.5f, p = p * 2.03f) sum += gain * noise(p);
  return sum;
}

}  // namespace frontmost::bench
