// SPDX-License-Identifier: Apache-2.0
// Curved meshes as triangles fine enough for one view: first the levels, so that limits are known, then triangles.
//
//   scene, view --Plan--> a level for every instance of a curved mesh --> one mesh for every pair of mesh and level
//                         count of triangles, or an error                 instances refer to theirs
//
// A model may place a sphere a thousand times at the same size; instances that need the same fineness share a mesh. A
// patch becomes a grid whose rims are as fine as the neighbours need: quads inside, fans of triangles along finer rims.
//
// A level is the first at which the error of the grid does not exceed the tolerated displacement:
//
//   how far a displacement shows:   pixels  ->  world units, by the distance from the eye (ScreenTolerance)
//   how far a grid is off:          second derivatives of a patch, over 8 u^2, 4 u v and 8 v^2 (PatchBending);
//                                   for a sphere the height of the cap over a cell of its globe (globe_error)
//
// Both are upper bounds, never estimates, because a drawing may be required to be right to `pixels` pixels. (D. Filip,
// R. Magedson, R. Markot. Surface Algorithms Using Bounds on Derivatives. 1986: patches.)
#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "base/parallel.h"
#include "frontmost/view.h"
#include "scene/bezier_patch.h"
#include "scene/shapes.h"
#include "scene/turn.h"
#include "scene/validate.h"
#include "view/tessellate/level.h"

namespace frontmost {
namespace {

constexpr int kFewestRings = 4;

/// How much a matrix can lengthen a vector, at most (Gershgorin's circles about M^T M); exact for scaled rotations.
double greatest_stretch(const glm::dmat3& m) {
  const glm::dmat3 squares = glm::transpose(m) * m;
  double most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::abs(squares[k].x) + std::abs(squares[k].y) + std::abs(squares[k].z));
  return std::sqrt(most);
}

/// The least number of rings with which the error is within the tolerance. Doubles the number first, and then bisects,
/// because globe_error() visits all rings, and falls with their number.
int rings_within(double tolerance) {
  int rings = kFewestRings;
  while (rings < finest_level && globe_error(rings) > tolerance) rings *= 2;
  // Bisects between half of `rings` and `rings`.
  int few = rings / 2, many = rings;
  while (rings > kFewestRings && many - few > 1) {
    const int middle = (few + many) / 2;
    (globe_error(middle) > tolerance ? few : many) = middle;
  }
  return many;
}

}  // namespace

double MeshLevel::triangle_count() const {
  double count = 0;
  for (const int r : rings) count += 4.0 * r * r;
  for (const PatchLevel& level : patches) count += 2.0 * level.u * level.v;
  return count;
}

// Moving a point at distance w by e moves its image, at tangents (x, y) from the axis, by at most focal * e * sqrt(1 +
// x^2 + y^2) / w: image = focal * (X - x W) / w for a displacement (X, W).
ScreenTolerance::ScreenTolerance(const View& view, double pixels)
    : eye_(view.eye()), forward_(view.forward()), near_(view.projection.clip.near) {
  const Projection& p = view.projection;
  const double focal = std::max(view.width / (p.right - p.left), view.height / (p.top - p.bottom));
  if (p.orthographic) {
    anywhere_ = pixels / focal;
    return;
  }
  const double x = std::max(std::abs(p.left), std::abs(p.right)), y = std::max(std::abs(p.bottom), std::abs(p.top));
  per_distance_ = pixels / (focal * std::sqrt(1 + x * x + y * y));
}

double ScreenTolerance::at(double nearest, double farthest) const {
  // Nothing before the near plane is seen, so any tessellation will do.
  if (farthest < near_) return std::numeric_limits<double>::infinity();
  return anywhere_ + std::max(nearest, near_) * per_distance_;
}

double ScreenTolerance::of(std::span<const glm::dvec3> points) const {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const glm::dvec3& p : points) {
    nearest = std::min(nearest, distance(p));
    farthest = std::max(farthest, distance(p));
  }
  return at(nearest, farthest);
}

double ScreenTolerance::of_ball(const glm::dvec3& centre, double radius) const {
  return at(distance(centre) - radius, distance(centre) + radius);
}

// Second derivatives of a Bezier surface are convex combinations of second differences of its points.
PatchBending::PatchBending(std::span<const glm::dvec3, 16> points) {
  const auto at = [&](std::size_t i, std::size_t j) { return points[4 * i + j]; };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      if (i < 2) uu_ = std::max(uu_, 6 * glm::length(at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j)));
      if (j < 2) vv_ = std::max(vv_, 6 * glm::length(at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)));
      if (i < 3 && j < 3)
        uv_ = std::max(uv_, 9 * glm::length((at(i + 1, j + 1) - at(i + 1, j)) - (at(i, j + 1) - at(i, j))));
    }
}

