// SPDX-License-Identifier: Apache-2.0
// The frame of a sheet by ISO 5457 (border, zones, centring and trimming marks), and its title block by ISO 7200.
//
//      1   2   3   4        Zones are counted from the middle of each side, an even number on each. Pages as narrow as
//    +---+---+---+---+      A4 have letters and numbers on two sides only.
//  A |               | A
//    +               +      Letters have the heights of ISO 3098. A text too wide for its field is split into two lines
//  B |               | B    before its letters get smaller. Nothing is cut off.
//    +---+---+---+---+
#include <algorithm>
#include <cmath>
#include <map>

#include "sheets/paper.h"

namespace frontmost::detail {
namespace {

constexpr glm::dvec2 title_block_size{180, 36};
constexpr double outer_width = 0.7, inner_width = 0.35;
constexpr double label_height = 1.8;
constexpr double indent = 1.2;                             // millimetres, for all text in a field
constexpr double heights[] = {5, 3.5, 2.5, label_height};  // letter heights of ISO 3098

/// A field's name, its rectangle in the block, and the tallest letters that suit it.
struct Field {
  const char* label;
  glm::dvec2 low, high;
  double tallest;
  int lines;
};

struct FittedText {
  double height;
  std::vector<std::string> lines;
};

/// The text in two lines, split at the blank that makes the longer line shortest; in one line if it has no blank.
std::vector<std::string> halves(const std::string& text) {
  std::vector<std::string> best = {text};
  double least = text_width(text);
  for (std::size_t at = text.find(' '); at != std::string::npos; at = text.find(' ', at + 1)) {
    const std::string first = text.substr(0, at), second = text.substr(at + 1);
    if (first.empty() || second.empty()) continue;
    const double longer = std::max(text_width(first), text_width(second));
    if (longer >= least) continue;
    least = longer;
    best = {first, second};
  }
  return best;
}

/// The text in the tallest letters that fit the field; two lines are preferred to smaller letters.
FittedText fitted(const std::string& text, const Field& field) {
  const double room = field.high.x - field.low.x - 3 * indent;  // two of the indents are before the text
  const double rows = field.high.y - field.low.y - label_height - 2 * indent;
  const std::vector<std::string> parted = field.lines > 1 ? halves(text) : std::vector<std::string>{text};
  const auto widest = [](const std::vector<std::string>& lines) {
    double most = 0;
    for (const std::string& line : lines) most = std::max(most, text_width(line, 1));
    return most;
  };
  for (const double height : heights) {
    if (height > field.tallest) continue;
    if (text_width(text, height) <= room) return {height, {text}};
    const bool has_rows = height * (1 + 1.6 * double(parted.size() - 1)) <= rows;
    if (has_rows && widest(parted) * height <= room) return {height, parted};
  }
  return {std::min(label_height, room / widest(parted)), parted};
}

class BlockDrawing {
 public:
  BlockDrawing(const glm::dvec2& corner, Lettering lettering) : corner_(corner), lettering_(lettering) {}

  void add(const Field& field, const std::string& text) {
    add_text(labels_, field.label, corner_ + field.low + indent, {label_height, 0, TextAlign::left, TextLine::top},
             lettering_);
    outline(field);
    if (text.empty()) return;
    const FittedText fit = fitted(text, field);
    PageGroup& group =
        texts_.try_emplace(fit.height, PageGroup{"title block: text", text_pen(fit.height)}).first->second;
    // The text is centred below the label, with room for descenders.
    const double step = 1.6 * fit.height, taken = step * double(fit.lines.size() - 1) + 1.3 * fit.height;
    const double top = field.low.y + indent + label_height, free = field.high.y - top;
    glm::dvec2 at = corner_ + glm::dvec2(field.low.x + 2 * indent, top + (free - taken) / 2 + fit.height);
    for (const std::string& line : fit.lines) {
      add_text(group, line, at, {fit.height}, lettering_);
      at.y += step;
    }
  }

