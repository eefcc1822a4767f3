// SPDX-License-Identifier: Apache-2.0
// Counts of a scene, mesh by mesh and object by object; and likely units of files that state no unit. The topology of a
// mesh is found by sorting and joining, in parallel:
//
//   positions --equal--> one number for each point
//   half-edges --by their two points--> groups: one is a boundary, two are joined, more are not manifold
//   joined triangles --union-find--> shells; joined corners --union-find--> pieces
//
// Sets are named by their least member, so no result depends on the order of threads.
// The genus follows from Euler's formula if the mesh is closed and every edge has two triangles.
#include "frontmost/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/orientation.h"
#include "base/parallel.h"
#include "geometry/buckets.h"
#include "geometry/disjoint_sets.h"
#include "geometry/places.h"

namespace frontmost {
namespace {

void add(Oddities& sum, const Oddities& odd) {
  sum.non_finite_triangles += odd.non_finite_triangles;
  sum.degenerate_triangles += odd.degenerate_triangles;
  sum.duplicate_triangles += odd.duplicate_triangles;
  sum.boundary_edges += odd.boundary_edges;
  sum.non_manifold_edges += odd.non_manifold_edges;
  sum.inconsistent_edges += odd.inconsistent_edges;
}

constexpr std::size_t kMaxTriangles = std::size_t(1) << 29;  // leaves a free bit beside a half-edge's number
constexpr std::size_t kGrain = std::size_t(1) << 14;
constexpr std::uint32_t kUnpaired = no_index;

/// A half-edge, in the bucket of half-edges with the same lower point.
struct HalfEdge {
  std::uint32_t upper;   ///< the other point
  std::uint32_t marked;  ///< number of the half-edge; the highest bit is set if the half-edge leads to the lower point

  static constexpr std::uint32_t backward = 1u << 31;
  [[nodiscard]] std::uint32_t number() const { return marked & ~backward; }
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.number() < b.number();
  }
  [[nodiscard]] bool is_same(const HalfEdge& other) const { return upper == other.upper; }
};

/// The two greater points of a triangle, in the bucket of triangles with the same least point.
struct UpperPoints {
  std::uint32_t middle, last;

  friend auto operator<=>(const UpperPoints&, const UpperPoints&) = default;
  [[nodiscard]] bool is_same(const UpperPoints& other) const { return *this == other; }
};

/// Sorts each bucket, and calls visit(group, sums) for each group of equal items, from several threads. Adds all `sums`
/// to `all`.
template <class Item, class Visit>
void for_each_group(Buckets<Item>& buckets, const Execution& execution, Oddities& all, const Visit& visit) {
  std::mutex mutex;
  parallel_for(execution, buckets.count(), kGrain, [&](std::size_t begin, std::size_t end) {
    Oddities sums;
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
    add(all, sums);
  });
}

/// The mesh after welding. Half-edge 3 * triangle + k runs from corner k to the next one.
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

  /// Sets the counts of a report. \returns the different positions that finite triangles use.
  [[nodiscard]] std::vector<glm::vec3> examine(MeshReport& report) {
    Oddities& odd = report.odd;
    std::uint64_t surface = 0;  // number of triangles with three different corners
    for (const Kind kind : kinds_) {
      odd.non_finite_triangles += kind == Kind::non_finite;
      odd.degenerate_triangles += kind == Kind::repeated || kind == Kind::flat;
      surface += has_edges(kind);
    }
    count_duplicates(odd);
    join_edges(odd);
    for (std::uint32_t t = 0; t < kinds_.size(); ++t)
      report.shells += has_edges(kinds_[t]) && triangle_sets_.is_leader(t);
    report.closed = surface > 0 && odd.boundary_edges == 0;
    if (report.closed && odd.non_manifold_edges == 0 && odd.inconsistent_edges == 0) {
      // Euler: sum over shells of 2 - 2 genus = vertices - edges + triangles.
      const auto euler = std::int64_t(count_fans()) - std::int64_t(surface * 3 / 2) + std::int64_t(surface);
      report.genus = std::uint64_t(std::int64_t(report.shells) - euler / 2);
    }
    return collect_points(report);
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

  void count_duplicates(Oddities& odd) const {
    const auto list = [&](std::size_t t, const auto& add) {
      if (kinds_[t] == Kind::non_finite) return;
      glm::uvec3 c = corners_[t];
      if (c.x > c.y) std::swap(c.x, c.y);
      if (c.y > c.z) std::swap(c.y, c.z);
      if (c.x > c.y) std::swap(c.x, c.y);
      add(c.x, UpperPoints{c.y, c.z});
    };
    Buckets<UpperPoints> triangles(mesh_.positions.size(), corners_.size(), list, execution_);
    for_each_group(triangles, execution_, odd, [](std::span<const UpperPoints> same, Oddities& counts) {
      counts.duplicate_triangles += same.size() - 1;
    });
  }

  // Counts edges by their number of triangles, joins the triangles of each edge, and pairs opposite half-edges.
  void join_edges(Oddities& odd) {
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
    for_each_group(edges, execution_, odd, [&](std::span<const HalfEdge> edge, Oddities& counts) {
      for (std::size_t i = 1; i < edge.size(); ++i) triangle_sets_.join(edge[0].number() / 3, edge[i].number() / 3);
      counts.boundary_edges += edge.size() == 1;
      counts.non_manifold_edges += edge.size() > 2;
      if (edge.size() != 2) return;
      if (((edge[0].marked ^ edge[1].marked) & HalfEdge::backward) == 0) {
        ++counts.inconsistent_edges;
      } else {
        twins_[edge[0].number()] = edge[1].number();
        twins_[edge[1].number()] = edge[0].number();
      }
    });
  }

  // The number of fans of triangles around vertices. A vertex has one fan, unless several fans touch in it. The surface
  // then passes the vertex several times, and counting the vertex once would turn the contact into a handle.
  // Precondition: every half-edge has its twin.
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

  [[nodiscard]] std::vector<glm::vec3> collect_points(MeshReport& report) const {
    std::vector<glm::vec3> points;
    std::vector<bool> used(mesh_.positions.size(), false);
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      if (kinds_[t] == Kind::non_finite) continue;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t corner = corners_[t][k];
        if (used[corner]) continue;
        used[corner] = true;
        points.push_back(mesh_.positions[corner]);
        report.pieces += corner_sets_.is_leader(corner);
      }
    }
    return points;
  }

  const Mesh& mesh_;
  const Execution& execution_;
  std::vector<glm::uvec3> corners_;
  std::vector<Kind> kinds_;
  DisjointSets<> triangle_sets_, corner_sets_;
  std::vector<std::uint32_t> twins_;
};

