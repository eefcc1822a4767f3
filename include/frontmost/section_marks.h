// SPDX-License-Identifier: Apache-2.0
// Marks of sections on drawing sheets: cutting planes, and the names of the views that they lead to (ISO 128-3).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontmost/dimensions.h"

namespace frontmost {

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

}  // namespace frontmost
