// SPDX-License-Identifier: Apache-2.0
// The tests from the cheapest to the dearest, each of which may decide:
//
//    is all of this piece behind the plane of the other?      it cannot cover the other
//    is all of the other before the plane of this one?        it cannot cover the other
//    does a side of either separate them on the screen?       they do not overlap
//    (two whole triangles) which is nearer in the overlap?    by vertices within, then by sides that cross
//
// The first two tests decide most pairs. The fourth test reuses the signs of the third, so no sign is computed twice.
// All signs are exact: a pair that is tested in two cells, or from both sides, gets one answer.
#include "painter/order/newell_tests.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

bool is_within(const std::array<std::array<int, 3>, 3>& turns, std::size_t corner) {
  return turns[0][corner] >= 0 && turns[1][corner] >= 0 && turns[2][corner] >= 0;
}

}  // namespace

NewellTests::NewellTests(const Pieces& pieces, std::uint32_t piece)
    : pieces_(pieces), piece_(piece), face_(pieces.face(piece)), plane_(face_.plane()) {}

std::array<Plane, 3> NewellTests::edges_of(const Face& face) const {
  return {pieces_.edge_plane(face, 0), pieces_.edge_plane(face, 1), pieces_.edge_plane(face, 2)};
}

bool NewellTests::covers(std::uint32_t other, PaintSteps& steps) {
  const Face& face = pieces_.face(other);
  const Plane other_plane = face.plane();
  bool is_flat = false;
  if (pieces_.keeps_off(piece_, other_plane, 1, is_flat) && !is_flat) {
    ++steps.behind;
    return false;
  }
  if (!is_flat && pieces_.keeps_off(other, plane_, -1, is_flat)) {
    ++steps.before;
    return false;
  }
  if (is_apart(other)) {
    ++steps.projections_apart;
    return false;
  }
  ++steps.compared;
  if (is_flat) return face_.id < face.id;
  if (pieces_.keeps_off(other, plane_, 1, is_flat) || pieces_.keeps_off(piece_, other_plane, -1, is_flat)) return true;
  if (!pieces_.is_whole(piece_) || !pieces_.is_whole(other)) return true;
  return is_over(face, other_plane);
}

/// Convex polygons are apart if and only if an edge of either separates them. For pieces that were cut, only the edges
/// of their triangles are tested.
bool NewellTests::is_apart(std::uint32_t other) {
  if (!edges_) edges_.emplace(edges_of(face_));
  if (is_outside(*edges_, other, other_turns_)) return true;
  return is_outside(edges_of(pieces_.face(other)), piece_, turns_);
}

bool NewellTests::is_outside(const std::array<Plane, 3>& edges, std::uint32_t piece, Turns& turns) const {
  const Face& face = pieces_.face(piece);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) turns[k][i] = edges[k].side(glm::dvec3(face.corners[i]));
    if (turns[k][0] <= 0 && turns[k][1] <= 0 && turns[k][2] <= 0) return true;
    bool is_flat = false;
    if (face.shape != no_index && pieces_.keeps_off(piece, edges[k], 1, is_flat)) return true;
  }
  return false;
}

/// In the overlap of two triangles on the screen, the nearer one changes only along a line. So the corners of the
/// overlap tell whether this triangle is nearer anywhere.
bool NewellTests::is_over(const Face& other, const Plane& other_plane) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_within(turns_, i) && other_plane.side(glm::dvec3(face_.corners[i])) > 0) return true;
    if (is_within(other_turns_, i) && plane_.side(glm::dvec3(other.corners[i])) < 0) return true;
  }
  return crosses_over(other);
}

/// Whether an edge of this triangle passes before an edge of the other.
bool NewellTests::crosses_over(const Face& other) const {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next_k = (k + 1) % 3, next_i = (i + 1) % 3;
      if (other_turns_[k][i] * other_turns_[k][next_i] >= 0 || turns_[i][k] * turns_[i][next_k] >= 0) continue;
      const glm::dvec3 from(face_.corners[k]), to(face_.corners[next_k]);
      const glm::dvec3 other_from(other.corners[i]), other_to(other.corners[next_i]);
      const int order = sign_of_determinant({to, from}, {other_from, from}, {other_to, from});
      if (order * other_turns_[k][i] < 0) return true;
    }
  return false;
}

}  // namespace frontmost::painter_detail
