// SPDX-License-Identifier: Apache-2.0
// Curved surfaces as triangles, as fine as a view needs them: how the methods for triangles draw spheres and patches.
//
//         ____
//     .-~'    `~-.       the curved surface
//   /--------------\     a side of a triangle between two of its points
//          |
//          at most so many pixels, as the eye sees them: near parts are cut finely, distant ones coarsely
#pragma once

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// True when a mesh of the scene that is placed is curved.
[[nodiscard]] bool has_curved(const Scene& scene);

/// The scene with its curved meshes cut into triangles anew, so fine that in `view` no point of a triangle is farther
/// than `pixels` from the point of the curved surface that it stands for; so every outline is where it should be to
/// that many pixels. The bound is proven from second derivatives, and mostly two to four times too large; snapping of
/// corners to 1/256 pixel comes on top of it. What lies before the near plane does not count, and is cut coarsely.
/// (D. Filip, R. Magedson, R. Markot. Surface algorithms using bounds on derivatives. 1986.)
///
/// Every patch is a grid of its own fineness, a power of two each way. Patches of a mesh that share a whole edge, its
/// four control points to the bit in either order, are given the same points along it: nothing leaks between them.
/// Corners have the normals and texture coordinates of the surface. A sphere is a globe of rings.
///
/// Instances stay as they are, but for the number of their mesh: those that need another fineness have their own. The
/// meshes stay curved, and Mesh::face_ids says which curved primitive a triangle comes from; other meshes stay as they
/// are. O(size of the scene + triangles made).
/// \throws Error bad_argument unless pixels > 0; limit_exceeded beyond 2^26 triangles made, naming instance and mesh;
/// and as validate() does of scene and view.
[[nodiscard]] Scene tessellate(const Scene& scene, const View& view, double pixels);

}  // namespace frontmost
