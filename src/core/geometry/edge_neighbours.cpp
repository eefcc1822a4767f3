// SPDX-License-Identifier: Apache-2.0
// Sides are put into buckets by their lower vertex. In a bucket, sides with the same upper vertex belong to the same
// edge. Most vertices have few triangles, so all pairs of their sides are compared. The sides of other vertices are
// sorted.
#include "geometry/edge_neighbours.h"

#include <algorithm>

#include "base/parallel.h"
#include "geometry/buckets.h"

namespace frontmost {
namespace {

constexpr std::size_t kFewSides = 8, kVerticesAtOnce = 4096;

/// A side of a triangle, in the bucket of its lower vertex.
struct EdgeSide {
  std::uint32_t upper;   ///< the other vertex
  std::uint32_t number;  ///< 3 * triangle + side; the highest bit is set if the side leads to the lower vertex

  static constexpr std::uint32_t downwards = 1u << 31;
  [[nodiscard]] std::uint32_t side() const { return number & ~downwards; }
};

void join(const EdgeSide& a, const EdgeSide& b, Buffer<std::uint32_t>& beyond) {
  const std::uint32_t is_wound_alike = (a.number ^ b.number) >> 31;
  beyond[a.side()] = b.side() / 3 << 1 | is_wound_alike;
  beyond[b.side()] = a.side() / 3 << 1 | is_wound_alike;
}

/// Like join_pairs(), but compares all pairs.
void join_few(std::span<const EdgeSide> sides, Buffer<std::uint32_t>& beyond) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    std::size_t found = 0, partner = i;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (k == i || sides[k].upper != sides[i].upper) continue;
      ++found;
      partner = k;
    }
    if (found == 1 && partner > i) join(sides[i], sides[partner], beyond);
  }
}

/// Joins the two triangles at each edge that exactly two triangles share, for the edges of one lower vertex.
void join_pairs(std::span<EdgeSide> sides, Buffer<std::uint32_t>& beyond) {
  if (sides.size() <= kFewSides) return join_few(sides, beyond);
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.side() < b.side();
  });
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].upper == sides[i].upper;) ++end;
    if (end - i == 2) join(sides[i], sides[i + 1], beyond);
  }
}

std::size_t checked_count(std::span<const glm::uvec3> triangles) {
  if (triangles.size() > EdgeNeighbours::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "mesh", "more than 536870912 triangles to join at their edges");
  return triangles.size();
}

}  // namespace

EdgeNeighbours::EdgeNeighbours(std::span<const glm::uvec3> triangles, std::size_t vertex_count,
                               const Execution& execution)
    : beyond_(3 * checked_count(triangles), no_index) {
  const auto list_sides = [&](std::size_t t, const auto& add) {
    const glm::uvec3& c = triangles[t];
    if (c.x == c.y || c.y == c.z || c.z == c.x) return;
    const std::uint32_t v[4] = {c.x, c.y, c.z, c.x};
    for (std::uint32_t k = 0; k < 3; ++k)
      add(std::min(v[k], v[k + 1]),
          EdgeSide{std::max(v[k], v[k + 1]), 3 * std::uint32_t(t) + k + (v[k] < v[k + 1] ? 0 : EdgeSide::downwards)});
  };
  Buckets<EdgeSide> sides(vertex_count, triangles.size(), list_sides, execution);
  parallel_for(execution, vertex_count, kVerticesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) join_pairs(sides[v], beyond_);
  });
}

}  // namespace frontmost
