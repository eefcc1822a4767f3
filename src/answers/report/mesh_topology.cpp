// SPDX-License-Identifier: Apache-2.0
// Topology of a mesh by sorting and joining, in parallel.
//
//   positions --equal--> one number for each point
//   half-edges --by their two points--> groups: one is a boundary, two are joined, more are not manifold
//   joined triangles --union-find--> shells; joined corners --union-find--> pieces
//
// Sets are named by their least member, so no result depends on the order of threads.
// The genus follows from Euler's formula if the mesh is closed and every edge has two triangles.
#include "report/mesh_topology.h"

#include <algorithm>
#include <mutex>
#include <span>
#include <utility>

#include "base/orientation.h"
#include "base/parallel.h"
#include "geometry/buckets.h"
#include "geometry/disjoint_sets.h"
#include "geometry/places.h"

namespace frontmost {
namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 29;  // leaves a free bit beside a half-edge's number
constexpr std::size_t kGrain = std::size_t(1) << 14;
constexpr std::uint32_t kUnpaired = no_index;

/// A half-edge among those with the same lower point.
struct HalfEdge {
  std::uint32_t upper;   ///< the other point
  std::uint32_t marked;  ///< number of the half-edge; the highest bit is set where it leads to the lower point

  static constexpr std::uint32_t backward = 1u << 31;
  [[nodiscard]] std::uint32_t number() const { return marked & ~backward; }
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.number() < b.number();
  }
  [[nodiscard]] bool is_same(const HalfEdge& other) const { return upper == other.upper; }
};

/// The two greater points of a triangle, among the triangles with the same least point.
struct UpperPoints {
  std::uint32_t middle, last;

  friend auto operator<=>(const UpperPoints&, const UpperPoints&) = default;
  [[nodiscard]] bool is_same(const UpperPoints& other) const { return *this == other; }
};

struct EdgeCounts {
  std::uint64_t boundary = 0, non_manifold = 0, inconsistent = 0;
  EdgeCounts& operator+=(const EdgeCounts& other) {
    boundary += other.boundary;
    non_manifold += other.non_manifold;
    inconsistent += other.inconsistent;
    return *this;
  }
};

/// Calls visit(group, sums) for each group of equal items of a bucket, from several threads. \returns all `sums`.
template <class Sums, class Item, class Visit>
Sums for_each_group(Buckets<Item>& buckets, const Execution& execution, const Visit& visit) {
  Sums all{};
  std::mutex mutex;
  parallel_for(execution, buckets.count(), kGrain, [&](std::size_t begin, std::size_t end) {
    Sums sums{};
    for (std::size_t bucket = begin; bucket < end; ++bucket) {
      const std::span<Item> items = buckets[bucket];
      std::sort(items.begin(), items.end());
      for (auto first = items.begin(); first != items.end();) {
        const auto last = std::find_if(first, items.end(), [&](const Item& item) { return !item.is_same(*first); });
        visit(std::span<const Item>(first, last), sums);
        first = last;
      }
    }
    const std::lock_guard lock(mutex);
    all += sums;
  });
  return all;
}

