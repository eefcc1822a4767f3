// SPDX-License-Identifier: Apache-2.0
// Circles among the sharp edges of a mesh, and cylinders (walls) that begin at them or at two smooth neighbours.
//
//    corners of a chain     0   1   2   3   4   5   6   7   8   9 ...
//    tried                  |---------------|  4 sides fit, then 8, until some do not; then the step is halved
//
// A circle goes through the first, middle and last vertex of a run. Arcs of one circle are united, because a rim is
// split wherever another edge meets it. A wall grows over all smooth neighbours that are parallel to its axis and have
// their vertices at its radius. Two neighbours determine its axis worse than a circle, so their tube is fitted again.
#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

#include "base/parallel.h"
#include "geometry/buckets.h"
#include "lines/strokes/parts.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kShortestArc = 40 * std::numbers::pi / 180;
constexpr double kSmallestRadius = 50;  // in units of noise: smaller circles cannot be told from polygons
constexpr double kSameCircle = 64;      // in units of noise: the uncertainty of the centres of short arcs
constexpr std::size_t kLargestStep = std::size_t(1) << 20;

struct RunFinder {
  void append_to(std::vector<FoundCircle>& found) const {
    if (chain.is_closed && sides >= 18) {
      const auto circle = circle_through(corner(0), corner(sides / 3), corner(2 * sides / 3));
      const auto turn = circle ? turn_along(*circle, 0, sides) : std::nullopt;
      if (turn && std::abs(std::abs(*turn) - kWhole) < 1e-6)
        return found.push_back({*circle, {{corner(0), corner(0), kWhole}}, triangles_of(0, sides)});
    }
    // The first vertex of a closed chain may lie in the middle of an arc, whose two parts are united later.
    for (std::size_t at = 0; at + kFewestSides <= sides;) {
      const std::size_t end = longest_run(
          at, kFewestSides, sides, [&](std::size_t last) { return fit(at, last).has_value(); }, kLargestStep);
      // A circle through three points has their orientation.
      if (const auto arc = end > at ? fit(at, end) : std::nullopt; arc && arc->second >= kShortestArc)
        found.push_back({arc->first, {{corner(at), corner(end), arc->second}}, triangles_of(at, end)});
      at = std::max(at + 1, end);
    }
  }

  [[nodiscard]] glm::dvec3 corner(std::size_t i) const {
    return mesh.mesh.positions[chain.vertices[i % chain.vertices.size()]];
  }

  /// The angle that the sides from `first` to `last` cover around the circle; none if these sides are not chords of the
  /// circle.
  [[nodiscard]] std::optional<double> turn_along(const Circle3& circle, std::size_t first, std::size_t last) const {
    if (!(circle.radius >= kSmallestRadius * mesh.noise)) return std::nullopt;
    double turn = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double by = circle.turn_between(corner(i), corner(i + 1));
      if (!(std::abs(by) <= kWidestStep && by * turn >= 0)) return std::nullopt;
      turn += by;
    }
    const double slack = std::max(mesh.noise, sagitta(circle.radius, turn / double(last - first)) / 4);
    for (std::size_t i = first; i <= last; ++i)
      if (!(circle.distance(corner(i)) <= slack)) return std::nullopt;
    return turn;
  }

  [[nodiscard]] std::optional<std::pair<Circle3, double>> fit(std::size_t first, std::size_t last) const {
    const auto circle = circle_through(corner(first), corner((first + last) / 2), corner(last));
    if (!circle) return std::nullopt;
    const auto turn = turn_along(*circle, first, last);
    if (!turn || std::abs(*turn) > 6.2) return std::nullopt;
    return std::pair(*circle, *turn);
  }

  [[nodiscard]] std::vector<std::uint32_t> triangles_of(std::size_t first, std::size_t last) const {
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = first; i < last; ++i) {
      const SharpEdge& edge = all.edges[chain.edges[i]];
      triangles.push_back(edge.left);
      if (edge.right != no_index) triangles.push_back(edge.right);
    }
    return triangles;
  }

  const SmoothMesh& mesh;
  const SharpChains& all;
  const SharpChain& chain;
  const std::size_t sides = chain.edges.size();
};

/// Unites arcs that lie on one circle.
class ArcJoiner {
 public:
  ArcJoiner(double noise, std::vector<FoundCircle>& circles) : same_(kSameCircle * noise), circles_(circles) {}