// Number of triangles of each material, in the order of material numbers.
std::vector<MaterialUse> materials_of(const Mesh& mesh) {
  if (mesh.triangles.empty()) return {};
  if (mesh.material_ids.size() <= 1) return {{mesh.material_of(0), mesh.triangles.size()}};
  std::map<std::uint32_t, std::uint64_t> counts;  // no_index, the greatest number, comes last
  std::uint64_t* count = nullptr;
  for (std::size_t i = 0; i < mesh.material_ids.size(); ++i) {
    if (i == 0 || mesh.material_ids[i] != mesh.material_ids[i - 1]) count = &counts[mesh.material_ids[i]];
    ++*count;
  }
  std::vector<MaterialUse> uses;
  for (const auto& [material, triangles] : counts) uses.push_back({material, triangles});
  return uses;
}

std::uint64_t face_count(const Mesh& mesh) {
  if (mesh.face_ids.empty()) return mesh.triangles.size();
  // The triangles of a polygon are consecutive.
  std::uint64_t faces = 1;
  for (std::size_t i = 1; i < mesh.face_ids.size(); ++i) faces += mesh.face_ids[i] != mesh.face_ids[i - 1];
  return faces;
}

/// Reports a mesh. Sets `points` to the different positions of finite triangles. Precondition: indices are in range.
MeshReport report_mesh(const Mesh& mesh, const Execution& execution, std::vector<glm::vec3>& points) {
  if (mesh.triangles.size() > kMaxTriangles)
    throw Error(ErrorCode::limit_exceeded, "mesh " + mesh.name, "more than 536870912 triangles to examine");
  MeshReport report;
  points = MeshTopology(mesh, execution).examine(report);
  report.name = mesh.name;
  report.triangles = mesh.triangles.size();
  report.vertices = mesh.positions.size();
  report.positions = points.size();
  report.faces = face_count(mesh);
  report.has_normals = !mesh.normals.empty();
  report.has_texcoords = !mesh.texcoords.empty();
  report.has_colors = !mesh.colors.empty();
  report.materials = materials_of(mesh);
  return report;
}

// The bounds of those points that are finite in world space.
Box bounds_of(const std::vector<glm::vec3>& points, const glm::dmat4& world_from_mesh, const Execution& execution) {
  Box bounds;
  std::mutex mutex;
  parallel_for(execution, points.size(), std::size_t(1) << 16, [&](std::size_t begin, std::size_t end) {
    Box part;
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 p(world_from_mesh * glm::dvec4(glm::dvec3(points[i]), 1));
      if (is_finite(p)) part.include(p);
    }
    const std::lock_guard lock(mutex);
    bounds.include(part);
  });
  return bounds;
}

struct Measures {
  double area = 0, volume = 0;
};

/// Area and volume of a placed mesh. Triangles are summed in blocks, so that the number of threads does not change the
/// result. The volume is the sum of tetrahedra with their tip in the middle of the bounds; a tip far from the object
/// would cause cancellation.
Measures measures_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const Box& bounds,
                     const Execution& execution) {
  constexpr std::size_t block = std::size_t(1) << 14;
  std::vector<Measures> sums((mesh.triangles.size() + block - 1) / block);
  const glm::dvec3 tip = (glm::dvec3(bounds.low) + glm::dvec3(bounds.high)) * 0.5;
  const auto world = [&](std::uint32_t vertex) {
    return glm::dvec3(world_from_mesh * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1));
  };
  parallel_for(execution, sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t t = b * block; t < std::min((b + 1) * block, mesh.triangles.size()); ++t) {
        const glm::uvec3& c = mesh.triangles[t];
        const glm::dvec3 p = world(c.x) - tip, q = world(c.y) - tip, r = world(c.z) - tip;
        const glm::dvec3 across = glm::cross(q - p, r - p);
        const double area = 0.5 * glm::length(across), volume = glm::dot(p, across) / 6;
        if (!std::isfinite(area) || !std::isfinite(volume)) continue;
        sums[b].area += area;
        sums[b].volume += volume;
      }
  });
  Measures all;
  for (const Measures& sum : sums) all = {all.area + sum.area, all.volume + sum.volume};
  return all;
}

