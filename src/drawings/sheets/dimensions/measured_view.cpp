// SPDX-License-Identifier: Apache-2.0
// A polygon of twenty sides reaches slightly less far than its circle. So if a round surface is the outermost feature,
// within the sagitta of a side of 20 degrees, its own radius gives the extent. Extension lines begin at the lines drawn
// at that end, at the ones nearest to the dimension line.
#include "sheets/dimensions/measured_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "rounds/centre_lines.h"

namespace frontmost::detail {
namespace {

constexpr double square = 2e-3;               // sine, as for centre lines
constexpr double least_drawn = 0.2;           // likewise
constexpr double nearly_whole = 6.2;          // radians
constexpr double widest_sagitta = 0.016;      // as a share of the radius, for sides of 20 degrees
constexpr double same_place_on_paper = 0.02;  // millimetres of paper

}  // namespace

MeasuredView::MeasuredView(const DimensionedView& view) : view_(view) {
  const View& camera = view.drawing->view;
  const Projection& p = camera.projection;
  millimetres_ = camera.width / (p.right - p.left) * view.sheet->millimetres_per_pixel;
  const DrawingBounds drawn = bounds_of(*view.drawing, true);
  is_empty_ = drawn.is_empty();
  if (is_empty_) return;
  box_ = {view.sheet->on_page(drawn.low), view.sheet->on_page(drawn.high)};
  if (view.rounds != nullptr) find_circles();
}

glm::dvec2 MeasuredView::on_page(const glm::dvec3& point) const {
  return view_.sheet->on_page(on_screen(view_.drawing->view, point));
}

bool MeasuredView::is_seen_along(const Round& round) const {
  return glm::length(glm::cross(round.axis, view_.drawing->view.forward())) <= square;
}

void MeasuredView::find_circles() {
  for (const Round& prism : view_.rounds->prisms)
    if (is_seen_along(prism)) prisms_.push_back(&prism);
  const std::vector<double> lengths = drawn_lengths(*view_.rounds, *view_.drawing, view_.with_hidden);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Round& round = view_.rounds->rounds[i];
    if (round.kind == RoundKind::revolved) continue;  // its largest circle is no edge
    if (!is_seen_along(round)) continue;
    const double radius = round.radius * millimetres_;
    if (lengths[i] * view_.sheet->millimetres_per_pixel >= least_drawn * round.turn * radius)
      circles_.push_back({&round, on_page(round.from), radius});
    else if (round.kind == RoundKind::cylinder)
      undrawn_.push_back(&round);
  }
}

Extent MeasuredView::extent(int axis) const {
  Extent all{box_.low[axis], box_.high[axis], 0};
  const View& camera = view_.drawing->view;
  const glm::dvec3 direction = axis == 0 ? camera.right() : camera.up();
  double low = all.low, high = all.high;
  for (const Round& round :
       view_.rounds != nullptr ? std::span<const Round>(view_.rounds->rounds) : std::span<const Round>()) {
    const double along = glm::dot(round.axis, direction), slack = widest_sagitta * round.radius * millimetres_;
    if (round.turn < nearly_whole) continue;
    const double reach = round.radius * millimetres_ * std::sqrt(std::max(0.0, 1 - along * along));
    const double from = on_page(round.from)[axis], to = on_page(round.to)[axis];
    const double begin = std::min(from, to) - reach, end = std::max(from, to) + reach;
    const bool is_low =
        begin <= box_.low[axis] + same_place_on_paper && begin >= box_.low[axis] - slack - same_place_on_paper;
    const bool is_high =
        end >= box_.high[axis] - same_place_on_paper && end <= box_.high[axis] + slack + same_place_on_paper;
    if (is_low) low = std::min(low, begin);
    if (is_high) high = std::max(high, end);
    const bool is_larger = all.diameter == nullptr || round.radius > all.diameter->radius;
    if (is_low && is_high && std::abs(along) <= square && is_larger) all.diameter = &round;
  }
  all.low = low;
  all.high = high;
  all.size = all.diameter != nullptr ? 2 * all.diameter->radius : (high - low) / millimetres_;
  return all;
}

double MeasuredView::foot_of_end(int axis, double end) const {
  const double slack = same_place_on_paper + widest_sagitta * (box_.high[axis] - box_.low[axis]) / 2;
  const int other = 1 - axis;
  double nearest = std::numeric_limits<double>::infinity(), foot = axis == 0 ? box_.low.y : box_.high.x;
  const auto look_at = [&](const glm::dvec2& point) {
    const double off = std::abs(point[axis] - end);
    if (off > slack || off > nearest + same_place_on_paper) return;
    // Among points at one distance, the one nearest to the dimension line is taken.
    const bool is_nearer = off < nearest - same_place_on_paper;
    const double at = point[other];
    foot = is_nearer ? at : axis == 0 ? std::max(foot, at) : std::min(foot, at);
    nearest = std::min(nearest, off);
  };
  for (const DrawnPart& part : view_.drawing->parts) {
    look_at(view_.sheet->on_page(part.from));
    look_at(view_.sheet->on_page(part.to));
  }
  return foot;
}

}  // namespace frontmost::detail
