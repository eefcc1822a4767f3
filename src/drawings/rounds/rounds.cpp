// SPDX-License-Identifier: Apache-2.0
// Finds surfaces of revolution and prisms, and makes the public list of all rounds. Rings with corners at equal angles
// have equal moments in all directions across their axis. So the axis passes through the mean of the corners, in the
// direction whose second moment differs from the other two, which are equal. A prism has two rims about one axis, each
// with its corners on a circle. Rims are sorted by their AxisKey.
#include <algorithm>
#include <numbers>

#include "base/parallel.h"
#include "rounds/found_rounds.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t kFewestCorners = 19;  // a ring and a tip
constexpr double kEqualMoments = 1e-5;      // share of the sum of the moments
constexpr double kSameRing = 8;             // in units of noise: the greatest distance within a ring
constexpr double kSmallestRevolved = 400;   // smallest radius, in units of noise

/// A vertex relative to an axis.
struct Polar {
  double height, radius, angle;
};

/// Takes the triangles that are connected with `first` by smooth edges. \returns them, ascending.
std::vector<std::uint32_t> region_from(std::uint32_t first, const SmoothMesh& mesh, std::vector<bool>& is_taken) {
  std::vector<std::uint32_t> region = {first};
  is_taken[first] = true;
  for (std::size_t i = 0; i < region.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (!mesh.is_smooth(region[i], k)) continue;
      const std::uint32_t next = mesh.across(region[i], k);
      if (is_taken[next]) continue;
      is_taken[next] = true;
      region.push_back(next);
    }
  std::sort(region.begin(), region.end());
  return region;
}