  /// Adds the symbol of a projection method: a truncated cone, seen from the side and from its narrow end, which is on
  /// the left. In first-angle projection the view from the left is on the right; in third-angle projection, on the
  /// left.
  void add_symbol(const Field& field, ProjectionMethod method) {
    add(field, "");
    if (method == ProjectionMethod::none) return;
    constexpr double wide = 7, narrow = 3.5, length = 7, apart = 4, beyond = 1.2;
    const double total = length + apart + wide;
    const double left = (field.low.x + field.high.x - total) / 2;
    const double middle = (field.low.y + label_height + indent + field.high.y) / 2;
    const bool first = method == ProjectionMethod::first_angle;
    const double cone = first ? left : left + wide + apart, rings = (first ? left + length + apart : left) + wide / 2;
    const auto at = [&](double x, double y) { return corner_ + glm::dvec2(x, middle + y); };
    symbol_.add(std::vector<glm::dvec2>{at(cone, -narrow / 2), at(cone + length, -wide / 2),
                                        at(cone + length, wide / 2), at(cone, narrow / 2)},
                true);
    symbol_.bulges.resize(symbol_.points.size());
    for (const double diameter : {narrow, wide}) {
      symbol_.add(std::vector<glm::dvec2>{at(rings - diameter / 2, 0), at(rings + diameter / 2, 0)}, true);
      symbol_.bulges.resize(symbol_.points.size(), 1);
    }
    const double reach = wide / 2 + beyond;
    axes_.add(std::vector<glm::dvec2>{at(cone - beyond, 0), at(cone + length + beyond, 0)}, false);
    axes_.add(std::vector<glm::dvec2>{at(rings - reach, 0), at(rings + reach, 0)}, false);
    axes_.add(std::vector<glm::dvec2>{at(rings, -reach), at(rings, reach)}, false);
  }

  void finish(PageLayer& layer) {
    PageGroup border{"title block", {outer_width, {}}};
    // The right and the lower side of the block are sides of the frame.
    border.add(std::vector<glm::dvec2>{corner_ + glm::dvec2(0, title_block_size.y), corner_,
                                       corner_ + glm::dvec2(title_block_size.x, 0)},
               false);
    layer.groups.push_back(std::move(inner_));
    layer.groups.push_back(std::move(border));
    layer.groups.push_back(std::move(labels_));
    for (auto& [height, group] : texts_) layer.groups.push_back(std::move(group));
    if (symbol_.paths.empty()) return;
    layer.groups.push_back(std::move(symbol_));
    layer.groups.push_back(std::move(axes_));
  }

 private:
  /// Adds the upper and left side of a field, if they are not the block's own; neighbours add the other sides.
  void outline(const Field& field) {
    if (field.low.y > 0)
      inner_.add(std::vector<glm::dvec2>{corner_ + field.low, corner_ + glm::dvec2(field.high.x, field.low.y)}, false);
    if (field.low.x > 0)
      inner_.add(std::vector<glm::dvec2>{corner_ + field.low, corner_ + glm::dvec2(field.low.x, field.high.y)}, false);
  }

