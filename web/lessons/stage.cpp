// SPDX-License-Identifier: Apache-2.0
// Scenes of the lessons.
#include <frontmost/io.h>

#include <array>
#include <memory>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// A U of solid blocks: one body that hides parts of itself.
Scene concave_scene() {
  Scene scene;
  scene.name = "concave";
  const std::array<std::array<glm::vec3, 2>, 3> blocks = {{{glm::vec3(-1.5f, -1, -0.6f), glm::vec3(1.5f, -0.4f, 0.6f)},
                                                           {glm::vec3(-1.5f, -0.4f, -0.6f), glm::vec3(-0.8f, 1, 0.6f)},
                                                           {glm::vec3(0.8f, -0.4f, -0.6f), glm::vec3(1.5f, 1, 0.6f)}}};
  Mesh mesh;
  mesh.name = "concave";
  for (const auto& [low, high] : blocks) {
    const auto first = std::uint32_t(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
      mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> sides = {
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& s : sides) {
      mesh.triangles.push_back(glm::uvec3(s[0], s[1], s[2]) + first);
      mesh.triangles.push_back(glm::uvec3(s[0], s[2], s[3]) + first);
    }
  }
  add(scene, std::move(mesh));
  return scene;
}

/// One convex body.
Scene cube_scene() {
  Scene scene = concave_scene();
  scene.name = "cube";
  Mesh& mesh = scene.meshes.front();
  mesh.triangles.resize(12);
  for (int i = 0; i < 8; ++i) mesh.positions[std::size_t(i)] = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
  return scene;
}

}  // namespace

const LessonScene& lesson_scene(const Json& question) {
  static std::string name;
  static std::unique_ptr<LessonScene> stage;
  const std::string wanted = question.value("scene", "cubes");
  if (!stage || wanted != name) {
    stage = std::make_unique<LessonScene>(wanted == "concave" ? concave_scene()
                                          : wanted == "cube"  ? cube_scene()
                                                              : builtin(wanted));
    name = wanted;
  }
  return *stage;
}

Json frame_lesson(const Json& question) {
  const LessonScene& stage = lesson_scene(question);
  FrameOptions options;
  options.forward = vector_of(question.at("forward"));
  const View view = frame(stage.surfaces, question.at("width"), question.at("height"), options);
  return camera_json(view, stage.surfaces.bounds().centre());
}

View lesson_view(const LessonScene& stage, const Json& question) {
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
    // A turn of the palette is a shade darker than the one before.
    const int shade = 256 - 28 * int(id / colors.size() % 4);
    for (int c = 0; c < 3; ++c)
      rgba[4 * i + std::size_t(c)] = std::uint8_t(colors[id % colors.size()][c] * shade / 256);
    rgba[4 * i + 3] = 255;
  }
  return rgba;
}

}  // namespace frontmost::web