/// The direction whose second moment differs from the other two, which are equal. None if all three are equal or all
/// differ.
std::optional<glm::dvec3> odd_direction(const glm::dmat3& moments) {
  // If both equal moments are m, then moments = m * 1 + (odd - m) * outerProduct(axis, axis). The traces of this and of
  // its square give a quadratic equation for m; either root may be right.
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

struct RevolvedFinder {
  [[nodiscard]] std::optional<FoundRound> find(std::vector<std::uint32_t> region) {
    const std::vector<glm::dvec3> corners = corners_of(region);
    if (corners.size() < kFewestCorners) return std::nullopt;
    glm::dvec3 middle(0);
    for (const glm::dvec3& p : corners) middle += p;
    middle /= double(corners.size());
    glm::dmat3 moments(0);
    for (const glm::dvec3& p : corners) moments += glm::outerProduct(p - middle, p - middle);
    const auto axis = odd_direction(moments);
    if (!axis) return std::nullopt;
    const Tube tube{middle, *axis, 0};
    const Across across(*axis);
    std::vector<Polar> polar;
    for (const glm::dvec3& p : corners) {
      const glm::dvec3 out = tube.outwards(p);
      polar.push_back({glm::dot(p - middle, *axis), glm::length(out),
                       std::atan2(glm::dot(out, across.v), glm::dot(out, across.u))});
    }
    const auto by_radius = [](const Polar& a, const Polar& b) { return a.radius < b.radius; };
    const auto by_height = [](const Polar& a, const Polar& b) { return a.height < b.height; };
    const auto [thinnest, widest] = std::minmax_element(polar.begin(), polar.end(), by_radius);
    const auto [lowest, highest] = std::minmax_element(polar.begin(), polar.end(), by_height);
    const double radius = widest->radius, low = lowest->height, high = highest->height;
    // Left out: discs need no axis, walls are cylinders, and whole spheres are round about any axis.
    if (high - low <= slack || radius - thinnest->radius <= slack || is_sphere(middle, corners)) return std::nullopt;
    if (radius < kSmallestRevolved * mesh.noise || !is_in_rings(polar)) return std::nullopt;
    return FoundRound{{RoundKind::revolved, middle + low * *axis, middle + high * *axis, *axis, radius, kWhole},
                      std::move(region)};
  }

  /// The vertices of the region, each once.
  [[nodiscard]] std::vector<glm::dvec3> corners_of(const std::vector<std::uint32_t>& region) {
    std::vector<glm::dvec3> corners;
    for (const std::uint32_t t : region)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.mesh.triangles[t][k];
        // A region is identified by its first triangle.
        if (region_of[vertex] == region.front()) continue;
        region_of[vertex] = region.front();
        corners.push_back(mesh.mesh.positions[vertex]);
      }
    return corners;
  }

  [[nodiscard]] bool is_sphere(const glm::dvec3& middle, const std::vector<glm::dvec3>& corners) const {
    const double radius = glm::distance(middle, corners[0]);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const glm::dvec3& p) { return std::abs(glm::distance(middle, p) - radius) <= slack; });
  }

  /// Sorts the vertices by value, and splits them into runs where a gap is wider than a ring's tolerance. \returns
  /// whether every run lies within the tolerance and use(run) returns true for each.
  template <class Value, class Use>
  [[nodiscard]] bool all_runs(std::span<Polar> polar, const Value& value, const Use& use) const {
    std::sort(polar.begin(), polar.end(), [&](const Polar& a, const Polar& b) { return value(a) < value(b); });
    for (std::size_t begin = 0, end = 0; begin < polar.size(); begin = end) {
      for (end = begin + 1; end < polar.size() && value(polar[end]) - value(polar[end - 1]) <= slack;) ++end;
      if (value(polar[end - 1]) - value(polar[begin]) > slack || !use(polar.subspan(begin, end - begin))) return false;
    }
    return true;
  }

  /// Whether every vertex lies on the axis, or in a ring that is closed around it.
  [[nodiscard]] bool is_in_rings(std::vector<Polar>& polar) const {
    const auto is_ring = [&](std::span<Polar> ring) {
      if (ring.front().radius <= slack) return true;
      std::sort(ring.begin(), ring.end(), [](const Polar& a, const Polar& b) { return a.angle < b.angle; });
      double gap = ring.front().angle + kWhole - ring.back().angle;
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

  const SmoothMesh& mesh;
  const double slack = kSameRing * mesh.noise;
  /// By vertex: the last region that it was in.
  std::vector<std::uint32_t> region_of = std::vector<std::uint32_t>(mesh.mesh.positions.size(), no_index);
};

constexpr std::size_t kFewestPrismSides = 7, kMostPrismSides = 17;
constexpr double kWidestPrismTurn = 0.91;  // radians, a little more than the turn between two of seven sides
constexpr double kSamePrism = 1e-3;        // tolerance, as a share of the radius
constexpr std::size_t kMostLookedAt = 4096;

struct PrismRim {
  Circle3 circle;
  AxisKey axis;
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
  return turn < kWhole + 1e-3 ? circle : std::nullopt;
}

bool are_ends_of_one(const PrismRim& a, const PrismRim& b) {
  const double radius = a.circle.radius, slack = kSamePrism * radius;
  const glm::dvec3 way = b.circle.centre - a.circle.centre;
  const double along = glm::dot(way, a.circle.axis);
  return !b.is_used && std::abs(b.circle.radius - radius) <= slack && std::abs(along) > slack &&
         glm::length(way - along * a.circle.axis) <= 4 * slack &&
         glm::length(glm::cross(a.circle.axis, b.circle.axis)) <= kSamePrism;
}

/// O(sharp edges log sharp edges), and at most 4096 comparisons for each rim.
std::vector<Round> find_prisms(const SmoothMesh& mesh, const Execution& execution) {
  const SharpChains all = sharp_chains(mesh, execution, std::cos(kWidestPrismTurn));
  std::vector<PrismRim> rims;
  for (const SharpChain& chain : all.chains)
    if (const auto circle = circle_of(mesh, chain)) {
      const double off = 4 * kSamePrism * circle->radius, turned = 4 * mesh.noise / circle->radius;
      rims.push_back({*circle, AxisKey(circle->centre, circle->axis, off, turned)});
    }
  std::stable_sort(rims.begin(), rims.end(),
                   [](const PrismRim& a, const PrismRim& b) { return a.axis.key < b.axis.key; });
  std::vector<Round> found;
  for (std::size_t i = 0; i < rims.size(); ++i) {
    PrismRim& rim = rims[i];
    for (std::size_t k = i + 1;
         !rim.is_used && k < rims.size() && rims[k].axis.key <= rim.axis.key + 2 * rim.axis.slack; ++k) {
      if (k - i > kMostLookedAt) break;
      if (!are_ends_of_one(rim, rims[k])) continue;
      rim.is_used = rims[k].is_used = true;
      const Circle3& circle = rim.circle;
      found.push_back({RoundKind::cylinder, circle.centre, rims[k].circle.centre, circle.axis, circle.radius, kWhole});
    }
  }
  return found;
}

constexpr double kLeastTurn = 160 * std::numbers::pi / 180, kLeastArc = 40 * std::numbers::pi / 180;
constexpr double kOneArc = 0.9;  // pieces apart from each other add up to less than this share of one arc

/// Appends a shape, with the ids of its triangles.
template <class Shape>
void append(Shape shape, std::span<const std::uint32_t> triangles, const WeldedMesh& mesh, std::vector<Shape>& shapes,
            std::vector<PrimitiveId>& all_ids) {
  std::vector<PrimitiveId> ids;
  for (const std::uint32_t t : triangles) ids.push_back(mesh.ids[t]);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  shape.first = std::uint32_t(all_ids.size());
  shape.count = std::uint32_t(ids.size());
  shapes.push_back(shape);
  all_ids.insert(all_ids.end(), ids.begin(), ids.end());
}

/// Appends a round, unless too little of it exists.
void append(const FoundRound& found, const WeldedMesh& mesh, Rounds& all) {
  if (found.round.turn >= kLeastTurn) append(found.round, found.triangles, mesh, all.rounds, all.triangles);
}

/// Appends a circle of which too little exists for a round, unless its arcs are all around.
void append_arc(const FoundCircle& found, double turn, std::vector<CircleArc>& arcs) {
  if (turn < kLeastArc || turn >= kLeastTurn) return;
  const Circle3& circle = found.circle;
  glm::dvec3 out(0);
  // The integral of the directions of an arc, so that pieces add up to the whole.
  for (const FoundCircle::Arc& arc : found.arcs)
    out += (arc.from + arc.to - 2.0 * circle.centre) * std::tan(std::min(arc.turn, kLeastTurn) / 2);
  const double length = glm::length(out);
  if (!(length >= kOneArc * 2 * circle.radius * std::sin(turn / 2))) return;
  arcs.push_back({circle.centre, circle.axis, circle.radius, turn, circle.centre + out * (circle.radius / length)});
}

}  // namespace

