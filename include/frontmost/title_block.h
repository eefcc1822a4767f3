// SPDX-License-Identifier: Apache-2.0
// Frames and title blocks of drawing sheets, after ISO 5457 and ISO 7200.
#pragma once

#include <string>

#include "frontmost/page.h"

namespace frontmost {

/// Where views stand about the front one; its symbol (ISO 5456-2) stands in the title block.
enum class ProjectionMethod : std::uint8_t { none, first_angle, third_angle };

/// What the fields of a title block say, in UTF-8; empty ones stay empty. Text too long for its field at 1.8 mm is
/// written smaller.
struct TitleBlock {
  std::string title{};   ///< in up to two lines
  std::string number{};  ///< of the drawing
  std::string author{}, date{}, owner{};
  std::string scale{};  ///< as "1:2"
  std::string unit{};   ///< of what is written on the drawing, as "mm"
  std::string paper{};  ///< as "A3"
  ProjectionMethod projection = ProjectionMethod::none;
  int sheet = 1, sheets = 1;
};

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

}  // namespace frontmost
