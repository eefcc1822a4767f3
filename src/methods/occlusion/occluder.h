// SPDX-License-Identifier: Apache-2.0
// Finds the cells that an object covers. An end is a side that no two of the object's triangles with the same turn
// share. The number of triangles over a point is the winding number of the ends about it, which changes only across an
// end:
//
//     +---+---+---+---+---+     reached    the cell's middle lies in a triangle
//     |   | /´|\  |   |   |     ends       a side without a neighbour comes near the cell
//     |  /|   |  \|   |   |
//     | / |   |   \   |   |     Cells that are reached and have no ends are covered everywhere.
//     +---+---+---+---+---+
//
// Ends are widened by a margin, which is greater than the distance that snapping moves them. Leaving out triangles only
// makes more ends.
#pragma once

#include <span>
#include <vector>

#include "occlusion/cells.h"
#include "occlusion/occluder_mesh.h"
#include "view/clip.h"

namespace frontmost::occlusion_detail {

/// An object's triangles, and its pose in the world.
struct HidingObject {
  const OccluderMesh& mesh;
  const OccluderPart& part;
  const glm::dmat4& world_from_mesh;
};

/// How a triangle turns on the screen; `none` if it has no area there, or its turn is not certain.
enum class ScreenTurn : std::int8_t { none, clockwise, counter_clockwise };

/// Returns the turn of all triangles of the fan from the first corner, or `none` if they differ, because rounding may
/// fold a sliver over.
[[nodiscard]] ScreenTurn turn_of(const ClippedPolygon& polygon);

struct TriangleOnScreen {
  ScreenTurn turn = ScreenTurn::none;
  bool is_cut = false;  ///< true if it could not be snapped whole
  float farthest = 0;   ///< greatest planar distance of its corners, rounded up
};

struct ClippedTriangle {
  std::uint32_t triangle;  ///< number within the part
  ClippedPolygon polygon;
};

/// A vertex in 1/256 pixel from the middle of the image. The distance is planar, rounded up, and NaN if the vertex
/// cannot be snapped.
struct VertexOnScreen {
  std::int32_t x, y;
  float distance;
};

/// An object on the screen, by vertex and by triangle of its part.
struct OccluderOnScreen {
  std::vector<glm::vec3> world;
  std::vector<VertexOnScreen> vertices;
  std::vector<TriangleOnScreen> triangles;
  std::vector<ClippedTriangle> cut;
  /// True if all visible parts of the object lie in cells that a pass over the whole object reaches or has ends in. For
  /// this, no triangle may be missing or cut, and triangles without area on the screen must lie along the sides of
  /// triangles with area.
  bool is_told_by_cells = true;
  /// Snapping changes the turn of no triangle.
  bool has_certain_turns = true;
};

void put_on_screen(const CellGrid& grid, const HidingObject& occluder, OccluderOnScreen& out);

/// Returns an upper bound of the rounding of a vertex's planar distance.
[[nodiscard]] float distance_rounding(const ScreenTransform& screen, const glm::vec3& world);

/// The triangles of an object that count in a pass.
struct ChosenTriangles {
  std::span<const std::uint32_t> whole;  ///< triangles that are not cut
  std::span<const ClippedTriangle> cut;  ///< triangles that are cut
  std::span<const std::uint16_t> marks;  ///< by triangle: equals `mark` if and only if the triangle counts
  std::uint16_t mark = 0;
  const ScreenTransform* screen = nullptr;  ///< the transform that cut the cut triangles
};

/// The part of an object that is added to the cover.
struct CoverPass {
  CellRect rect;                                    ///< bounds of the object
  float distance;                                   ///< no triangle that counts is farther
  bool clockwise = true, counter_clockwise = true;  ///< whether these turns count
  const ChosenTriangles* chosen = nullptr;          ///< nullptr if all triangles count
};

/// A pass over an object.
struct OccluderPass {
  const CellGrid& grid;
  const HidingObject& occluder;
  const OccluderOnScreen& on_screen;
  const CoverPass& pass;
};

/// Memory for the cells of triangles that turn the same way on the screen; empty between uses.
struct CoverScratch {
  CellBits reached, ends;
};

/// Finds the cells that the counting triangles cover, and sets them in `solid`. `solid` has tile_rows rows for each
/// tile that the pass' rectangle reaches into, row of tiles by row of tiles, all zero at first. \returns whether the
/// triangles come near a cell that is not covered yet.
bool find_solid(const OccluderPass& over, CoverScratch& scratch, const CellCover& cover, std::uint32_t* solid, Isa isa);

/// Covers the cells of `solid`, which are no farther than pass.distance.
void add_to_cover(const CoverPass& pass, const std::uint32_t* solid, CellCover& cover, Isa isa);

}  // namespace frontmost::occlusion_detail
