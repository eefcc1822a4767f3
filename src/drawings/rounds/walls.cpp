// SPDX-License-Identifier: Apache-2.0
// A wall grows over all smooth neighbours that are parallel to its axis and have their vertices at its radius. It
// begins at a circle of sharp edges or, where there is none, as between fillets, at two neighbours. Two neighbours
// determine the axis poorly, so the axis is fitted again whenever the number of triangles has doubled.
//
//    circle ==> parallel triangles at it ==> their smooth neighbours, whose vertices lie on the tube
//    seed   ==> two triangles that turn about a common side ==> the same; the tube is fitted again as they get more
//
// Walls from circles come first, because a circle determines the axis better than a few triangles. The triangles of a
// failed wall are freed if it was short: they may belong to a wall that begins with a better axis.
#include <algorithm>
#include <numbers>

#include "base/parallel.h"
#include "lines/lists.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kSeedsPerPart = 4096;
constexpr double kFlat = 0.9999999;  // cosine of 0.026 degrees: the two halves of a plane
constexpr double kUpright = 0.01;    // radians from the axis, for neighbours of the two triangles
constexpr double kRoughlyUpright = 0.1;
constexpr double kFacesOut = 0.9;       // least cosine between the normal and the direction from the axis
constexpr double kWholeSagitta = 1.05;  // times the sagitta of the mean side
constexpr double kSmallestTube = 50;
constexpr std::size_t kFewestTriangles = 8;

/// Two triangles that might lie about an axis along their common side.
struct Seed {
  std::uint32_t triangle;
  int side;
};

class Seeds {
 public:
  explicit Seeds(const SmoothMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] bool is_one(const Seed& seed) const {
    const std::uint32_t other = mesh_.across(seed.triangle, seed.side);
    if (other == no_index || other < seed.triangle || !mesh_.is_smooth(seed.triangle, seed.side)) return false;
    if (glm::dot(mesh_.normals[seed.triangle], mesh_.normals[other]) > kFlat) return false;
    const glm::dvec3 side = mesh_.corner(seed.triangle, (seed.side + 1) % 3) - mesh_.corner(seed.triangle, seed.side);
    return goes_on(seed.triangle, other, side) && goes_on(other, seed.triangle, side);
  }

 private:
  /// Whether `triangle` has, apart from `before`, a smooth neighbour parallel to the axis, and no other smooth
  /// neighbour that is part of a doubly curved surface.
  [[nodiscard]] bool goes_on(std::uint32_t triangle, std::uint32_t before, const glm::dvec3& side) const {
    const double length = glm::length(side);
    const glm::dvec3 axis = side / length;
    bool has_one = false;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = mesh_.across(triangle, k);
      if (next == before || !mesh_.is_smooth(triangle, k)) continue;
      if (std::abs(lean(next, axis)) <= kUpright)
        has_one = true;
      else if (2 * height(next, axis) > length && leans_on(next, axis))
        return false;
    }
    return has_one;
  }

  /// Whether the next ring leans twice as much as this triangle. Then the triangle is beside a ring of a sphere or
  /// torus, which is no cylinder and no higher than the next ring. In contrast, a fillet leans by half a step where it
  /// begins at a wall and by three halves next; a slight chamfer does not lean more.
  [[nodiscard]] bool leans_on(std::uint32_t triangle, const glm::dvec3& axis) const {
    const double first = lean(triangle, axis);
    const auto is_twice = [&](std::uint32_t t) { return std::abs(lean(t, axis) / first - 2) < 0.4; };
    for (int k = 0; k < 3; ++k) {
      if (!mesh_.is_smooth(triangle, k)) continue;
      const std::uint32_t next = mesh_.across(triangle, k);
      if (is_twice(next)) return true;
      // The next ring may begin behind the other half of the triangle's quad.
      for (int j = 0; j < 3; ++j)
        if (mesh_.is_smooth(next, j) && is_twice(mesh_.across(next, j))) return true;
    }
    return false;
  }

  /// The extent of a triangle along the axis.
  [[nodiscard]] double height(std::uint32_t triangle, const glm::dvec3& axis) const {
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = glm::dot(mesh_.corner(triangle, k), axis);
    return *std::max_element(at, at + 3) - *std::min_element(at, at + 3);
  }

  /// The angle between a triangle and the axis; 0 if it is parallel to the axis.
  [[nodiscard]] double lean(std::uint32_t triangle, const glm::dvec3& axis) const {
    return std::asin(std::clamp(glm::dot(mesh_.normals[triangle], axis), -1.0, 1.0));
  }

  const SmoothMesh& mesh_;
};

