// SPDX-License-Identifier: Apache-2.0
// Shapes of machine parts with tessellations as CAD programs make them, good and bad.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "support/random_scene.h"

namespace frontmost::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A point of a profile that is revolved about z: radius and height, which may depend on the angle.
using ProfilePoint = std::function<glm::dvec2(double angle)>;

inline ProfilePoint at(double radius, double height) {
  return [=](double) { return glm::dvec2(radius, height); };
}

inline glm::vec3 turned_about_z(const ProfilePoint& point, double angle) {
  const glm::dvec2 p = point(angle);
  return glm::vec3(glm::dvec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y));
}

/// Adds the sides of a solid of revolution, from ring to ring of `profile`, divided at `angles`; the diagonals of
/// rectangles alternate. Angles ascend within a full turn. A ring of radius 0 is one point.
inline void add_sides(Mesh& mesh, const std::vector<ProfilePoint>& profile, const std::vector<double>& angles) {
  const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    if (a != b && b != c && c != a) add_triangle(mesh, a, b, c);
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const double from = angles[k], to = angles[(k + 1) % angles.size()];
      const glm::vec3 a = turned_about_z(profile[i], from), b = turned_about_z(profile[i], to),
                      c = turned_about_z(profile[i + 1], to), d = turned_about_z(profile[i + 1], from);
      if ((i + k) % 2 == 0) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
}

/// Adds a flat lid over a ring, as a fan from its first vertex, beside which are slivers.
inline void add_lid(Mesh& mesh, const ProfilePoint& ring, const std::vector<double>& angles, bool is_top) {
  for (std::size_t k = 1; k + 1 < angles.size(); ++k) {
    const glm::vec3 a = turned_about_z(ring, angles[0]), b = turned_about_z(ring, angles[k]),
                    c = turned_about_z(ring, angles[k + 1]);
    is_top ? add_triangle(mesh, a, b, c) : add_triangle(mesh, a, c, b);
  }
}

inline std::vector<double> even_angles(int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(2 * std::numbers::pi * i / count);
  return angles;
}

/// Angles over a full turn with steps up to `ratio` times as wide as others.
inline std::vector<double> uneven_angles(int count, float ratio, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> angles;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    angles.push_back(sum);
    sum += random.within(1, ratio);
  }
  for (double& angle : angles) angle *= 2 * std::numbers::pi / sum;
  return angles;
}

/// A grid from 0 to 1 in x and y of n x n squares, bent by `height`; vertices move by up to `noise` times a square's
/// edge.
inline Mesh bent(int n, float noise, const std::function<float(float)>& height) {
  Random random(11);
  std::vector<glm::vec3> places;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const float u = float(x) / float(n), v = float(y) / float(n);
      const glm::vec3 moved = random.point(noise / float(n));
      places.push_back(glm::vec3(u, v, height(u)) + moved);
    }
  Mesh mesh;
  const auto corner = [&](int x, int y) { return places[std::size_t(y * (n + 1) + x)]; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const bool is_rising = random.below(2) == 0;
      const glm::vec3 a = corner(x, y), b = corner(x + 1, y), c = corner(x + 1, y + 1), d = corner(x, y + 1);
      add_triangle(mesh, a, b, is_rising ? c : d);
      add_triangle(mesh, is_rising ? a : b, c, d);
    }
  return mesh;
}

}  // namespace frontmost::test
