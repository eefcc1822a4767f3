// SPDX-License-Identifier: Apache-2.0
// Edges by their lower vertex, triangles side by side at each: a counting sort, and short sorts within.
#include "lines/feature_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "base/parallel.h"
#include "lines/joined.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kVerticesPerPart = 4096, kTrianglesPerPoll = 1 << 18;

/// A triangle at an edge, which is known by its lower vertex.
struct Side {
  std::uint32_t upper;  ///< the edge's other vertex
  std::uint32_t triangle;
  std::uint32_t opposite;  ///< the vertex that is not on the edge
  bool is_forward;         ///< the triangle runs from the lower vertex to the upper
};

std::uint64_t key(const Side& side) { return std::uint64_t(side.upper) << 32 | side.opposite; }

/// As many as most vertices have.
constexpr std::size_t kFew = 12;

/// By counting who comes before, pair by pair: nothing to guess for the processor. Equal keys stay in order.
void sort_few(std::span<Side> sides) {
  Side copy[kFew];
  std::uint64_t keys[kFew];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    copy[i] = sides[i];
    keys[i] = key(sides[i]);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    std::size_t before = 0;
    for (std::size_t j = 0; j < i; ++j) before += keys[j] <= keys[i];
    for (std::size_t j = i + 1; j < sides.size(); ++j) before += keys[j] < keys[i];
    sides[before] = copy[i];
  }
}

/// The sides of all edges, those of one lower vertex together.
class SideTable {
 public:
  SideTable(const WeldedMesh& mesh, const Execution& execution)
      : first_(mesh.positions.size() + 1, 0), sides_(3 * mesh.triangles.size()) {
    const auto bands = std::size_t(thread_count(execution));
    const std::size_t vertices = mesh.positions.size();
    // A thread counts and enters what belongs to its own vertices: it reads all triangles, which costs less than
    // counting in common.
    const auto for_each_side = [&](const auto& visit) {
      parallel_for(execution, bands, 1, [&](std::size_t band, std::size_t) {
        const std::size_t begin = vertices * band / bands, end = vertices * (band + 1) / bands;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
          if (i % kTrianglesPerPoll == 0) check_cancelled(execution);
          const glm::uvec3& t = mesh.triangles[i];
          for (int k = 0; k < 3; ++k) {
            const std::uint32_t lower = std::min(t[k], t[k == 2 ? 0 : k + 1]);
            if (lower >= begin && lower < end) visit(lower, i, k);
          }
        }
      });
    };
    for_each_side([&](std::uint32_t lower, std::uint32_t, int) { ++first_[lower + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_each_side([&](std::uint32_t lower, std::uint32_t i, int k) {
      const glm::uvec3& t = mesh.triangles[i];
      const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
      sides_[next[lower]++] = {std::max(a, b), i, t[k == 0 ? 2 : k - 1], a < b};
    });
  }

  /// Sorted by edge, then by opposite vertex. For different vertices at once.
  [[nodiscard]] std::span<Side> at(std::uint32_t vertex) {
    const std::span<Side> sides(sides_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]);
    if (sides.size() <= kFew)
      sort_few(sides);
    else
      std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return key(a) != key(b) ? key(a) < key(b) : a.triangle < b.triangle;
      });
    return sides;
  }

 private:
  std::vector<std::uint32_t> first_;
  Buffer<Side> sides_;
};

class Classifier {
 public:
  Classifier(const SeenMesh& seen, const Surfaces& surfaces, const LineOptions& options)
      : mesh_(seen.mesh),
        seen_(seen),
        surfaces_(surfaces),
        options_(options),
        cosine_(std::cos(options.crease_angle)),
        has_borders_(options.borders && !is_one_surface(surfaces.scene())) {}

  /// `sides` with different opposite vertices: a triangle that is there twice counts once.
  [[nodiscard]] std::optional<EdgeKind> kind_of(std::span<const Side> sides) const {
    if (sides.size() != 2) return options_.boundaries ? std::optional(EdgeKind::boundary) : std::nullopt;
    const int a = side_of(sides[0]), b = side_of(sides[1]);
    if (options_.silhouettes && (a * b > 0 || (a == 0) != (b == 0))) return EdgeKind::silhouette;
    if (has_borders_ && !is_one_surface(sides[0].triangle, sides[1].triangle)) return EdgeKind::border;
    if (options_.creases && is_crease(sides[0], sides[1])) return EdgeKind::crease;
    return std::nullopt;
  }

