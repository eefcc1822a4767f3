// SPDX-License-Identifier: Apache-2.0
// The numbers behind the figures of the lessons: each is what the library's own methods answer, at every step that a
// figure shows.
#pragma once

#include <frontmost/image.h>
#include <frontmost/surfaces.h>
#include <frontmost/visible.h>

#include <array>
#include <span>

#include "web/json.h"

namespace frontmost::web {

/// A depth buffer that fills: {"example": "table"} the 8 x 8 integers of the classic example, cell by cell; {"example":
/// "picture"} a scene, triangle by triangle.
Json zbuffer_lesson(const Json& question);
/// What is hidden for which reason, and what leaving out a side of every triangle changes.
Json culling_lesson(const Json& question);
/// Depths along a segment, gaps of formats, two plates that fight.
Json projection_lesson(const Json& question);
/// Polygons in an order of painting, what it took to find it, and the pixels that it gets wrong.
Json painter_lesson(const Json& question);
/// A ray that walks a tree of boxes, step by step; {"example": "levels"} the tree opened down to a level, and what that
/// saves.
Json rays_lesson(const Json& question);
/// The fragments of a pixel, and all pixels composited in true order and in that of the file.
Json layers_lesson(const Json& question);
/// Feature edges, where they go out of sight, and of one of them what each triangle hides.
Json lines_lesson(const Json& question);
/// How long a method takes here, and how much its answer holds.
Json methods_lesson(const Json& question);

/// A scene of the lessons, with surfaces that borrow it.
struct LessonScene {
  explicit LessonScene(Scene&& taken) : scene(std::move(taken)), surfaces(scene) {}
  Scene scene;
  Surfaces surfaces;
};
/// {"scene", "width", "height", "forward"} -> a camera that shows all of it, and the points "beside" it; "angle" in
/// degrees.
Json frame_lesson(const Json& question);

/// {"scene"}: the last one asked for is kept.
const LessonScene& lesson_scene(const Json& question);
/// {"camera"}, or one that shows all of it in {"width", "height"}.
View lesson_view(const LessonScene& stage, const Json& question);

/// Colours of triangles, each with a number of its own; transparent where nothing is seen.
std::vector<std::uint8_t> triangle_colors(const Visible& visible);

/// The lit picture of what is visible, without shadows and background.
Bitmap lesson_picture(const LessonScene& stage, const Visible& visible);

/// How far a point of the world is to the right of the eye, above it, and before it.
glm::dvec3 from_eye(const View& view, const glm::dvec3& world);
/// Where a point of the world is, in pixels. Precondition: it lies before the eye.
glm::dvec2 on_screen(const View& view, const glm::dvec3& world);

using WorldLine = std::array<glm::dvec3, 2>;
std::array<WorldLine, 12> sides_of(const Box& box);
std::array<WorldLine, 3> sides_of(const std::array<glm::vec3, 3>& corners);
/// Lines of the world on the screen, as far as they lie beyond the near plane: [[x, y, x, y], ...] in pixels.
Json lines_json(const View& view, std::span<const WorldLine> lines);

}  // namespace frontmost::web
