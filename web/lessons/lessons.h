// SPDX-License-Identifier: Apache-2.0
// Data of the lessons' figures: answers of the library's own methods, at each step that a figure shows.
#pragma once

#include <frontmost/image.h>
#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <array>
#include <span>

#include "web/json.h"

namespace frontmost::web {

/// A depth buffer that fills. {"example": "table"}: the 8 x 8 integers of the classic example, cell by cell;
/// {"example": "picture"}: a scene, triangle by triangle; {"example": "coplanar"}: a board and a label in one plane,
/// with the board's polygon offset {"factor", "units"}.
PlainJson zbuffer_lesson(const PlainJson& question);
/// Hidden triangles by reason, and the effect of omitting one side of all triangles.
PlainJson culling_lesson(const PlainJson& question);
/// Depths along a segment, gaps of formats, and two fighting plates.
PlainJson projection_lesson(const PlainJson& question);
/// Polygons in painting order, the cost of finding the order, and the wrong pixels.
PlainJson painter_lesson(const PlainJson& question);
/// Newell's tests on each pair of triangles that boxes do not separate.
PlainJson newell_lesson(const PlainJson& question);
/// A BSP tree, and the painting order that it gives.
PlainJson bsp_lesson(const PlainJson& question);
/// A ray that walks a tree of boxes, step by step. {"example": "levels"}: the tree opened down to a level, and the work
/// that this saves.
PlainJson rays_lesson(const PlainJson& question);
/// The fragments of a pixel, and all pixels composited by depth and in the file's order.
PlainJson layers_lesson(const PlainJson& question);
/// Feature edges with the places where they become hidden. For one edge, the part that each triangle hides.
PlainJson lines_lesson(const PlainJson& question);
/// A triangle cut by the planes of the viewing volume, one after the other.
PlainJson clipping_lesson(const PlainJson& question);
/// A shadow map, and the pixels where exact rays disagree.
PlainJson shadows_lesson(const PlainJson& question);
/// Objects from the eye outwards, at most 300, the cells that they cover, and the objects proved hidden.
PlainJson occlusion_lesson(const PlainJson& question);
/// The time that a method takes here, and the size of its answer.
PlainJson methods_lesson(const PlainJson& question);

/// A scene of the lessons, with surfaces that borrow it.
struct LessonScene {
  explicit LessonScene(Scene&& taken) : scene(std::move(taken)), surfaces(scene) {}
  Scene scene;
  Surfaces surfaces;
};
/// Makes a camera of {"scene", "width", "height", "forward"} that shows the whole scene and the points "beside" it;
/// "angle" is in degrees. Directions assume that y is up, and are rotated for other scenes.
PlainJson frame_lesson(const PlainJson& question);

/// Opens the bytes of a file as the scene "own", which is kept beside the last of the others. {"name"}
PlainJson open_lesson(std::span<const std::byte> bytes, const PlainJson& question);
/// The scene {"scene"}; the last one is kept. {"most"} limits the number of triangles, foremost first.
const LessonScene& lesson_scene(const PlainJson& question);
/// The view of {"camera"}, or one of {"width", "height"} that shows the whole scene.
View lesson_view(const LessonScene& stage, const PlainJson& question);

/// Colours of triangles by number; transparent where nothing is visible.
std::vector<std::uint8_t> triangle_colors(const Visible& visible);

/// The lit picture of visible surfaces, without shadows and background.
Bitmap lesson_picture(const LessonScene& stage, const Visible& visible);

/// Coordinates of a world point relative to the eye: right, up, forwards.
glm::dvec3 from_eye(const View& view, const glm::dvec3& world);
/// The position of a world point in pixels. Precondition: it lies before the eye.
glm::dvec2 pixel_of_point(const View& view, const glm::dvec3& world);

using WorldLine = std::array<glm::dvec3, 2>;
std::array<WorldLine, 12> sides_of(const Box& box);
std::array<WorldLine, 3> sides_of(const std::array<glm::vec3, 3>& corners);
/// The edges of a viewing volume between near and far.
std::vector<WorldLine> sides_of_volume(const View& view);
/// World lines on the screen, as far as they lie beyond the near plane: [[x, y, x, y], ...] in pixels.
PlainJson lines_json(const View& view, std::span<const WorldLine> lines);

}  // namespace frontmost::web
