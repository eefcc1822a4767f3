// SPDX-License-Identifier: Apache-2.0
//     patch A  | |  patch B       Rims of both patches lie beside each other, nearer than the widest gap and than a
//              | |                sixteenth of their length, and their triangles are on different sides. A rim is a
//     ---------+ +---------       gap if such rims lie beside it all along: their stretches have to cover its length.
//
// Open sides are found by a tree of boxes. The set of sides beside a rim does not depend on the order in which the tree
// finds them. A rim with more than 64 sides beside it stays undecided.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lines/creases/neighbours.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kMostInLeaf = 8, kMostBeside = 64;
constexpr double kShare = 1.0 / 16;  // the widest gap, as a share of an edge's length
constexpr double kAcross = 0.5;      // least cosine of the angle between the directions into both triangles

/// A side of one triangle alone.
struct OpenSide {
  glm::dvec3 from, along, normal,
      ahead;  ///< `from` is a point, the others unit vectors; `ahead` points into the triangle
  double length;
  std::uint32_t edge, triangle;
  std::array<std::uint32_t, 2> ends;
  Box box;
};

OpenSide open_side(const WeldedMesh& mesh, const FeatureEdge& edge, std::uint32_t number) {
  const glm::dvec3 from = mesh.positions[edge.from], to = mesh.positions[edge.to];
  const std::uint32_t tip = third_of(mesh.triangles[edge.left], edge.from, edge.to);
  const double length = glm::distance(from, to);
  const glm::dvec3 along = (to - from) / length, normal = normal_of(mesh, edge.left);
  const glm::dvec3 to_tip = mesh.positions[tip] - from, across = to_tip - along * glm::dot(to_tip, along);
  OpenSide side{from,
                along,
                normal / glm::length(normal),
                across / glm::length(across),
                length,
                number,
                edge.left,
                {edge.from, edge.to},
                {}};
  side.box.include(mesh.positions.places()[edge.from]);
  side.box.include(mesh.positions.places()[edge.to]);
  return side;
}

/// Open sides in a binary tree of boxes.
class SideTree {
 public:
  explicit SideTree(std::vector<OpenSide> sides) : sides_(std::move(sides)), boxes_(1) { build(0, 0, sides_.size()); }

  [[nodiscard]] const std::vector<OpenSide>& sides() const { return sides_; }
  /// Visits sides whose boxes touch `box`, until `visit` returns false.
  template <class Visit>
  void visit_near(const Box& box, const Visit& visit) const {
    (void)visit_node(0, 0, sides_.size(), box, visit);
  }

 private:
  void build(std::size_t node, std::size_t begin, std::size_t end) {
    if (node >= boxes_.size()) boxes_.resize(node + 1);
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.include(sides_[i].box);
    boxes_[node] = box;
    if (end - begin <= kMostInLeaf) return;
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](const OpenSide& side) { return side.box.low[axis] + side.box.high[axis]; };
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(sides_.begin() + std::ptrdiff_t(begin), sides_.begin() + std::ptrdiff_t(middle),
                     sides_.begin() + std::ptrdiff_t(end), [&](const OpenSide& a, const OpenSide& b) {
                       return std::pair(place(a), a.edge) < std::pair(place(b), b.edge);
                     });
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
  }

  static bool overlap(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis)
      if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
    return true;
  }

  template <class Visit>
  [[nodiscard]] bool visit_node(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                                const Visit& visit) const {
    if (!overlap(boxes_[node], box)) return true;
    if (end - begin <= kMostInLeaf) {
      for (std::size_t i = begin; i < end; ++i)
        if (overlap(sides_[i].box, box) && !visit(sides_[i])) return false;
      return true;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    return visit_node(2 * node + 1, begin, middle, box, visit) && visit_node(2 * node + 2, middle, end, box, visit);
  }

  std::vector<OpenSide> sides_;
  std::vector<Box> boxes_;
};

/// Whether stretches cover a length, up to holes of `slack`.
bool cover(std::vector<std::pair<double, double>>& stretches, double length, double slack) {
  std::sort(stretches.begin(), stretches.end());
  double reached = 0;
  for (const auto& [begin, end] : stretches) {
    if (begin > reached + slack) return false;
    reached = std::max(reached, end);
  }
  return reached >= length - slack;
}

