// SPDX-License-Identifier: Apache-2.0
// A grid over a patch whose rims are as fine as the neighbours need: rows of quads inside, fans of triangles along
// finer rims.

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <tuple>

#include "scene/bezier_patch.h"
#include "view/tessellate/level.h"

namespace frontmost {
namespace {

using EdgePoints = std::array<glm::dvec3, 4>;

bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Edges are equal if all four control points are, to the bit; points that differ by a rounding are apart.
struct EdgeOrder {
  bool operator()(const EdgePoints& a, const EdgePoints& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), comes_before);
  }
};

/// The control points of an edge, from the end that comes first in a fixed order.
EdgePoints edge_of(const BezierPatch& patch, std::size_t edge) {
  constexpr std::size_t first[4] = {0, 12, 0, 3}, step[4] = {1, 1, 4, 4};
  EdgePoints points, reversed;
  for (std::size_t k = 0; k < 4; ++k) points[k] = patch.points[first[edge] + k * step[edge]];
  std::reverse_copy(points.begin(), points.end(), reversed.begin());
  return EdgeOrder()(reversed, points) ? reversed : points;
}

/// A place on a patch, in steps of a lattice that has all points of the grid and its edges, and the middles of cells.
struct LatticePlace {
  int u, v;
  friend auto operator<=>(const LatticePlace&, const LatticePlace&) = default;
};

class GridBuilder {
 public:
  GridBuilder(const BezierPatch& patch, const PatchLevel& level, const EdgeLevels& edges, Mesh& mesh)
      : patch_(patch),
        level_(level),
        edges_(edges),
        lattice_{std::max({2 * level.u, edges[2], edges[3]}), std::max({2 * level.v, edges[0], edges[1]})},
        mesh_(mesh) {}

  void add_all(std::uint32_t face) {
    for (int i = 0; i < level_.u; ++i)
      for (int j = 0; j < level_.v; ++j) add_cell(i, j);
    mesh_.face_ids.resize(mesh_.triangles.size(), face);
  }

 private:
  void add_cell(int i, int j) {
    const int step_u = lattice_.u / level_.u, step_v = lattice_.v / level_.v;
    const int u0 = i * step_u, u1 = u0 + step_u, v0 = j * step_v, v1 = v0 + step_v;
    const bool last_u = i + 1 == level_.u, last_v = j + 1 == level_.v;
    // All around, counter-clockwise seen from the outer side; each side without its end.
    around_.clear();
    walk({u0, v0}, {u0, v1}, i == 0 ? lattice_.v / edges_[0] : step_v);
    walk({u0, v1}, {u1, v1}, last_v ? lattice_.u / edges_[3] : step_u);
    walk({u1, v1}, {u1, v0}, last_u ? lattice_.v / edges_[1] : step_v);
    walk({u1, v0}, {u0, v0}, j == 0 ? lattice_.u / edges_[2] : step_u);
    // Without finer neighbours a cell is two triangles. Otherwise it is a fan about the middle, which joins any number
    // of rim points.
    if (around_.size() == 4) {
      add_triangle(around_[0], around_[1], around_[2]);
      add_triangle(around_[0], around_[2], around_[3]);
      return;
    }
    const std::uint32_t middle = vertex({(u0 + u1) / 2, (v0 + v1) / 2});
    for (std::size_t k = 0; k < around_.size(); ++k)
      add_triangle(around_[k], around_[(k + 1) % around_.size()], middle);
  }

  void walk(LatticePlace from, const LatticePlace& to, int step) {
    const LatticePlace by{(to.u > from.u) - (to.u < from.u), (to.v > from.v) - (to.v < from.v)};
    for (; from != to; from.u += by.u * step, from.v += by.v * step) around_.push_back(vertex(from));
  }

  /// Fractions of powers of two: both sides of an edge get the same point, however fine their lattices are.
  std::uint32_t vertex(const LatticePlace& place) {
    const auto [entry, is_new] = numbers_.try_emplace(place, std::uint32_t(mesh_.positions.size()));
    if (!is_new) return entry->second;
    const PatchParameter u = fraction(place.u, lattice_.u), v = fraction(place.v, lattice_.v);
    const PatchPoint point = evaluate(patch_, u, v);
    mesh_.positions.push_back(glm::vec3(point.position) + 0.0f);  // + 0.0f avoids negative zeros
    mesh_.normals.values.emplace_back(point.normal);
    mesh_.texcoords.values.emplace_back(patch_.texture_low + patch_.texture_size * glm::dvec2(v.value, u.value));
    return entry->second;
  }

  /// At a pole a side of a cell is a point.
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::vector<glm::vec3>& p = mesh_.positions;
    if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a]) mesh_.triangles.emplace_back(a, b, c);
  }

  const BezierPatch& patch_;
  PatchLevel level_;
  EdgeLevels edges_;
  PatchLevel lattice_;
  Mesh& mesh_;
  std::map<LatticePlace, std::uint32_t> numbers_;
  std::vector<std::uint32_t> around_;
};

}  // namespace

bool is_finite(const BezierPatch& patch) {
  for (const glm::dvec3& p : patch.points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  return true;
}

std::vector<EdgeLevels> edge_levels(std::span<const BezierPatch> patches, std::span<const PatchLevel> levels) {
  std::map<EdgePoints, int, EdgeOrder> finest;
  const auto own = [&](std::size_t patch, std::size_t edge) { return edge < 2 ? levels[patch].v : levels[patch].u; };
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (std::size_t e = 0; e < 4 && is_finite(patches[p]); ++e) {  // NaN has no order
      int& level = finest[edge_of(patches[p], e)];
      level = std::max(level, own(p, e));
    }
  std::vector<EdgeLevels> result(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (std::size_t e = 0; e < 4 && is_finite(patches[p]); ++e) result[p][e] = finest[edge_of(patches[p], e)];
  return result;
}

void append_grid(const BezierPatch& patch, const PatchLevel& level, const EdgeLevels& edges, std::uint32_t face,
                 Mesh& mesh) {
  GridBuilder(patch, level, edges, mesh).add_all(face);
}

}  // namespace frontmost