  void add(FoundCircle arc) {
    const glm::dvec3 cell = arc.circle.centre / (2 * same_);
    const Key middle{std::int64_t(std::floor(cell.x)), std::int64_t(std::floor(cell.y)),
                     std::int64_t(std::floor(cell.z))};
    for (int i = 0; i < 8; ++i) {
      // The cell and its neighbours on the nearer sides suffice, because equal circles are less than half a cell away.
      const auto moved = [&](int axis) {
        const bool is_high = cell[axis] - std::floor(cell[axis]) >= 0.5;
        return (i >> axis & 1) == 0 ? 0 : is_high ? 1 : -1;
      };
      const auto found = places_.equal_range(
          {std::get<0>(middle) + moved(0), std::get<1>(middle) + moved(1), std::get<2>(middle) + moved(2)});
      int looked_at = 0;
      for (auto place = found.first; place != found.second && looked_at < kMostPerCell; ++place, ++looked_at)
        if (take(arc, circles_[place->second])) return;
    }
    places_.emplace(middle, circles_.size());
    circles_.push_back(std::move(arc));
  }

 private:
  using Key = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  static constexpr int kMostPerCell = 64;

  [[nodiscard]] bool take(FoundCircle& arc, FoundCircle& known) const {
    const Circle3 &a = arc.circle, &b = known.circle;
    if (!(glm::distance(a.centre, b.centre) <= same_ && std::abs(a.radius - b.radius) <= same_)) return false;
    if (!(glm::length(glm::cross(a.axis, b.axis)) * a.radius <= 2 * same_)) return false;
    const bool is_turned = glm::dot(a.axis, b.axis) < 0;
    for (const FoundCircle::Arc& part : arc.arcs)
      known.arcs.push_back(is_turned ? FoundCircle::Arc{part.to, part.from, part.turn} : part);
    known.triangles.insert(known.triangles.end(), arc.triangles.begin(), arc.triangles.end());
    return true;
  }

  const double same_;
  std::vector<FoundCircle>& circles_;
  std::multimap<Key, std::size_t> places_;
};

/// The circle that a mesh states, with the arcs between its edges and the triangles beside them.
FoundCircle found(const StatedCircle& stated, const SmoothMesh& mesh, const Buckets<std::uint32_t>& triangles_at) {
  FoundCircle result{{stated.centre, stated.axis, stated.radius}, {}, {}};
  for (const glm::uvec2& edge : stated.edges) {
    const glm::dvec3 from = mesh.mesh.positions[edge.x], to = mesh.mesh.positions[edge.y];
    const double turn = result.circle.turn_between(from, to);
    result.arcs.push_back(turn > 0 ? FoundCircle::Arc{from, to, turn} : FoundCircle::Arc{to, from, -turn});
    // A hub has many triangles.
    const auto [hub, other] = triangles_at[edge.x].size() > triangles_at[edge.y].size() ? std::pair(edge.x, edge.y)
                                                                                        : std::pair(edge.y, edge.x);
    for (const std::uint32_t triangle : triangles_at[other]) {
      const glm::uvec3& corners = mesh.mesh.triangles[triangle];
      if (corners.x == hub || corners.y == hub || corners.z == hub) result.triangles.push_back(triangle);
    }
  }
  return result;
}

constexpr std::size_t kSeedsPerPart = 4096;
constexpr double kFlat = 0.9999999;  // cosine of 0.026 degrees: triangles that turn by less lie in one plane
constexpr double kUpright = 0.01;    // radians: greatest lean of a triangle that counts as parallel to the axis
constexpr double kRoughlyUpright = 0.1;
constexpr double kFacesOut = 0.9;       // least cosine between the normal and the direction from the axis
constexpr double kWholeSagitta = 1.05;  // times the sagitta of the mean side
constexpr double kSmallestTube = 50;
constexpr std::size_t kFewestTriangles = 8;

/// The tube about this axis that fits the points best (I. Kasa's fit of circles). None if the points lie on a line.
std::optional<Tube> tube_through(std::span<const glm::dvec3> points, const glm::dvec3& axis) {
  const Across across(axis);
  glm::dvec3 middle(0);
  for (const glm::dvec3& p : points) middle += p;
  middle /= double(points.size());
  // x^2 + y^2 = 2 a x + 2 b y + c, about the middle: sums of x and y are 0.
  double xx = 0, xy = 0, yy = 0, xs = 0, ys = 0, squares = 0;
  for (const glm::dvec3& p : points) {
    const double x = glm::dot(p - middle, across.u), y = glm::dot(p - middle, across.v), s = x * x + y * y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xs += x * s;
    ys += y * s;
    squares += s;
  }
  const double determinant = 2 * (xx * yy - xy * xy);
  if (!(determinant > 1e-14 * squares * squares)) return std::nullopt;
  const double a = (xs * yy - ys * xy) / determinant, b = (ys * xx - xs * xy) / determinant;
  const double radius = std::sqrt(squares / double(points.size()) + a * a + b * b);
  if (!std::isfinite(radius)) return std::nullopt;
  return Tube{middle + a * across.u + b * across.v, axis, radius};
}

