// SPDX-License-Identifier: Apache-2.0
// Directions and fractions of a full turn with the same bits on every machine, which no C library guarantees.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace frontmost {

/// The direction of v with length 1, with the same bits on every machine. Precondition: v is not zero.
[[nodiscard]] inline glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(glm::dot(v, v)); }

/// The point (cos, sin) in one of eight octants. `fraction` of 45 degrees is measured from the axis that bounds the
/// octant; `is_diagonal` says that the angle from there is exactly 45 degrees.
[[nodiscard]] inline glm::dvec2 turn_in_octant(std::int64_t octant, double fraction, bool is_diagonal) {
  const double x = 0.78539816339744830962 * fraction, xx = x * x;
  // Taylor's series up to x^17 and x^16; the remainder is below 1e-17 for x <= pi / 4.
  double sine = 1, cosine = 1;
  for (int k = 16; k >= 2; k -= 2) {
    sine = 1 - sine * xx / double(k * (k + 1));
    cosine = 1 - cosine * xx / double(k * (k - 1));
  }
  sine *= x;
  if (is_diagonal) sine = cosine;  // at 45 degrees the two series round differently
  switch (octant) {
    case 0: return {cosine, sine};
    case 1: return {sine, cosine};
    case 2: return {0 - sine, cosine};
    case 3: return {0 - cosine, sine};
    case 4: return {0 - cosine, 0 - sine};
    case 5: return {0 - sine, 0 - cosine};
    case 6: return {sine, 0 - cosine};
    default: return {cosine, 0 - sine};
  }
}

/// The point (cos, sin) of the unit circle at part / whole of a full turn, counter-clockwise from (1, 0), to within
/// about 2e-16. Exact at quarters of the turn, and exactly symmetric in the eight octants. Precondition: whole > 0.
[[nodiscard]] inline glm::dvec2 turn(std::int64_t part, std::int64_t whole) {
  // Integers fold the angle into the first octant without rounding: 8 * part / whole octants.
  std::int64_t eighths = (part % whole + whole) % whole * 8;
  const std::int64_t octant = eighths / whole;
  eighths -= octant * whole;
  if (octant % 2 == 1) eighths = whole - eighths;
  return turn_in_octant(octant, double(eighths) / double(whole), eighths == whole);
}

/// The point (cos, sin) at an angle in degrees, as exact as turn(). Not a number if the angle is not finite.
[[nodiscard]] inline glm::dvec2 turn_of_degrees(double degrees) {
  // fmod and all differences below are exact.
  const double positive = std::fmod(std::abs(degrees), 360.0), rest = std::fmod(positive, 45.0);
  if (!(positive >= 0)) return {positive, positive};
  const auto octant = std::int64_t((positive - rest) / 45);
  const double from_axis = octant % 2 == 1 ? 45 - rest : rest;
  const glm::dvec2 point = turn_in_octant(octant, from_axis / 45, from_axis == 45);
  return {point.x, degrees < 0 ? 0 - point.y : point.y};
}

/// All points of a circle divided into `whole` parts.
[[nodiscard]] inline std::vector<glm::dvec2> circle(int whole) {
  std::vector<glm::dvec2> points;
  for (int part = 0; part < whole; ++part) points.push_back(turn(part, whole));
  return points;
}

}  // namespace frontmost
