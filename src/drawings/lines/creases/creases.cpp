// SPDX-License-Identifier: Apache-2.0
// Folds are judged one by one, by the surfaces beside them (fold.cpp), and then together, in a graph of edges that
// share vertices:
//
//    judged      strong ---- weak ---- weak      smooth      follow_strong: weak folds that continue strong ones
//    followed    strong --- strong --- strong                thin: the faintest of a triangle's three creases goes
//    cut_short_ends: lines of one or two edges that end in the air go, unless they are long
//
// Grades only change from weak to strong, and from strong to smooth, so every pass comes to an end.
#include "lines/creases/creases.h"

#include <algorithm>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "geometry/buckets.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kEdgesPerPart = 256;
constexpr double kGoesOn = 0.5;          // the least cosine of the angle between a crease and its continuation
constexpr double kBend = 0.25;           // the least cosine between two edges that count as one line
constexpr double kFaintest = 0.75;       // a fainter crease goes: share of the greatest jump of a triangle's creases
constexpr std::size_t kFewestEdges = 3;  // the edges of a line that may end in the air
constexpr double kLong = 0.05;           // the length of a line that may end in the air, as a share of the mesh's
                                         // diagonal

bool is_fold(const FeatureEdge& edge) { return edge.kind == EdgeKind::crease || edge.kind == EdgeKind::silhouette; }

std::vector<JudgedFold> judge_folds(const SeenMesh& seen, const CornerTable& table,
                                    const std::vector<FeatureEdge>& edges, const Execution& execution) {
  const Neighbours near(seen, table, execution);
  std::vector<JudgedFold> folds(edges.size());
  parallel_for(execution, edges.size(), kEdgesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      folds[i] = is_fold(edges[i]) ? judge_fold(near, edges[i])
                                   : JudgedFold{FoldGrade::sharp, std::numeric_limits<double>::infinity()};
  });
  return folds;
}

/// The edges that may be drawn, by their end vertices.
class CreaseGraph {
 public:
  CreaseGraph(const WeldedMesh& mesh, const std::vector<FeatureEdge>& edges, std::vector<JudgedFold> folds,
              const Execution& execution);

  void follow_strong();
  void thin();
  void cut_short_ends();
  [[nodiscard]] bool is_drawn(std::size_t edge) const { return folds_[edge].grade >= FoldGrade::strong; }

 private:
  [[nodiscard]] std::span<const std::uint32_t> at(std::uint32_t vertex) const { return edges_at_[vertex]; }
  [[nodiscard]] std::uint32_t other_end(std::uint32_t edge, std::uint32_t vertex) const {
    return edges_[edge].from == vertex ? edges_[edge].to : edges_[edge].from;
  }
  /// The unit direction of the edge, away from one of its ends.
  [[nodiscard]] glm::dvec3 direction_from(std::uint32_t edge, std::uint32_t vertex) const {
    return glm::normalize(mesh_.positions[other_end(edge, vertex)] - mesh_.positions[vertex]);
  }
  /// The cosine of the angle between the end of one edge and the beginning of the next.
  [[nodiscard]] double bend(std::uint32_t edge, std::uint32_t next, std::uint32_t vertex) const {
    return -glm::dot(direction_from(edge, vertex), direction_from(next, vertex));
  }
  [[nodiscard]] std::size_t drawn_at(std::uint32_t vertex) const {
    const std::span<const std::uint32_t> here = at(vertex);
    return std::size_t(std::count_if(here.begin(), here.end(), [&](std::uint32_t e) { return is_drawn(e); }));
  }
  [[nodiscard]] std::vector<std::uint32_t> line_from(std::uint32_t tip) const;

  const WeldedMesh& mesh_;
  const std::vector<FeatureEdge>& edges_;
  const Execution& execution_;
  std::vector<JudgedFold> folds_;
  Buckets<std::uint32_t> edges_at_;  ///< by vertex
};

CreaseGraph::CreaseGraph(const WeldedMesh& mesh, const std::vector<FeatureEdge>& edges, std::vector<JudgedFold> folds,
                         const Execution& execution)
    : mesh_(mesh), edges_(edges), execution_(execution), folds_(std::move(folds)) {
  const auto list = [&](std::size_t i, const auto& add) {
    if (folds_[i].grade == FoldGrade::smooth) return;
    add(edges_[i].from, std::uint32_t(i));
    add(edges_[i].to, std::uint32_t(i));
  };
  edges_at_ = Buckets<std::uint32_t>(mesh.positions.size(), edges_.size(), list, execution);
}

