// SPDX-License-Identifier: Apache-2.0
// Blind holes among hollow walls, by the triangles beyond the edges at the ends of a wall:
//
//    _____       _____        outwards: the end is open, as in a face, at a chamfer or in another bore
//         '     '
//          |   |              the wall
//          |   |
//          '._.'              inwards: the end is closed, by a plane, the cone of a drill, or a narrower bore
//
// Flanks are triangles between a wall and a face across the axis, such as chamfers and roundings in any number of
// facets. The flanks at an end belong to the depth if they end at one height.
#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kWidestHole = 2.79;         // radians, 160 degrees: less of a wall is a fillet
constexpr double kSteepest = 0.7;            // sine: steeper edges are beside a wall, not at its end
constexpr double kSameHole = 2e-3;           // tolerance, as a share of the radius
constexpr double kLeastTilt = 3e-3;          // sine of the least angle between a flank and a wall, or a face across
constexpr std::size_t kMostFlanks = 128;     // triangles for each edge at an end of a wall
constexpr std::size_t kMostCompared = 4096;  // walls with nearly the axis of a hole

struct WallEnd {
  double inwards = 0, outwards = 0;  ///< lengths of the edges beyond which the surface leads inwards, or outwards
  double rise = 0;                   ///< height of the flanks beyond the end

  [[nodiscard]] bool is_open() const { return outwards > inwards; }
  [[nodiscard]] bool is_closed() const { return inwards > outwards; }
};

struct HollowWall {
  FoundRound* wall;
  std::uint32_t object;  ///< number of the instance
  AxisKey axis;
  std::array<WallEnd, 2> ends{};  ///< at Round::from and at Round::to
};

/// Looks at the ends of walls.
class EndFinder {
 public:
  explicit EndFinder(const SmoothMesh& mesh) : mesh_(mesh), seen_(mesh.mesh.triangles.size()) {}

  void look_at(HollowWall& hollow) {
    const FoundRound& wall = *hollow.wall;
    tube_ = {wall.round.from, wall.round.axis, wall.round.radius};
    std::vector<std::uint32_t> beyond[2][2];  // triangles: at which end, and whether they lead outwards
    for (const std::uint32_t triangle : wall.triangles)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh_.across(triangle, k);
        if (other == no_index || is_of(wall, other)) continue;
        const glm::uvec3& corners = mesh_.mesh.triangles[triangle];
        const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
        const glm::dvec3 a = mesh_.mesh.positions[from], b = mesh_.mesh.positions[to], middle = (a + b) * 0.5;
        if (is_steep(a, b)) continue;
        const bool is_upper = height(mesh_.corner(triangle, (k + 2) % 3)) < height(middle);
        const glm::dvec3 way = mesh_.mesh.positions[third_of(mesh_.mesh.triangles[other], from, to)] - middle;
        const double out = glm::dot(way, tube_.outwards(middle)) / tube_.radius;
        if (std::abs(out) <= kSameHole * glm::length(way)) continue;
        (out > 0 ? hollow.ends[is_upper].outwards : hollow.ends[is_upper].inwards) += glm::distance(a, b);
        beyond[is_upper][out > 0].push_back(other);
      }
    for (const int upper : {0, 1}) {
      const bool is_open = hollow.ends[upper].is_open();
      hollow.ends[upper].rise = rise_of(std::move(beyond[upper][is_open]), wall, upper == 1, is_open);
    }
  }

 private:
  [[nodiscard]] static bool is_of(const FoundRound& wall, std::uint32_t triangle) {
    return std::binary_search(wall.triangles.begin(), wall.triangles.end(), triangle);
  }

  [[nodiscard]] double height(const glm::dvec3& at) const { return glm::dot(at - tube_.point, tube_.axis); }

  [[nodiscard]] bool is_steep(const glm::dvec3& a, const glm::dvec3& b) const {
    return std::abs(height(a) - height(b)) > kSteepest * glm::distance(a, b);
  }

  /// Whether a triangle faces the axis and the open end. `out`: direction to the open end.
  [[nodiscard]] bool is_flank(std::uint32_t triangle, const glm::dvec3& out) const {
    const glm::dvec3& normal = mesh_.normals[triangle];
    const glm::dvec3 middle = (mesh_.corner(triangle, 0) + mesh_.corner(triangle, 1) + mesh_.corner(triangle, 2)) / 3.0;
    const glm::dvec3 radial = tube_.outwards(middle);
    return glm::dot(normal, out) > kLeastTilt && glm::dot(normal, radial) < -kLeastTilt * glm::length(radial);
  }

  /// The height of the flanks beyond an end; 0 if they do not end at one height. At a closed end they must end at a
  /// plane floor, so a drill's cone has none. `flanks`: the triangles at the end.
  [[nodiscard]] double rise_of(std::vector<std::uint32_t> flanks, const FoundRound& wall, bool is_upper, bool is_open) {
    const glm::dvec3 out = is_upper == is_open ? tube_.axis : -tube_.axis;
    const std::size_t most = kMostFlanks * flanks.size();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    ++visit_;
    std::erase_if(flanks, [&](std::uint32_t triangle) {
      if (is_flank(triangle, out)) return std::exchange(seen_[triangle], visit_) == visit_;
      low = high = 0;
      return true;
    });
    for (std::size_t i = 0; i < flanks.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh_.across(flanks[i], k);
        if (other != no_index && is_of(wall, other)) continue;
        if (other != no_index && is_flank(other, out)) {
          if (std::exchange(seen_[other], visit_) != visit_) flanks.push_back(other);
          if (flanks.size() > most) return 0;
          continue;
        }
        const glm::dvec3 a = mesh_.corner(flanks[i], k), b = mesh_.corner(flanks[i], (k + 1) % 3);
        if (is_steep(a, b)) continue;
        if (!is_open && (other == no_index || glm::dot(mesh_.normals[other], out) < 1 - kLeastTilt * kLeastTilt))
          return 0;
        for (const glm::dvec3& end : {a, b}) {
          const double rise = is_upper ? height(end) - height(wall.round.to) : -height(end);
          low = std::min(low, rise);
          high = std::max(high, rise);
        }
      }
    return high > 0 && high - low <= kSameHole * tube_.radius ? high : 0;
  }

  const SmoothMesh& mesh_;
  Tube tube_{};
  std::vector<std::uint32_t> seen_;  ///< by triangle: the last visit
  std::uint32_t visit_ = 0;
};

