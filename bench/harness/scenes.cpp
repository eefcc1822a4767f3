// SPDX-License-Identifier: Apache-2.0
#include "harness/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include "harness/random.h"

namespace frontmost::bench {
namespace {

constexpr SceneEntry kScenes[] = {
    {"teapot", Camera::fit, 4.5},
    {"bunny", Camera::fit, 15},
    {"sphere100k", Camera::fit, 0},
    {"sphere1m", Camera::fit, 45},
    {"sphere4m", Camera::fit, 60},
    {"terrain1m", Camera::fit, 33},
    {"terrain1m-fly", Camera::over_terrain, 22},
    {"terrain4m", Camera::fit, 45},
    {"terrain16m", Camera::fit, 55, true},
    {"terrain16m-fly", Camera::over_terrain, 0, true},
    {"soup100k", Camera::fit, 0},
    {"soup1m", Camera::fit, 26},
    {"city-fly", Camera::in_city, 24},
    {"city-street", Camera::in_street, 0},
    {"boxes-in", Camera::fit, 28},
    {"boxes-out", Camera::fit, 28},
    {"boxes-random", Camera::fit, 28},
    {"huge", Camera::close, 0},
    {"outside", Camera::away, 0},
    {"city-wall", Camera::wall, 0},
    {"city-no-wall", Camera::wall, 0},
};

constexpr SceneEntry kTranslucent[] = {{"teapots"}, {"bunnies"}};
constexpr int kCopies = 4;

/// Triangles of a grid of columns x rows positions.
void add_grid(Mesh& mesh, std::uint32_t columns, std::uint32_t rows) {
  mesh.triangles.reserve(std::size_t(2) * (columns - 1) * (rows - 1));
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
}

/// A fractal height field over the unit square, y up.
Mesh terrain(std::size_t triangles) {
  const auto side = std::uint32_t(std::lround(std::sqrt(double(triangles) / 2))) + 1;
  Mesh mesh;
  mesh.positions.reserve(std::size_t(side) * side);
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i) {
      const float x = float(i) / float(side - 1), z = float(j) / float(side - 1);
      mesh.positions.push_back({x, 0.25f * fractal({x * 6, 0.5f, z * 6}, 8), z});
    }
  add_grid(mesh, side, side);
  return mesh;
}

/// A sphere with a rough surface: closed, with a silhouette at every scale.
Mesh sphere(std::size_t triangles) {
  const auto rows = std::uint32_t(std::lround(std::sqrt(double(triangles) / 4))) + 1, columns = 2 * (rows - 1) + 1;
  Mesh mesh;
  mesh.positions.reserve(std::size_t(rows) * columns);
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double theta = std::numbers::pi * j / (rows - 1);
      const double phi = 2 * std::numbers::pi * (i % (columns - 1)) / (columns - 1);
      const glm::vec3 d{float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                        float(-std::sin(theta) * std::sin(phi))};
      mesh.positions.push_back(d * (1 + 0.15f * fractal(d * 4.0f + glm::vec3(7), 7)));
    }
  add_grid(mesh, columns, rows);
  return mesh;
}

struct BoxAxes {
  glm::vec3 x, y, z;  ///< half edges
};

void add_box(Mesh& mesh, const glm::vec3& centre, const BoxAxes& axes) {
  const auto base = std::uint32_t(mesh.positions.size());
  for (int k = 0; k < 8; ++k)
    mesh.positions.push_back(centre + axes.x * (k & 1 ? 1.f : -1.f) + axes.y * (k & 2 ? 1.f : -1.f) +
                             axes.z * (k & 4 ? 1.f : -1.f));
  constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({base + f[0], base + f[1], base + f[2]});
    mesh.triangles.push_back({base + f[0], base + f[2], base + f[3]});
  }
}

enum class BoxOrder : std::uint8_t { inner_first, outer_first, shuffled };

/// Boxes inside each other, each turned a little: every pixel is covered a thousand times.
Mesh nested_boxes(std::size_t count, BoxOrder order) {
  std::vector<std::size_t> rank(count);
  std::iota(rank.begin(), rank.end(), std::size_t(0));
  if (order == BoxOrder::outer_first) std::reverse(rank.begin(), rank.end());
  Random random{42};
  if (order == BoxOrder::shuffled)
    for (std::size_t i = count; i > 1; --i) std::swap(rank[i - 1], rank[random.next() % i]);
  Mesh mesh;
  for (const std::size_t k : rank) {
    const float size = 0.2f + 0.8f * float(k + 1) / float(count), turn = 0.35f * float(k) / float(count);
    const float c = std::cos(turn) * size, s = std::sin(turn) * size;
    add_box(mesh, {}, {{c, 0, s}, {0, size, 0}, {-s, 0, c}});
  }
  return mesh;
}