/// Makes weak folds strong that continue strong ones.
void CreaseGraph::follow_strong() {
  std::vector<std::uint32_t> open;
  for (std::size_t i = 0; i < edges_.size(); ++i)
    if (is_drawn(i) && is_fold(edges_[i])) open.push_back(std::uint32_t(i));
  while (!open.empty()) {
    const std::uint32_t edge = open.back();
    open.pop_back();
    for (const std::uint32_t vertex : {edges_[edge].from, edges_[edge].to})
      for (const std::uint32_t next : at(vertex)) {
        if (folds_[next].grade != FoldGrade::weak || bend(edge, next, vertex) < kGoesOn) continue;
        folds_[next].grade = FoldGrade::strong;
        open.push_back(next);
      }
  }
}

/// Removes the faintest crease of triangles with three. A crease that zigzags across a row of triangles gives them
/// three.
void CreaseGraph::thin() {
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      if (is_drawn(i) && is_fold(edges_[i]))
        for (const std::uint32_t triangle : {edges_[i].left, edges_[i].right}) visit(triangle, std::uint32_t(i));
  };
  Buffer<std::uint8_t> creases(mesh_.triangles.size(), 0);
  for_each_side([&](std::uint32_t triangle, std::uint32_t) { ++creases[triangle]; });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;  // triangle, edge
  for_each_side([&](std::uint32_t triangle, std::uint32_t edge) {
    if (creases[triangle] == 3) sides.emplace_back(triangle, edge);
  });
  std::sort(sides.begin(), sides.end());
  std::vector<std::uint32_t> faint;
  const auto less = [&](const auto& a, const auto& b) { return folds_[a.second].jump < folds_[b.second].jump; };
  for (std::size_t i = 0; i + 2 < sides.size(); i += 3) {
    const auto [least, most] = std::minmax_element(&sides[i], &sides[i] + 3, less);
    const JudgedFold& fold = folds_[least->second];
    if (fold.grade == FoldGrade::strong && fold.jump < kFaintest * folds_[most->second].jump)
      faint.push_back(least->second);
  }
  for (const std::uint32_t edge : faint) folds_[edge].grade = FoldGrade::smooth;
}

/// The line from a vertex with one edge to where others meet it, or it bends sharply, or it is long enough.
std::vector<std::uint32_t> CreaseGraph::line_from(std::uint32_t tip) const {
  std::vector<std::uint32_t> line;
  for (std::uint32_t vertex = tip; line.size() < kFewestEdges;) {
    std::uint32_t next = no_index;
    for (const std::uint32_t edge : at(vertex))
      if (is_drawn(edge) && (line.empty() || edge != line.back())) next = edge;
    if (next == no_index || !is_fold(edges_[next])) break;
    if (!line.empty() && bend(line.back(), next, vertex) < kBend) break;
    line.push_back(next);
    vertex = other_end(next, vertex);
    if (drawn_at(vertex) != 2) break;
  }
  return line;
}

void CreaseGraph::cut_short_ends() {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  std::vector<std::uint32_t> tips;
  for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) {
    low = glm::min(low, mesh_.positions[v]);
    high = glm::max(high, mesh_.positions[v]);
    if (drawn_at(v) == 1) tips.push_back(v);
  }
  const double least = kLong * glm::distance(low, high);
  for (std::size_t i = 0; i < tips.size(); ++i) {
    if (i % kEdgesPerPart == 0) check_cancelled(execution_);
    if (drawn_at(tips[i]) != 1) continue;
    const std::vector<std::uint32_t> line = line_from(tips[i]);
    double length = 0;
    for (const std::uint32_t edge : line)
      length += glm::distance(mesh_.positions[edges_[edge].from], mesh_.positions[edges_[edge].to]);
    if (line.empty() || line.size() >= kFewestEdges || length > least) continue;
    for (const std::uint32_t edge : line) folds_[edge].grade = FoldGrade::smooth;
    // An edge that met the removed line may end in the air now.
    for (const std::uint32_t vertex : {edges_[line.back()].from, edges_[line.back()].to})
      if (drawn_at(vertex) == 1) tips.push_back(vertex);
  }
}

}  // namespace

void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution) {
  CreaseGraph graph(seen.mesh, edges, judge_folds(seen, table, edges, execution), execution);
  graph.follow_strong();
  graph.thin();
  graph.cut_short_ends();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].kind != EdgeKind::crease || graph.is_drawn(i)) edges[kept++] = edges[i];
  edges.resize(kept);
}

}  // namespace frontmost::lines_detail
