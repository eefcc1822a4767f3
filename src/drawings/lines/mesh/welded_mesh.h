// SPDX-License-Identifier: Apache-2.0
// All triangles of a scene over vertices that are shared wherever they lie at one place, and seams closed in it: where
// triangles without area fill T-junctions.
//
//          C                  C            A filler A-M-B has its corners on one line, and no area: it was put there to
//         / .                /|.           hold the long side A-B against the two short ones. It goes, and the triangle
//        /   .              / | .          A-B-C beside it is split at M, so that every side has one neighbour again
//       A--M--B      ->    A--M--B         and surfaces go on across it.
#pragma once

#include "frontmost/scene.h"

namespace frontmost::lines_detail {

/// Where vertices are, in world space: kept as the floats that they are, half as much to fetch from afar.
class Positions {
 public:
  Positions() = default;
  explicit Positions(Buffer<glm::vec3> places) : places_(std::move(places)) {}
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] glm::dvec3 operator[](std::size_t vertex) const { return glm::dvec3(places_[vertex]); }
  [[nodiscard]] const Buffer<glm::vec3>& places() const { return places_; }

 private:
  Buffer<glm::vec3> places_;
};

struct WeldedMesh {
  Positions positions;
  /// Three different vertices each, counter-clockwise seen from the front.
  Buffer<glm::uvec3> triangles;
  Buffer<PrimitiveId> ids;  ///< of the triangles
};

/// Leaves out triangles with a corner that is not finite, and those with two corners at one place. O(triangles).
/// Vertices are numbered in the order in which their places come.
[[nodiscard]] WeldedMesh weld(const Surfaces& surfaces, const Execution& execution);

/// Leaves out the triangles whose corners lie on one line, exactly, and splits those beside them at the corners that
/// lie on their sides: a long side A-B, a filler A-M-B and two short sides A-M and M-B are then two edges of two
/// triangles each, as if the long one's triangle had been cut from M to its third corner. Pieces come where their
/// triangle was, and have its id. O(triangles) where there are no fillers, else O(triangles log fillers). A seam with
/// which there would be more than five times as many triangles stays open, without its fillers: sides that overlap
/// along one line can be made to give as many as the square of their number. `facing` is of the mesh, for any view.
/// \returns whether there were fillers; else the mesh is as it was.
[[nodiscard]] bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution);

}  // namespace frontmost::lines_detail
