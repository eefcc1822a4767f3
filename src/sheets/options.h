// SPDX-License-Identifier: Apache-2.0
// What the options of a sheet mean together.
#pragma once

#include "frontmost/sheet.h"

namespace frontmost::detail {

/// How far centre lines reach beyond what they are drawn for, in millimetres.
inline constexpr double centre_overshoot = 3;

[[nodiscard]] inline bool has_named_views(const SheetOptions& options) {
  return !options.views.empty() || !options.sections.empty();
}
[[nodiscard]] inline bool wants_centre_lines(const SheetOptions& options) {
  return options.centre_lines.value_or(has_named_views(options) && options.style == DrawingStyle::technical);
}
/// Of the model's unit of length.
[[nodiscard]] double millimetres_per_unit(const SheetOptions& options, const Scene& scene);
/// The pens of the style, as wide as asked for.
[[nodiscard]] LinePens pens_of(const SheetOptions& options);
/// \throws Error bad_argument for what a drawing in this projection, of no named views, cannot have.
void validate_for_view(const SheetOptions& options, const Projection& projection);

}  // namespace frontmost::detail
