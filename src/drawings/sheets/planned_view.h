// SPDX-License-Identifier: Apache-2.0
// The views of a sheet, from their cameras to their places on the page, and their sections (ISO 128-3).
//
//    views of a sheet         +------+   A|   |A   cutting lines in the first view that sees the plane edge-on
//                             |      |    |---|
//                             +------+
//                               A-A                the section, under the name of its line
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontmost/lines.h"
#include "sheets/paper.h"

namespace frontmost::detail {

struct PlannedView : DrawnView {
  std::optional<NamedView> direction;    ///< none if the caller gave the view
  CuttingPlane plane;                    ///< cutting plane of a section
  std::string letter;                    ///< letter of a section: "A"
  double millimetres_per_pixel = 1;      ///< at scale 1:1; meaningless by itself in perspective
  glm::dvec2 anchor{0};                  ///< pixel at the anchor of the view's cell
  std::shared_ptr<const Rounds> rounds;  ///< circles of the surfaces; null if not needed
  /// Millimetres of paper that marks of sections occupy on the left of the view and below it.
  glm::dvec2 taken{0};
};

/// Surfaces that own a reference to their scene.
[[nodiscard]] std::shared_ptr<const Surfaces> surfaces_of(std::shared_ptr<const Scene> scene,
                                                          const Execution& execution);

/// An object that sections leave whole if their planes run along its axis.
struct UncutObject {
  std::uint32_t instance;
  std::optional<glm::dvec3> axis;  ///< none: whatever the plane, as for a ball
};

/// The objects that SheetOptions::uncut names, and shafts: objects without bores that lie in their thickest cylinder
/// and are at least twice as long as thick. O(triangles log triangles).
[[nodiscard]] std::vector<UncutObject> uncut_objects(const Surfaces& surfaces, std::span<const std::string> words,
                                                     const Execution& execution);

/// Cuts the surfaces of a view, but for `uncut` objects, unless these alone are cut: sets its section and plane, and
/// its surfaces to those behind the plane. \throws Error bad_argument if the plane misses them.
void cut_surfaces(PlannedView& view, const SectionView& wanted, std::span<const UncutObject> uncut, const View& camera,
                  const Execution& execution);

/// Leaves a section in the cell of its direction if no other view has that cell; otherwise gives the section a column
/// of its own.
void place_sections(std::vector<ViewCell>& cells, const std::vector<PlannedView>& views);
/// Reserves room in the cells for cutting lines and names, and records it in PlannedView::taken.
void keep_section_room(std::vector<ViewCell>& cells, std::vector<PlannedView>& views);

/// Hatches the cut faces of views whose places on the sheet are final.
void hatch_sections(std::vector<PlannedView>& views, const SheetOptions& options, const Execution& execution);

/// The line of an edge-on cutting plane on the page.
struct CuttingLine {
  glm::dvec2 from{0}, to{0};  ///< ends of the part that the plane cuts
  glm::dvec2 looking{0};      ///< the section's view direction, across the line; unit length
  std::string letter;         ///< "A"
};

/// The name of a view.
struct ViewName {
  glm::dvec2 at{0};  ///< the middle of the text's lower edge
  std::string text;  ///< "A-A"
};

struct SectionMarkOptions {
  Pen thin{0.25, {}, {6, 1, 0.1, 1}};  ///< pen of the lines; their ends are twice as wide
  double text_height = 5;              ///< millimetres, as in TextStyle
  Lettering lettering = Lettering::strokes;
};

/// Millimetres that a cutting line takes beyond its ends, and beside them on the side from which the section is viewed.
inline constexpr double cutting_line_room = 12, section_arrow_room = 15;

struct SectionMarks {
  PageLayer layer{"9 sections"};  ///< unnamed groups of lines, of ends with arrows, and of letters
  std::vector<PageBox> boxes;     ///< boxes of arrows and letters
};

/// Draws cutting lines with thick ends 3 to 9 mm beyond the cut part, and the names of views.
[[nodiscard]] SectionMarks draw_section_marks(std::span<const CuttingLine> lines, std::span<const ViewName> names,
                                              const SectionMarkOptions& options = {});

/// The cutting lines and names of all sections; empty if there are none.
[[nodiscard]] SectionMarks section_marks_of(const std::vector<PlannedView>& views, const Pen& thin,
                                            Lettering lettering);

}  // namespace frontmost::detail