/// The direction that is closest to perpendicular to all vectors.
glm::dvec3 common_perpendicular(std::span<const glm::dvec3> vectors) {
  glm::dmat3 sum(0);
  for (const glm::dvec3& n : vectors) sum += glm::outerProduct(n, n);
  // The adjugate's powers converge to the eigenvector of the least eigenvalue.
  const auto adjugate = [](const glm::dmat3& m) {
    return glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  };
  glm::dmat3 power = adjugate(sum);
  for (int i = 0; i < 4; ++i) {
    const double trace = power[0][0] + power[1][1] + power[2][2];
    if (!(trace > 0)) return glm::dvec3(0, 0, 1);
    power /= trace;
    power = power * power;
  }
  glm::dvec3 longest = power[0];
  for (const int i : {1, 2})
    if (glm::dot(power[i], power[i]) > glm::dot(longest, longest)) longest = power[i];
  return unit_of(longest, glm::dvec3(0, 0, 1));
}

/// Two triangles that might lie about an axis along their common side.
struct Seed {
  std::uint32_t triangle;
  int side;
};

struct Seeds {
  const SmoothMesh& mesh;

  [[nodiscard]] bool is_one(const Seed& seed) const {
    const std::uint32_t other = mesh.across(seed.triangle, seed.side);
    if (other == no_index || other < seed.triangle || !mesh.is_smooth(seed.triangle, seed.side)) return false;
    if (glm::dot(mesh.normals[seed.triangle], mesh.normals[other]) > kFlat) return false;
    const glm::dvec3 side = mesh.corner(seed.triangle, (seed.side + 1) % 3) - mesh.corner(seed.triangle, seed.side);
    return goes_on(seed.triangle, other, side) && goes_on(other, seed.triangle, side);
  }

  /// Whether `triangle` has, apart from `before`, a smooth neighbour parallel to the axis, and no other smooth
  /// neighbour that is part of a doubly curved surface.
  [[nodiscard]] bool goes_on(std::uint32_t triangle, std::uint32_t before, const glm::dvec3& side) const {
    const double length = glm::length(side);
    const glm::dvec3 axis = side / length;
    bool has_one = false;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = mesh.across(triangle, k);
      if (next == before || !mesh.is_smooth(triangle, k)) continue;
      if (std::abs(lean(next, axis)) <= kUpright)
        has_one = true;
      else if (2 * height(next, axis) > length && leans_on(next, axis))
        return false;
    }
    return has_one;
  }

  /// Whether the next ring leans twice as much as this triangle, as beside a ring of a sphere or torus, which is no
  /// cylinder. A fillet leans by half a step and then by three halves; a slight chamfer does not lean more.
  [[nodiscard]] bool leans_on(std::uint32_t triangle, const glm::dvec3& axis) const {
    const double first = lean(triangle, axis);
    const auto is_twice = [&](std::uint32_t t) { return std::abs(lean(t, axis) / first - 2) < 0.4; };
    for (int k = 0; k < 3; ++k) {
      if (!mesh.is_smooth(triangle, k)) continue;
      const std::uint32_t next = mesh.across(triangle, k);
      if (is_twice(next)) return true;
      // The next ring may begin beyond the other half of the triangle's quad.
      for (int j = 0; j < 3; ++j)
        if (mesh.is_smooth(next, j) && is_twice(mesh.across(next, j))) return true;
    }
    return false;
  }

  /// The extent of a triangle along the axis.
  [[nodiscard]] double height(std::uint32_t triangle, const glm::dvec3& axis) const {
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = glm::dot(mesh.corner(triangle, k), axis);
    return *std::max_element(at, at + 3) - *std::min_element(at, at + 3);
  }

  /// The angle between a triangle and the axis; 0 if it is parallel to the axis.
  [[nodiscard]] double lean(std::uint32_t triangle, const glm::dvec3& axis) const {
    return std::asin(std::clamp(glm::dot(mesh.normals[triangle], axis), -1.0, 1.0));
  }
};

struct WallGrower {
  /// None if the seed's surface is no cylinder, or already part of one.
  [[nodiscard]] std::optional<FoundRound> grow(const Seed& seed) {
    const std::uint32_t other = mesh.across(seed.triangle, seed.side);
    if (is_used[seed.triangle] || is_used[other] || !start(seed, other)) return std::nullopt;
    return grown(true);
  }

