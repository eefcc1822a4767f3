// SPDX-License-Identifier: Apache-2.0
// What is known of faces as tables: a row for each face that is seen, or one for every face of the model, coloured.
//
//   not seen   grey
//   seen       dark blue where next to nothing of the face is seen, over green to yellow where all of it is
#pragma once

#include <frontmost/files.h>
#include <frontmost/report.h>
#include <frontmost/scene.h>

#include <vector>

namespace frontmost::cli {

/// A row for each that is listed: primitive, object, triangle, and what is known of it.
[[nodiscard]] Table table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces);
[[nodiscard]] Table table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces);

/// A row for every face of the model: object, triangle, what is known (0 of those that are not seen), and red, green
/// and blue by the share of it that is seen.
[[nodiscard]] Table colored_table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces);
[[nodiscard]] Table colored_table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces);

/// Of each of these faces its object and its number there.
[[nodiscard]] Table origin_table_of(const std::vector<PrimitiveId>& ids, const Surfaces& surfaces);

}  // namespace frontmost::cli
