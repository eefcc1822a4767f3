// SPDX-License-Identifier: Apache-2.0
// A neighbour across a side is the only other triangle there, copies aside. A walk around a vertex over a table of all
// its triangles takes a few comparisons a step, so a fan of up to 32 triangles is copied out of the table once.
// Vertices with more triangles have no fan: the tip of a cone has no meaningful normal.
#include "lines/creases/neighbours.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kWidestCorner = 0.9659;  // the cosine of 15 degrees, by which slivers' corners miss a straight angle
constexpr double kOnePlane = 0.996;       // the cosine of 5 degrees
constexpr std::size_t kTrianglesPerPart = 4096;
constexpr std::size_t kMostSlivers = 8;  // more in one plane are no sliver together

}  // namespace

TurnedTriangle Neighbours::beyond(const TurnedTriangle& triangle, std::uint32_t a, std::uint32_t b) const {
  const WeldedMesh& mesh = seen_.mesh;
  const std::uint32_t own = third_of(corners(triangle.number), a, b);
  std::uint32_t found = no_index, opposite = no_index;
  for (const Corner& corner : table_[a]) {
    const std::uint32_t next = corner.next(mesh), last = corner.last(mesh);
    if (next != b && last != b) continue;
    const std::uint32_t third = next == b ? last : next;
    if (third == own || third == opposite) continue;
    if (found != no_index) return {};
    found = corner.triangle();
    opposite = third;
  }
  if (found == no_index) return {};
  const bool is_alike = runs(corners(triangle.number), a, b) != runs(corners(found), a, b);
  return {found, triangle.is_turned == is_alike};
}

Fan Neighbours::fan(std::uint32_t vertex) const {
  Fan fan;
  const std::span<const Corner> corners = table_[vertex];
  if (corners.size() > Fan::most) return fan;
  for (const Corner& corner : corners)
    fan.entries_[fan.count_++] = {corner.triangle(), corner.next(seen_.mesh), corner.last(seen_.mesh)};
  return fan;
}

Fan::Side Fan::side(const TurnedTriangle& triangle, std::uint32_t rim) const {
  std::size_t entry = 0;
  while (entry < count_ && entries_[entry].triangle != triangle.number) ++entry;
  return {triangle, rim, entry};
}

/// Crosses to an entry that has the rim of `from`, and gives that entry's other side.
Fan::Side Fan::to(std::size_t entry, const Side& from) const {
  const Entry& own = entries_[from.entry];
  const Entry& other = entries_[entry];
  const bool is_alike = (other.next == from.rim) != (own.next == from.rim);
  const std::uint32_t rim = other.next == from.rim ? other.last : other.next;
  return {{other.triangle, from.triangle.is_turned == is_alike}, rim, entry};
}

Fan::Side Fan::beyond(const Side& side) const {
  if (side.entry >= count_) return {{}, no_index, count_};
  std::uint32_t beside = 0;  // bit i: entry i has the rim
  for (std::size_t i = 0; i < count_; ++i)
    beside |= std::uint32_t(entries_[i].next == side.rim || entries_[i].last == side.rim) << i;
  beside &= ~(1u << side.entry);
  const bool is_one = (beside & (beside - 1)) == 0 && beside != 0;
  const Side found = is_one ? to(std::size_t(std::countr_zero(beside)), side) : beyond_copies(side, beside);
  const Entry& own = entries_[side.entry];
  return found.rim == (own.next == side.rim ? own.last : own.next) ? Side{{}, no_index, count_} : found;
}

Fan::Side Fan::beyond_copies(const Side& side, std::uint32_t beside) const {
  const Entry& own = entries_[side.entry];
  const std::uint32_t own_rim = own.next == side.rim ? own.last : own.next;
  Side found{{}, no_index, count_};
  for (; beside != 0; beside &= beside - 1) {
    const Side other = to(std::size_t(std::countr_zero(beside)), side);
    if (other.rim == own_rim || other.rim == found.rim) continue;
    if (found.triangle.is_there()) return {{}, no_index, count_};
    found = other;
  }
  return found;
}

Neighbours::Neighbours(const SeenMesh& seen, const CornerTable& table, const Execution& execution)
    : seen_(seen), table_(table), is_sliver_(seen.mesh.triangles.size()) {
  parallel_for(execution, is_sliver_.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) is_sliver_[i] = find_sliver(std::uint32_t(i));
  });
}

glm::dvec3 Neighbours::rounded_normal(std::uint32_t triangle) const {
  const glm::dvec3 normal = normal_of(seen_.mesh, triangle);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3(0);
}

bool Neighbours::find_sliver(std::uint32_t triangle) const {
  const glm::uvec3& t = corners(triangle);
  const glm::dvec3 a = place(t.x), b = place(t.y), c = place(t.z), sides[3] = {b - a, c - b, a - c};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &u = sides[k], &v = sides[k == 2 ? 0 : k + 1];
    const double dot = glm::dot(u, v);
    // A triangle has at most one corner wider than a right angle.
    if (dot > 0) return dot * dot > kWidestCorner * kWidestCorner * glm::dot(u, u) * glm::dot(v, v);
  }
  return false;
}

glm::dvec3 Neighbours::surface_normal(const TurnedTriangle& triangle) const {
  const glm::dvec3 own = normal(triangle);
  if (!is_sliver(triangle.number)) return own;
  std::array<TurnedTriangle, kMostSlivers> piece;  // the slivers of one plane
  piece[0] = triangle;
  std::size_t count = 1;
  const auto has = [&](std::uint32_t number) {
    return std::any_of(piece.begin(), piece.begin() + std::ptrdiff_t(count),
                       [&](const TurnedTriangle& sliver) { return sliver.number == number; });
  };
  glm::dvec3 nearest = own;
  double cosine = -2;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::uvec3& t = corners(piece[i].number);
    for (int k = 0; k < 3; ++k) {
      const TurnedTriangle other = beyond(piece[i], t[k], t[k == 2 ? 0 : k + 1]);
      if (!other.is_there() || has(other.number)) continue;
      const bool is_thin = is_sliver(other.number);
      const glm::dvec3 its = normal(other);
      const double along = glm::dot(its, own);
      if (along > kOnePlane) {
        if (!is_thin || count == piece.size()) return own;
        piece[count++] = other;
      } else if (!is_thin && along > cosine) {
        cosine = along;
        nearest = its;
      }
    }
  }
  return nearest;
}

}  // namespace frontmost::lines_detail