class Gaps {
 public:
  Gaps(const SeenMesh& seen, const GapOptions& options, std::vector<OpenSide> sides)
      : seen_(seen), options_(options), tree_(std::move(sides)) {}

  [[nodiscard]] const std::vector<OpenSide>& sides() const { return tree_.sides(); }

  /// Whether the side is a gap. Adds its vertices, with those beyond the gap, to `continued`.
  [[nodiscard]] bool is_one(const OpenSide& side, VertexPairs& continued) const {
    const double widest = std::min(options_.widest, kShare * side.length);
    Box box = side.box;
    box.low -= glm::vec3(float(widest));
    box.high += glm::vec3(float(widest));
    std::vector<std::pair<double, double>> stretches;
    const std::size_t first = continued.size();
    std::size_t count = 0;
    tree_.visit_near(box, [&](const OpenSide& other) {
      if (other.edge == side.edge) return true;
      const auto stretch = stretch_beside(side, other, widest);
      if (stretch.first < stretch.second && goes_on(side, other)) {
        stretches.push_back(stretch);
        for (const std::uint32_t own : side.ends)
          for (const std::uint32_t its : other.ends) continued.emplace_back(std::minmax({own, its}));
      }
      return ++count <= kMostBeside;
    });
    const bool is_gap = count <= kMostBeside && cover(stretches, side.length, 2 * widest);
    if (!is_gap) continued.resize(first);
    return is_gap;
  }

 private:
  /// The stretch of `side` beside which `other` lies, in lengths from its beginning; empty if there is none.
  static std::pair<double, double> stretch_beside(const OpenSide& side, const OpenSide& other, double widest) {
    const double slope = glm::dot(other.along, side.along);
    if (slope == 0) return {0, 0};
    const glm::dvec3 start = other.from - side.from;
    const double s = glm::dot(start, side.along), e = s + slope * other.length;
    // A little beyond the ends: triangles that meet the side only at a corner may reach into its own triangle.
    const double begin = std::max(-widest, std::min(s, e)), end = std::min(side.length + widest, std::max(s, e));
    const auto is_near = [&](double at) {
      const glm::dvec3 place = start + other.along * ((at - s) / slope);
      return glm::length(place - side.along * at) <= widest;
    };
    return begin < end && is_near(begin) && is_near(end) ? std::pair(begin, end) : std::pair(0.0, 0.0);
  }

  [[nodiscard]] bool goes_on(const OpenSide& side, const OpenSide& other) const {
    const double cosine = glm::dot(side.normal, other.normal);
    const int facing = seen_.facing[side.triangle];
    return glm::dot(side.ahead, other.ahead) < -kAcross && std::abs(cosine) > options_.cosine && facing != 0 &&
           facing == seen_.facing[other.triangle] * (cosine < 0 ? -1 : 1) &&
           options_.surface_of(side.triangle) == options_.surface_of(other.triangle);
  }

  const SeenMesh& seen_;
  const GapOptions& options_;
  SideTree tree_;
};

}  // namespace

VertexPairs leave_out_gaps(const SeenMesh& seen, const GapOptions& options, std::vector<FeatureEdge>& edges) {
  std::vector<OpenSide> sides;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].kind == EdgeKind::boundary && edges[i].right == no_index && seen.facing[edges[i].left] != 0)
      sides.push_back(open_side(seen.mesh, edges[i], std::uint32_t(i)));
  if (sides.empty() || sides.size() > options.triangles) return {};
  const Gaps gaps(seen, options, std::move(sides));
  VertexPairs continued;
  std::vector<bool> is_gap(edges.size(), false);
  for (const OpenSide& side : gaps.sides()) is_gap[side.edge] = gaps.is_one(side, continued);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_gap[i]) edges[kept++] = edges[i];
  edges.resize(kept);
  std::sort(continued.begin(), continued.end());
  continued.erase(std::unique(continued.begin(), continued.end()), continued.end());
  return continued;
}

bool meet_at_gap(const WeldedMesh& mesh, const VertexPairs& continued, std::uint32_t a, std::uint32_t b) {
  if (continued.empty()) return false;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax({mesh.triangles[a][i], mesh.triangles[b][k]});
      if (std::binary_search(continued.begin(), continued.end(), pair)) return true;
    }
  return false;
}

}  // namespace frontmost::lines_detail
