// SPDX-License-Identifier: Apache-2.0
// Where several sharp edges meet at a vertex, pairs of them continue each other, the straightest pair first. So the rim
// of a hole is followed across edges that end in it. Chains are followed from their open ends first; the others are
// closed.
//
//       |                  at the vertex (o) the edges from left and right continue each other; the one from above
//    ---o---               ends
#include <algorithm>
#include <span>

#include "base/parallel.h"
#include "lines/lists.h"
#include "rounds/smooth_mesh.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kSharpPerPart = 4096;
/// More edges at one vertex belong to no circle, and would take the square of their number.
constexpr std::size_t kMostAtVertex = 16;

std::vector<SharpEdge> sharp_edges(const SmoothMesh& mesh, const Execution& execution) {
  const std::size_t triangles = mesh.mesh.triangles.size();
  std::vector<std::vector<SharpEdge>> lists((triangles + kSharpPerPart - 1) / kSharpPerPart);
  parallel_for(execution, triangles, kSharpPerPart, [&](std::size_t begin, std::size_t end) {
    std::vector<SharpEdge>& list = lists[begin / kSharpPerPart];
    for (auto t = std::uint32_t(begin); t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh.across(t, k);
        if ((other != no_index && other < t) || mesh.is_smooth(t, k)) continue;
        const glm::uvec3& corners = mesh.mesh.triangles[t];
        list.push_back({corners[k], corners[(k + 1) % 3], t, other});
      }
  });
  return joined(lists, execution);
}

/// An end of an edge: edge i has the ends 2 i and 2 i + 1.
using ChainEnd = std::uint32_t;

class Chainer {
 public:
  Chainer(const SmoothMesh& mesh, SharpChains& all, double least_cosine)
      : mesh_(mesh),
        edges_(all.edges),
        chains_(all.chains),
        next_(2 * edges_.size(), no_index),
        least_cosine_(least_cosine) {}

  void run(const Execution& execution) {
    join_all(execution);
    std::vector<bool> is_done(edges_.size());
    // First open chains from their ends, then the rest, which are closed.
    for (const bool closed : {false, true})
      for (std::uint32_t edge = 0; edge < edges_.size(); ++edge) {
        if (edge % 65536 == 0) check_cancelled(execution);
        if (is_done[edge]) continue;
        if (closed || next_[2 * edge] == no_index)
          follow(2 * edge + 1, closed, is_done);
        else if (next_[2 * edge + 1] == no_index)
          follow(2 * edge, closed, is_done);
      }
  }

 private:
  [[nodiscard]] std::uint32_t vertex(ChainEnd end) const {
    return end % 2 == 0 ? edges_[end / 2].from : edges_[end / 2].to;
  }

  /// The unit direction of the edge, away from this end.
  [[nodiscard]] glm::dvec3 direction(ChainEnd end) const {
    const glm::dvec3 along = mesh_.mesh.positions[vertex(end ^ 1)] - mesh_.mesh.positions[vertex(end)];
    const double length = glm::length(along);
    return length > 0 ? along / length : glm::dvec3(0);
  }

  void join_all(const Execution& execution) {
    std::vector<std::pair<std::uint32_t, ChainEnd>> ends(2 * edges_.size());
    for (ChainEnd end = 0; end < ends.size(); ++end) ends[end] = {vertex(end), end};
    std::sort(ends.begin(), ends.end());
    std::size_t steps = 0;
    for (auto begin = ends.begin(); begin != ends.end();) {
      if (++steps % 65536 == 0) check_cancelled(execution);
      const auto end = std::find_if(begin, ends.end(), [&](const auto& e) { return e.first != begin->first; });
      const auto count = std::size_t(end - begin);
      if (count <= kMostAtVertex) join({&*begin, count});
      begin = end;
    }
  }

  /// Joins the straightest pairs first.
  void join(std::span<const std::pair<std::uint32_t, ChainEnd>> ends) {
    struct Pair {
      double cosine;
      ChainEnd a, b;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        // Copies of an edge, from duplicate surfaces, do not continue each other.
        if (vertex(ends[i].second ^ 1) == vertex(ends[k].second ^ 1)) continue;
        const double cosine = -glm::dot(direction(ends[i].second), direction(ends[k].second));
        if (cosine >= least_cosine_) pairs.push_back({cosine, ends[k].second, ends[i].second});
      }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
      return p.cosine != q.cosine ? p.cosine > q.cosine : p.a != q.a ? p.a < q.a : p.b < q.b;
    });
    for (const Pair& pair : pairs) {
      if (next_[pair.a] != no_index || next_[pair.b] != no_index) continue;
      next_[pair.a] = pair.b;
      next_[pair.b] = pair.a;
    }
  }

  /// Follows a chain from the edge whose far end is `ahead`.
  void follow(ChainEnd ahead, bool closed, std::vector<bool>& is_done) {
    SharpChain chain;
    chain.is_closed = closed;
    while (!is_done[ahead / 2]) {
      is_done[ahead / 2] = true;
      chain.vertices.push_back(vertex(ahead ^ 1));
      chain.edges.push_back(ahead / 2);
      if (next_[ahead] == no_index) {
        chain.vertices.push_back(vertex(ahead));
        break;
      }
      ahead = next_[ahead] ^ 1;
    }
    if (chain.edges.size() >= kFewestSides) chains_.push_back(std::move(chain));
  }

  const SmoothMesh& mesh_;
  const std::vector<SharpEdge>& edges_;
  std::vector<SharpChain>& chains_;
  std::vector<ChainEnd> next_;  ///< by end: the end that continues it, or no_index
  double least_cosine_;         ///< of a turn
};

}  // namespace

SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution, double least_cosine) {
  SharpChains all;
  all.edges = sharp_edges(mesh, execution);
  if (all.edges.size() >= std::size_t(1) << 31)
    throw Error(ErrorCode::limit_exceeded, "rounds", "more than 2147483647 sharp edges");
  Chainer(mesh, all, least_cosine).run(execution);
  return all;
}

}  // namespace frontmost::lines_detail
