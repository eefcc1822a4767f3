// SPDX-License-Identifier: Apache-2.0
// What an object covers.
//
// Take triangles that turn the same way on the screen, and of their sides those that no two of them share: the ends.
// How often the triangles cover a place is the winding number of the ends about it, which changes only where an end
// passes. So a cell that no end comes near is covered everywhere as often as at any one of its places:
//
//     +---+---+---+---+---+
//     |   | /´|\  |   |   |     reached    the cell's middle lies in a triangle
//     |   |/  | \ |   |   |     ends       a side that is no triangle's other side comes near the cell
//     |  /|   |  \|   |   |
//     | / |   |   \   |   |     covered is what is reached and has no ends. Sides within the surface are no ends,
//     +---+---+---+---+---+     however thin the triangles beside them are.
//
// Vertices are snapped, which moves what they span by less than the margin that ends are widened by; sides that are no
// ends move with both of their triangles. Triangles may be left out as one likes, which only makes more ends.
#pragma once

#include <span>
#include <vector>

#include "occlusion/boxes.h"
#include "occlusion/occluder_mesh.h"
#include "view/clip.h"

namespace frontmost::occlusion_detail {

/// An object's triangles where they are.
struct HidingObject {
  const OccluderMesh& mesh;
  const OccluderPart& part;
  const glm::dmat4& world_from_mesh;
};

/// How a triangle turns on the screen. Of none: without area there, or nothing of it is certain.
enum class ScreenTurn : std::int8_t { none, clockwise, counter_clockwise };

/// That of all pieces of the fan from its first corner, or none: rounding may fold a sliver over.
[[nodiscard]] ScreenTurn turn_of(const ClippedPolygon& polygon);

struct TriangleOnScreen {
  ScreenTurn turn = ScreenTurn::none;
  bool is_cut = false;  ///< could not be snapped whole
  float farthest = 0;   ///< planar distance of its corners, rounded up
};

struct ClippedTriangle {
  std::uint32_t triangle;  ///< of the part
  ClippedPolygon polygon;
};

/// A vertex in 1/256 pixel from the middle of the image; distance is planar, rounded up, NaN where it cannot be
/// snapped.
struct VertexOnScreen {
  std::int32_t x, y;
  float distance;
};

/// An object on the screen. By vertex and by triangle of its part.
struct OccluderOnScreen {
  std::vector<glm::vec3> world;
  std::vector<VertexOnScreen> vertices;
  std::vector<TriangleOnScreen> triangles;
  std::vector<ClippedTriangle> cut;
  /// Whatever is seen of the object lies where a pass over all of it reaches or has ends: nothing was cut, and what has
  /// no area there lies along the sides of what has.
  bool is_told_by_cells = true;
  /// Snapping does not change how any of the triangles turns.
  bool has_certain_turns = true;
};

void put_on_screen(const CellGrid& grid, const HidingObject& occluder, OccluderOnScreen& out);

/// More than what rounding changes the planar distance of a vertex by.
[[nodiscard]] float distance_rounding(const ScreenTransform& screen, const glm::vec3& world);

/// Which triangles of an object count.
struct ChosenTriangles {
  std::span<const std::uint32_t> whole;  ///< those that are not cut
  std::span<const ClippedTriangle> cut;  ///< the others
  std::span<const std::uint16_t> marks;  ///< by triangle: those that count have `mark`, and no other has
  std::uint16_t mark = 0;
  const ScreenTransform* screen = nullptr;  ///< by which they are cut
};

/// What of an object is added to the cover.
struct CoverPass {
  CellRect rect;                                    ///< that the object reaches at most
  float distance;                                   ///< nothing that counts is farther
  bool clockwise = true, counter_clockwise = true;  ///< which count
  const ChosenTriangles* chosen = nullptr;          ///< nullptr: all of them
};

/// A pass over an object.
struct OccluderPass {
  const CellGrid& grid;
  const HidingObject& occluder;
  const OccluderOnScreen& on_screen;
  const CoverPass& pass;
};

/// Cells of one side of an object; nothing, between sides.
struct CoverScratch {
  CellBits reached, ends;
};

/// Finds the cells that the triangles cover that count: sets them in `solid`, which has tile_rows rows for each tile
/// that the pass' rectangle reaches into, row of tiles by row of tiles, all zero.
/// \returns whether the triangles come near a cell that is not covered yet.
bool find_solid(const OccluderPass& over, CoverScratch& scratch, const CellCover& cover, std::uint32_t* solid, Isa isa);

/// Covers these cells, no farther away than pass.distance.
void add_to_cover(const CoverPass& pass, const std::uint32_t* solid, CellCover& cover, Isa isa);

}  // namespace frontmost::occlusion_detail
