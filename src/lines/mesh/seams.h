// SPDX-License-Identifier: Apache-2.0
// Seams: where triangles without area fill T-junctions.
#pragma once

#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// Leaves out the triangles whose corners lie on one line, exactly, and splits those beside them at the corners that
/// lie on their sides: a long side A-B, a filler A-M-B and two short sides A-M and M-B are then two edges of two
/// triangles each, as if the long one's triangle had been cut from M to its third corner. Pieces come where their
/// triangle was, and have its id. O(triangles) where there are no fillers, else O(triangles log fillers). A seam with
/// which there would be more than five times as many triangles stays open, without its fillers: sides that overlap
/// along one line can be made to give as many as the square of their number. `facing` is of the mesh, for any view.
/// \returns whether there were fillers; else the mesh is as it was.
[[nodiscard]] bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution);

}  // namespace frontmost::lines_detail