class WallGrower {
 public:
  explicit WallGrower(const SmoothMesh& mesh) : mesh_(mesh), is_used_(mesh.mesh.triangles.size()) {}

  /// None if the seed's surface is no cylinder, or already part of one. Visited triangles are not visited again.
  [[nodiscard]] std::optional<FoundWall> grow(const Seed& seed) {
    const std::uint32_t other = mesh_.across(seed.triangle, seed.side);
    if (is_used_[seed.triangle] || is_used_[other] || !start(seed, other)) return std::nullopt;
    return grown(true);
  }

  /// Grows a wall from a side of a circle whose triangle is parallel to the axis. `may_be_cut`: vertices may lie on
  /// chords, inside of the radius, where something else cuts the wall; a circle is precise enough to allow that.
  [[nodiscard]] std::optional<FoundWall> grow(const Circle3& circle, double step, std::uint32_t triangle,
                                              bool may_be_cut) {
    if (is_used_[triangle]) return std::nullopt;
    tube_ = {circle.centre, circle.axis, circle.radius};
    slack_ = std::max(mesh_.noise, sagitta(circle.radius, step) / 4);
    within_ = may_be_cut ? std::max(slack_, kWholeSagitta * sagitta(circle.radius, step)) : slack_;
    outside_ = glm::dot(mesh_.normals[triangle], tube_.outwards(mesh_.corner(triangle, 0))) > 0 ? 1 : -1;
    if (!holds(triangle)) return std::nullopt;
    triangles_.clear();
    take(triangle);
    return grown(false);
  }

