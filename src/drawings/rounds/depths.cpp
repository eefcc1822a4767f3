// SPDX-License-Identifier: Apache-2.0
// Blind holes among hollow walls, by the triangles beyond the edges at the ends of a wall:
//
//    _____       _____        outwards: the end is open, as in a face, at a chamfer or in another bore
//         '     '
//          |   |              the wall
//          |   |
//          '._.'              inwards: the end is closed, by a plane, the cone of a drill, or a narrower bore
#include <algorithm>
#include <limits>

#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kWidestHole = 2.79;      // radians, 160 degrees: less of a wall is a fillet
constexpr double kSteepest = 0.7;         // sine: steeper edges are beside a wall, not at its end
constexpr double kSameHole = 2e-3;        // tolerance, as a share of the radius
constexpr std::size_t kMostHoles = 4096;  // walls that are compared with each other

/// What adjoins one end of a wall.
struct WallEnd {
  double inwards = 0, outwards = 0;  ///< lengths of edges
  /// How far the triangles that lead outwards rise beyond the end, and the distance of their tips from the axis.
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;

  [[nodiscard]] bool is_open() const { return outwards > inwards; }
  [[nodiscard]] bool is_closed() const { return inwards > outwards; }
  /// The height of a conical chamfer at the end; 0 if there is none.
  [[nodiscard]] double chamfer(double slack) const {
    return lowest > slack && highest - lowest <= slack && farthest - nearest <= slack ? highest : 0;
  }
};

struct HollowWall {
  FoundRound* wall;
  WallEnd ends[2];  ///< at Round::from and at Round::to
};

HollowWall look_at_ends(FoundRound& wall, const SmoothMesh& mesh) {
  HollowWall result{&wall, {}};
  const Tube tube{wall.round.from, wall.round.axis, wall.round.radius};
  const auto height = [&](const glm::dvec3& at) { return glm::dot(at - tube.point, tube.axis); };
  for (const std::uint32_t triangle : wall.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t other = mesh.across(triangle, k);
      if (other == no_index || std::binary_search(wall.triangles.begin(), wall.triangles.end(), other)) continue;
      const glm::uvec3& corners = mesh.mesh.triangles[triangle];
      const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
      const glm::dvec3 a = mesh.mesh.positions[from], b = mesh.mesh.positions[to], middle = (a + b) * 0.5;
      const double length = glm::distance(a, b);
      if (std::abs(height(a) - height(b)) > kSteepest * length) continue;
      const bool is_upper = height(mesh.corner(triangle, (k + 2) % 3)) < height(middle);
      WallEnd& end = result.ends[is_upper];
      const glm::dvec3 tip = mesh.mesh.positions[third_of(mesh.mesh.triangles[other], from, to)];
      const glm::dvec3 beyond = tip - middle;
      const double out = glm::dot(beyond, tube.outwards(middle)) / tube.radius;
      if (std::abs(out) <= kSameHole * glm::length(beyond)) continue;
      (out > 0 ? end.outwards : end.inwards) += length;
      if (out < 0) continue;
      const double rise = is_upper ? height(tip) - height(middle) : height(middle) - height(tip);
      const double distance = glm::length(tube.outwards(tip));
      end.lowest = std::min(end.lowest, rise);
      end.highest = std::max(end.highest, rise);
      end.nearest = std::min(end.nearest, distance);
      end.farthest = std::max(end.farthest, distance);
    }
  return result;
}

/// Lengthens the depth of a hole by the walls before it: those of its axis and radius that are open at both ends.
void add_walls_before(Round& hole, const std::vector<HollowWall>& all) {
  const double slack = kSameHole * hole.radius, length = hole.depth;
  const Tube tube{hole.from, hole.axis, hole.radius};
  for (const HollowWall& other : all) {
    const Round& round = other.wall->round;
    if (!other.ends[0].is_open() || !other.ends[1].is_open() || std::abs(round.radius - hole.radius) > slack) continue;
    if (glm::length(tube.outwards(round.from)) > slack || glm::length(tube.outwards(round.to)) > slack) continue;
    const double from = glm::dot(hole.from - round.from, hole.axis), to = glm::dot(hole.from - round.to, hole.axis);
    if (std::min(from, to) < -slack) continue;
    hole.depth = std::max(hole.depth, length + std::max(from, to) + other.ends[to > from].chamfer(slack));
  }
}

}  // namespace

void find_depths(const SmoothMesh& mesh, std::vector<FoundRound>& walls) {
  std::vector<HollowWall> all;
  for (FoundRound& wall : walls)
    if (wall.round.is_hollow && wall.round.turn >= kWidestHole) all.push_back(look_at_ends(wall, mesh));
  std::vector<Round*> blind;
  for (const HollowWall& hole : all) {
    Round& round = hole.wall->round;
    const bool is_open_above = hole.ends[1].is_open() && hole.ends[0].is_closed();
    if (!is_open_above && !(hole.ends[0].is_open() && hole.ends[1].is_closed())) continue;
    round.depth = glm::distance(round.from, round.to) + hole.ends[is_open_above].chamfer(kSameHole * round.radius);
    if (is_open_above) {
      std::swap(round.from, round.to);
      round.axis = -round.axis;
    }
    blind.push_back(&round);
  }
  if (all.size() <= kMostHoles)
    for (Round* const hole : blind) add_walls_before(*hole, all);
}

}  // namespace frontmost::lines_detail
