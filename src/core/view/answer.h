// SPDX-License-Identifier: Apache-2.0
// Whether a Visible that comes from outside can be read: the door for all that take one; and planes to be filled.
//
// Callers can put any Visible together with any surfaces: planes of another size than their view, planes that were
// moved away, ids of surfaces that have gone or were edited since. Behind this door every id is looked up without a
// check, so each public function that takes a Visible passes here first, and what it says begins with that function's
// name.
#pragma once

#include <span>

#include "frontmost/view.h"

namespace frontmost {

/// \throws Error bad_argument, beginning with `who`, unless both planes have one value for every sample of the view.
/// One that was moved from keeps its view, and has none.
void check_planes(const Visible& visible, const char* who);

/// The same unless every id is less than `primitive_count` or no_primitive: those of other surfaces, or of the same
/// before the scene was edited, would be looked up beyond all arrays. O(ids), as fast as memory.
void check_ids(std::span<const PrimitiveId> ids, std::uint32_t primitive_count, const char* who,
               const Execution& execution);

/// Both.
void check_answer(const Visible& visible, std::uint32_t primitive_count, const char* who, const Execution& execution);
void check_answer(const VisiblePixels& pixels, std::uint32_t primitive_count, const char* who,
                  const Execution& execution);

/// Pixels of a view with nothing in them: every plane has its size, and is undefined. \throws Error as validate(view)
/// does.
[[nodiscard]] VisiblePixels undefined_pixels(const View& view);

}  // namespace frontmost
