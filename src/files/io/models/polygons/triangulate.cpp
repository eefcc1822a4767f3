// SPDX-License-Identifier: Apache-2.0
// Ear clipping with exact predicates.
//
// Each cut takes a triangle of the polygon's winding, so signed areas add up: triangles that all turn left cover a
// polygon that does not cross itself exactly once, whatever else went wrong. So the first attempt, a fan, needs no
// further test if all its triangles turn left; it serves all convex polygons.
//
// If an outline touches itself, rounding makes edges cross slightly that should coincide, unless they share both
// corners. Then there may be no ear left, and a triangle turns the other way. In that case all triangulations are
// tried, which takes O(n^3), and the one with the least area of such triangles is chosen.
//
// A spatial search finds corners that block an ear, so cutting takes O(n log n), unless ears are far apart: the search
// for an ear takes O(n) tests at worst.
#include "io/models/polygons/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/orientation.h"
#include "frontmost/base.h"

namespace frontmost {
namespace {

/// Twice the polygon's area, projected along each axis (M. Newell).
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum{0};
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  return sum;
}

}  // namespace

void Triangulator::project(std::span<const glm::vec3> corners) {
  const glm::dvec3 area = area_vector(corners), size = glm::abs(area);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  is_flat_ =
      size[axis] > 0 && std::all_of(corners.begin(), corners.end(), [](const glm::vec3& p) { return is_finite(p); });
  // The polygon is seen from the side that the area vector points to, so that its own turns are left turns.
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  points_.clear();
  for (const glm::vec3& p : corners) points_.push_back(area[axis] > 0 ? glm::vec2(p[u], p[v]) : glm::vec2(p[v], p[u]));
}

bool Triangulator::fan_is_right() const {
  for (std::size_t i = 1; i + 1 < points_.size(); ++i)
    if (orientation(points_[0], points_[i], points_[i + 1]) <= 0) return false;
  return true;
}

/// Adds a fan about the corner `first` over all remaining corners.
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
    if (std::any_of(triangles_.begin(), triangles_.end(), [&](const glm::uvec3& t) { return wrong_area(t) > 0; }))
      try_all();
  } else {
    for (std::uint32_t i = 1; i + 1 < count; ++i) triangles_.emplace_back(0, i, i + 1);
  }
  return triangles_;
}

int Triangulator::turn(std::uint32_t corner) const {
  return orientation(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

void Triangulator::note_turn(std::uint32_t corner) {
  is_left_[corner] = turn(corner) > 0;
  blockers_.mark(corner, !is_left_[corner]);
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
  blockers_.build(points_, previous_, next_);
  for (std::uint32_t i = 0; i < count; ++i) note_turn(i);
  // The allowed work is proportional to the file's corners, plus half a second once. This suffices for polygons of
  // millions of corners as long as an ear can always be found.
  allowed_work_ += 1000 * std::uint64_t(count);

  std::uint32_t corner = 0;
  for (std::uint32_t left = count; left > 3; --left) {
    std::uint32_t ear = corner;
    bool found = false;
    // Ears that nothing touches and spikes come first, then corners on a line with their neighbours, then touched ears.
    // The last kind accepts any corner.
    for (const Ear kind : {Ear::clear, Ear::flat, Ear::touched, Ear::any}) {
      ear = corner;
      for (std::uint32_t tried = 0; tried < left && !found && may_work(); ++tried)
        if (!(found = is_ear(ear, kind))) ear = next_[ear];
      if (found) break;
    }
    if (!found) return fan(corner);
    corner = next_[ear];
    clip(ear);
    // Skipping one corner gives rounder triangles than cutting a fan at one spot.
    corner = next_[corner];
  }
  triangles_.emplace_back(previous_[corner], corner, next_[corner]);
}

bool Triangulator::is_ear(std::uint32_t corner, Ear kind) {
  ++work_;
  switch (kind) {
    case Ear::clear: return is_left_[corner] ? !is_blocked(corner, true) : is_spike(corner);
    case Ear::flat: return !is_left_[corner] && turn(corner) == 0;
    case Ear::touched: return is_left_[corner] && !is_blocked(corner, false);
    case Ear::any: return true;
  }
  return true;
}

bool Triangulator::is_blocked(std::uint32_t corner, bool by_touching) {
  return blockers_.blocks({points_[previous_[corner]], points_[corner], points_[next_[corner]]}, by_touching, work_);
}

/// Whether the outline turns back at the corner, so that nothing lies between its two edges.
bool Triangulator::is_spike(std::uint32_t corner) const {
  const glm::vec2 &a = points_[previous_[corner]], &b = points_[corner], &c = points_[next_[corner]];
  return turn(corner) == 0 && b != glm::clamp(b, glm::min(a, c), glm::max(a, c));
}

void Triangulator::clip(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  triangles_.emplace_back(before, corner, after);
  next_[before] = after;
  previous_[after] = before;
  is_left_[corner] = true;
  blockers_.mark(corner, false);  // a corner that was cut off blocks nothing
  note_turn(before);
  note_turn(after);
}

/// Twice the area of a triangle that turns right; 0 for others.
double Triangulator::wrong_area(const glm::uvec3& t) const {
  const glm::vec2 &a = points_[t.x], &b = points_[t.y], &c = points_[t.z];
  if (orientation(a, b, c) >= 0) return 0;
  const glm::dvec2 u = glm::dvec2(b) - glm::dvec2(a), v = glm::dvec2(c) - glm::dvec2(a);
  return std::max(u.y * v.x - u.x * v.y, std::numeric_limits<double>::min());
}

/// Chooses the triangulation with the least area that turns the wrong way (G. Klincsek. Minimal Triangulations of
/// Polygonal Domains. 1980). Does nothing if that exceeds the allowed work.
void Triangulator::try_all() {
  constexpr std::uint32_t most_corners = 1000;  // 16 MB; the first polygon of a file is allowed work for 580
  const auto count = std::uint32_t(points_.size());
  const std::uint64_t work = std::uint64_t(count) * count * count / 6;
  if (count > most_corners || work_ + work > allowed_work_) return;
  work_ += work;
  const auto cut = [&](std::uint32_t begin, std::uint32_t end) -> Cut& { return cuts_[begin * count + end]; };
  cuts_.assign(std::size_t(count) * count, {});
  for (std::uint32_t length = 2; length < count; ++length)
    for (std::uint32_t begin = 0, end = length; end < count; ++begin, ++end) {
      Cut best{std::numeric_limits<double>::infinity()};
      for (std::uint32_t tip = begin + 1; tip < end && best.wrong > 0; ++tip) {
        double wrong = cut(begin, tip).wrong + cut(tip, end).wrong;
        if (wrong < best.wrong) wrong += wrong_area({begin, tip, end});
        if (wrong < best.wrong) best = {wrong, tip};
      }
      cut(begin, end) = best;
    }
  triangles_.clear();
  std::vector<glm::uvec2> rest{{0, count - 1}};
  while (!rest.empty()) {
    const glm::uvec2 part = rest.back();
    rest.pop_back();
    if (part.y - part.x < 2) continue;
    const std::uint32_t tip = cut(part.x, part.y).tip;
    triangles_.emplace_back(part.x, tip, part.y);
    rest.emplace_back(part.x, tip);
    rest.emplace_back(tip, part.y);
  }
}

}  // namespace frontmost
