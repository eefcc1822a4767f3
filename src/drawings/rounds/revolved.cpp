// SPDX-License-Identifier: Apache-2.0
// Rings with corners at equal angles have equal moments in all directions across their axis. So the axis passes through
// the mean of the corners, in the direction whose second moment differs from two equal ones. Scans and most other
// meshes fail this test; regions that pass are checked ring by ring.
//
//    smooth region --> its corners, each once --> mean and moments --> axis --> rings about it?
//                                                     no odd direction: none       discs, walls, whole spheres: none
//
// Moments are sums, so the axis is as precise as all corners together, without any search.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kFewestCorners = 19;  // a ring and a tip
constexpr double kEqualMoments = 1e-5;      // of the largest
constexpr double kSameRing = 8;             // in units of noise: the greatest distance within a ring
constexpr double kSmallestRevolved = 400;   // in units of noise

/// A vertex relative to an axis.
struct Polar {
  double height, radius, angle;
};

/// Whole regions of triangles that are connected by smooth edges.
class Regions {
 public:
  explicit Regions(const SmoothMesh& mesh) : mesh_(mesh), is_taken_(mesh.mesh.triangles.size()) {}

  /// The region that contains `first`; empty if an earlier call returned it.
  [[nodiscard]] std::vector<std::uint32_t> from(std::uint32_t first) {
    std::vector<std::uint32_t> region;
    if (is_taken_[first]) return region;
    is_taken_[first] = true;
    region.push_back(first);
    for (std::size_t i = 0; i < region.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        if (!mesh_.is_smooth(region[i], k)) continue;
        const std::uint32_t next = mesh_.across(region[i], k);
        if (is_taken_[next]) continue;
        is_taken_[next] = true;
        region.push_back(next);
      }
    std::sort(region.begin(), region.end());
    return region;
  }

 private:
  const SmoothMesh& mesh_;
  std::vector<bool> is_taken_;
};

/// The direction whose second moment differs from two equal ones; none if all are equal or all differ.
std::optional<glm::dvec3> odd_direction(const glm::dmat3& moments) {
  // With the equal moments m: moments = m * 1 + (odd - m) * outerProduct(axis, axis). The traces of this and of its
  // square give a quadratic equation for m; either root may be right.
  const double trace = moments[0][0] + moments[1][1] + moments[2][2], mean = trace / 3;
  glm::dmat3 deviator = moments;
  for (int k = 0; k < 3; ++k) deviator[k][k] -= mean;
  double squares = 0;
  for (int i = 0; i < 3; ++i) squares += glm::dot(deviator[i], deviator[i]);
  const double size = std::sqrt(squares / 6);  // a third of |odd - m|
  if (!(size > kEqualMoments * trace)) return std::nullopt;
  for (const double sign : {1.0, -1.0}) {
    glm::dmat3 rest = deviator * sign;
    for (int k = 0; k < 3; ++k) rest[k][k] += size;  // leaves 3 * size * outerProduct(axis, axis)
    int longest = 0;
    for (const int k : {1, 2})
      if (rest[k][k] > rest[longest][longest]) longest = k;
    const glm::dvec3 axis = glm::normalize(rest[longest]);
    const glm::dmat3 wanted = 3 * size * glm::outerProduct(axis, axis);
    double off = 0;
    for (int i = 0; i < 3; ++i) off += glm::dot(rest[i] - wanted[i], rest[i] - wanted[i]);
    if (std::sqrt(off) <= kEqualMoments * trace) return axis;
  }
  return std::nullopt;
}

class RevolvedFinder {
 public:
  explicit RevolvedFinder(const SmoothMesh& mesh)
      : mesh_(mesh), slack_(kSameRing * mesh.noise), region_of_(mesh.mesh.positions.size(), no_index) {}