double PatchBending::error(const PatchLevel& level) const {
  const double u = 1.0 / level.u, v = 1.0 / level.v;
  return (uu_ * u * u + 2 * uv_ * u * v + vv_ * v * v) / 8;
}

PatchLevel PatchBending::level_within(double tolerance) const {
  PatchLevel level;
  // A control point is infinite or NaN: tessellate() leaves such patches out.
  if (!std::isfinite(error(level))) return level;  // never seen
  while (error(level) > tolerance && (level.u < finest_level || level.v < finest_level)) {
    // The direction with the greater share of the error is halved. This quarters its share, and keeps the share
    // of the other direction.
    const double by_u = uu_ / level.u / level.u, by_v = vv_ / level.v / level.v;
    // If only the twist remains, the longer cells are halved.
    const bool is_u = by_u != by_v ? by_u > by_v : level.u <= level.v;
    int& steps = (is_u && level.u < finest_level) || level.v >= finest_level ? level.u : level.v;
    steps *= 2;
  }
  return level;
}

// The four corners of a cell lie on a circle. Its radius R is that of the circle about the triangle of a side, a
// diagonal and a leg. The plane through the corners is sqrt(1 - R^2) from the centre, and no point of the cell is
// nearer to the centre.
double globe_error(int rings) {
  const double half_step = turn(1, 4 * std::int64_t(rings)).y;
  const double leg = 2 * half_step;
  double most = 0;
  for (int i = 0; i < rings; ++i) {
    // `a` and `b` are chords of the two parallels of a ring, one column wide. At a pole one of them is 0.
    const double a = 2 * turn(i, 2 * rings).y * half_step, b = 2 * turn(i + 1, 2 * rings).y * half_step;
    const double diagonal = std::sqrt(leg * leg + a * b), height = std::sqrt(leg * leg - (a - b) * (a - b) / 4);
    const double radius = leg * diagonal / (2 * height);
    most = std::max(most, radius);
  }
  return most < 1 ? 1 - std::sqrt(1 - most * most) : 1;
}

MeshLevel level_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const ScreenTolerance& tolerance) {
  MeshLevel level;
  const double stretch = greatest_stretch(glm::dmat3(world_from_mesh));
  for (const Sphere& sphere : mesh.spheres) {
    const double radius = stretch * std::max(sphere.radius, 0.0);
    const double allowed = tolerance.of_ball(glm::dvec3(world_from_mesh * glm::dvec4(sphere.centre, 1)), radius);
    level.rings.push_back(radius > 0 && std::isfinite(radius) ? rings_within(allowed / radius) : kFewestRings);
  }
  for (const BezierPatch& patch : mesh.patches) {
    std::array<glm::dvec3, 16> points;
    for (std::size_t i = 0; i < 16; ++i) points[i] = glm::dvec3(world_from_mesh * glm::dvec4(patch.points[i], 1));
    level.patches.push_back(PatchBending(points).level_within(tolerance.of(points)));
  }
  return level;
}

