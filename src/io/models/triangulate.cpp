// SPDX-License-Identifier: Apache-2.0
// Ear clipping with exact tests.
//
// Every cut takes a triangle that turns the polygon's way, so the signed areas add up: for a polygon that does not
// cross itself, triangles that all turn left cover it once, whatever else went wrong. That is also why the first
// attempt, a fan whose triangles all turn left, needs no further test; it serves all convex polygons.
// Looking for ears among n corners with r blockers takes O(n r) tests at best and O(n^2 r) at worst.
#include "io/models/triangulate.h"

#include <algorithm>
#include <cmath>

namespace frontmost {
namespace {

struct Sum {
  double high, low;
};

/// a + b without error (D. Knuth): high + low, where high is the rounded sum.
Sum two_sum(double a, double b) {
  const double high = a + b, b_part = high - a, a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

/// The sign of the exact sum of six numbers, as an expansion (J. Shewchuk, Adaptive Precision Floating-Point
/// Arithmetic and Fast Robust Geometric Predicates, 1997): the last non-zero component decides.
int sign_of_sum(const double (&terms)[6]) {
  double parts[6];
  int count = 0;
  for (const double term : terms) {
    double carry = term;
    for (int i = 0; i < count; ++i) {
      const Sum sum = two_sum(carry, parts[i]);
      parts[i] = sum.low;
      carry = sum.high;
    }
    parts[count++] = carry;
  }
  for (int i = count; i-- > 0;)
    if (parts[i] != 0) return parts[i] > 0 ? 1 : -1;
  return 0;
}

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Twice the polygon's area as seen along each axis (M. Newell).
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum{0};
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  return sum;
}

}  // namespace

int orientation(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  // Products of two floats are exact in double.
  const double ax = a.x, ay = a.y, bx = b.x, by = b.y, cx = c.x, cy = c.y;
  const double terms[6] = {ax * by, -(ay * bx), bx * cy, -(by * cx), cx * ay, -(cy * ax)};
  double sum = 0, size = 0;
  for (const double term : terms) {
    sum += term;
    size += std::abs(term);
  }
  // Five additions err by less than 5 * 2^-53 of the sizes; 1e-15 is 9 * 2^-53.
  if (std::abs(sum) > 1e-15 * size) return sum > 0 ? 1 : -1;
  return sign_of_sum(terms);
}

void Triangulator::project(std::span<const glm::vec3> corners) {
  const glm::dvec3 area = area_vector(corners), size = glm::abs(area);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  is_flat_ = size[axis] > 0 && std::all_of(corners.begin(), corners.end(), is_finite);
  // Seen from the side that the area points to, so that left turns are the polygon's own.
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  points_.clear();
  for (const glm::vec3& p : corners) points_.push_back(area[axis] > 0 ? glm::vec2(p[u], p[v]) : glm::vec2(p[v], p[u]));
}

bool Triangulator::fan_is_right() const {
  for (std::size_t i = 1; i + 1 < points_.size(); ++i)
    if (orientation(points_[0], points_[i], points_[i + 1]) <= 0) return false;
  return true;
}

/// A fan about the corner `first` over all that remain after it.
void Triangulator::fan(std::size_t first) {
  const auto tip = std::uint32_t(first);
  for (std::uint32_t i = next_[tip]; next_[i] != tip; i = next_[i]) triangles_.emplace_back(tip, i, next_[i]);
}

std::span<const glm::uvec3> Triangulator::operator()(std::span<const glm::vec3> corners) {
  const auto count = std::uint32_t(corners.size());
  triangles_.clear();
  project(corners);
  if (is_flat_ && !fan_is_right()) {
    clip_ears();
  } else {
    for (std::uint32_t i = 1; i + 1 < count; ++i) triangles_.emplace_back(0, i, i + 1);
  }
  return triangles_;
}

int Triangulator::turn(std::uint32_t corner) const {
  return orientation(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

void Triangulator::note_turn(std::uint32_t corner) {
  const bool left = turn(corner) > 0;
  if (is_left_[corner] && !left) blockers_.push_back(corner);
  is_left_[corner] = left;
}

void Triangulator::clip_ears() {
  const auto count = std::uint32_t(points_.size());
  previous_.resize(count);
  next_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    previous_[i] = i == 0 ? count - 1 : i - 1;
    next_[i] = i + 1 == count ? 0 : i + 1;
  }
  is_left_.assign(count, true);
  blockers_.clear();
  for (std::uint32_t i = 0; i < count; ++i) note_turn(i);
  // Files of any size get time in proportion, and one polygon half a second at once: enough for some 15000 corners
  // of the most jagged kind.
  allowed_work_ += 1000 * std::uint64_t(count);

  std::uint32_t corner = 0;
  for (std::uint32_t left = count; left > 3; --left) {
    std::uint32_t ear = corner;
    bool found = false;
    // Ears that nothing touches first; corners on a line with their neighbours before worse. Something always is.
    for (const Ear kind : {Ear::clear, Ear::flat, Ear::touched, Ear::any}) {
      ear = corner;
      for (std::uint32_t tried = 0; tried < left && !found && may_work(); ++tried)
        if (!(found = is_ear(ear, kind))) ear = next_[ear];
      if (found) break;
    }
    if (!found) return fan(corner);
    corner = next_[ear];
    clip(ear);
    // Skipping one corner makes rounder triangles than cutting a fan at one spot.
    corner = next_[corner];
  }
  triangles_.emplace_back(previous_[corner], corner, next_[corner]);
}

bool Triangulator::is_ear(std::uint32_t corner, Ear kind) {
  ++work_;
  switch (kind) {
    case Ear::clear: return is_left_[corner] && !is_blocked(corner, true);
    case Ear::flat: return !is_left_[corner] && turn(corner) == 0;
    case Ear::touched: return is_left_[corner] && !is_blocked(corner, false);
    case Ear::any: return true;
  }
  return true;
}

/// Whether another corner lies within the triangle at `corner`, or on its edges if `by_touching`. Corners at the
/// place of one of the triangle's own do not count: that is how holes are joined to an outline.
bool Triangulator::is_blocked(std::uint32_t corner, bool by_touching) {
  const glm::vec2 a = points_[previous_[corner]], b = points_[corner], c = points_[next_[corner]];
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  const int least = by_touching ? 0 : 1;
  // Corners that were cut or turn left by now are dropped from the list on the way.
  std::size_t kept = 0;
  bool blocked = false;
  for (std::size_t i = 0; i < blockers_.size(); ++i) {
    const std::uint32_t other = blockers_[i];
    if (is_left_[other]) continue;
    blockers_[kept++] = other;
    const glm::vec2 p = points_[other];
    if (blocked || p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) continue;
    if (p == a || p == b || p == c) continue;
    blocked = orientation(a, b, p) >= least && orientation(b, c, p) >= least && orientation(c, a, p) >= least;
  }
  work_ += blockers_.size();
  blockers_.resize(kept);
  return blocked;
}

void Triangulator::clip(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  triangles_.emplace_back(before, corner, after);
  next_[before] = after;
  previous_[after] = before;
  is_left_[corner] = true;  // it is gone, so it blocks nothing
  note_turn(before);
  note_turn(after);
}

}  // namespace frontmost
