// SPDX-License-Identifier: Apache-2.0
// Faces that meet at an edge, turned so that both have the same side outside. IGES does not state which side that is.
#pragma once

#include <TopoDS_Shape.hxx>

namespace frontmost::import {

/// Returns the faces of a shape, which has triangles, each as it is or reversed. Of neighbours, both or neither show
/// their front. A closed shell shows its outside, or its inside if it bounds a cavity of another; of an open shell,
/// most triangles stay as they are. Takes time in proportion to the triangles, and to those around each shell inside
/// another.
[[nodiscard]] TopoDS_Shape wound_alike(const TopoDS_Shape& shape);

}  // namespace frontmost::import
