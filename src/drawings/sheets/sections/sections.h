// SPDX-License-Identifier: Apache-2.0
// Sections of sheets: what they cut, where they stand, how they are hatched, and the marks that lead to them: cutting
// planes, and the names of the views (ISO 128-3).
//
//    views of a sheet         +------+   A|   |A   cutting lines in the first view that sees the plane from its edge
//                             |      |    |---|
//                             +------+
//                               A-A                the section, under the name of its line
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sheets/page_marks.h"
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
/// A plane that is seen from its edge, on the page.
struct CuttingLine {
  glm::dvec2 from{0}, to{0};  ///< where what it cuts begins and ends
  glm::dvec2 looking{0};      ///< which way its section looks, across the line; of unit length
  std::string letter;         ///< "A"
};

/// The name of a view.
struct ViewName {
  glm::dvec2 at{0};  ///< the middle of its lower edge
  std::string text;  ///< "A-A"
};

struct SectionMarkOptions {
  Pen thin{0.25, {}, {6, 1, 0.1, 1}};  ///< of lines; their ends are twice as wide
  double text_height = 5;              ///< millimetres, as TextStyle's
};

/// Millimetres that a cutting line takes beyond its ends; on the side from where its section looks it takes
/// `section_arrow_room` beside them.
inline constexpr double cutting_line_room = 12, section_arrow_room = 15;

struct SectionMarks {
  PageLayer layer{"9 sections"};  ///< groups of lines, of ends with arrows, and of letters; none has a name
  std::vector<PageBox> boxes;     ///< what arrows and letters cover
};

/// Cutting lines in long dashes and dots, with thick ends 3 to 9 mm beyond what they cut, an arrow at each and its
/// letter behind it; and the names of views. All are strokes of pens, for plotters as well.
[[nodiscard]] SectionMarks draw_section_marks(std::span<const CuttingLine> lines, std::span<const ViewName> names,
                                              const SectionMarkOptions& options = {});

/// Cutting lines and names of all sections; nothing without any.
[[nodiscard]] SectionMarks section_marks_of(const std::vector<PlannedView>& views, const Pen& thin);

}  // namespace frontmost::detail