  /// Grows a wall from `triangle`, which has a side on `circle`, if the triangle is parallel to the circle's axis.
  /// `step` is the angle of a side. With `may_be_cut`, vertices may also lie inside of the radius, on chords, because
  /// something else cuts the wall there. A circle is precise enough to allow that.
  [[nodiscard]] std::optional<FoundRound> grow(const Circle3& circle, double step, std::uint32_t triangle,
                                               bool may_be_cut) {
    if (is_used[triangle]) return std::nullopt;
    current = {circle.centre, circle.axis, circle.radius};
    slack = std::max(mesh.noise, sagitta(circle.radius, step) / 4);
    within = may_be_cut ? std::max(slack, kWholeSagitta * sagitta(circle.radius, step)) : slack;
    outside = glm::dot(mesh.normals[triangle], current.outwards(mesh.corner(triangle, 0))) > 0 ? 1 : -1;
    if (!holds(triangle)) return std::nullopt;
    triangles.clear();
    take(triangle);
    return grown(false);
  }

  /// Grows the current triangles. The axis of a circle is not fitted.
  std::optional<FoundRound> grown(bool fits) {
    std::size_t fitted = std::max(triangles.size(), kFewestTriangles / 2);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!mesh.is_smooth(triangles[i], k)) continue;
        const std::uint32_t next = mesh.across(triangles[i], k);
        if (!is_used[next] && holds(next)) take(next);
      }
      if (!fits || triangles.size() < 2 * fitted) continue;
      fitted = triangles.size();
      if (!fit()) break;
    }
    if (triangles.size() >= kFewestTriangles) {
      if (!fits || (fit() && holds_all())) return measured();
      return std::nullopt;
    }
    // Too few triangles are released again, because they may belong to a wall that begins with a better axis.
    for (const std::uint32_t t : triangles) is_used[t] = false;
    return std::nullopt;
  }

  bool start(const Seed& seed, std::uint32_t other) {
    const glm::dvec3 from = mesh.corner(seed.triangle, seed.side);
    const glm::dvec3 to = mesh.corner(seed.triangle, (seed.side + 1) % 3);
    const glm::dvec3 left = mesh.corner(seed.triangle, (seed.side + 2) % 3);
    glm::dvec3 right = from;
    for (int k = 0; k < 3; ++k)
      if (const glm::dvec3 at = mesh.corner(other, k); at != from && at != to) right = at;
    const glm::dvec3 points[] = {from, left, right};
    const auto tube = tube_through(points, glm::normalize(to - from));
    if (!tube || !(tube->radius >= kSmallestTube * mesh.noise)) return false;
    current = *tube;
    const double step = std::acos(std::min(1.0, glm::dot(mesh.normals[seed.triangle], mesh.normals[other])));
    slack = within = std::max(mesh.noise, sagitta(current.radius, step) / 4);
    outside = glm::dot(mesh.normals[seed.triangle], current.outwards(from)) > 0 ? 1 : -1;
    triangles.clear();
    take(seed.triangle);
    take(other);
    return true;
  }

  void take(std::uint32_t triangle) {
    is_used[triangle] = true;
    triangles.push_back(triangle);
  }

  [[nodiscard]] bool holds(std::uint32_t triangle) const {
    const glm::dvec3& normal = mesh.normals[triangle];
    if (std::abs(glm::dot(normal, current.axis)) > kRoughlyUpright) return false;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 at = mesh.corner(triangle, k), out = current.outwards(at);
      const double length = glm::length(out);
      if (!(length - current.radius <= slack && current.radius - length <= within &&
            outside * glm::dot(normal, out) >= kFacesOut * length))
        return false;
    }
    return true;
  }
  [[nodiscard]] bool holds_all() const {
    return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) { return holds(t); });
  }

  bool fit() {
    std::vector<glm::dvec3> normals, points;
    for (const std::uint32_t t : triangles) {
      // The first ring of a fillet may lie within the tolerance of the radius, but is not part of the wall.
      if (std::abs(glm::dot(mesh.normals[t], current.axis)) > kUpright) continue;
      normals.push_back(mesh.normals[t]);
      for (int k = 0; k < 3; ++k) points.push_back(mesh.corner(t, k));
    }
    const auto tube = tube_through(points, common_perpendicular(normals));
    if (tube) current = *tube;
    return tube.has_value();
  }

  [[nodiscard]] FoundRound measured() {
    const Across across(current.axis);
    std::vector<double> angles;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::uint32_t t : triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 at = mesh.corner(t, k), out = current.outwards(at);
        angles.push_back(std::atan2(glm::dot(out, across.v), glm::dot(out, across.u)));
        low = std::min(low, glm::dot(at - current.point, current.axis));
        high = std::max(high, glm::dot(at - current.point, current.axis));
      }
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + kWhole - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    std::sort(triangles.begin(), triangles.end());
    const double turn = gap <= kWidestStep ? kWhole : kWhole - gap;
    return {{RoundKind::cylinder, current.point + low * current.axis, current.point + high * current.axis, current.axis,
             current.radius, turn, outside < 0},
            triangles};
  }

  const SmoothMesh& mesh;
  std::vector<bool> is_used = std::vector<bool>(mesh.mesh.triangles.size());
  Tube current{};
  double slack = 0, within = 0, outside = 1;  ///< slack and within: how far vertices may lie outside and inside of
                                              ///< the radius; outside: 1, or -1 if hollow
  std::vector<std::uint32_t> triangles{};
};

}  // namespace

