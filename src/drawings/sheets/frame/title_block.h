// SPDX-License-Identifier: Apache-2.0
// Frames and title blocks of drawing sheets, after ISO 5457 and ISO 7200.
//
//    +--------------------------+     The frame leaves a drawing space, from corner to corner. The title block stands
//    | +----------------------+ |     in its lower right corner; views stand above it or beside it.
//    | |  drawing space       | |
//    | |             +--------+ |
//    | |             | block  | |
//    +-+-------------+--------+-+
#pragma once

#include <vector>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// What the frame leaves for views: from corner to corner, but for the title block in its lower right corner.
struct DrawingSpace {
  glm::dvec2 low{0}, high{0};
  glm::dvec2 block{
      0};  ///< the title block's upper left corner, in millimetres of the page; its lower right one is high
};

/// The least page that has room for a frame, in millimetres.
inline constexpr glm::dvec2 least_framed_page{210, 100};

/// ISO 5457: 20 mm are left free at the left and 10 mm at the other sides; the title block is 180 x 36 mm.
/// \throws Error bad_argument for a page that is smaller than least_framed_page.
[[nodiscard]] DrawingSpace drawing_space(const glm::dvec2& page);

/// The layer "8 frame" for a page of that size: frame (0.7 mm), zones of 50 mm from the middle with letters and
/// figures, above and on the right alone where a side is up to 210 mm, centring marks, trimming marks, title block and
/// its text. Everything is lines of pens, for plotters and DXF as well. \throws Error as drawing_space() does.
[[nodiscard]] PageLayer draw_frame(const glm::dvec2& page, const TitleBlock& block);

inline constexpr glm::dvec2 title_block_size{180, 36};

/// Appends the groups of a title block whose upper left corner is `corner`.
void draw_title_block(const TitleBlock& block, const glm::dvec2& corner, PageLayer& layer);

[[nodiscard]] inline std::vector<glm::dvec2> rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

}  // namespace frontmost::detail