  /// The other side than that of all triangles at the edge; 0 where they are on both.
  [[nodiscard]] std::int8_t outer_side(std::span<const Side> sides) const {
    int inner = 0;
    for (const Side& side : sides) {
      const int own = side_of(side);
      if (own * inner < 0) return 0;
      if (own != 0) inner = own;
    }
    return std::int8_t(-inner);
  }

 private:
  /// Of the eye's plane through the edge: where the triangle lies, whichever way it is wound.
  [[nodiscard]] int side_of(const Side& side) const { return seen_.facing[side.triangle] * (side.is_forward ? 1 : -1); }

  static bool is_one_surface(const Scene& scene) {
    return scene.instances.size() == 1 && scene.meshes[scene.instances[0].mesh].material_ids.empty();
  }
  [[nodiscard]] bool is_one_surface(std::uint32_t a, std::uint32_t b) const {
    const PrimitiveSource p = surfaces_.source(mesh_.ids[a]), q = surfaces_.source(mesh_.ids[b]);
    if (p.instance != q.instance) return false;
    const Mesh& mesh = surfaces_.scene().meshes[p.mesh];
    return mesh.material_of(p.triangle) == mesh.material_of(q.triangle);
  }

  [[nodiscard]] bool is_crease(const Side& a, const Side& b) const {
    // Neighbours that run along their edge the same way are wound against each other.
    const glm::dvec3 &n = seen_.normals[a.triangle], &m = seen_.normals[b.triangle];
    const double along = glm::dot(n, m) * (a.is_forward == b.is_forward ? -1.0 : 1.0);
    const double size = std::sqrt(glm::dot(n, n) * glm::dot(m, m));
    if (along > cosine_ * size) return false;
    if (along <= 0) return true;
    const glm::uvec3& t = mesh_.triangles[a.triangle];
    const Positions& at = mesh_.positions;
    return FacePlane(at[t.x], at[t.y], at[t.z]).height(at[b.opposite]).sign != 0;
  }

  const WeldedMesh& mesh_;
  const SeenMesh& seen_;
  const Surfaces& surfaces_;
  const LineOptions& options_;
  const double cosine_;
  const bool has_borders_;
};

/// `sides` are those of the edges whose lower vertex is v.
void add_features(std::span<Side> sides, std::uint32_t v, const Classifier& classifier, Features& features) {
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(begin, sides.end(), [&](const Side& s) { return s.upper != begin->upper; });
    for (auto side = begin; side + 1 < end; ++side)  // known at one of its three edges
      if (side[0].opposite == side[1].opposite && side->opposite > side->upper)
        features.twins.push_back(side[1].triangle);
    const auto last = std::unique(begin, end, [](const Side& a, const Side& b) { return a.opposite == b.opposite; });
    const std::span<const Side> edge(begin, last);
    if (const std::optional<EdgeKind> kind = classifier.kind_of(edge))
      features.edges.push_back({v, begin->upper, edge[0].triangle, edge.size() > 1 ? edge[1].triangle : no_index, *kind,
                                classifier.outer_side(edge)});
    begin = end;
  }
}

}  // namespace

Features find_features(const SeenMesh& seen, const Surfaces& surfaces, const LineOptions& options,
                       const Execution& execution) {
  SideTable table(seen.mesh, execution);
  const Classifier classifier(seen, surfaces, options);
  const std::size_t vertices = seen.mesh.positions.size();
  const std::size_t parts = (vertices + kVerticesPerPart - 1) / kVerticesPerPart;
  std::vector<std::vector<FeatureEdge>> edges(parts);
  std::vector<std::vector<std::uint32_t>> twins(parts);
  parallel_for(execution, vertices, kVerticesPerPart, [&](std::size_t begin, std::size_t end) {
    Features found;
    for (std::size_t v = begin; v < end; ++v)
      add_features(table.at(std::uint32_t(v)), std::uint32_t(v), classifier, found);
    edges[begin / kVerticesPerPart] = std::move(found.edges);
    twins[begin / kVerticesPerPart] = std::move(found.twins);
  });
  Features all{joined(edges), joined(twins)};
  std::sort(all.twins.begin(), all.twins.end());
  return all;
}

}  // namespace frontmost::lines_detail
