// SPDX-License-Identifier: Apache-2.0
// Cylinders of few sides, which count as polygons: two rims about one axis, each with its corners on a circle.
//
// A rim is a closed chain of sharp edges. Rims are sorted by the point of their axis nearest to the origin, along a
// direction that is parallel to no usual row of holes. So the other rim of a cylinder is among the next ones.
#include <algorithm>
#include <numbers>

#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kFewestPrismSides = 7, kMostPrismSides = 17;
constexpr double kWidestPrismTurn = 0.91;  // 52 degrees in radians, a little more than the turn between two of seven
                                           // sides
constexpr double kSamePrism = 1e-3;        // of the radius
constexpr std::size_t kMostLookedAt = 4096;

struct PrismRim {
  Circle3 circle;
  double key, slack;  ///< `key`: the axis' nearest point to the origin, along one direction; `slack`: its uncertainty
  bool is_used = false;
};

/// The circle through all corners of a chain, if the chain goes around it once.
std::optional<Circle3> circle_of(const SmoothMesh& mesh, const SharpChain& chain) {
  const std::size_t sides = chain.edges.size();
  if (!chain.is_closed || sides < kFewestPrismSides || sides > kMostPrismSides) return std::nullopt;
  const auto corner = [&](std::size_t i) { return mesh.mesh.positions[chain.vertices[i % sides]]; };
  const auto circle = circle_through(corner(0), corner(sides / 3), corner(2 * sides / 3));
  if (!circle) return std::nullopt;
  const double slack = std::max(mesh.noise, kSamePrism * circle->radius);
  double turn = 0;
  for (std::size_t i = 0; i < sides; ++i) {
    const double by = circle->turn_between(corner(i), corner(i + 1));
    if (!(circle->distance(corner(i)) <= slack && by > 0 && by <= kWidestPrismTurn)) return std::nullopt;
    turn += by;
  }
  return turn < 2 * std::numbers::pi + 1e-3 ? circle : std::nullopt;
}

bool are_ends_of_one(const PrismRim& a, const PrismRim& b) {
  const double radius = a.circle.radius, slack = kSamePrism * radius;
  const glm::dvec3 way = b.circle.centre - a.circle.centre;
  const double along = glm::dot(way, a.circle.axis);
  return !b.is_used && std::abs(b.circle.radius - radius) <= slack && std::abs(along) > slack &&
         glm::length(way - along * a.circle.axis) <= 4 * slack &&
         glm::length(glm::cross(a.circle.axis, b.circle.axis)) <= kSamePrism;
}

}  // namespace

std::vector<FoundPrism> find_prisms(const SmoothMesh& mesh, const Execution& execution) {
  const SharpChains all = sharp_chains(mesh, execution, std::cos(kWidestPrismTurn));
  std::vector<PrismRim> rims;
  for (const SharpChain& chain : all.chains)
    if (const auto circle = circle_of(mesh, chain)) {
      const double along = glm::dot(circle->centre, circle->axis), turned = 4 * mesh.noise / circle->radius;
      const glm::dvec3 foot = circle->centre - along * circle->axis;
      rims.push_back({*circle, glm::dot(foot, glm::dvec3(0.7236, 0.5257, 0.4472)),
                      4 * kSamePrism * circle->radius + turned * std::abs(along)});
    }
  std::stable_sort(rims.begin(), rims.end(), [](const PrismRim& a, const PrismRim& b) { return a.key < b.key; });
  std::vector<FoundPrism> found;
  for (std::size_t i = 0; i < rims.size(); ++i) {
    PrismRim& rim = rims[i];
    for (std::size_t k = i + 1; !rim.is_used && k < rims.size() && rims[k].key <= rim.key + 2 * rim.slack; ++k) {
      if (k - i > kMostLookedAt) break;
      if (!are_ends_of_one(rim, rims[k])) continue;
      rim.is_used = rims[k].is_used = true;
      found.push_back({rim.circle, rims[k].circle.centre});
    }
  }
  return found;
}

}  // namespace frontmost::lines_detail