namespace {

using EdgePoints = std::array<glm::dvec3, 4>;

/// Edges are equal if all four control points are, to the bit; points that differ by a rounding are apart.
struct EdgeOrder {
  bool operator()(const EdgePoints& a, const EdgePoints& b) const {
    const auto comes_before = [](const glm::dvec3& p, const glm::dvec3& q) {
      return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
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
    // Walks all around the cell, counter-clockwise as seen from the outer side, along each side without its end.
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

  /// The number of the vertex at a place. Places are fractions of powers of two, so both sides of an edge get the same
  /// point, however fine their lattices are.
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

  /// Adds a triangle unless it is degenerate: at a pole a side of a cell is a point.
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

/// Whether the patch can be tessellated: all its points are finite.
bool is_finite(const BezierPatch& patch) {
  return std::all_of(patch.points.begin(), patch.points.end(),
                     [](const glm::dvec3& p) { return frontmost::is_finite(p); });
}

}  // namespace

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

namespace {

/// The limit amounts to some 3 GiB of mesh. It is a double, because the requested number may exceed all integers.
constexpr double kMostTriangles = 1 << 26;

void append_globe(const Sphere& sphere, int rings, std::uint32_t face, Mesh& mesh) {
  const Mesh globe = frontmost::sphere(rings);
  const auto first = std::uint32_t(mesh.positions.size()), first_texcoord = std::uint32_t(mesh.texcoords.values.size());
  for (const glm::vec3& p : globe.positions) mesh.positions.emplace_back(sphere.centre + glm::dvec3(p) * sphere.radius);
  mesh.normals.values.insert(mesh.normals.values.end(), globe.normals.values.begin(), globe.normals.values.end());
  mesh.texcoords.values.insert(mesh.texcoords.values.end(), globe.texcoords.values.begin(),
                               globe.texcoords.values.end());
  for (const glm::uvec3& t : globe.triangles) mesh.triangles.push_back(t + first);
  for (const glm::uvec3& t : globe.texcoords.triangles) mesh.texcoords.triangles.push_back(t + first_texcoord);
  mesh.face_ids.resize(mesh.triangles.size(), face);
}

/// The triangles of a mesh at one level. Primitives that are never seen have no triangles.
Mesh make_triangles(const Mesh& curved, const MeshLevel& level) {
  Mesh mesh;
  mesh.name = curved.name;
  mesh.material_ids = curved.material_ids;
  mesh.spheres = curved.spheres;
  mesh.patches = curved.patches;
  for (std::size_t i = 0; i < curved.spheres.size(); ++i)
    if (curved.spheres[i].radius > 0) append_globe(curved.spheres[i], level.rings[i], std::uint32_t(i), mesh);
  const std::vector<EdgeLevels> edges = edge_levels(curved.patches, level.patches);
  for (std::size_t i = 0; i < curved.patches.size(); ++i) {
    if (!is_finite(curved.patches[i])) continue;
    const std::size_t before = mesh.triangles.size();
    GridBuilder(curved.patches[i], level.patches[i], edges[i], mesh).add_all(std::uint32_t(curved.spheres.size() + i));
    // A grid numbers its texture coordinates like its positions. Behind spheres, the numbers of the two differ by a
    // constant.
    const auto shift = std::uint32_t(mesh.texcoords.values.size() - mesh.positions.size());
    for (std::size_t t = before; t < mesh.triangles.size(); ++t)
      mesh.texcoords.triangles.push_back(mesh.triangles[t] + shift);
  }
  return mesh;
}

/// The fineness of each instance of a curved mesh, known before anything is made; equal instances share meshes.
struct Plan {
  using Key = std::pair<std::uint32_t, MeshLevel>;  ///< a mesh, and its level

  std::vector<std::optional<Key>> keys;  ///< by instance; none if the mesh is not curved
  std::vector<double> counts;            ///< by instance: triangles made for this and all earlier instances
  double triangle_count = 0;

  Plan(const Scene& scene, const View& view, double pixels) {
    if (!(pixels > 0))
      throw Error(ErrorCode::bad_argument, "tessellation error", std::to_string(pixels) + " pixels is not above 0");
    validate(scene);
    validate(view);
    const ScreenTolerance tolerance(view, pixels);
    std::set<Key> seen;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      std::optional<Key>& key = keys.emplace_back();
      if (mesh.is_curved()) {
        key.emplace(instance.mesh, level_of(mesh, instance.world_from_mesh, tolerance));
        if (seen.insert(*key).second) triangle_count += key->second.triangle_count();
      }
      counts.push_back(triangle_count);
    }
  }

  void check_limit(const Scene& scene) const {
    const auto over = std::find_if(counts.begin(), counts.end(), [](double n) { return !(n <= kMostTriangles); });
    if (over == counts.end()) return;
    const auto instance = std::size_t(over - counts.begin());
    throw Error(ErrorCode::limit_exceeded,
                place_in(scene) + "instance " + std::to_string(instance) + ", mesh " +
                    std::to_string(scene.instances[instance].mesh),
                "this tessellation error needs more than 2^26 triangles; give a larger one");
  }
};

}  // namespace

double tessellated_count(const Scene& scene, const View& view, double pixels) {
  const IeeeScope ieee;
  return Plan(scene, view, pixels).triangle_count;
}

bool has_curved(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh < scene.meshes.size() && scene.meshes[instance.mesh].is_curved();
  });
}

Scene tessellate(const Scene& scene, const View& view, double pixels) {
  const IeeeScope ieee;
  const Plan plan(scene, view, pixels);
  plan.check_limit(scene);
  Scene out = scene;
  std::vector<bool> is_made(scene.meshes.size());  // meshes of the scene that have new triangles
  std::map<Plan::Key, std::uint32_t> made;         // number of the mesh made for a key
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!plan.keys[i]) continue;
    const auto& [mesh, level] = *plan.keys[i];
    const auto [entry, is_new] = made.try_emplace(*plan.keys[i], mesh);
    if (is_new) {
      Mesh triangles = make_triangles(scene.meshes[mesh], level);
      if (is_made[mesh]) {
        entry->second = std::uint32_t(out.meshes.size());
        out.meshes.push_back(std::move(triangles));
      } else {  // the first level takes the place of the mesh itself
        is_made[mesh] = true;
        out.meshes[mesh] = std::move(triangles);
      }
    }
    out.instances[i].mesh = entry->second;
  }
  return out;
}

}  // namespace frontmost
