// SPDX-License-Identifier: Apache-2.0
// The frame of a sheet by ISO 5457: border, zones, centring and trimming marks.
//
//      1   2   3   4          Zones are counted from the middle of each side, an even number on each. Their border is
//    +---+---+---+---+        outside of the frame, so that the drawing space stays whole. Pages as narrow as A4 have
//  A |               | A      letters and numbers on two sides only.
//    +               +
//  B |               | B
//    +---+---+---+---+
#include <algorithm>
#include <cmath>

#include "frontmost/sheets.h"
#include "sheets/frame/title_block.h"

namespace frontmost::detail {
namespace {

constexpr double filing_margin = 20, frame_margin = 10;  // millimetres of paper outside the frame
constexpr double strip = 5;                              // width of the zones' border, outside the frame
constexpr double zone = 50;                              // beginning at the centring marks
constexpr double mark_inside = 10;                       // of centring marks
constexpr double narrow_page = 210;                      // A4 has zones on two sides
constexpr double frame_width = 0.7, zone_width = 0.35, zone_text = 3.5;

/// A, B, ... without I and O, which look like digits; AA follows Z.
std::string zone_letter(int number) {
  constexpr std::string_view letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";
  const int count = int(letters.size());
  std::string name;
  for (int rest = number; rest >= 0; rest = rest / count - 1)
    name.insert(name.begin(), letters[std::size_t(rest % count)]);
  return name;
}

/// The lines between zones along one axis, in the frame from `low` to `high`, including both ends. The number of zones
/// is even and nearest to the page's side divided by 50 mm.
std::vector<double> zone_ends(double side, double low, double high) {
  const int half = std::max(1, int(std::lround(side / (2 * zone))));
  std::vector<double> ends = {low};
  for (int i = 1 - half; i < half; ++i)
    if (const double at = side / 2 + i * zone; at > low && at < high) ends.push_back(at);
  ends.push_back(high);
  return ends;
}

class FrameDrawing {
 public:
  explicit FrameDrawing(const glm::dvec2& page)
      : page_(page), space_(drawing_space(page)), is_narrow_(std::min(page.x, page.y) <= narrow_page) {}

  void draw(PageLayer& layer) const {
    PageGroup trimming{"trimming marks", {frame_width, {}}};
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)})
      trimming_mark(trimming, corner);
    PageGroup frame{"frame", {frame_width, {}}};
    frame.add(rectangle(space_.low, space_.high), true);
    centring_marks(frame);
    PageGroup zones{"zones", {zone_width, {}}};
    zones_border(zones);
    PageGroup names{"zones: text", text_pen(zone_text)};
    for (const int axis : {0, 1}) zones_along(axis, zones, names);
    for (PageGroup* const group : {&trimming, &zones, &names, &frame}) layer.groups.push_back(std::move(*group));
  }

 private:
  /// Two rectangles of 10 x 5 mm in an L shape, filled by rounds of the pen, because DXF has no fills.
  void trimming_mark(PageGroup& group, const glm::dvec2& corner) const {
    constexpr double length = 10, width = 5;
    const glm::dvec2 inwards = 1.0 - 2.0 * corner;
    // Successive passes of the pen are so close together that its round tip leaves no gaps at the corners.
    for (double in = frame_width / 2; in < width / 2; in += 0.6 * frame_width) {
      const double far = length - in, near = width - in;
      std::vector<glm::dvec2> points = {{in, in}, {far, in}, {far, near}, {near, near}, {near, far}, {in, far}};
      for (glm::dvec2& p : points) p = corner * page_ + inwards * p;
      group.add(points, true);
    }
  }

  /// Marks from the zones' border into the drawing, but not into the title block.
  void centring_marks(PageGroup& group) const {
    const glm::dvec2 middle = page_ * 0.5;
    for (const int axis : {0, 1})
      for (const bool at_end : {false, true}) {
        const double outwards = at_end ? 1 : -1, edge = at_end ? space_.high[axis] : space_.low[axis];
        const int across = 1 - axis;
        const bool meets_block = at_end && middle[across] >= space_.block[across];
        glm::dvec2 from(0), to(0);
        from[across] = to[across] = middle[across];
        from[axis] = edge + outwards * strip;
        to[axis] = meets_block ? edge : edge - outwards * mark_inside;
        group.add(std::vector<glm::dvec2>{from, to}, false);
      }
  }

  /// The border around the frame, or above it and on its right.
  void zones_border(PageGroup& group) const {
    const glm::dvec2 low = space_.low - strip, high = space_.high + strip;
    if (is_narrow_)
      group.add(std::vector<glm::dvec2>{{space_.low.x, low.y}, {high.x, low.y}, {high.x, space_.high.y}}, false);
    else
      group.add(rectangle(low, high), true);
  }

  /// Numbers from left to right, and letters downwards.
  void zones_along(int axis, PageGroup& lines, PageGroup& names) const {
    const int across = 1 - axis;
    const std::vector<double> ends = zone_ends(page_[axis], space_.low[axis], space_.high[axis]);
    for (const bool at_end : {false, true}) {
      if (is_narrow_ && at_end != (axis == 1)) continue;  // only above, and on the right
      const double edge = at_end ? space_.high[across] : space_.low[across],
                   outer = at_end ? edge + strip : edge - strip;
      const auto point = [&](double along, double beside) {
        return axis == 0 ? glm::dvec2(along, beside) : glm::dvec2(beside, along);
      };
      for (const double at : ends)  // centring marks are lines already
        if (at != page_[axis] / 2) lines.add(std::vector<glm::dvec2>{point(at, edge), point(at, outer)}, false);
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        add_text(names, axis == 0 ? std::to_string(i + 1) : zone_letter(int(i)),
                 point((ends[i] + ends[i + 1]) / 2, (edge + outer) / 2),
                 {zone_text, 0, TextAlign::centre, TextLine::middle});
    }
  }

  const glm::dvec2 page_;
  const DrawingSpace space_;
  const bool is_narrow_;
};

}  // namespace

DrawingSpace drawing_space(const glm::dvec2& page) {
  // Written so that NaN fails.
  if (!(page.x >= least_framed_page.x && page.y >= least_framed_page.y))
    throw Error(ErrorCode::bad_argument, "page", "a frame and its title block need 210 x 100 mm or more");
  DrawingSpace space{{filing_margin, frame_margin}, page - frame_margin};
  space.block = space.high - title_block_size;
  return space;
}

PageLayer draw_frame(const glm::dvec2& page, const TitleBlock& block) {
  PageLayer layer{"8 frame"};
  FrameDrawing(page).draw(layer);
  draw_title_block(block, drawing_space(page).block, layer);
  return layer;
}

}  // namespace frontmost::detail
