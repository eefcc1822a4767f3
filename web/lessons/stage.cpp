// SPDX-License-Identifier: Apache-2.0
// Scenes of the lessons.
#include <frontmost/files.h>
#include <frontmost/pictures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

Mesh block(const char* name, const glm::vec3& low, const glm::vec3& high) {
  constexpr std::array<std::array<std::uint32_t, 4>, 6> sides = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  Mesh mesh;
  mesh.name = name;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  for (const auto& s : sides) {
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

/// An extruded U: one body that hides parts of itself.
Scene concave_scene() {
  constexpr std::array<std::array<float, 2>, 8> outline = {
      {{-1.5f, -1}, {1.5f, -1}, {1.5f, 1}, {0.8f, 1}, {0.8f, -0.4f}, {-0.8f, -0.4f}, {-0.8f, 1}, {-1.5f, 1}}};
  constexpr std::array<std::array<std::uint32_t, 3>, 6> front = {
      {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}}};
  Scene scene;
  scene.name = "concave";
  Mesh mesh;
  mesh.name = "concave";
  for (const float z : {0.6f, -0.6f})
    for (const auto& [x, y] : outline) mesh.positions.push_back({x, y, z});
  for (const auto& t : front) {
    mesh.triangles.push_back({t[0], t[1], t[2]});
    mesh.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t next = (i + 1) % 8;
    mesh.triangles.push_back({i, i + 8, next + 8});
    mesh.triangles.push_back({i, next + 8, next});
  }
  add(scene, std::move(mesh));
  return scene;
}

/// One convex body.
Scene cube_scene() {
  Scene scene;
  scene.name = "cube";
  add(scene, block("cube", {-1, -1, -1}, {1, 1, 1}));
  return scene;
}

/// Blocks on a floor that throw shadows on each other.
Scene blocks_scene() {
  Scene scene;
  scene.name = "blocks";
  add(scene, block("floor", {-1.8f, -0.1f, -1.8f}, {1.8f, 0, 1.8f}));
  add(scene, block("tower", {-0.9f, 0, -0.6f}, {-0.2f, 1.7f, 0.1f}));
  add(scene, block("cube", {0.3f, 0, -1}, {1.1f, 0.8f, -0.2f}));
  add(scene, block("step", {-0.5f, 0, 0.7f}, {0.7f, 0.35f, 1.2f}));
  return scene;
}

/// Houses in streets, each an object.
Scene town_scene() {
  Scene scene;
  scene.name = "town";
  constexpr int rows = 8;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < rows; ++column) {
      const int number = row * rows + column;
      const auto x = float(column - rows / 2) + 0.2f, z = -float(row);
      const float height = 0.35f + 0.09f * float(number * 7 % 11);
      add(scene, block(("house " + std::to_string(number)).c_str(), {x, 0, z - 0.6f}, {x + 0.6f, height, z}));
    }
  return scene;
}

/// Rotates a direction that assumes y up to the scene's up axis.
glm::dvec3 turned_up(const glm::dvec3& d, Axis up) { return up == Axis::z ? glm::dvec3(d.x, -d.z, d.y) : d; }

/// The triangles of a scene that reach farthest towards the usual first viewpoint of figures, in their order.
Scene foremost_of(const LessonScene& stage, std::size_t most) {
  const Surfaces& surfaces = stage.surfaces;
  const glm::dvec3 towards = turned_up({0.6, 0.45, 0.8}, stage.scene.up);
  std::vector<std::pair<double, PrimitiveId>> reaches;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const std::array<glm::vec3, 3> corners = surfaces.corners(id);
    const double reach = glm::dot(towards, glm::dvec3(corners[0]) + glm::dvec3(corners[1]) + glm::dvec3(corners[2]));
    if (std::isfinite(reach)) reaches.emplace_back(-reach, id);
  }
  std::sort(reaches.begin(), reaches.end());
  reaches.resize(std::min(reaches.size(), most));
  std::sort(reaches.begin(), reaches.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  Scene part;
  part.name = stage.scene.name;
  part.up = stage.scene.up;
  part.materials = stage.scene.materials;
  part.textures = stage.scene.textures;
  Mesh mesh;
  for (const auto& [reach, id] : reaches) {
    const PrimitiveSource source = surfaces.source(id);
    const auto first = std::uint32_t(mesh.positions.size());
    for (const glm::vec3& corner : surfaces.corners(id)) mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.material_ids.push_back(stage.scene.meshes[source.mesh].material_of(source.triangle));
  }
  add(part, std::move(mesh));
  return part;
}

/// A scene, and the part of it that was requested last.
struct StagedScene {
  explicit StagedScene(Scene&& scene) : whole(std::move(scene)) {}
  LessonScene whole;
  std::optional<LessonScene> part;
  std::size_t most = 0;

  const LessonScene& at_most(std::size_t count) {
    if (whole.surfaces.primitive_count() <= count) return whole;
    if (!part || most != count) part.emplace(foremost_of(whole, count));
    most = count;
    return *part;
  }
};

std::unique_ptr<StagedScene>& own_scene() {
  static std::unique_ptr<StagedScene> own;
  return own;
}

}  // namespace

PlainJson open_lesson(std::span<const std::byte> bytes, const PlainJson& question) {
  own_scene() = std::make_unique<StagedScene>(load(bytes, question.at("name").get<std::string>()));
  return {{"triangles", own_scene()->whole.surfaces.primitive_count()}};
}

