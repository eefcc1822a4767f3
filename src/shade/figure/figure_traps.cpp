// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/figure_traps.h"

#include <algorithm>
#include <cmath>

#include "base/float_environment.h"
#include "shade/figure/grouping/order_parts.h"

namespace frontmost::shading {
namespace {

/// Pixels by which a part of a side may end before the whole, of which it is all then: they may have been rounded.
constexpr double kAtEnd = 1.0 / 1024;

}  // namespace

FigureTraps::FigureTraps(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
                         const Execution& execution)
    : colored_(colored) {
  if (!(width > 0 && width <= 100))
    throw Error(ErrorCode::bad_argument, "hems: must be more than 0, at most 100 pixels");
  const IeeeScope ieee;
  std::vector<std::uint8_t> hiding;
  const PaintOrder grouped = grouped_by_color(hiding, hides);
  hems_ = painter_detail::side_hems(
      grouped, width, [&](PrimitiveId group) { return hiding[group] != 0; }, execution);
  for (std::size_t i = 0; i < grouped.polygons.size(); ++i) hems_of_.push_back({hems_.begin_of(i), hems_.ends[i]});
  if (!colored.sheets.empty()) hem_sheets(grouped, width, execution);
}

/// What is translucent reaches under others of its own sheet, and under nothing else.
void FigureTraps::hem_sheets(const PaintOrder& grouped, double width, const Execution& execution) {
  const std::size_t count = colored_.colors.size();
  PaintOrder sheet;
  sheet.view = grouped.view;
  for (std::size_t begin = 0, end; begin < count; begin = end) {
    for (end = begin + 1; end < count && colored_.sheets[end] == colored_.sheets[begin];) ++end;
    if (colored_.colors[begin].a == 255 || colored_.shapes[end - 1] == colored_.shapes[begin]) continue;
    sheet.polygons.clear();
    sheet.corners.clear();
    for (std::size_t i = begin; i < end; ++i) append(grouped, i, sheet);
    const painter_detail::HemList own = painter_detail::side_hems(sheet, width, {}, execution);
    for (std::size_t i = begin; i < end; ++i) {
      hems_of_[i].begin = hems_.hems.size();
      for (painter_detail::SideHem hem : own.of(i - begin)) {
        hem.first_corner += hems_.corners.size();
        hems_.hems.push_back(hem);
      }
      hems_of_[i].end = hems_.hems.size();
    }
    hems_.corners.insert(hems_.corners.end(), own.corners.begin(), own.corners.end());
  }
}

/// Hems may reach over other parts of the same primitive, as if it had one colour. That is true of a shape, and of
/// parts of a primitive that have the same; so numbers of such groups take the place of the primitive's.
PaintOrder FigureTraps::grouped_by_color(std::vector<std::uint8_t>& hiding,
                                         const std::function<bool(PrimitiveId)>& hides) const {
  PaintOrder grouped = colored_.order;
  const std::vector<PaintPolygon>& polygons = colored_.order.polygons;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const PrimitiveId id = polygons[i].id;
    const bool goes_on = i > 0 && (colored_.shapes[i] == colored_.shapes[i - 1] ||
                                   (id == polygons[i - 1].id && colored_.colors[i] == colored_.colors[i - 1]));
    if (!goes_on) hiding.push_back(1);
    hiding.back() = hiding.back() && colored_.colors[i].a == 255 && (!hides || hides(id));
    grouped.polygons[i].id = PrimitiveId(hiding.size() - 1);
  }
  return grouped;
}

/// Parted where a hem begins or ends.
std::span<const NetCorner> FigureTraps::sides(std::size_t polygon) {
  const std::span<const PaintCorner> corners = corners_of(colored_.order, polygon);
  auto [hem, end] = hems_of_[polygon];
  sides_.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 from(corners[i].at), to(corners[i + 1 == corners.size() ? 0 : i + 1].at);
    sides_.push_back({from});
    for (; hem < end && hems_.hems[hem].side == i; ++hem) {
      if (sides_.back().at != hems_.hems[hem].from) sides_.push_back({hems_.hems[hem].from});
      sides_.back().hem = std::uint32_t(hem);
      if (hems_.hems[hem].to != to) sides_.push_back({hems_.hems[hem].to});
    }
  }
  return sides_;
}

std::span<const glm::dvec2> FigureTraps::part(std::uint32_t number, const glm::dvec2& from, const glm::dvec2& to) {
  const painter_detail::SideHem& hem = hems_.hems[number];
  const glm::dvec2 way = hem.to - hem.from, along = way / glm::length(way);
  const auto is_beyond = [](const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) > kAtEnd; };
  const std::span<const glm::dvec2> corners = hems_.corners_of(hem);
  part_.assign(corners.begin(), corners.end());
  const auto cut = [&](const glm::dvec2& at, const glm::dvec2& way_in, const glm::dvec2& end) {
    // The corners that are beyond a line across the side, and where the outline comes back over it.
    const auto within = [&](const glm::dvec2& p) { return glm::dot(p - at, way_in); };
    std::size_t kept = 0;
    glm::dvec2 before = end;
    while (kept < part_.size() && within(part_[kept]) < 0) before = part_[kept++];
    if (kept == part_.size()) return part_.clear();
    const double a = within(before), b = within(part_[kept]);
    part_.erase(part_.begin(), part_.begin() + std::ptrdiff_t(kept));
    part_.insert(part_.begin(), before + (part_.front() - before) * (a / (a - b)));
  };
  if (is_beyond(from, hem.from)) cut(from, along, hem.from);
  if (is_beyond(to, hem.to)) {
    std::reverse(part_.begin(), part_.end());
    cut(to, -along, hem.to);
    std::reverse(part_.begin(), part_.end());
  }
  return part_;
}

}  // namespace frontmost::shading