  const glm::dvec2 corner_;
  const Lettering lettering_;
  PageGroup inner_{"title block: fields", {inner_width, {}}};
  PageGroup labels_{"title block: labels", text_pen(label_height)};
  PageGroup symbol_{"title block: projection", {inner_width, {}}};
  PageGroup axes_{"title block: axes", {0.18, {}, {3, 0.5, 0.2, 0.5}}};
  std::map<double, PageGroup> texts_;  ///< by text height, since each height has its pen
};

std::vector<glm::dvec2> rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

constexpr double filing_margin = 20, frame_margin = 10;  // millimetres of paper outside the frame
constexpr double strip = 5;                              // width of the zones' border, outside the frame
constexpr double zone = 50;                              // length of a zone; zones begin at the centring marks
constexpr double mark_inside = 10;                       // length of centring marks inside the frame
constexpr double narrow_page = 210;                      // a page this narrow, such as A4, has zones on two sides only
constexpr double frame_width = 0.7, zone_width = 0.35, zone_text = 3.5;

/// A, B, ...; AA follows Z.
std::string zone_letter(int number) {
  constexpr int count = int(clear_letters.size());
  std::string name;
  for (; number >= 0; number = number / count - 1)
    name.insert(name.begin(), clear_letters[std::size_t(number % count)]);
  return name;
}

/// The lines between zones along one axis, in the frame from `low` to `high`, including both ends. The even number of
/// zones is nearest to the page's side divided by 50 mm.
std::vector<double> zone_ends(double side, double low, double high) {
  const int half = std::max(1, int(std::lround(side / (2 * zone))));
  std::vector<double> ends = {low};
  for (int i = 1 - half; i < half; ++i)
    if (const double at = side / 2 + i * zone; at > low && at < high) ends.push_back(at);
  ends.push_back(high);
  return ends;
}

struct FrameDrawing {
  void draw(PageLayer& layer) const {
    PageGroup trimming{"trimming marks", {frame_width, {}}};
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)})
      trimming_mark(trimming, corner);
    PageGroup frame{"frame", {frame_width, {}}};
    frame.add(rectangle(space.low, space.high), true);
    centring_marks(frame);
    PageGroup zones{"zones", {zone_width, {}}};
    // The border of the zones is around the frame, or only above it and on its right.
    const glm::dvec2 low = space.low - strip, high = space.high + strip;
    if (is_narrow)
      zones.add(std::vector<glm::dvec2>{{space.low.x, low.y}, {high.x, low.y}, {high.x, space.high.y}}, false);
    else
      zones.add(rectangle(low, high), true);
    PageGroup names{"zones: text", text_pen(zone_text)};
    for (const int axis : {0, 1}) zones_along(axis, zones, names);
    for (PageGroup* const group : {&trimming, &zones, &names, &frame}) layer.groups.push_back(std::move(*group));
  }

  /// Adds a trimming mark: two rectangles of 10 x 5 mm in an L shape. The pen fills them in rounds, because DXF has no
  /// fills.
  void trimming_mark(PageGroup& group, const glm::dvec2& corner) const {
    constexpr double length = 10, width = 5;
    const glm::dvec2 inwards = 1.0 - 2.0 * corner;
    // Successive passes of the pen are so close together that its round tip leaves no gaps at the corners.
    for (double in = frame_width / 2; in < width / 2; in += 0.6 * frame_width) {
      const double far = length - in, near = width - in;
      std::vector<glm::dvec2> points = {{in, in}, {far, in}, {far, near}, {near, near}, {near, far}, {in, far}};
      for (glm::dvec2& p : points) p = corner * page + inwards * p;
      group.add(points, true);
    }
  }

  /// Adds marks that lead from the zones' border into the drawing, but not into the title block.
  void centring_marks(PageGroup& group) const {
    const glm::dvec2 middle = page * 0.5;
    for (const int axis : {0, 1})
      for (const bool at_end : {false, true}) {
        const double outwards = at_end ? 1 : -1, edge = at_end ? space.high[axis] : space.low[axis];
        const int across = 1 - axis;
        const bool meets_block = at_end && middle[across] >= space.block[across];
        glm::dvec2 from(0), to(0);
        from[across] = to[across] = middle[across];
        from[axis] = edge + outwards * strip;
        to[axis] = meets_block ? edge : edge - outwards * mark_inside;
        group.add(std::vector<glm::dvec2>{from, to}, false);
      }
  }

  /// Adds the zones along an axis: numbers from left to right, letters downwards.
  void zones_along(int axis, PageGroup& lines, PageGroup& names) const {
    const int across = 1 - axis;
    const std::vector<double> ends = zone_ends(page[axis], space.low[axis], space.high[axis]);
    for (const bool at_end : {false, true}) {
      if (is_narrow && at_end != (axis == 1)) continue;  // only above, and on the right
      const double edge = at_end ? space.high[across] : space.low[across], outer = at_end ? edge + strip : edge - strip;
      const auto point = [&](double along, double beside) {
        return axis == 0 ? glm::dvec2(along, beside) : glm::dvec2(beside, along);
      };
      for (const double at : ends)  // centring marks are lines already
        if (at != page[axis] / 2) lines.add(std::vector<glm::dvec2>{point(at, edge), point(at, outer)}, false);
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        add_text(names, axis == 0 ? std::to_string(i + 1) : zone_letter(int(i)),
                 point((ends[i] + ends[i + 1]) / 2, (edge + outer) / 2),
                 {zone_text, 0, TextAlign::centre, TextLine::middle}, lettering);
    }
  }

  const glm::dvec2 page;
  const Lettering lettering;
  const DrawingSpace space = drawing_space(page);
  const bool is_narrow = std::min(page.x, page.y) <= narrow_page;
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

PageLayer draw_frame(const glm::dvec2& page, const TitleBlock& block, Lettering lettering) {
  PageLayer layer{"8 frame"};
  FrameDrawing{page, lettering}.draw(layer);
  BlockDrawing drawing(drawing_space(page).block, lettering);
  drawing.add({"Legal owner", {0, 0}, {69, 18}, 3.5, 2}, block.owner);
  drawing.add({"Scale", {0, 18}, {45, 27}, 2.5, 1}, block.scale);
  drawing.add({"Unit", {0, 27}, {22.5, 36}, 2.5, 1}, block.unit);
  drawing.add({"Paper", {22.5, 27}, {45, 36}, 2.5, 1}, block.paper);
  drawing.add_symbol({"Projection", {45, 18}, {69, 36}, 3.5, 1}, block.projection);
  drawing.add({"Created by", {69, 0}, {129, 9}, 2.5, 1}, block.author);
  drawing.add({"Approved by", {69, 9}, {129, 18}, 2.5, 1}, "");  // signed by hand
  drawing.add({"Title", {69, 18}, {129, 36}, 5, 2}, block.title);
  drawing.add({"Document type", {129, 0}, {180, 9}, 2.5, 1}, "Technical drawing");
  drawing.add({"Number", {129, 9}, {180, 27}, 5, 1}, block.number);
  drawing.add({"Date of issue", {129, 27}, {159, 36}, 2.5, 1}, block.date);
  drawing.add({"Sheet", {159, 27}, {180, 36}, 2.5, 1},
              std::to_string(block.sheet) + "/" + std::to_string(block.sheets));
  drawing.finish(layer);
  return layer;
}

}  // namespace frontmost::detail
