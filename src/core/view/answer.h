// SPDX-License-Identifier: Apache-2.0
// Checks whether a Visible that comes from outside can be read, and makes planes to be filled.
//
// Callers can combine any Visible with any surfaces: planes of another size than their view, planes that were moved
// away, ids of surfaces that are gone or were edited since. After these checks every id is looked up without a check.
// So each public function that takes a Visible calls them first, and their errors begin with that function's name.
#pragma once

#include <span>

#include "frontmost/view.h"

namespace frontmost {

/// \throws Error bad_argument, beginning with `who`, unless both planes have one value for every sample of the view. A
/// Visible that was moved from keeps its view, and has no planes.
void check_planes(const Visible& visible, const char* who);

/// \throws Error bad_argument, beginning with `who`, unless every id is less than `primitive_count` or no_primitive.
/// Ids of other surfaces, or of the same surfaces before an edit, would be read beyond all arrays. O(ids).
void check_ids(std::span<const PrimitiveId> ids, std::uint32_t primitive_count, const char* who,
               const Execution& execution);

/// check_planes() and check_ids().
void check_answer(const Visible& visible, std::uint32_t primitive_count, const char* who, const Execution& execution);
void check_answer(const VisiblePixels& pixels, std::uint32_t primitive_count, const char* who,
                  const Execution& execution);

/// Pixels of a view with planes of its size and undefined contents. \throws Error as validate(view) does.
[[nodiscard]] VisiblePixels undefined_pixels(const View& view);

}  // namespace frontmost