const LessonScene& lesson_scene(const PlainJson& question) {
  static std::string name;
  static std::unique_ptr<StagedScene> stage;
  const std::string wanted = question.value("scene", "cubes");
  const std::size_t most = question.value("most", std::size_t(no_index));
  if (wanted == "own" && own_scene()) return own_scene()->at_most(most);
  if (!stage || wanted != name) {
    stage = std::make_unique<StagedScene>(wanted == "concave"  ? concave_scene()
                                          : wanted == "cube"   ? cube_scene()
                                          : wanted == "blocks" ? blocks_scene()
                                          : wanted == "town"   ? town_scene()
                                                               : builtin(wanted));
    name = wanted;
  }
  return stage->at_most(most);
}

PlainJson frame_lesson(const PlainJson& question) {
  const LessonScene& stage = lesson_scene(question);
  Box box = stage.surfaces.bounds();
  for (const PlainJson& point : question.value("beside", PlainJson::array())) box.include(glm::vec3(vector_of(point)));
  FrameOptions options;
  const glm::dvec3 up = direction(stage.scene.up);
  options.forward = turned_up(vector_of(question.at("forward")), stage.scene.up);
  if (question.contains("angle")) options.min_fov = glm::radians(question["angle"].get<double>());
  const View view = frame(box, stage.scene.up, question.at("width"), question.at("height"), options);
  PlainJson camera = camera_json(view, box.centre());
  camera["world_up"] = to_json(up);
  return camera;
}

View lesson_view(const LessonScene& stage, const PlainJson& question) {
  if (question.contains("camera")) return view_of(question["camera"], stage.surfaces.bounds());
  return frame(stage.surfaces, question.value("width", 320), question.value("height", 240));
}

std::vector<std::uint8_t> triangle_colors(const Visible& visible) {
  constexpr std::array<glm::u8vec3, 8> colors = {{{230, 126, 60},
                                                  {74, 134, 201},
                                                  {92, 171, 112},
                                                  {196, 96, 146},
                                                  {226, 183, 74},
                                                  {110, 108, 190},
                                                  {84, 178, 180},
                                                  {170, 120, 84}}};
  std::vector<std::uint8_t> rgba(4 * visible.primitives.size());
  for (std::size_t i = 0; i < visible.primitives.size(); ++i) {
    const PrimitiveId id = visible.primitives[i];
    if (id == no_primitive) continue;
    // Each repetition of the palette is darker than the one before.
    const int shade = 256 - 28 * int(id / colors.size() % 4);
    for (int c = 0; c < 3; ++c)
      rgba[4 * i + std::size_t(c)] = std::uint8_t(colors[id % colors.size()][c] * shade / 256);
    rgba[4 * i + 3] = 255;
  }
  return rgba;
}

Bitmap lesson_picture(const LessonScene& stage, const Visible& visible) {
  ShadeOptions options;
  options.background.reset();
  options.light.shadows = Shadows::off;
  return shade_bitmap(stage.surfaces, visible, options);
}

glm::dvec3 from_eye(const View& view, const glm::dvec3& world) {
  const glm::dvec3 away = world - view.eye();
  return {glm::dot(away, view.right()), glm::dot(away, view.up()), glm::dot(away, view.forward())};
}

glm::dvec2 pixel_of_point(const View& view, const glm::dvec3& world) {
  const Projection& p = view.projection;
  const glm::dvec3 at = from_eye(view, world);
  const double scale = p.orthographic ? 1 : std::max(at.z, 1e-9);
  return {(at.x / scale - p.left) / (p.right - p.left) * view.width,
          (p.top - at.y / scale) / (p.top - p.bottom) * view.height};
}

std::array<WorldLine, 12> sides_of(const Box& box) {
  std::array<WorldLine, 12> lines;
  std::size_t count = 0;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if (i >> axis & 1) continue;
      const auto corner = [&](int bits) {
        return glm::dvec3(bits & 1 ? box.high.x : box.low.x, bits & 2 ? box.high.y : box.low.y,
                          bits & 4 ? box.high.z : box.low.z);
      };
      lines[count++] = {corner(i), corner(i | 1 << axis)};
    }
  return lines;
}

std::array<WorldLine, 3> sides_of(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  return {{{a, b}, {b, c}, {c, a}}};
}

std::vector<WorldLine> sides_of_volume(const View& view) {
  const Projection& p = view.projection;
  const auto corner = [&](int i, double distance) {
    const double scale = p.orthographic ? 1 : distance;
    return view.eye() + view.forward() * distance + view.right() * ((i == 1 || i == 2 ? p.right : p.left) * scale) +
           view.up() * ((i >= 2 ? p.top : p.bottom) * scale);
  };
  std::vector<WorldLine> lines;
  for (int i = 0; i < 4; ++i) {
    lines.push_back({corner(i, p.clip.near), corner((i + 1) % 4, p.clip.near)});
    lines.push_back({corner(i, p.clip.far), corner((i + 1) % 4, p.clip.far)});
    lines.push_back({corner(i, p.clip.near), corner(i, p.clip.far)});
  }
  return lines;
}

PlainJson lines_json(const View& view, std::span<const WorldLine> lines) {
  const double near = view.projection.clip.near;
  PlainJson json = PlainJson::array();
  for (WorldLine line : lines) {
    const double from = from_eye(view, line[0]).z - near, to = from_eye(view, line[1]).z - near;
    if (from < 0 && to < 0) continue;
    const glm::dvec3 border = line[0] + (line[1] - line[0]) * (from / (from - to));
    if (from < 0) line[0] = border;
    if (to < 0) line[1] = border;
    const glm::dvec2 a = pixel_of_point(view, line[0]), b = pixel_of_point(view, line[1]);
    json.push_back({a.x, a.y, b.x, b.y});
  }
  return json;
}

}  // namespace frontmost::web