Rounds find_rounds(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  const SmoothMesh mesh = smooth_mesh(surfaces, execution);
  Rounds all;
  const std::vector<FoundCircle> circles = find_circles(mesh, execution);
  for (const FoundCircle& found : circles) {
    const Circle3& circle = found.circle;
    const double turn = covered(found);
    append({{RoundKind::circle, circle.centre, circle.centre, circle.axis, circle.radius, turn}, found.triangles},
           mesh.mesh, all);
    append_arc(found, turn, all.arcs);
  }
  std::vector<FoundRound> walls = find_walls(mesh, circles, execution);
  find_depths(mesh, surfaces, walls, execution);
  for (const FoundRound& wall : walls) append(wall, mesh.mesh, all);
  std::vector<bool> is_taken(mesh.mesh.triangles.size());
  RevolvedFinder finder{mesh};
  for (std::uint32_t t = 0; t < is_taken.size(); ++t) {
    if (t % 4096 == 0) check_cancelled(execution);
    if (is_taken[t]) continue;
    if (const auto revolved = finder.find(region_from(t, mesh, is_taken))) append(*revolved, mesh.mesh, all);
  }
  all.prisms = find_prisms(mesh, execution);
  for (const FoundFlats& found : find_flats(mesh, all.rounds, execution))
    append(found.flats, found.triangles, mesh.mesh, all.flats, all.triangles);
  return all;
}

}  // namespace frontmost
