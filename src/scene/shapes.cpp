// SPDX-License-Identifier: Apache-2.0
#include "scene/shapes.h"

#include <cmath>
#include <utility>

#include "base/srgb.h"
#include "scene/turn.h"

namespace frontmost {
namespace {

glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(glm::dot(v, v)); }

// The number of grid point (i, j) among the stored points.
struct GridNumbers {
  explicit GridNumbers(const SurfaceGrid& shape)
      : grid(shape),
        rows(shape.closed_rows ? shape.rows : shape.rows + 1),
        columns(shape.closed_columns ? shape.columns : shape.columns + 1) {}

  [[nodiscard]] std::uint32_t operator()(int i, int j) const {
    if (!grid.poles) return std::uint32_t((i % rows) * columns + j % columns);
    if (i == 0) return 0;
    const int inner = std::min(i, grid.rows) - 1;
    return std::uint32_t(1 + inner * columns + (i == grid.rows ? 0 : j % columns));
  }

  SurfaceGrid grid;
  int rows, columns;
};

// Both triangles of a quad, less one that a pole has pulled together to a line.
void add_quad(const glm::uvec4& corners, const glm::uvec4& texcoords, Mesh& mesh) {
  const glm::uvec4 &c = corners, &t = texcoords;
  if (c[0] != c[1]) {
    mesh.triangles.emplace_back(c[0], c[1], c[2]);
    mesh.texcoords.triangles.emplace_back(t[0], t[1], t[2]);
  }
  if (c[2] != c[3]) {
    mesh.triangles.emplace_back(c[0], c[2], c[3]);
    mesh.texcoords.triangles.emplace_back(t[0], t[2], t[3]);
  }
}

}  // namespace

Mesh surface(const SurfaceGrid& grid, const std::function<SurfacePoint(int i, int j)>& point) {
  const GridNumbers number(grid);
  Mesh mesh;
  for (int i = 0; i < number.rows; ++i)
    for (int j = 0; j < number.columns; ++j) {
      if (grid.poles && (i == 0 || i == grid.rows) && j > 0) continue;
      const SurfacePoint p = point(i, j);
      mesh.positions.emplace_back(p.position);
      mesh.normals.values.emplace_back(p.normal);
    }
  for (int i = 0; i <= grid.rows; ++i)
    for (int j = 0; j <= grid.columns; ++j)
      mesh.texcoords.values.emplace_back(double(j) / grid.columns, double(i) / grid.rows);
  const auto texcoord = [&](int i, int j) { return std::uint32_t(i * (grid.columns + 1) + j); };
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j)
      add_quad({number(i, j + 1), number(i, j), number(i + 1, j), number(i + 1, j + 1)},
               {texcoord(i, j + 1), texcoord(i, j), texcoord(i + 1, j), texcoord(i + 1, j + 1)}, mesh);
  return mesh;
}

Mesh box(const glm::dvec3& low, const glm::dvec3& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  mesh.texcoords.values = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  // Corners of each side from its lower left, counter-clockwise from outside; bit k of a corner is its axis k.
  constexpr std::array<glm::uvec4, 6> kSides{
      {{0, 4, 6, 2}, {5, 1, 3, 7}, {0, 1, 5, 4}, {6, 7, 3, 2}, {1, 0, 2, 3}, {4, 5, 7, 6}}};
  for (std::uint32_t side = 0; side < 6; ++side) {
    const glm::uvec4& c = kSides[side];
    glm::vec3 normal(0);
    normal[int(side / 2)] = side % 2 == 0 ? -1.0f : 1.0f;
    mesh.normals.values.push_back(normal);
    for (const glm::uvec3 k : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
      mesh.triangles.emplace_back(c[k.x], c[k.y], c[k.z]);
      mesh.normals.triangles.emplace_back(side);
      mesh.texcoords.triangles.push_back(k);
      mesh.face_ids.push_back(side);
    }
  }
  return mesh;
}

