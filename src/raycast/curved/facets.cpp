// SPDX-License-Identifier: Apache-2.0
// A triangle of its own for every pixel of a curved surface.
//
//    a pixel on a sphere       Shading works on triangles. So every pixel that shows a curved primitive gets a triangle
//        ____                  of its own in the tangent plane at the point that is seen there, with the normal and the
//      /  /\  .                texture coordinates of the surface about that point.
//     |  /__\  |
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/curved/double_ray.h"
#include "scene/bezier_patch.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

/// How a curved surface and its texture run about a point: changes of position and of texture coordinates by u and v.
struct Chart {
  glm::dvec3 along_u, along_v;
  glm::dvec2 texcoord, texcoord_u, texcoord_v;
};

Chart chart_of(const Sphere& sphere, const glm::dmat3& world, const glm::dvec2& at) {
  constexpr double pi = 3.14159265358979323846;
  const double around = 2 * pi * at.x, down = pi * at.y;
  const glm::dvec3 u = glm::dvec3(-std::sin(around), 0, -std::cos(around)) * (2 * pi * std::sin(down));
  const glm::dvec3 v{std::cos(down) * std::cos(around), -std::sin(down), -std::cos(down) * std::sin(around)};
  const glm::dmat3 axes = world * sphere.radius;
  return {axes * u, axes * (v * pi), at, {1, 0}, {0, 1}};
}

Chart chart_of(const BezierPatch& patch, const glm::dmat3& world, const glm::dvec2& at) {
  const PatchPoint point = evaluate(patch, {at.x, 1 - at.x}, {at.y, 1 - at.y});
  const glm::dvec2 across = {at.y, at.x}, size = patch.texture_size;
  return {world * point.along_u, world * point.along_v, patch.texture_low + size * across, {0, size.y}, {size.x, 0}};
}

/// The change of texture coordinates over a step in the tangent plane; none where the parameters run together.
glm::dvec2 texcoord_step(const Chart& c, const glm::dvec3& step) {
  const double uu = glm::dot(c.along_u, c.along_u), vv = glm::dot(c.along_v, c.along_v);
  const double uv = glm::dot(c.along_u, c.along_v), determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-9 * uu * vv)) return glm::dvec2(0);
  const double by_u = glm::dot(c.along_u, step), by_v = glm::dot(c.along_v, step);
  return c.texcoord_u * ((by_u * vv - by_v * uv) / determinant) +
         c.texcoord_v * ((by_v * uu - by_u * uv) / determinant);
}

/// A mesh in world space whose corners are its alone.
class LooseMesh {
 public:
  explicit LooseMesh(const Mesh& like) {
    mesh_.name = like.name;
    mesh_.material_ids = like.material_ids;
  }

  void add_corner(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& texcoord) {
    mesh_.positions.emplace_back(position);
    mesh_.normals.values.emplace_back(normal);
    mesh_.texcoords.values.emplace_back(texcoord);
  }
  /// Of the last three corners.
  void add_triangle() {
    const auto first = std::uint32_t(mesh_.positions.size() - 3);
    mesh_.triangles.emplace_back(first, first + 1, first + 2);
  }
  Mesh& mesh() { return mesh_; }

 private:
  Mesh mesh_;
};

