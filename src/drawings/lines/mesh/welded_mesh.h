// SPDX-License-Identifier: Apache-2.0
// All triangles of a scene over vertices that are shared wherever they coincide, with closed seams. A seam is a place
// where triangles without area fill T-junctions.
//
//          C                  C            A filler A-M-B has its corners on one line, and no area: it was put there to
//         / .                /|.           close the long side A-B against the two short ones. The filler is removed,
//        /   .              / | .          and the triangle A-B-C beside it is split at M. So every side has one
//       A--M--B      ->    A--M--B         neighbour again, and surfaces continue across it.
#pragma once

#include "frontmost/scene.h"

namespace frontmost::lines_detail {

/// Vertex positions in world space, stored as floats, which halves the memory traffic.
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

/// Leaves out triangles with a vertex that is not finite, and those with two vertices at one place. Vertices are
/// numbered in the order in which their places first occur. O(triangles).
[[nodiscard]] WeldedMesh weld(const Surfaces& surfaces, const Execution& execution);

/// Removes the triangles whose corners lie exactly on one line (fillers), and splits triangles beside them at the
/// corners on their sides. A long side A-B, a filler A-M-B and short sides A-M and M-B become two edges of two
/// triangles each. Pieces come where their triangle was, with its id. A seam that would make more than five times as
/// many triangles stays open, without its fillers: overlapping sides on one line could make as many as the square of
/// their number. `facing` is of the mesh, for any view. O(triangles) without fillers, else O(triangles log fillers).
/// \returns whether there were fillers; else the mesh is unchanged.
[[nodiscard]] bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution);

}  // namespace frontmost::lines_detail