// The mesh after welding. Half-edge 3 * triangle + k runs from corner k to the next one.
class MeshTopology {
 public:
  MeshTopology(const Mesh& mesh, const Execution& execution)
      : mesh_(mesh),
        execution_(execution),
        corners_(mesh.triangles.size()),
        kinds_(mesh.triangles.size()),
        triangle_sets_(mesh.triangles.size()),
        corner_sets_(mesh.positions.size()) {
    const Buffer<std::uint32_t> first = first_at_place(mesh.positions, execution);
    parallel_for(execution, corners_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const glm::uvec3& c = mesh.triangles[t];
        corners_[t] = {first[c.x], first[c.y], first[c.z]};
        kinds_[t] = kind_of(corners_[t]);
        if (kinds_[t] == Kind::non_finite) continue;
        corner_sets_.join(corners_[t].x, corners_[t].y);
        corner_sets_.join(corners_[t].x, corners_[t].z);
      }
    });
  }

  [[nodiscard]] Topology examine() {
    Topology topology;
    Oddities& odd = topology.odd;
    std::uint64_t surface = 0;  // number of triangles with three different corners
    for (const Kind kind : kinds_) {
      odd.non_finite_triangles += kind == Kind::non_finite;
      odd.degenerate_triangles += kind == Kind::repeated || kind == Kind::flat;
      surface += has_edges(kind);
    }
    odd.duplicate_triangles = count_duplicates();
    const EdgeCounts edges = join_edges();
    odd.boundary_edges = edges.boundary;
    odd.non_manifold_edges = edges.non_manifold;
    odd.inconsistent_edges = edges.inconsistent;
    for (std::uint32_t t = 0; t < kinds_.size(); ++t)
      topology.shells += has_edges(kinds_[t]) && triangle_sets_.is_leader(t);
    topology.closed = surface > 0 && edges.boundary == 0;
    if (topology.closed && edges.non_manifold == 0 && edges.inconsistent == 0) {
      // Euler: sum over shells of 2 - 2 genus = vertices - edges + triangles.
      const auto euler = std::int64_t(count_fans()) - std::int64_t(surface * 3 / 2) + std::int64_t(surface);
      topology.genus = std::uint64_t(std::int64_t(topology.shells) - euler / 2);
    }
    collect_points(topology);
    return topology;
  }

 private:
  enum class Kind : std::uint8_t { proper, flat, repeated, non_finite };
  static bool has_edges(Kind kind) { return kind == Kind::proper || kind == Kind::flat; }

  [[nodiscard]] Kind kind_of(const glm::uvec3& c) const {
    const glm::vec3 &a = mesh_.positions[c.x], &b = mesh_.positions[c.y], &d = mesh_.positions[c.z];
    if (!is_finite(a) || !is_finite(b) || !is_finite(d)) return Kind::non_finite;
    if (c.x == c.y || c.y == c.z || c.z == c.x) return Kind::repeated;
    return are_collinear(a, b, d) ? Kind::flat : Kind::proper;
  }

  [[nodiscard]] std::uint64_t count_duplicates() const {
    const auto list = [&](std::size_t t, const auto& add) {
      if (kinds_[t] == Kind::non_finite) return;
      glm::uvec3 c = corners_[t];
      if (c.x > c.y) std::swap(c.x, c.y);
      if (c.y > c.z) std::swap(c.y, c.z);
      if (c.x > c.y) std::swap(c.x, c.y);
      add(c.x, UpperPoints{c.y, c.z});
    };
    Buckets<UpperPoints> triangles(mesh_.positions.size(), corners_.size(), list, execution_);
    return for_each_group<std::uint64_t>(
        triangles, execution_,
        [](std::span<const UpperPoints> same, std::uint64_t& count) { count += same.size() - 1; });
  }

  // Counts edges by their number of triangles, joins the triangles of each edge, and pairs opposite half-edges.
  EdgeCounts join_edges() {
    twins_.assign(3 * corners_.size(), kUnpaired);
    const auto list = [&](std::size_t t, const auto& add) {
      if (!has_edges(kinds_[t])) return;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = corners_[t][k], to = corners_[t][(k + 1) % 3],
                            half_edge = 3 * std::uint32_t(t) + std::uint32_t(k);
        add(std::min(from, to), HalfEdge{std::max(from, to), half_edge | (from < to ? 0 : HalfEdge::backward)});
      }
    };
    Buckets<HalfEdge> edges(mesh_.positions.size(), corners_.size(), list, execution_);
    return for_each_group<EdgeCounts>(edges, execution_, [&](std::span<const HalfEdge> edge, EdgeCounts& counts) {
      for (std::size_t i = 1; i < edge.size(); ++i) triangle_sets_.join(edge[0].number() / 3, edge[i].number() / 3);
      counts.boundary += edge.size() == 1;
      counts.non_manifold += edge.size() > 2;
      if (edge.size() != 2) return;
      if (((edge[0].marked ^ edge[1].marked) & HalfEdge::backward) == 0) {
        ++counts.inconsistent;
      } else {
        twins_[edge[0].number()] = edge[1].number();
        twins_[edge[1].number()] = edge[0].number();
      }
    });
  }

  // The number of fans of triangles around vertices. A vertex has one fan, unless two fans touch in a point; the
  // surface passes that point twice, and counting it once would turn it into a handle. Precondition: every half-edge
  // has its twin.
  [[nodiscard]] std::uint64_t count_fans() const {
    std::uint64_t fans = 0;
    std::vector<bool> seen(twins_.size(), false);
    for (std::uint32_t start = 0; start < twins_.size(); ++start) {
      if (seen[start] || twins_[start] == kUnpaired) continue;
      ++fans;
      // The previous half-edge in its triangle ends where this one starts, so its twin starts there, too.
      for (std::uint32_t h = start; !seen[h]; h = twins_[h % 3 == 0 ? h + 2 : h - 1]) seen[h] = true;
    }
    return fans;
  }

  void collect_points(Topology& topology) const {
    std::vector<bool> used(mesh_.positions.size(), false);
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      if (kinds_[t] == Kind::non_finite) continue;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t corner = corners_[t][k];
        if (used[corner]) continue;
        used[corner] = true;
        topology.points.push_back(mesh_.positions[corner]);
        topology.pieces += corner_sets_.is_leader(corner);
      }
    }
  }

  const Mesh& mesh_;
  const Execution& execution_;
  std::vector<glm::uvec3> corners_;
  std::vector<Kind> kinds_;
  DisjointSets<> triangle_sets_, corner_sets_;
  std::vector<std::uint32_t> twins_;
};

}  // namespace

Topology examine(const Mesh& mesh, const Execution& execution) {
  if (mesh.triangles.size() > kMaxTriangles)
    throw Error(ErrorCode::limit_exceeded, "mesh " + mesh.name, "more than 536870912 triangles to examine");
  return MeshTopology(mesh, execution).examine();
}

bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orientation({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orientation({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

}  // namespace frontmost