glm::vec3 random_point(Random& random, float scale) {
  const float x = random.unit() * scale, y = random.unit() * scale, z = random.unit() * scale;
  return {x, y, z};
}

/// Triangles that share no vertex, with edges of about `edge`, anywhere in the unit cube.
Mesh soup(std::size_t triangles, float edge) {
  Mesh mesh;
  Random random{7};
  for (std::size_t i = 0; i < triangles; ++i) {
    const glm::vec3 place = random_point(random, 1);
    const auto first = std::uint32_t(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(place + (random_point(random, 2 * edge) - glm::vec3(edge)));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Houses on a square grid of unit spacing.
Mesh city(std::size_t houses) {
  Mesh mesh;
  Random random{11};
  const auto side = std::size_t(std::ceil(std::sqrt(double(houses))));
  for (std::size_t i = 0; i < houses; ++i) {
    // The generator draws the last axis first; the evaluation order is part of the scene.
    const float a = random.unit(), b = random.unit();
    const float half_height = 0.5f + 2.5f * a * b;
    const float half_depth = 0.2f + 0.2f * random.unit(), half_width = 0.2f + 0.2f * random.unit();
    const std::size_t column = i % side, row = i / side;
    add_box(mesh, {float(column), half_height, float(row)},
            {{half_width, 0, 0}, {0, half_height, 0}, {0, 0, half_depth}});
  }
  return mesh;
}

Mesh walled_city(bool wall) {
  Mesh mesh = city(90000);
  if (wall) add_box(mesh, {150, 25, 312}, {{60, 0, 0}, {0, 25, 0}, {0, 0, 0.25f}});
  return mesh;
}

/// A few triangles, each covering most of the picture, one behind the other.
Mesh huge_triangles() {
  Mesh mesh;
  for (int k = 0; k < 200; ++k) {
    const float z = float(k) * -0.01f;
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-8, -5, z}, {8, -5, z}, {0, 9, z - 0.5f}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh make_mesh(std::string_view name) {
  if (name == "sphere100k") return sphere(100'000);
  if (name == "sphere1m") return sphere(1'000'000);
  if (name == "sphere4m") return sphere(4'000'000);
  if (name == "terrain1m") return terrain(1'000'000);
  if (name == "terrain4m") return terrain(4'000'000);
  if (name == "terrain16m") return terrain(16'000'000);
  if (name == "soup100k") return soup(100'000, 0.005f);
  if (name == "soup1m") return soup(1'000'000, 0.005f);
  if (name == "city" || name == "city-street") return city(10'000);
  if (name == "city-wall" || name == "city-no-wall") return walled_city(name == "city-wall");
  if (name == "boxes-in") return nested_boxes(500, BoxOrder::inner_first);
  if (name == "boxes-out") return nested_boxes(500, BoxOrder::outer_first);
  if (name == "boxes-random") return nested_boxes(500, BoxOrder::shuffled);
  if (name == "huge") return huge_triangles();
  if (name == "outside") return terrain(1'000'000);
  return sphere(69'451);  // a stand-in for the bunny
}

/// Position and direction of a camera, before near and far are known.
View aim(Camera camera, const glm::dvec3& centre) {
  View view;
  const auto look = [&](const glm::dvec3& eye, const glm::dvec3& target) {
    view.world_from_eye = look_at(eye, target, {0, 1, 0});
  };
  switch (camera) {
    case Camera::fit: look(centre + glm::dvec3(3, 2, 4), centre); break;
    case Camera::over_terrain: look({0.5, 0.25, 1.05}, {0.5, 0, 0.3}); break;
    case Camera::in_city: look({50, 4, 104}, {50, 0, 60}); break;
    case Camera::in_street: look({50.5, 0.5, 50.5}, {49, 0.4, 42}); break;
    case Camera::away: look({0.5, 0.25, 2}, {0.5, 0.25, 4}); break;
    case Camera::wall: look({150, 30, 330}, {150, 0, 220}); break;
    case Camera::close: look({0, 0, 4}, {0, 0, 0}); break;
  }
  return view;
}

void add_copies(Scene& scene) {
  Box bounds;
  for (const glm::vec3& position : scene.meshes.at(0).positions) bounds.include(position);
  const glm::dvec3 step = glm::dvec3(bounds.high - bounds.low) * (0.25 / (kCopies - 1));
  scene.instances = {{"0", 0, glm::dmat4(1.0)}};
  for (int copy = 1; copy < kCopies; ++copy) {
    Instance& instance = scene.instances.emplace_back(scene.instances[0]);
    instance.name = std::to_string(copy);
    instance.world_from_mesh[3] += glm::dvec4(step * double(copy), 0);
  }
}

}  // namespace

std::span<const SceneEntry> scene_entries() { return kScenes; }
std::span<const SceneEntry> translucent_entries() { return kTranslucent; }

const SceneEntry& find_scene(std::string_view name) {
  std::string known;
  for (const std::span<const SceneEntry> entries : {scene_entries(), translucent_entries()})
    for (const SceneEntry& entry : entries) {
      if (entry.name == name) return entry;
      known.append(" ").append(entry.name);
    }
  throw Error(ErrorCode::bad_argument, "scene '" + std::string(name) + "' is none of:" + known);
}

Scene make_scene(std::string_view name, const std::string& models) {
  const std::string_view mesh_name = name.substr(0, name.rfind("-fly"));
  const auto from_file = [&](const char* relative) {
    const std::filesystem::path path = std::filesystem::path(models) / relative;
    return std::filesystem::exists(path) ? std::optional(load(path.string())) : std::nullopt;
  };
  std::optional<Scene> scene;
  if (mesh_name == "bunny" || mesh_name == "bunnies") scene = from_file("organic/stanford-bunny.obj");
  if (mesh_name == "teapots") scene = from_file("reference/teapot/teapot.obj");
  if (mesh_name == "teapot" || (mesh_name == "teapots" && !scene)) scene = builtin("teapot");
  if (!scene) {
    scene.emplace();
    scene->meshes.push_back(make_mesh(mesh_name));
    scene->instances.push_back({std::string(mesh_name), 0, glm::dmat4(1.0)});
  }
  if (mesh_name == "bunnies" || mesh_name == "teapots") add_copies(*scene);
  scene->name = mesh_name;
  scene->up = Axis::y;
  return std::move(*scene);
}

Scene taken_apart(const Scene& scene) {
  Scene apart;
  const Mesh& all = scene.meshes[0];
  constexpr std::size_t kTriangles = 12;
  for (std::size_t t = 0; t + kTriangles <= all.triangles.size(); t += kTriangles) {
    Mesh& box = apart.meshes.emplace_back();
    for (std::size_t k = t; k < t + kTriangles; ++k) {
      glm::uvec3 corners;
      for (int c = 0; c < 3; ++c) {
        corners[c] = std::uint32_t(box.positions.size());
        box.positions.push_back(all.positions[all.triangles[k][c]]);
      }
      box.triangles.push_back(corners);
    }
    apart.instances.push_back({"", std::uint32_t(apart.meshes.size() - 1), glm::dmat4(1.0)});
  }
  return apart;
}

View make_view(const Box& bounds, Camera camera, int width, int height) {
  constexpr double kFov = 45 * std::numbers::pi / 180;
  const glm::dvec3 low(bounds.low), high(bounds.high), centre = (low + high) * 0.5;
  View view = aim(camera, centre);
  view.width = width;
  view.height = height;
  const double tan_y = std::tan(kFov / 2), tan_x = tan_y * width / height;
  double distance = 0, nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 corner(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
    const glm::dvec3 p = corner - centre;
    const double z = glm::dot(p, view.forward());
    distance = std::max(
        {distance, std::abs(glm::dot(p, view.right())) / tan_x - z, std::abs(glm::dot(p, view.up())) / tan_y - z});
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  if (camera == Camera::fit) view.world_from_eye[3] = glm::dvec4(centre - 1.05 * distance * view.forward(), 1);
  const double along = glm::dot(centre - view.eye(), view.forward()), margin = 0.01 * (farthest - nearest);
  const double far = std::max(along + farthest + margin, 1e-6);
  view.projection =
      make_projection(kFov, double(width) / height, {std::max(along + nearest - margin, 1e-3 * far), far});
  return view;
}

}  // namespace frontmost::bench