/// Lengthens the depth of a hole by the walls before it: those of its object, axis and radius that are open at both
/// ends. `length`: of the hole's wall and floor; `all` ascends by key.
void add_walls_before(const HollowWall& blind, double length, const std::vector<HollowWall>& all) {
  Round& hole = blind.wall->round;
  const double slack = kSameHole * hole.radius;
  const Tube tube{hole.from, hole.axis, hole.radius};
  const auto begin = std::lower_bound(all.begin(), all.end(), blind.axis.key - 2 * blind.axis.slack,
                                      [](const HollowWall& wall, double key) { return wall.axis.key < key; });
  for (auto other = begin; other != all.end() && other->axis.key <= blind.axis.key + 2 * blind.axis.slack; ++other) {
    if (std::size_t(other - begin) >= kMostCompared) {
      hole.depth = 0;
      return;
    }
    const Round& round = other->wall->round;
    if (!other->ends[0].is_open() || !other->ends[1].is_open() || other->object != blind.object) continue;
    if (std::abs(round.radius - hole.radius) > slack) continue;
    if (glm::length(tube.outwards(round.from)) > slack || glm::length(tube.outwards(round.to)) > slack) continue;
    const double from = glm::dot(hole.from - round.from, hole.axis), to = glm::dot(hole.from - round.to, hole.axis);
    if (std::min(from, to) < -slack) continue;
    hole.depth = std::max(hole.depth, length + std::max(from, to) + other->ends[to > from].rise);
  }
}

}  // namespace

void find_depths(const SmoothMesh& mesh, const Surfaces& surfaces, std::vector<FoundRound>& walls,
                 const Execution& execution) {
  std::vector<HollowWall> all;
  for (FoundRound& wall : walls) {
    const Round& round = wall.round;
    if (!round.is_hollow || round.turn < kWidestHole) continue;
    const std::uint32_t object = surfaces.source(mesh.mesh.ids[wall.triangles[0]]).instance;
    all.push_back(
        {&wall, object, AxisKey(round.from, round.axis, 2 * kSameHole * round.radius, 4 * mesh.noise / round.radius)});
  }
  if (all.empty()) return;
  std::stable_sort(all.begin(), all.end(),
                   [](const HollowWall& a, const HollowWall& b) { return a.axis.key < b.axis.key; });
  EndFinder ends(mesh);
  for (HollowWall& wall : all) {
    check_cancelled(execution);
    ends.look_at(wall);
  }
  for (const HollowWall& hole : all) {
    check_cancelled(execution);
    Round& round = hole.wall->round;
    const bool is_open_above = hole.ends[1].is_open() && hole.ends[0].is_closed();
    if (!is_open_above && !(hole.ends[0].is_open() && hole.ends[1].is_closed())) continue;
    const double length = glm::distance(round.from, round.to) + hole.ends[!is_open_above].rise;
    round.depth = length + hole.ends[is_open_above].rise;
    if (is_open_above) {
      std::swap(round.from, round.to);
      round.axis = -round.axis;
    }
    add_walls_before(hole, length, all);
  }
}

}  // namespace frontmost::lines_detail
