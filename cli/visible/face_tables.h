// SPDX-License-Identifier: Apache-2.0
// Tables of faces: a row for each visible face, or a coloured row for each face of the model.
//
//   not seen   grey
//   seen       dark blue for hardly visible faces, over green, to yellow for wholly visible ones
#pragma once

#include <frontmost/files.h>
#include <frontmost/report.h>
#include <frontmost/scene.h>

#include <vector>

namespace frontmost::cli {

/// Returns a row for each listed face: primitive, object, triangle, and its measurements.
[[nodiscard]] Table table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces);
[[nodiscard]] Table table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces);

/// Returns a row for each face of the model: object, triangle, measurements (0 for unseen faces), and red, green and
/// blue by the visible share.
[[nodiscard]] Table colored_table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces);
[[nodiscard]] Table colored_table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces);

/// Returns the object of each of these faces, and its number in that object.
[[nodiscard]] Table origin_table_of(const std::vector<PrimitiveId>& ids, const Surfaces& surfaces);

}  // namespace frontmost::cli
