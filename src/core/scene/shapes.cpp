// SPDX-License-Identifier: Apache-2.0
// Shapes as grids of points: a sphere, a torus knot and the shape of a lathe are one grid each, bent so that its first
// and last row, or column, coincide or contract to a point.
//
//   rows i       0 ------ j ------ columns
//     |          +---+---+---+
//     |          | / | / | / |      poles: row 0 and the last row are one point each, and a quad there is one triangle
//     |          +---+---+---+
//   rows         | / | / | / |      closed: the last row or column has the numbers of the first, so there is no seam
//                +---+---+---+
#include "scene/shapes.h"

#include <cmath>
#include <utility>

#include "scene/turn.h"

namespace frontmost {
namespace {

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

// Adds both triangles of a quad, except a triangle that a pole has contracted to a line.
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
  // Corners of each side from its lower left, counter-clockwise from outside; bit k of a corner belongs to axis k.
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
  const std::vector<glm::dvec2> turns = circle(2 * rings);
  Mesh mesh = surface(grid, [&](int i, int j) {
    const glm::dvec2 down = turns[std::size_t(i)], around = turns[std::size_t(j)];
    const glm::dvec3 p{down.y * around.x, down.x, 0.0 - down.y * around.y};
    return SurfacePoint{p, p};
  });
  mesh.spheres = {Sphere{}};
  return mesh;
}

Mesh torus_knot(const KnotShape& shape) {
  // A point of the curve with two directions across it: away from the core circle, and the third direction.
  struct Station {
    glm::dvec3 position, out, side;
  };
  std::vector<Station> stations;
  for (int i = 0; i < shape.along; ++i) {
    const glm::dvec2 about = turn(std::int64_t(i) * shape.p, shape.along);
    const glm::dvec2 swing = turn(std::int64_t(i) * shape.q, shape.along);
    const double radius = 1 + shape.core * swing.x, growth = -shape.core * shape.q * swing.y;
    const glm::dvec3 slope{growth * about.x - radius * shape.p * about.y, shape.core * shape.q * swing.x,
                           growth * about.y + radius * shape.p * about.x};
    const glm::dvec3 forward = unit(slope);
    const glm::dvec3 side = unit(glm::cross(forward, glm::dvec3(swing.x * about.x, swing.y, swing.x * about.y)));
    stations.push_back({{radius * about.x, shape.core * swing.y, radius * about.y}, glm::cross(side, forward), side});
  }
  const std::vector<glm::dvec2> around = circle(shape.around);
  const SurfaceGrid grid{.rows = shape.along, .columns = shape.around, .closed_rows = true, .closed_columns = true};
  return surface(grid, [&](int i, int j) {
    const Station& at = stations[std::size_t(i)];
    const glm::dvec3 normal = at.out * around[std::size_t(j)].x - at.side * around[std::size_t(j)].y;
    return SurfacePoint{at.position + normal * shape.tube, normal};
  });
}

Mesh lathe(std::span<const ProfilePoint> profile, int segments) {
  Mesh mesh;
  const int last = int(profile.size()) - 1;
  const std::vector<glm::dvec2> turns = circle(segments);
  for (int i = 0; i <= last; ++i)
    for (int j = 0; j <= segments; ++j) {
      const ProfilePoint& p = profile[std::size_t(i)];
      mesh.texcoords.values.emplace_back(double(j) / segments, double(i) / last);
      if (j == segments) continue;  // the seam: another texture coordinate, but the first position again
      const glm::dvec2 around = turns[std::size_t(j)];
      mesh.positions.emplace_back(p.radius * around.x, p.height, 0.0 - p.radius * around.y);
      mesh.normals.values.emplace_back(p.normal.x * around.x, p.normal.y, 0.0 - p.normal.x * around.y);
    }
  const auto position = [&](int i, int j) { return std::uint32_t(i * segments + j % segments); };
  const auto texcoord = [&](int i, int j) { return std::uint32_t(i * (segments + 1) + j); };
  for (int i = 0; i < last; ++i) {
    const ProfilePoint &upper = profile[std::size_t(i)], &lower = profile[std::size_t(i) + 1];
    if (upper.radius == lower.radius && upper.height == lower.height) continue;
    for (int j = 0; j < segments; ++j) {
      glm::uvec4 c{position(i, j + 1), position(i, j), position(i + 1, j), position(i + 1, j + 1)};
      if (upper.radius == 0) c[0] = c[1];
      if (lower.radius == 0) c[3] = c[2];
      add_quad(c, {texcoord(i, j + 1), texcoord(i, j), texcoord(i + 1, j), texcoord(i + 1, j + 1)}, mesh);
    }
  }
  return mesh;
}

Mesh round_slab(const RoundSlab& slab, int segments) {
  constexpr int kBevelSteps = 5;
  std::vector<ProfilePoint> profile{{0, slab.height, {0, 1}}};
  for (int i = 0; i <= kBevelSteps; ++i) {
    const glm::dvec2 normal = turn(kBevelSteps - i, 4 * kBevelSteps);
    profile.push_back({slab.radius - slab.bevel * (1 - normal.x), slab.height - slab.bevel * (1 - normal.y), normal});
  }
  profile.push_back({slab.radius, 0, {1, 0}});
  profile.push_back({slab.radius, 0, {0, -1}});
  profile.push_back({0, 0, {0, -1}});
  return lathe(profile, segments);
}

namespace {

// Appends the values of a part to an attribute of the mesh, and the numbers of the values at the part's corners.
template <class T>
void append_values(Attribute<T>& attribute, const std::vector<T>& values, const std::vector<glm::uvec3>& corners) {
  const auto first = std::uint32_t(attribute.values.size());
  attribute.values.insert(attribute.values.end(), values.begin(), values.end());
  for (const glm::uvec3& c : corners) attribute.triangles.push_back(c + first);
}

}  // namespace

void append(Mesh& mesh, const Mesh& part, std::uint32_t material, const glm::dmat4& mesh_from_part) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::vec3& p : part.positions) mesh.positions.emplace_back(mesh_from_part * glm::dvec4(p, 1));
  for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + first);
  std::vector<glm::vec3> normals;
  for (const glm::vec3& n : part.normals.values)
    normals.emplace_back(unit(glm::dvec3(mesh_from_part * glm::dvec4(n, 0))));
  append_values(mesh.normals, normals, part.normals.triangles.empty() ? part.triangles : part.normals.triangles);
  append_values(mesh.texcoords, part.texcoords.values,
                part.texcoords.triangles.empty() ? part.triangles : part.texcoords.triangles);
  mesh.material_ids.resize(mesh.triangles.size(), material);
}

}  // namespace frontmost
