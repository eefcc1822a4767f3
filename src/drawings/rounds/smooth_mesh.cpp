// SPDX-License-Identifier: Apache-2.0
// Triangles are neighbours where exactly two share an edge and run along it in opposite directions. Every other edge,
// as of copies or of three triangles, is a border: nothing smooth goes on across it.
//
//       |        Where several sharp edges meet at a vertex (o), pairs of them continue each other, the straightest
//       pair
//    ---o---     first. Chains are followed from their open ends first; the others are closed.
#include <algorithm>
#include <tuple>

#include "base/parallel.h"
#include "lines/lists.h"
#include "lines/strokes/parts.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;
constexpr double kSixDigits = 2e-6;  // share of the largest coordinate

/// If more edges meet at a vertex, they belong to no circle, and pairing them would take the square of their number.
constexpr std::size_t kMostAtVertex = 16;

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
    std::vector<std::pair<std::uint32_t, ChainEnd>> all(2 * edges_.size());
    for (ChainEnd end = 0; end < all.size(); ++end) all[end] = {vertex(end), end};
    std::sort(all.begin(), all.end());
    std::size_t steps = 0;
    for (auto begin = all.begin(); begin != all.end();) {
      if (++steps % 65536 == 0) check_cancelled(execution);
      const auto end = std::find_if(begin, all.end(), [&](const auto& e) { return e.first != begin->first; });
      const auto count = std::size_t(end - begin);
      if (count <= kMostAtVertex) join({&*begin, count});
      begin = end;
    }
    for_each_chain(next_, [&](const std::vector<ChainEnd>& ends, bool is_closed) {
      if (++steps % 65536 == 0) check_cancelled(execution);
      if (ends.size() < kFewestSides) return;
      SharpChain& chain = chains_.emplace_back();
      chain.is_closed = is_closed;
      for (const ChainEnd end : ends) {
        chain.vertices.push_back(vertex(end));
        chain.edges.push_back(end / 2);
      }
      if (!is_closed) chain.vertices.push_back(vertex(ends.back() ^ 1));
    });
  }

 private:
  [[nodiscard]] std::uint32_t vertex(ChainEnd end) const {
    return end % 2 == 0 ? edges_[end / 2].from : edges_[end / 2].to;
  }

  /// The unit direction of the edge, away from this end.
  [[nodiscard]] glm::dvec3 direction(ChainEnd end) const {
    return unit_of(mesh_.mesh.positions[vertex(end ^ 1)] - mesh_.mesh.positions[vertex(end)]);
  }

  /// Joins the straightest pairs first.
  void join(std::span<const std::pair<std::uint32_t, ChainEnd>> ends) {
    std::vector<std::tuple<double, ChainEnd, ChainEnd>> pairs;  // with the negative cosine
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        // Copies of an edge, from duplicate surfaces, do not continue each other.
        if (vertex(ends[i].second ^ 1) == vertex(ends[k].second ^ 1)) continue;
        const double cosine = -glm::dot(direction(ends[i].second), direction(ends[k].second));
        if (cosine >= least_cosine_) pairs.emplace_back(-cosine, ends[k].second, ends[i].second);
      }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [turn, a, b] : pairs) {
      if (next_[a] != no_index || next_[b] != no_index) continue;
      next_[a] = b;
      next_[b] = a;
    }
  }

  const SmoothMesh& mesh_;
  const std::vector<SharpEdge>& edges_;
  std::vector<SharpChain>& chains_;
  std::vector<ChainEnd> next_;  ///< by end: the end that continues it, or no_index
  double least_cosine_;         ///< cosine of the largest turn
};

}  // namespace

Across::Across(const glm::dvec3& axis) {
  const glm::dvec3 size = glm::abs(axis);
  const glm::dvec3 least = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  u = glm::normalize(glm::cross(axis, least));
  v = glm::cross(axis, u);
}

SmoothMesh smooth_mesh(const Surfaces& surfaces, const Execution& execution) {
  SmoothMesh result;
  result.mesh = weld(surfaces, execution);
  const WeldedMesh& mesh = result.mesh;
  // Removes the fillers of T-junctions, which have no area and would split smooth surfaces.
  Buffer<std::int8_t> may_be_flat(mesh.triangles.size());
  for (std::size_t i = 0; i < may_be_flat.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    const glm::dvec3 at = mesh.positions[t.x], p = mesh.positions[t.y] - at, q = mesh.positions[t.z] - at;
    const glm::dvec3 normal = glm::cross(p, q);
    may_be_flat[i] = glm::dot(normal, normal) > 1e-20 * glm::dot(p, p) * glm::dot(q, q);
  }
  static_cast<void>(close_seams(result.mesh, may_be_flat, execution));
  result.normals = Buffer<glm::dvec3>(mesh.triangles.size());
  parallel_for(execution, mesh.triangles.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result.normals[i] = unit_of(normal_of(mesh, std::uint32_t(i)));
  });
  result.neighbours = EdgeNeighbours({mesh.triangles.data(), mesh.triangles.size()}, mesh.positions.size(), execution);
  const Box& box = surfaces.bounds();
  const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(box.low)), glm::abs(glm::dvec3(box.high)));
  if (!box.is_empty()) result.noise = kSixDigits * std::max({reach.x, reach.y, reach.z});
  return result;
}

SharpChains sharp_chains(const SmoothMesh& mesh, const Execution& execution, double least_cosine) {
  const std::size_t triangles = mesh.mesh.triangles.size();
  std::vector<std::vector<SharpEdge>> lists((triangles + kTrianglesPerPart - 1) / kTrianglesPerPart);
  parallel_for(execution, triangles, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (auto t = std::uint32_t(begin); t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh.across(t, k);
        if ((other != no_index && other < t) || mesh.is_smooth(t, k)) continue;
        const glm::uvec3& corners = mesh.mesh.triangles[t];
        lists[begin / kTrianglesPerPart].push_back({corners[k], corners[(k + 1) % 3], t, other});
      }
  });
  SharpChains all{joined(lists, execution), {}};
  if (all.edges.size() >= std::size_t(1) << 31)
    throw Error(ErrorCode::limit_exceeded, "rounds", "more than 2147483647 sharp edges");
  Chainer(mesh, all, least_cosine).run(execution);
  return all;
}

}  // namespace frontmost::lines_detail