double rounding_within(const Box& bounds) {
  if (bounds.is_empty()) return 0;
  float farthest = 0;
  for (int axis = 0; axis < 3; ++axis)
    farthest = std::max({farthest, std::abs(bounds.low[axis]), std::abs(bounds.high[axis])});
  return 0.5 * (double(farthest) - double(std::nextafter(farthest, 0.0f)));
}

MaterialReport report_material(const Material& material) {
  MaterialReport report;
  report.name = material.name;
  for (const TextureUse* use : texture_uses_of(material)) report.textures += use->is_set();
  report.alpha = material.alpha;
  report.double_sided = material.double_sided;
  return report;
}

glm::dvec3 unit(const glm::dvec4& v) {
  const glm::dvec3 direction(v);
  const double length = std::sqrt(glm::dot(direction, direction));
  return length > 0 ? direction / length : direction;
}

CameraReport report_camera(const Camera& camera) {
  const glm::dmat4& pose = camera.world_from_eye;
  return {camera.name, glm::dvec3(pose[3]), unit(-pose[2]), unit(pose[1]), camera.orthographic, camera.vertical};
}

LightReport report_light(const Light& light) {
  const glm::dmat4& pose = light.world_from_light;
  return {light.name,      light.kind,  glm::dvec3(pose[3]), unit(-pose[2]),  light.color,
          light.intensity, light.range, light.inner_cone,    light.outer_cone};
}

// Reports the objects of one mesh, which need its points. Meshes are examined one after the other, so only one mesh's
// points are in memory at a time.
void report_objects(const Scene& scene, const std::vector<std::uint32_t>& instances,
                    const std::vector<glm::vec3>& points, const Execution& execution, SceneReport& report) {
  for (const std::uint32_t i : instances) {
    const Instance& instance = scene.instances[i];
    const MeshReport& mesh = report.meshes[instance.mesh];
    report.objects[i] = {
        instance.name, instance.mesh, mesh.triangles, bounds_of(points, instance.world_from_mesh, execution), 0,
        std::nullopt};
    const Measures measures =
        measures_of(scene.meshes[instance.mesh], instance.world_from_mesh, report.objects[i].bounds, execution);
    report.area += report.objects[i].area = measures.area;
    if (mesh.genus) {
      report.objects[i].volume = std::abs(measures.volume);
      report.volume = report.volume.value_or(0) + std::abs(measures.volume);
    }
    report.bounds.include(report.objects[i].bounds);
    report.triangles += mesh.triangles;
    for (const MaterialUse& use : mesh.materials)
      if (use.material != no_index) report.materials[use.material].triangles += use.triangles;
  }
}

constexpr double millimetre = 0.001, centimetre = 0.01, inch = 0.0254, metre = 1;

}  // namespace

SceneReport inspect(const Scene& scene, const Execution& execution) {
  validate(scene);
  SceneReport report;
  report.name = scene.name;
  report.up = scene.up;
  report.origin = scene.origin;
  report.texture_count = scene.textures.size();
  report.warnings = scene.warnings;
  for (const Material& material : scene.materials) report.materials.push_back(report_material(material));
  for (const Camera& camera : scene.cameras) report.cameras.push_back(report_camera(camera));
  for (const Light& light : scene.lights) report.lights.push_back(report_light(light));
  std::vector<std::vector<std::uint32_t>> instances(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) instances[scene.instances[i].mesh].push_back(i);
  report.objects.resize(scene.instances.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    report_progress(execution, "inspect", double(m) / double(scene.meshes.size()));
    std::vector<glm::vec3> points;
    report.meshes.push_back(report_mesh(scene.meshes[m], execution, points));
    report.stored_triangles += report.meshes[m].triangles;
    report.vertices += report.meshes[m].vertices;
    add(report.odd, report.meshes[m].odd);
    report_objects(scene, instances[m], points, execution, report);
  }
  report.rounding = rounding_within(report.bounds);
  return report;
}

std::vector<double> likely_units(const Box& bounds) {
  if (bounds.is_empty()) return {};
  const glm::dvec3 size = glm::dvec3(bounds.high) - glm::dvec3(bounds.low);
  const double greatest = std::max({size.x, size.y, size.z});
  constexpr double least_part = 5, greatest_part = 2000, grain = 1, least_in_metres = 0.001;
  if (!(greatest >= least_in_metres && greatest <= greatest_part)) return {};
  if (greatest >= least_part) return {millimetre};
  if (greatest < grain) return {metre};
  return {centimetre, inch, metre};
}

}  // namespace frontmost
