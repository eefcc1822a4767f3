// SPDX-License-Identifier: Apache-2.0
// The length of a run of vertices on a circle is doubled while it fits, and then halved, as for arcs of strokes. A
// circle through the first, middle and last vertex is as precise as the vertices; one through three neighbours is not.
//
//    corners of a chain     0   1   2   3   4   5   6   7   8   9 ...
//    tried                  |---------------|  4 sides fit
//                           |-------------------------------|  8 fit
//                           |---------------------------------------- ...  16 do not
//    then halved            the longest run that fits, in a logarithmic number of tries
//
// Arcs of one circle are then united, whatever chains they are in: a rim is split wherever another edge meets it.
// Circles are looked up by the grid cells of their centres. Equal circles are less than half a cell apart, so eight
// cells are searched.
#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

#include "base/parallel.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kShortestArc = 40 * std::numbers::pi / 180;
constexpr double kWhole = 2 * std::numbers::pi;
constexpr double kSmallestRadius = 50;  // in units of noise: smaller circles cannot be told from polygons
constexpr double kSameCircle = 64;      // in units of noise: the uncertainty of the centres of short arcs
constexpr std::size_t kLongestTry = std::size_t(1) << 20;

class RunFinder {
 public:
  RunFinder(const SmoothMesh& mesh, const SharpChains& all, const SharpChain& chain)
      : mesh_(mesh), all_(all), chain_(chain), sides_(chain.edges.size()) {}

  void append_to(std::vector<FoundCircle>& found) const {
    if (chain_.is_closed && sides_ >= 18) {
      if (const auto circle = whole_circle()) {
        found.push_back({*circle, {{corner(0), corner(0), kWhole}}, triangles_of(0, sides_)});
        return;
      }
    }
    // A closed chain is a run from its first vertex, which may lie in the middle of an arc. Such an arc comes in two
    // parts, which are united later.
    for (std::size_t at = 0; at + kFewestSides <= sides_;) {
      const std::size_t end = longest_run(at);
      if (end == at) {
        ++at;
        continue;
      }
      // A circle through three points has their orientation.
      if (const auto arc = fit(at, end); arc->second >= kShortestArc)
        found.push_back({arc->first, {{corner(at), corner(end), arc->second}}, triangles_of(at, end)});
      at = end;
    }
  }

 private:
  [[nodiscard]] glm::dvec3 corner(std::size_t i) const {
    return mesh_.mesh.positions[chain_.vertices[i % chain_.vertices.size()]];
  }

  /// The angle around the circle of the sides from `first` to `last`; none if they are not chords of it.
  [[nodiscard]] std::optional<double> turn_along(const Circle3& circle, std::size_t first, std::size_t last) const {
    if (!(circle.radius >= kSmallestRadius * mesh_.noise)) return std::nullopt;
    double turn = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double by = circle.turn_between(corner(i), corner(i + 1));
      if (!(std::abs(by) <= kWidestStep && by * turn >= 0)) return std::nullopt;
      turn += by;
    }
    const double slack = std::max(mesh_.noise, sagitta(circle.radius, turn / double(last - first)) / 4);
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

  [[nodiscard]] std::optional<Circle3> whole_circle() const {
    const auto circle = circle_through(corner(0), corner(sides_ / 3), corner(2 * sides_ / 3));
    if (!circle) return std::nullopt;
    const auto turn = turn_along(*circle, 0, sides_);
    return turn && std::abs(std::abs(*turn) - kWhole) < 1e-6 ? circle : std::nullopt;
  }

  [[nodiscard]] std::size_t longest_run(std::size_t first) const {
    std::size_t fits = first + kFewestSides;
    if (fits > sides_ || !fit(first, fits)) return first;
    std::size_t step = kFewestSides;
    while (fits < sides_ && step < kLongestTry && fit(first, std::min(sides_, fits + step))) {
      fits = std::min(sides_, fits + step);
      step *= 2;
    }
    for (; step > 0; step /= 2)
      if (fits + step <= sides_ && fit(first, fits + step)) fits += step;
    return fits;
  }

  [[nodiscard]] std::vector<std::uint32_t> triangles_of(std::size_t first, std::size_t last) const {
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = first; i < last; ++i) {
      const SharpEdge& edge = all_.edges[chain_.edges[i]];
      triangles.push_back(edge.left);
      if (edge.right != no_index) triangles.push_back(edge.right);
    }
    return triangles;
  }

  const SmoothMesh& mesh_;
  const SharpChains& all_;
  const SharpChain& chain_;
  const std::size_t sides_;
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
      // The neighbours on the nearer sides: equal circles are less than half a cell away.
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

}  // namespace

double covered(const FoundCircle& circle) {
  std::vector<std::pair<double, double>> spans;  // angles from the begin of the first arc
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
      RunFinder(mesh, all, all.chains[i]).append_to(lists[begin / chains_per_part]);
  });
  std::vector<FoundCircle> circles;
  ArcJoiner joiner(mesh.noise, circles);
  for (std::vector<FoundCircle>& list : lists)
    for (FoundCircle& circle : list) joiner.add(std::move(circle));
  return circles;
}

}  // namespace frontmost::lines_detail