  [[nodiscard]] std::optional<FoundRevolved> find(std::vector<std::uint32_t> region) {
    const std::vector<glm::dvec3> corners = corners_of(region);
    if (corners.size() < kFewestCorners) return std::nullopt;
    glm::dvec3 middle(0);
    for (const glm::dvec3& p : corners) middle += p;
    middle /= double(corners.size());
    glm::dmat3 moments(0);
    for (const glm::dvec3& p : corners) moments += glm::outerProduct(p - middle, p - middle);
    const auto axis = odd_direction(moments);
    if (!axis) return std::nullopt;
    std::vector<Polar> polar = seen_from({middle, *axis, 0}, corners);
    const auto by_radius = [](const Polar& a, const Polar& b) { return a.radius < b.radius; };
    const auto by_height = [](const Polar& a, const Polar& b) { return a.height < b.height; };
    const auto [thinnest, widest] = std::minmax_element(polar.begin(), polar.end(), by_radius);
    const auto [lowest, highest] = std::minmax_element(polar.begin(), polar.end(), by_height);
    const double radius = widest->radius, low = lowest->height, high = highest->height;
    // Discs need no axis, walls are cylinders, and whole spheres are round about any axis.
    if (high - low <= slack_ || radius - thinnest->radius <= slack_ || is_sphere(middle, corners)) return std::nullopt;
    if (radius < kSmallestRevolved * mesh_.noise || !is_in_rings(polar)) return std::nullopt;
    return FoundRevolved{middle + low * *axis, middle + high * *axis, *axis, radius, std::move(region)};
  }

 private:
  /// The vertices of the region, each once.
  [[nodiscard]] std::vector<glm::dvec3> corners_of(const std::vector<std::uint32_t>& region) {
    std::vector<glm::dvec3> corners;
    for (const std::uint32_t t : region)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh_.mesh.triangles[t][k];
        // A region is identified by its first triangle.
        if (region_of_[vertex] == region.front()) continue;
        region_of_[vertex] = region.front();
        corners.push_back(mesh_.mesh.positions[vertex]);
      }
    return corners;
  }

  [[nodiscard]] bool is_sphere(const glm::dvec3& middle, const std::vector<glm::dvec3>& corners) const {
    const double radius = glm::distance(middle, corners[0]);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const glm::dvec3& p) { return std::abs(glm::distance(middle, p) - radius) <= slack_; });
  }

  [[nodiscard]] static std::vector<Polar> seen_from(const Tube& tube, const std::vector<glm::dvec3>& corners) {
    const Across across(tube.axis);
    std::vector<Polar> polar;
    for (const glm::dvec3& p : corners) {
      const glm::dvec3 out = tube.outwards(p);
      polar.push_back({glm::dot(p - tube.point, tube.axis), glm::length(out),
                       std::atan2(glm::dot(out, across.v), glm::dot(out, across.u))});
    }
    return polar;
  }

  /// Calls use(begin, end) for each run of vertices whose sorted values are within a ring's tolerance of each other.
  template <class Value, class Use>
  [[nodiscard]] bool all_runs(std::span<Polar> polar, const Value& value, const Use& use) const {
    std::sort(polar.begin(), polar.end(), [&](const Polar& a, const Polar& b) { return value(a) < value(b); });
    for (std::size_t begin = 0, end = 0; begin < polar.size(); begin = end) {
      for (end = begin + 1; end < polar.size() && value(polar[end]) - value(polar[end - 1]) <= slack_;) ++end;
      if (value(polar[end - 1]) - value(polar[begin]) > slack_ || !use(polar.subspan(begin, end - begin))) return false;
    }
    return true;
  }

  /// Whether every vertex lies on the axis, or in a ring that is closed around it.
  [[nodiscard]] bool is_in_rings(std::vector<Polar>& polar) const {
    const auto is_ring = [&](std::span<Polar> ring) {
      if (ring.front().radius <= slack_) return true;
      std::sort(ring.begin(), ring.end(), [](const Polar& a, const Polar& b) { return a.angle < b.angle; });
      double gap = ring.front().angle + 2 * std::numbers::pi - ring.back().angle;
      for (std::size_t i = 1; i < ring.size(); ++i) gap = std::max(gap, ring[i].angle - ring[i - 1].angle);
      return gap <= kWidestStep;
    };
    return all_runs(
        std::span(polar), [](const Polar& p) { return p.height; },
        [&](std::span<Polar> level) {
          return all_runs(
              level, [](const Polar& p) { return p.radius; }, is_ring);
        });
  }

  const SmoothMesh& mesh_;
  const double slack_;
  std::vector<std::uint32_t> region_of_;  ///< by vertex: the last region that it was in
};

}  // namespace

std::vector<FoundRevolved> find_revolved(const SmoothMesh& mesh, const Execution& execution) {
  std::vector<FoundRevolved> found;
  Regions regions(mesh);
  RevolvedFinder finder(mesh);
  for (std::uint32_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    if (t % 4096 == 0) check_cancelled(execution);
    std::vector<std::uint32_t> region = regions.from(t);
    if (region.empty()) continue;
    if (auto revolved = finder.find(std::move(region))) found.push_back(std::move(*revolved));
  }
  return found;
}

}  // namespace frontmost::lines_detail
