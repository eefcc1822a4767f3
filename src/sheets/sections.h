// SPDX-License-Identifier: Apache-2.0
// Sections of sheets: what they cut, where they stand, how they are hatched, and the marks that lead to them.
#pragma once

#include "frontmost/section_marks.h"
#include "sheets/planned_view.h"

namespace frontmost::detail {

inline constexpr std::string_view section_letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";  // none that looks like a number

/// Surfaces that keep their scene.
[[nodiscard]] std::shared_ptr<const Surfaces> surfaces_of(std::shared_ptr<const Scene> scene,
                                                          const Execution& execution);

/// What a plane leaves of a scene.
struct CutScene {
  std::shared_ptr<const Surfaces> surfaces;
  std::shared_ptr<const Section> section;
  CuttingPlane plane;
};
/// Cuts `surfaces` for a view of them. \throws Error bad_argument where the plane misses them.
[[nodiscard]] CutScene cut_for(const SectionView& wanted, const Surfaces& surfaces, const View& camera,
                               const Execution& execution);

/// The cells of sections: where the view would stand that looks the same way, or in a column of their own.
void place_sections(std::vector<ViewCell>& cells, const std::vector<PlannedView>& views);
/// Lets cells keep room for cutting lines and names, and says so in the views.
void keep_section_room(std::vector<ViewCell>& cells, std::vector<PlannedView>& views);

/// Hatches the cut faces of views whose places on the sheet are settled.
void hatch_sections(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution);
/// Cutting lines and names of all sections; nothing without any.
[[nodiscard]] SectionMarks section_marks_of(const std::vector<PlannedView>& views, const Pen& thin);

}  // namespace frontmost::detail
