// SPDX-License-Identifier: Apache-2.0
// Creases told from the edges of a tessellation.
//
//           ____ ____            A mesh is folded at all of its edges: at some because the object has an edge
//          /    |    \           there, at most because a curved surface was cut into triangles. The angle of the
//     ____/     |     \____      fold alone does not tell the two apart: a cylinder of twelve sides is folded by 30
//                                degrees everywhere. What tells them apart is whether the surface goes on to
//       curved       creased     turn beyond the fold by as much as it does in it.
#pragma once

#include <vector>

#include "lines/creases/neighbours.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

// Folds: edges at which a surface turns, because it has a crease there or because it is curved and was cut into
// triangles.

/// The cosine of 15 degrees: folds of less are no creases, whatever is beside them. Half the edges of a scan are folds
/// of some degrees.
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

/// What the surface jumps by is the angle between the normals of both sides, less what it would turn by if each side
/// went on to curve as it does beyond its triangle: half of the next angle on each side. So a cylinder jumps by
/// nothing, however few sides it has, a chamfer or a cone's rim by all of its angle, and the edge between a plane and a
/// fillet by half. What is far in comparison with the other side's triangle counts little, and where a side turns back
/// the fold has to be deeper by as much: it is rough. Where each side turns one way alone, and by half as much at most,
/// the fold stands out, and may be fainter: a plane or a cylinder is even, not rough, whichever way it turns. `edge`
/// has two triangles. O(triangles at its corners).
[[nodiscard]] JudgedFold judge_fold(const Neighbours& near, const FeatureEdge& edge);

/// Leaves out of `edges` the creases that are none by the surfaces on both sides. As edges are found in pictures
/// (J. Canny. A Computational Approach to Edge Detection. 1986): a strong fold is a crease, and so are weak ones on
/// which it goes on; of a triangle with three creases the faintest is none; and what ends in the air after one or two
/// edges is none, unless it is long. Silhouettes take part, so that what is found hardly depends on the view;
/// boundaries and borders hold what ends at them. The other edges, and their order, stay. O(edges).
void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution);

}  // namespace frontmost::lines_detail