double covered(const FoundCircle& circle) {
  std::vector<std::pair<double, double>> spans;  // angles from the beginning of the first arc
  for (const FoundCircle::Arc& arc : circle.arcs) {
    double begin = circle.circle.turn_between(circle.arcs[0].from, arc.from);
    if (begin < 0) begin += kWhole;
    spans.emplace_back(begin, std::min(kWhole, begin + arc.turn));
    if (begin + arc.turn > kWhole) spans.emplace_back(0, begin + arc.turn - kWhole);
  }
  std::sort(spans.begin(), spans.end());
  double sum = 0, reached = 0;
  for (const auto& [begin, end] : spans) {
    sum += std::max(0.0, end - std::max(begin, reached));
    reached = std::max(reached, end);
  }
  return sum;
}

std::vector<FoundCircle> find_circles(const SmoothMesh& mesh, const Execution& execution) {
  const SharpChains all = sharp_chains(mesh, execution);
  constexpr std::size_t chains_per_part = 64;
  std::vector<std::vector<FoundCircle>> lists((all.chains.size() + chains_per_part - 1) / chains_per_part);
  parallel_for(execution, all.chains.size(), chains_per_part, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      RunFinder{mesh, all, all.chains[i]}.append_to(lists[begin / chains_per_part]);
  });
  std::vector<FoundCircle> circles;
  ArcJoiner joiner(mesh.noise, circles);
  // Stated circles come first, because arcs of the same circle that chains have are added to them.
  if (!mesh.mesh.stated.circles().empty()) {
    const std::vector<StatedCircle>& stated = mesh.mesh.stated.circles();
    const auto list = [&](std::size_t triangle, const auto& add) {
      for (int k = 0; k < 3; ++k) add(mesh.mesh.triangles[triangle][k], std::uint32_t(triangle));
    };
    const Buckets<std::uint32_t> triangles_at(mesh.mesh.positions.size(), mesh.mesh.triangles.size(), list, execution);
    for (const StatedCircle& circle : stated)
      if (FoundCircle ready = found(circle, mesh, triangles_at); !ready.arcs.empty()) joiner.add(std::move(ready));
  }
  for (std::vector<FoundCircle>& list : lists)
    for (FoundCircle& circle : list) joiner.add(std::move(circle));
  if (!mesh.mesh.stated.circles().empty())
    for (FoundCircle& circle : circles) {
      std::sort(circle.triangles.begin(), circle.triangles.end());
      circle.triangles.erase(std::unique(circle.triangles.begin(), circle.triangles.end()), circle.triangles.end());
    }
  return circles;
}

std::vector<FoundRound> find_walls(const SmoothMesh& mesh, const std::vector<FoundCircle>& circles,
                                   const Execution& execution) {
  std::vector<FoundRound> walls;
  WallGrower grower{mesh};
  const auto keep = [&](std::optional<FoundRound> wall) {
    if (wall) walls.push_back(std::move(*wall));
  };
  const auto grow_from_circles = [&](bool may_be_cut) {
    for (const FoundCircle& circle : circles) {
      check_cancelled(execution);
      // The mean angle of a side, because most sides have two triangles.
      const double step = std::min(kWidestStep, 2 * covered(circle) / double(circle.triangles.size()));
      for (const std::uint32_t triangle : circle.triangles)
        keep(grower.grow(circle.circle, step, triangle, may_be_cut));
    }
  };
  grow_from_circles(false);
  const std::size_t count = mesh.mesh.triangles.size();
  std::vector<std::vector<Seed>> lists((count + kSeedsPerPart - 1) / kSeedsPerPart);
  parallel_for(execution, count, kSeedsPerPart, [&](std::size_t begin, std::size_t end) {
    const Seeds seeds{mesh};
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