 private:
  /// Grows the current triangles. The axis of a circle is better than a fit to few triangles, so it is not fitted.
  std::optional<FoundWall> grown(bool fits) {
    std::size_t fitted = std::max(triangles_.size(), kFewestTriangles / 2);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      for (int k = 0; k < 3; ++k) reach(triangles_[i], k);
      if (!fits || triangles_.size() < 2 * fitted) continue;
      fitted = triangles_.size();
      if (!fit()) break;
    }
    if (triangles_.size() >= kFewestTriangles) {
      if (!fits || (fit() && holds_all())) return measured();
      return std::nullopt;
    }
    // A short run of triangles may belong to a wall that begins with a better axis.
    for (const std::uint32_t t : triangles_) is_used_[t] = false;
    return std::nullopt;
  }

  bool start(const Seed& seed, std::uint32_t other) {
    const glm::dvec3 from = mesh_.corner(seed.triangle, seed.side);
    const glm::dvec3 to = mesh_.corner(seed.triangle, (seed.side + 1) % 3);
    const glm::dvec3 left = mesh_.corner(seed.triangle, (seed.side + 2) % 3);
    glm::dvec3 right = from;
    for (int k = 0; k < 3; ++k)
      if (const glm::dvec3 at = mesh_.corner(other, k); at != from && at != to) right = at;
    const glm::dvec3 points[] = {from, left, right};
    const auto tube = tube_through(points, glm::normalize(to - from));
    if (!tube || !(tube->radius >= kSmallestTube * mesh_.noise)) return false;
    tube_ = *tube;
    const double step = std::acos(std::min(1.0, glm::dot(mesh_.normals[seed.triangle], mesh_.normals[other])));
    slack_ = within_ = std::max(mesh_.noise, sagitta(tube_.radius, step) / 4);
    outside_ = glm::dot(mesh_.normals[seed.triangle], tube_.outwards(from)) > 0 ? 1 : -1;
    triangles_.clear();
    take(seed.triangle);
    take(other);
    return true;
  }

  void take(std::uint32_t triangle) {
    is_used_[triangle] = true;
    triangles_.push_back(triangle);
  }

  void reach(std::uint32_t triangle, int side) {
    if (!mesh_.is_smooth(triangle, side)) return;
    const std::uint32_t next = mesh_.across(triangle, side);
    if (!is_used_[next] && holds(next)) take(next);
  }

  [[nodiscard]] bool holds(std::uint32_t triangle) const {
    const glm::dvec3& normal = mesh_.normals[triangle];
    if (std::abs(glm::dot(normal, tube_.axis)) > kRoughlyUpright) return false;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 at = mesh_.corner(triangle, k), out = tube_.outwards(at);
      const double length = glm::length(out);
      if (!(length - tube_.radius <= slack_ && tube_.radius - length <= within_ &&
            outside_ * glm::dot(normal, out) >= kFacesOut * length))
        return false;
    }
    return true;
  }
  [[nodiscard]] bool holds_all() const {
    return std::all_of(triangles_.begin(), triangles_.end(), [&](std::uint32_t t) { return holds(t); });
  }

  bool fit() {
    std::vector<glm::dvec3> normals, points;
    for (const std::uint32_t t : triangles_) {
      // The first ring of a fillet may lie within the tolerance of the radius, but is not part of the wall.
      if (std::abs(glm::dot(mesh_.normals[t], tube_.axis)) > kUpright) continue;
      normals.push_back(mesh_.normals[t]);
      for (int k = 0; k < 3; ++k) points.push_back(mesh_.corner(t, k));
    }
    const auto tube = tube_through(points, common_perpendicular(normals));
    if (tube) tube_ = *tube;
    return tube.has_value();
  }

  [[nodiscard]] FoundWall measured() {
    const Across across(tube_.axis);
    std::vector<double> angles;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::uint32_t t : triangles_)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 at = mesh_.corner(t, k), out = tube_.outwards(at);
        angles.push_back(std::atan2(glm::dot(out, across.v), glm::dot(out, across.u)));
        low = std::min(low, glm::dot(at - tube_.point, tube_.axis));
        high = std::max(high, glm::dot(at - tube_.point, tube_.axis));
      }
    std::sort(angles.begin(), angles.end());
    constexpr double whole = 2 * std::numbers::pi;
    double gap = angles.front() + whole - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    std::sort(triangles_.begin(), triangles_.end());
    return {tube_.point + low * tube_.axis,
            tube_.point + high * tube_.axis,
            tube_.axis,
            tube_.radius,
            gap <= kWidestStep ? whole : whole - gap,
            outside_ < 0,
            triangles_};
  }

  const SmoothMesh& mesh_;
  std::vector<bool> is_used_;
  Tube tube_{};
  double slack_ = 0, within_ = 0, outside_ = 1;  ///< how far vertices may be outside of the radius, and inside
  std::vector<std::uint32_t> triangles_;
};

}  // namespace

std::vector<FoundWall> find_walls(const SmoothMesh& mesh, const std::vector<FoundCircle>& circles,
                                  const Execution& execution) {
  std::vector<FoundWall> walls;
  WallGrower grower(mesh);
  const auto keep = [&](std::optional<FoundWall> wall) {
    if (wall) walls.push_back(std::move(*wall));
  };
  const auto grow_from_circles = [&](bool may_be_cut) {
    for (const FoundCircle& circle : circles) {
      check_cancelled(execution);
      // Most sides have two triangles.
      const double step = std::min(kWidestStep, 2 * covered(circle) / double(circle.triangles.size()));
      for (const std::uint32_t triangle : circle.triangles)
        keep(grower.grow(circle.circle, step, triangle, may_be_cut));
    }
  };
  grow_from_circles(false);
  const std::size_t count = mesh.mesh.triangles.size();
  std::vector<std::vector<Seed>> lists((count + kSeedsPerPart - 1) / kSeedsPerPart);
  parallel_for(execution, count, kSeedsPerPart, [&](std::size_t begin, std::size_t end) {
    const Seeds seeds(mesh);
    for (auto t = std::uint32_t(begin); t < end; ++t)
      for (int k = 0; k < 3; ++k)
        if (const Seed seed{t, k}; seeds.is_one(seed)) lists[begin / kSeedsPerPart].push_back(seed);
  });
  for (const std::vector<Seed>& list : lists) {
    check_cancelled(execution);
    for (const Seed& seed : list) keep(grower.grow(seed));
  }
  // Cut walls come last, so that whole walls are found as precisely as possible.
  grow_from_circles(true);
  return walls;
}

}  // namespace frontmost::lines_detail
