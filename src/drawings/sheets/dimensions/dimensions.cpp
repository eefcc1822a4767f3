// SPDX-License-Identifier: Apache-2.0
// Dimensions: overall sizes first, then diameters where there is room.
//
//    views --> overall sizes: width below, height on the left, each direction of space once
//          --> diameters, view by view, where there is room
//
// Upright sizes use the same code as level ones: x and y are swapped, and "below" becomes "left". Numbers are rounded
// to the digits of a drawing, except where noise would decide how a half is rounded.
#include "sheets/dimensions/dimensions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sheets/dimensions/diameters.h"
#include "sheets/dimensions/measured_view.h"

namespace frontmost::detail {
namespace {

constexpr double same_direction = 0.9999;  // cosine

/// An overall size along `axis` of its view.
struct OverallSize {
  int axis;
  Extent extent;
  std::string text;
};

/// Draws a size: a level one as it is; for an upright one, x and y are swapped, seen from the right.
class OverallPen {
 public:
  OverallPen(DimensionPen& pen, const MeasuredView& view, const glm::dvec2& taken)
      : pen_(pen), view_(view), distance_(first_distance + taken) {}

  void draw(const OverallSize& size) {
    const bool is_level = size.axis == 0;
    const Extent& e = size.extent;
    const double line = is_level ? view_.box().high.y + distance_.y : view_.box().low.x - distance_.x;
    const double away = is_level ? 1 : -1;
    const auto at = [&](double along, double across) {
      return is_level ? glm::dvec2(along, across) : glm::dvec2(across, along);
    };
    for (const double end : {e.low, e.high})
      pen_.line(at(end, view_.foot_of_end(size.axis, end) + away * extension_gap),
                at(end, line + away * extension_overshoot));
    const double length = e.high - e.low, arrow = pen_.arrow_length(), width = pen_.width_of(size.text);
    const bool is_inside = length >= 2 * arrow + 1;
    const bool is_text_inside = width + 2 * text_distance <= length;
    // Read from the right, the text of an upright number runs upwards, towards lower y.
    const double first = is_level ? e.high : e.low, forwards = is_level ? 1 : -1;
    const double tail = is_inside ? 0 : 2 * arrow;
    const double text_tail = is_text_inside ? tail : std::max(tail, arrow) + width + 2 * text_distance;
    const double last = is_level ? e.low : e.high;
    pen_.line(at(last - forwards * tail, line), at(first + forwards * text_tail, line));
    const double inwards = is_inside ? -1 : 1;
    pen_.arrow(at(e.low, line), at(inwards, 0));
    pen_.arrow(at(e.high, line), at(-inwards, 0));
    const double middle =
        is_text_inside ? (e.low + e.high) / 2 : first + forwards * (text_tail - text_distance - width / 2);
    pen_.text(size.text, at(middle, line), TextAlign::centre, !is_level);
  }

 private:
  DimensionPen& pen_;
  const MeasuredView& view_;
  const glm::dvec2 distance_;  ///< of dimension lines from the view, on its left and below it
};

void validate(const DimensionOptions& options) {
  if (!(options.numbers_per_unit > 0 && std::isfinite(options.numbers_per_unit)))
    throw Error(ErrorCode::bad_argument, "numbers_per_unit", "must be above 0 and finite");
  if (options.decimals < 0 || options.decimals > 6)
    throw Error(ErrorCode::bad_argument, "decimals", "must be from 0 to 6");
  if (!(options.text_height >= 0.5 && options.text_height <= 100))
    throw Error(ErrorCode::bad_argument, "text_height", "must be from 0.5 to 100 millimetres");
}

}  // namespace

std::string dimension_text(double number, int decimals) {
  const double size = std::abs(number);
  // Below 1, three significant digits are as precise as two decimals above 1.
  if (size > 0 && size < 1) decimals = std::max(decimals, std::min(9, 2 - int(std::floor(std::log10(size)))));
  double unit = 1;
  for (int i = 0; i < decimals; ++i) unit *= 10;
  // Noise would decide how a half is rounded, so one more digit is written.
  constexpr double noise = 2e-4;
  const double off = std::abs(size * unit - std::round(size * unit));
  if (std::abs(off - 0.5) < noise) unit *= 10;
  if (!(size * unit < 9e15)) return std::to_string(number);
  const auto whole = std::int64_t(std::llround(size * unit)), one = std::int64_t(unit);
  std::string text = std::to_string(whole / one), rest = std::to_string(whole % one + one).substr(1);
  while (!rest.empty() && rest.back() == '0') rest.pop_back();
  return rest.empty() ? text : text + "." + rest;
}

std::vector<OverallSizes> overall_sizes_of(std::span<const DimensionedView> views) {
  std::vector<OverallSizes> all(views.size());
  std::vector<glm::dvec3> known;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].is_dimensioned) continue;
    const auto take = [&](const glm::dvec3& direction) {
      for (const glm::dvec3& other : known)
        if (std::abs(glm::dot(other, direction)) > same_direction) return false;
      known.push_back(direction);
      return true;
    };
    all[i].width = take(views[i].drawing->view.right());
    all[i].height = take(views[i].drawing->view.up());
  }
  return all;
}

glm::dvec2 room_for(const OverallSizes& sizes, double text_height) {
  return {sizes.height ? first_distance + text_height + 2 * text_distance : 0,
          sizes.width ? first_distance + extension_overshoot + text_distance : 0};
}

Dimensions place_dimensions(std::span<const DimensionedView> views, const PageBox& area, std::span<const PageBox> taken,
                            const DimensionOptions& options) {
  validate(options);
  Obstacles obstacles(area);
  std::vector<MeasuredView> measured;
  for (const DimensionedView& view : views) {
    measured.emplace_back(view);
    obstacles.add(*view.sheet);
  }
  for (const PageBox& box : taken) obstacles.add(box);
  const std::vector<OverallSizes> shares = overall_sizes_of(views);
  Dimensions all;
  DimensionPen pen(options, obstacles);
  Diameters diameters(options, pen, obstacles);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (measured[i].is_empty()) continue;
    for (const int axis : {0, 1}) {
      if (!(axis == 0 ? shares[i].width : shares[i].height)) continue;
      const Extent extent = measured[i].extent(axis);
      if (!(extent.size > 0)) continue;
      std::string text = dimension_text(extent.size * options.numbers_per_unit, options.decimals);
      if (extent.diameter != nullptr) {
        if (!diameters.take(*extent.diameter)) continue;
        text = diameter_sign + text;
      }
      OverallPen(pen, measured[i], views[i].taken).draw({axis, extent, text});
      ++all.count;
    }
  }
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].is_dimensioned) diameters.add(measured[i], all);
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].is_dimensioned) diameters.count_missing(measured[i], all);
  all.layer.groups = pen.take();
  return all;
}

}  // namespace frontmost::detail
