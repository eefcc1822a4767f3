// SPDX-License-Identifier: Apache-2.0
// Creases told from the edges of a tessellation.
//
//           ____ ____            A mesh is folded at all of its edges: at some because the object has an edge
//          /    |    \           there, at most because a curved surface was cut into triangles. The angle of the
//     ____/     |     \____      fold alone does not tell the two apart: a cylinder of twelve sides is folded by 30
//                                degrees everywhere. A crease turns by more than the surface beyond it goes on to
//       curved       creased     turn; a fold of a curved surface does not.
#pragma once

#include <vector>

#include "lines/creases/neighbours.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

// A fold is an edge at which a surface turns, because it has a crease there or because it is curved and was cut into
// triangles.

/// The cosine of 15 degrees. Smaller folds are never creases: half the edges of a scan are folds of some degrees.
inline constexpr double kLeastFoldCosine = 0.96592582628906831;

enum class FoldGrade : std::uint8_t {
  smooth,
  weak,    ///< a crease where one goes on along it
  strong,  ///< a crease
  sharp,   ///< a crease whatever is beside it
};

struct JudgedFold {
  FoldGrade grade = FoldGrade::smooth;
  double jump = 0;  ///< radians: by how much the surfaces on both sides differ at the edge
};

/// The jump is the angle between the normals of both sides, less half of the next angle on each side, by which that
/// side goes on to curve. So a cylinder jumps by 0, however few sides it has; a chamfer or a cone's rim by its whole
/// angle; the edge between a plane and a fillet by half. Two rules adjust the grade. Where a side turns back, it is
/// rough, and the fold has to be deeper by as much. Where each side turns one way only, and by at most half as much,
/// fainter folds count. Triangles that are far in comparison with the width of the other side's triangle count little.
/// `edge` has two triangles. O(triangles at its corners).
[[nodiscard]] JudgedFold judge_fold(const Neighbours& near, const FeatureEdge& edge);

/// Removes from `edges` the creases that the surfaces on both sides do not confirm, by hysteresis as in J. Canny. A
/// Computational Approach to Edge Detection. 1986. A strong fold is a crease, and so are weak folds that continue one.
/// The faintest crease of a triangle with three goes. A line of one or two edges that ends in the air goes, unless it
/// is long. Silhouettes take part, so that the result hardly depends on the view; boundaries and borders hold what ends
/// at them. The other edges and their order stay. O(edges).
void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution);

}  // namespace frontmost::lines_detail