Mesh floor(double width, double depth, double repeats) {
  Mesh mesh;
  const double x = width / 2, z = depth / 2;
  mesh.positions = {glm::vec3(-x, 0, z), glm::vec3(x, 0, z), glm::vec3(x, 0, -z), glm::vec3(-x, 0, -z)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.normals.values.assign(4, {0, 1, 0});
  mesh.texcoords.values = {glm::vec2(0, repeats), glm::vec2(repeats, repeats), glm::vec2(repeats, 0), glm::vec2(0, 0)};
  mesh.face_ids = {0, 0};
  return mesh;
}

Mesh sphere(int rings) {
  const SurfaceGrid grid{.rows = rings, .columns = 2 * rings, .closed_columns = true, .poles = true};
  return surface(grid, [&](int i, int j) {
    const glm::dvec2 down = turn(i, 2 * rings), around = turn(j, 2 * rings);
    const glm::dvec3 p{down.y * around.x, down.x, 0.0 - down.y * around.y};
    return SurfacePoint{p, p};
  });
}

Mesh torus_knot(const KnotShape& shape) {
  // The curve and its derivative by the angle; the frame across it is the derivative's with the vector from the core.
  const auto curve = [&](int i) {
    const glm::dvec2 about = turn(std::int64_t(i) * shape.p, shape.along),
                     swing = turn(std::int64_t(i) * shape.q, shape.along);
    const double radius = 1 + shape.core * swing.x, radius_slope = -shape.core * shape.q * swing.y;
    struct {
      glm::dvec3 position, slope, outward;
    } at{{radius * about.x, shape.core * swing.y, radius * about.y},
         {radius_slope * about.x - radius * shape.p * about.y, shape.core * shape.q * swing.x,
          radius_slope * about.y + radius * shape.p * about.x},
         {swing.x * about.x, swing.y, swing.x * about.y}};
    return at;
  };
  const SurfaceGrid grid{.rows = shape.along, .columns = shape.around, .closed_rows = true, .closed_columns = true};
  return surface(grid, [&](int i, int j) {
    const auto at = curve(i);
    const glm::dvec3 forward = unit(at.slope), side = unit(glm::cross(forward, at.outward)),
                     out = glm::cross(side, forward);
    const glm::dvec2 around = turn(j, shape.around);
    const glm::dvec3 normal = out * around.x - side * around.y;
    return SurfacePoint{at.position + normal * shape.tube, normal};
  });
}

Material paint(std::string name, std::uint32_t srgb, float roughness, float metallic) {
  Material material;
  material.name = std::move(name);
  material.base_color = color(srgb);
  material.roughness = roughness;
  material.metallic = metallic;
  return material;
}

std::uint32_t add(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return std::uint32_t(scene.materials.size() - 1);
}

std::uint32_t add(Scene& scene, std::string name, Mesh mesh, std::uint32_t material) {
  mesh.name = std::move(name);
  mesh.material_ids = {material};
  scene.meshes.push_back(std::move(mesh));
  return std::uint32_t(scene.meshes.size() - 1);
}

void place(Scene& scene, std::string name, std::uint32_t mesh, const glm::dmat4& world_from_mesh) {
  scene.instances.push_back({std::move(name), mesh, world_from_mesh});
}

glm::dmat4 moved(const glm::dvec3& by) {
  glm::dmat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1);
  return matrix;
}

glm::dmat4 scaled(double by) {
  glm::dmat4 matrix(by);
  matrix[3][3] = 1;
  return matrix;
}

glm::dmat4 turned(int part, int whole) {
  const glm::dvec2 t = turn(part, whole);
  glm::dmat4 matrix(1.0);
  matrix[0] = {t.x, 0, 0 - t.y, 0};
  matrix[2] = {t.y, 0, t.x, 0};
  return matrix;
}

Camera look_at(std::string name, const glm::dvec3& eye, const glm::dvec3& target, double vertical) {
  const glm::dvec3 back = unit(eye - target), right = unit(glm::cross(glm::dvec3(0, 1, 0), back));
  Camera camera;
  camera.name = std::move(name);
  camera.world_from_eye = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                           glm::dvec4(eye, 1)};
  camera.vertical = vertical * 0.017453292519943295769;
  return camera;
}

glm::vec4 color(std::uint32_t srgb, double alpha) {
  const auto byte = [&](int shift) { return linear_of_srgb8(std::uint8_t(srgb >> shift & 255)); };
  return {byte(16), byte(8), byte(0), float(alpha)};
}

}  // namespace frontmost
