// SPDX-License-Identifier: Apache-2.0
// Silhouettes of ripples. Where a smooth surface is seen nearly edge-on, single triangles of it face away from the eye:
//
//    eye            edge                      Triangles that face the eye and others take turns along the surface. Each
//     o  - - - - - /\ - - - - -.------        turn is a silhouette, but beside the edge of a ripple the same surface
//              ___/  \_____.--'               goes on. Beside the edge of a fold, other things are seen.
//                                    a ripple and a fold
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {
namespace {

constexpr float kSharp = 0.829f;        // the cosine of 34 degrees, at which an edge is a crease whatever is beside it
constexpr float kGoesOnAlike = 0.866f;  // the cosine of 30 degrees: the same surface turns by less beside the edge
constexpr int kRings = 2;
constexpr std::size_t kMostCorners = 32, kMostVertices = 96;  // at vertices with more corners the search ends
constexpr std::size_t kEdgesInTask = 256;
constexpr std::array<double, 5> kPlaces{0.02, 0.26, 0.5, 0.74, 0.98};  // along an edge, as shares of its length
constexpr double kBeside = 1e-3;  // distance from the edge, as a share of its length on the screen

class RippleFinder {
 public:
  RippleFinder(const SeenMesh& seen, const CornerTable& table) : seen_(seen), mesh_(seen.mesh), table_(table) {}

  [[nodiscard]] bool is_ripple(const FeatureEdge& edge) {
    if (edge.kind != EdgeKind::silhouette || edge.right == no_index || mesh_.stated.are_sharp(edge.from, edge.to))
      return false;
    const glm::vec3 left = normal_at(edge.left), right = normal_at(edge.right);
    const auto normal = glm::vec3(unit_of(glm::dvec3(left + right)));
    if (!(glm::dot(left, right) > kSharp)) return false;
    look_along(edge);
    if (has_other_sides(edge) || !(is_ahead(mesh_.triangles[edge.left]) && is_ahead(mesh_.triangles[edge.right])))
      return false;
    std::array<glm::dvec2, kPlaces.size()> open = places_beside(edge);
    std::size_t open_count = open.size();
    // Triangles ring by ring around the edge, over vertices that are listed once.
    vertices_.assign({edge.from, edge.to});
    std::size_t next = 0;
    for (int ring = 0; ring < kRings; ++ring)
      for (const std::size_t end = vertices_.size(); next < end; ++next) {
        const std::span<const Corner> corners = table_[vertices_[next]];
        if (corners.size() > kMostCorners || vertices_.size() > kMostVertices) return false;
        for (const Corner& corner : corners) {
          const std::uint32_t triangle = corner.triangle();
          if (triangle == edge.left || triangle == edge.right) continue;
          if (!(glm::dot(normal_at(triangle), normal) > kGoesOnAlike)) continue;
          if (!is_ahead(mesh_.triangles[triangle])) continue;
          if (reaches_out(mesh_.triangles[triangle], open[0].y)) {
            const Flat flat = on_picture(mesh_.triangles[triangle]);
            const auto still = std::remove_if(open.begin(), open.begin() + std::ptrdiff_t(open_count),
                                              [&](const glm::dvec2& place) { return covers(flat, place); });
            open_count = std::size_t(still - open.begin());
            if (open_count == 0) return true;
          }
          for (const std::uint32_t vertex : {corner.next(mesh_), corner.last(mesh_)})
            if (std::find(vertices_.begin(), vertices_.end(), vertex) == vertices_.end()) vertices_.push_back(vertex);
        }
      }
    return false;
  }

 private:
  using Flat = std::array<glm::dvec2, 3>;  ///< the corners of a triangle on the picture

  [[nodiscard]] const glm::vec3& normal_at(std::uint32_t triangle) const { return seen_.triangles[triangle].normal; }

  /// Whether more than two triangles have the edge, as where two surfaces share it.
  [[nodiscard]] bool has_other_sides(const FeatureEdge& edge) const {
    const std::span<const Corner> corners = table_[edge.from];
    return std::count_if(corners.begin(), corners.end(), [&](const Corner& corner) {
             return corner.next(mesh_) == edge.to || corner.last(mesh_) == edge.to;
           }) > 2;
  }

  /// Chooses a picture plane on which the edge runs along x.
  void look_along(const FeatureEdge& edge) {
    const glm::dvec3 from = mesh_.positions[edge.from], to = mesh_.positions[edge.to];
    const Sight& sight = seen_.sight;
    origin_ = sight.is_parallel() ? from : sight.eye();
    ahead_ = sight.is_parallel() ? sight.forward() : unit_of((from + to) * 0.5 - origin_);
    x_ = unit_of((to - from) - ahead_ * glm::dot(to - from, ahead_));
    y_ = glm::cross(ahead_, x_);
  }
  /// Whether all corners lie before the eye, so that they have places on the picture.
  [[nodiscard]] bool is_ahead(const glm::uvec3& triangle) const {
    const auto is_vertex_ahead = [&](std::uint32_t vertex) {
      return glm::dot(mesh_.positions[vertex] - origin_, ahead_) > 0;
    };
    return seen_.sight.is_parallel() ||
           (is_vertex_ahead(triangle.x) && is_vertex_ahead(triangle.y) && is_vertex_ahead(triangle.z));
  }
  /// Whether a corner lies on the side of the edge on which `y` is. Precondition: all corners lie before the eye.
  [[nodiscard]] bool reaches_out(const glm::uvec3& triangle, double y) const {
    const auto is_out = [&](std::uint32_t vertex) { return glm::dot(mesh_.positions[vertex] - origin_, y_) * y > 0; };
    return is_out(triangle.x) || is_out(triangle.y) || is_out(triangle.z);
  }
  [[nodiscard]] glm::dvec2 on_picture(std::uint32_t vertex) const {
    const glm::dvec3 from_origin = mesh_.positions[vertex] - origin_;
    const glm::dvec2 place(glm::dot(from_origin, x_), glm::dot(from_origin, y_));
    return seen_.sight.is_parallel() ? place : place / glm::dot(from_origin, ahead_);
  }
  /// Places close to the edge, on the side on which its triangles do not lie.
  [[nodiscard]] std::array<glm::dvec2, kPlaces.size()> places_beside(const FeatureEdge& edge) const {
    double inner = 0;  // y of the opposite corner that lies farther from the edge
    for (const std::uint32_t triangle : {edge.left, edge.right}) {
      const double y = on_picture(third_of(mesh_.triangles[triangle], edge.from, edge.to)).y;
      if (std::abs(y) > std::abs(inner)) inner = y;
    }
    const double from = on_picture(edge.from).x, length = on_picture(edge.to).x - from;
    std::array<glm::dvec2, kPlaces.size()> places;
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] = {from + kPlaces[i] * length, std::copysign(kBeside * length, -inner)};
    return places;
  }
  [[nodiscard]] Flat on_picture(const glm::uvec3& triangle) const {
    return {on_picture(triangle.x), on_picture(triangle.y), on_picture(triangle.z)};
  }
  [[nodiscard]] static bool covers(const Flat& triangle, const glm::dvec2& place) {
    const glm::dvec2 a = triangle[0] - place, b = triangle[1] - place, c = triangle[2] - place;
    const double ab = a.x * b.y - a.y * b.x, bc = b.x * c.y - b.y * c.x, ca = c.x * a.y - c.y * a.x;
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  }

  const SeenMesh& seen_;
  const WeldedMesh& mesh_;
  const CornerTable& table_;
  glm::dvec3 origin_{0}, ahead_{0}, x_{0}, y_{0};
  std::vector<std::uint32_t> vertices_;
};

}  // namespace

std::vector<std::uint8_t> find_ripples(const SeenMesh& seen, const CornerTable& table,
                                       const std::vector<FeatureEdge>& edges, const Execution& execution) {
  std::vector<std::uint8_t> is_ripple(edges.size());
  parallel_for(execution, edges.size(), kEdgesInTask, [&](std::size_t begin, std::size_t end) {
    RippleFinder finder(seen, table);
    for (std::size_t i = begin; i < end; ++i) is_ripple[i] = finder.is_ripple(edges[i]);
  });
  return is_ripple;
}

}  // namespace frontmost::lines_detail
