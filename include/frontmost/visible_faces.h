// SPDX-License-Identifier: Apache-2.0
// Visible faces: every triangle of which any part is seen, however small, and how much of it.
//
//      .___________.
//      |      /   /|       0  2 of its 8 square pixels are seen, the rest lies behind 2
//      |  0 / 1 / :|       1  hidden: it is not in the list
//      |__/___/_2_:|       2  all of its 6 square pixels are seen
//
// Nothing is sampled: what is seen of a triangle is a polygon, and its area is that of the polygon. So the areas of all
// triangles together are the area inside the outlines of what is seen.
#pragma once

#include <span>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"

namespace frontmost {

/// What is seen of one triangle.
struct VisibleFace {
  PrimitiveId id = no_primitive;
  double pixels = 0;       ///< its area in the picture, in square pixels; more than 0
  double area = 0;         ///< its area on the triangle, in scene units squared
  double solid_angle = 0;  ///< in steradians, from the eye; 0 in parallel projection, whose eye is infinitely far away
};

struct VisibleFaces {
  View view;
  std::vector<VisibleFace> faces;  ///< by id, ascending; what is not seen is not there
};

/// Every triangle of which a part is seen within the picture between near and far, with the area of that part.
///
/// Corners are where doubles put them, not on the grid of 1/256 pixel on which samples are covered: a triangle far
/// smaller than a pixel is found. No place counts twice: of triangles that lie in one plane, exactly, the lower id is
/// seen where they overlap; those that pass through each other are parted along their intersection. Cuts that would
/// leave less than 2^-30 pixel beside them are not made, so that what is narrower than that is not told apart from its
/// neighbour. Triangles with holes (alpha mode MASK) and translucent ones count as whole and hide what is behind them.
/// What View::culling leaves out is not there. View::samples does not count.
///
/// The picture is divided into cells, where something ends in them into smaller ones. (J. Warnock. A Hidden Surface
/// Algorithm for Computer Generated Halftone Pictures. 1969.) In a cell in which no surface ends and the nearest one
/// lies before all others, what is seen is known without cutting anything; in the smallest the triangles are cut by
/// each other. Near-linear in meshes and in stacks of parallel sheets; where n triangles pass through each other in one
/// place and none of them hides the others whole, time goes with n squared there. About 150 bytes a triangle, 350 where
/// they share no vertices. The same for any number of threads and every instruction set. \throws Error as
/// validate(view) does, and limit_exceeded for a mesh of more than 2^29 triangles, or more than about 2^31 steps,
/// fifteen times as many as the most crowded of 237 models takes.
[[nodiscard]] VisibleFaces visible_faces(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// A triangle that is seen in one of several views.
struct SeenFace {
  PrimitiveId id = no_primitive;
  std::uint32_t view_count = 0;  ///< in how many views a part of it is seen
  std::uint32_t best_view = 0;   ///< the number of the view that shows the largest share; the first of several such
  double largest_share = 0;      ///< of its own area, in scene units, that one view shows: more than 0, at most 1
  double largest_pixels = 0;     ///< the most square pixels of it that any view shows
};

/// Which triangles are seen in any of `views`, by id, ascending. The cost of visible_faces() for each view; what does
/// not depend on the view is found once. \throws as above.
[[nodiscard]] std::vector<SeenFace> faces_ever_seen(const Surfaces& surfaces, std::span<const View> views,
                                                    const Execution& execution = {});

/// A scene of some of another's triangles alone, such as those that are ever seen: objects of which none is kept are
/// gone, every other one has a mesh of its own. Vertices that no triangle needs are left out; order, names, places,
/// materials and textures stay, and Mesh::face_ids tells which polygon of the first scene's mesh each triangle came
/// from. Curved primitives are not kept. O(size of the scene). \throws Error bad_argument for ids that do not ascend,
/// or are none of the scene's.
[[nodiscard]] Scene keep_faces(const Scene& scene, std::span<const PrimitiveId> ids);

}  // namespace frontmost
