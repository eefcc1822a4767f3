// SPDX-License-Identifier: Apache-2.0
// Frames and title blocks of drawing sheets, by ISO 5457 and ISO 7200.
//
//    +--------------------------+     The frame encloses a drawing space. The title block is in its lower right corner;
//    | +----------------------+ |     views stand above the block or beside it.
//    | |  drawing space       | |
//    | |             +--------+ |
//    | |             | block  | |
//    +-+-------------+--------+-+
#pragma once

#include <vector>

#include "frontmost/sheets.h"

namespace frontmost::detail {

/// The space for views: the rectangle from `low` to `high` without the title block in its lower right corner.
struct DrawingSpace {
  glm::dvec2 low{0}, high{0};
  glm::dvec2 block{
      0};  ///< the title block's upper left corner, in millimetres of the page; its lower right one is high
};

/// The smallest page with room for a frame, in millimetres.
inline constexpr glm::dvec2 least_framed_page{210, 100};

/// The drawing space by ISO 5457: margins are 20 mm on the left and 10 mm elsewhere; the title block is 180 x 36 mm.
/// \throws Error bad_argument for a page smaller than least_framed_page.
[[nodiscard]] DrawingSpace drawing_space(const glm::dvec2& page);

/// The layer "8 frame" for a page of that size: frame (0.7 mm), zones of 50 mm from the middle with letters and
/// numbers, centring marks, trimming marks, title block and its text. Zones are only above and on the right if a side
/// is at most 210 mm. Everything is pen lines, also for plotters and DXF. \throws Error as drawing_space() does.
[[nodiscard]] PageLayer draw_frame(const glm::dvec2& page, const TitleBlock& block);

inline constexpr glm::dvec2 title_block_size{180, 36};

/// Appends the groups of a title block whose upper left corner is `corner`.
void draw_title_block(const TitleBlock& block, const glm::dvec2& corner, PageLayer& layer);

[[nodiscard]] inline std::vector<glm::dvec2> rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

}  // namespace frontmost::detail
