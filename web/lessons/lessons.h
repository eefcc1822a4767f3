// SPDX-License-Identifier: Apache-2.0
// The numbers behind the figures of the lessons: each is what the library's own methods answer, at every step that a
// figure shows.
#pragma once

#include <frontmost/image.h>
#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <array>
#include <span>

#include "web/json.h"

namespace frontmost::web {

/// A depth buffer that fills: {"example": "table"} the 8 x 8 integers of the classic example, cell by cell; {"example":
/// "picture"} a scene, triangle by triangle.
PlainJson zbuffer_lesson(const PlainJson& question);
/// What is hidden for which reason, and what leaving out a side of every triangle changes.
PlainJson culling_lesson(const PlainJson& question);
/// Depths along a segment, gaps of formats, two plates that fight.
PlainJson projection_lesson(const PlainJson& question);
/// Polygons in an order of painting, what it took to find it, and the pixels that it gets wrong.
PlainJson painter_lesson(const PlainJson& question);
/// Newell's tests on every pair of triangles whose boxes do not decide.
PlainJson newell_lesson(const PlainJson& question);
/// A binary tree of planes, and the order of painting that it gives.
PlainJson bsp_lesson(const PlainJson& question);
/// A ray that walks a tree of boxes, step by step; {"example": "levels"} the tree opened down to a level, and what that
/// saves.
PlainJson rays_lesson(const PlainJson& question);
/// The fragments of a pixel, and all pixels composited in true order and in that of the file.
PlainJson layers_lesson(const PlainJson& question);
/// Feature edges, where they go out of sight, and of one of them what each triangle hides.
PlainJson lines_lesson(const PlainJson& question);
/// A triangle cut by the planes of the viewing volume, one after the other.
PlainJson clipping_lesson(const PlainJson& question);
/// A shadow map, and where exact rays say otherwise.
PlainJson shadows_lesson(const PlainJson& question);
/// Objects from the eye outwards, at most 300 of them, the cells that they cover, and what is proved hidden.
PlainJson occlusion_lesson(const PlainJson& question);
/// How long a method takes here, and how much its answer holds.
PlainJson methods_lesson(const PlainJson& question);

/// A scene of the lessons, with surfaces that borrow it.
struct LessonScene {
  explicit LessonScene(Scene&& taken) : scene(std::move(taken)), surfaces(scene) {}
  Scene scene;
  Surfaces surfaces;
};
/// {"scene", "width", "height", "forward"} -> a camera that shows all of it, and the points "beside" it; "angle" in
/// degrees. Directions are told for scenes whose y is up, and turned for others.
PlainJson frame_lesson(const PlainJson& question);

/// {"name"}: the bytes of a file become the scene "own", which is kept beside the last of the others.
PlainJson open_lesson(std::span<const std::byte> bytes, const PlainJson& question);
/// {"scene"}: the last one asked for is kept. {"most"}: no more triangles of it than these, the foremost.
const LessonScene& lesson_scene(const PlainJson& question);
/// {"camera"}, or one that shows all of it in {"width", "height"}.
View lesson_view(const LessonScene& stage, const PlainJson& question);

/// Colours of triangles, each with a number of its own; transparent where nothing is seen.
std::vector<std::uint8_t> triangle_colors(const Visible& visible);

/// The lit picture of what is visible, without shadows and background.
Bitmap lesson_picture(const LessonScene& stage, const Visible& visible);

/// How far a point of the world is to the right of the eye, above it, and before it.
glm::dvec3 from_eye(const View& view, const glm::dvec3& world);
/// Where a point of the world is, in pixels. Precondition: it lies before the eye.
glm::dvec2 pixel_of_point(const View& view, const glm::dvec3& world);

using WorldLine = std::array<glm::dvec3, 2>;
std::array<WorldLine, 12> sides_of(const Box& box);
std::array<WorldLine, 3> sides_of(const std::array<glm::vec3, 3>& corners);
/// The edges of a viewing volume between near and far.
std::vector<WorldLine> sides_of_volume(const View& view);
/// Lines of the world on the screen, as far as they lie beyond the near plane: [[x, y, x, y], ...] in pixels.
PlainJson lines_json(const View& view, std::span<const WorldLine> lines);

}  // namespace frontmost::web