/// The triangles that a curved mesh has, in world space.
void add_tessellation(const Mesh& from, const glm::dmat4& world_from_mesh, LooseMesh& to) {
  const glm::dmat3 m(world_from_mesh);
  const double outward = glm::determinant(m) < 0 ? -1 : 1;
  // Cofactors: the inverse's transpose, but also of singular matrices.
  const glm::dmat3 normals(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  for (std::uint32_t t = 0; t < from.triangles.size(); ++t) {
    for (const int k : {0, outward < 0 ? 2 : 1, outward < 0 ? 1 : 2}) {
      const glm::dvec3 position(world_from_mesh * glm::dvec4(from.positions[from.triangles[t][k]], 1));
      glm::dvec3 normal(0);
      glm::dvec2 texcoord(0);
      if (!from.normals.empty()) normal = normals * glm::dvec3(from.normals.values[from.corners(from.normals, t)[k]]);
      if (!from.texcoords.empty()) texcoord = from.texcoords.values[from.corners(from.texcoords, t)[k]];
      to.add_corner(position, normal * outward, texcoord);
    }
    to.add_triangle();
  }
}

struct FacetPlace {
  glm::dvec3 position, normal;
  double radius;
};

/// Counter-clockwise about the normal, the point in its middle.
void add_facet(const FacetPlace& place, const Chart& chart, LooseMesh& to) {
  const glm::dvec3& n = place.normal;
  const glm::dvec3 e1 = glm::normalize(std::abs(n.x) < 0.6 ? glm::dvec3(0, n.z, -n.y) : glm::dvec3(-n.z, 0, n.x));
  const glm::dvec3 e2 = glm::cross(n, e1);
  constexpr double kHalf = 0.5, kHigh = 0.86602540378443864676;
  const std::array<glm::dvec2, 3> corners{{{1, 0}, {-kHalf, kHigh}, {-kHalf, -kHigh}}};
  for (const glm::dvec2& c : corners) {
    const glm::dvec3 step = (e1 * c.x + e2 * c.y) * place.radius;
    to.add_corner(place.position + step, n, chart.texcoord + texcoord_step(chart, step));
  }
  to.add_triangle();
}

class FacetMaker {
 public:
  FacetMaker(const CurvedIndex& index, const Scene& scene) : index_(index), scene_(scene) {
    for (const Instance& instance : scene.instances) {
      meshes_.emplace_back(scene.meshes[instance.mesh]);
      if (scene.meshes[instance.mesh].is_curved())
        add_tessellation(scene.meshes[instance.mesh], instance.world_from_mesh, meshes_.back());
    }
  }

  /// Gives the samples the numbers of facets in their meshes; those of triangles are not touched yet.
  std::vector<std::uint32_t> add(const CurvedVisible& seen) {
    const View& view = seen.visible.view;
    const ViewRays rays(view);
    std::vector<std::uint32_t> numbers(view.sample_count(), no_index);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x)
        for (int s = 0; s < view.samples; ++s) {
          const std::size_t at = seen.visible.index(x, y, s);
          const PrimitiveId id = seen.visible.primitives[at];
          if (id == no_primitive) continue;
          const PrimitiveSource source = index_.source(id);
          if (!scene_.meshes[source.mesh].is_curved()) continue;
          numbers[at] = shared(seen, numbers, {x, y, s});
          if (numbers[at] == no_index) numbers[at] = make(seen, source, rays, {x, y, s});
        }
    return numbers;
  }

  /// The scene with all facets; those of every instance are in a mesh of its own.
  Scene take_scene() {
    Scene scene = scene_;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      Instance& instance = scene.instances[i];
      if (!scene_.meshes[instance.mesh].is_curved()) continue;
      instance.world_from_mesh = glm::dmat4(1.0);
      instance.mesh = std::uint32_t(scene.meshes.size());
      scene.meshes.push_back(std::move(meshes_[i].mesh()));
    }
    for (std::size_t m = 0; m < scene_.meshes.size(); ++m)
      if (scene_.meshes[m].is_curved()) scene.meshes[m] = Mesh();
    return scene;
  }

 private:
  struct Sample {
    int x, y, number;
  };

  /// The facet of an earlier sample of the pixel, where it shows the same element from about the same side.
  static std::uint32_t shared(const CurvedVisible& seen, const std::vector<std::uint32_t>& numbers,
                              const Sample& sample) {
    constexpr float kAlike = 0.9f;
    const std::size_t at = seen.visible.index(sample.x, sample.y, sample.number);
    for (int s = 0; s < sample.number; ++s) {
      const std::size_t other = seen.visible.index(sample.x, sample.y, s);
      if (seen.visible.primitives[other] == seen.visible.primitives[at] &&
          glm::dot(seen.normals[other], seen.normals[at]) > kAlike)
        return numbers[other];
    }
    return no_index;
  }

  std::uint32_t make(const CurvedVisible& seen, const PrimitiveSource& source, const ViewRays& rays,
                     const Sample& sample) {
    const View& view = seen.visible.view;
    const std::size_t at = seen.visible.index(sample.x, sample.y, sample.number);
    const DoubleRay ray = rays.at(sample.x, sample.y, sample_offsets(view.samples)[std::size_t(sample.number)]);
    const double distance = rays.distance(seen.visible.keys[at]);
    LooseMesh& mesh = meshes_[source.instance];
    const auto number = std::uint32_t(mesh.mesh().triangles.size());
    // A circle about the pixel's corners fits into the triangle.
    const FacetPlace place{ray.origin + distance * ray.direction, glm::dvec3(seen.normals[at]),
                           2 * rays.pixel_size(distance)};
    add_facet(place, chart_at(source, seen.parameters[at]), mesh);
    return number;
  }

  [[nodiscard]] Chart chart_at(const PrimitiveSource& source, const glm::dvec2& parameters) const {
    const Mesh& mesh = scene_.meshes[source.mesh];
    const glm::dmat3 world(scene_.instances[source.instance].world_from_mesh);
    if (source.triangle < mesh.spheres.size()) return chart_of(mesh.spheres[source.triangle], world, parameters);
    return chart_of(mesh.patches[source.triangle - mesh.spheres.size()], world, parameters);
  }

  const CurvedIndex& index_;
  const Scene& scene_;
  std::vector<LooseMesh> meshes_;  ///< by instance
};

/// The first triangle of every instance.
std::vector<PrimitiveId> first_triangles(const Scene& scene) {
  std::vector<PrimitiveId> first;
  PrimitiveId next = 0;
  for (const Instance& instance : scene.instances) {
    first.push_back(next);
    next += PrimitiveId(scene.meshes[instance.mesh].triangles.size());
  }
  first.push_back(next);
  return first;
}

}  // namespace

Facets facets_of(const CurvedIndex& index, const Scene& scene, std::span<const CurvedVisible> views) {
  const IeeeScope ieee;
  FacetMaker maker(index, scene);
  std::vector<std::vector<std::uint32_t>> numbers;
  for (const CurvedVisible& seen : views) numbers.push_back(maker.add(seen));
  Facets result{maker.take_scene(), {}, {}};
  const std::vector<PrimitiveId> first = first_triangles(result.scene);
  result.elements.assign(first.back(), no_primitive);
  for (std::size_t i = 0; i < views.size(); ++i) {
    Visible& visible = result.visible.emplace_back(views[i].visible);
    for (std::size_t at = 0; at < visible.primitives.size(); ++at) {
      PrimitiveId& id = visible.primitives[at];
      if (id == no_primitive) continue;
      const PrimitiveSource source = index.source(id);
      const std::uint32_t number = numbers[i][at];
      const PrimitiveId triangle = first[source.instance] + (number == no_index ? source.triangle : number);
      result.elements[triangle] = id;
      id = triangle;
    }
  }
  return result;
}

}  // namespace frontmost
