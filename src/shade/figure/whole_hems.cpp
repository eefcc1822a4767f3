// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/whole_hems.h"

#include <algorithm>
#include <cmath>

#include "base/float_environment.h"
#include "shade/figure/grouping/order_parts.h"

namespace frontmost::shading {
namespace {

/// Pixels that a cut's ends may lie beside the side that was cut.
constexpr double kOnSide = 1e-6;
/// And those of a part of a side from the ends of the whole, of which it is all then: they may have been rounded.
constexpr double kAtEnd = 1.0 / 1024;

double distance_from_line(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& at) {
  const glm::dvec2 way = (to - from) / glm::length(to - from), out = at - from;
  return std::abs(way.x * out.y - way.y * out.x);
}

}  // namespace

WholeHems::WholeHems(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution)
    : colored_(colored), wholes_(colored.whole_of.empty() ? colored.order : colored.wholes) {
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
void WholeHems::hem_sheets(const PaintOrder& grouped, double width, const Execution& execution) {
  const std::size_t count = colored_.colors.size();
  PaintOrder sheet;
  sheet.view = grouped.view;
  std::vector<std::size_t> members;
  for (std::size_t begin = 0, end; begin < count; begin = end) {
    for (end = begin + 1; end < count && colored_.sheets[end] == colored_.sheets[begin];) ++end;
    if (colored_.colors[begin].a == 255 || colored_.shapes[end - 1] == colored_.shapes[begin]) continue;
    members.clear();
    sheet.polygons.clear();
    sheet.corners.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (i > begin && whole_of(i) == whole_of(i - 1)) continue;
      members.push_back(whole_of(i));
      append(grouped, members.back(), sheet);
    }
    const painter_detail::HemList own = painter_detail::side_hems(sheet, width, {}, execution);
    for (std::size_t k = 0; k < members.size(); ++k) {
      hems_of_[members[k]].begin = hems_.hems.size();
      for (painter_detail::SideHem hem : own.of(k)) {
        hem.first_corner += hems_.corners.size();
        hems_.hems.push_back(hem);
      }
      hems_of_[members[k]].end = hems_.hems.size();
    }
    hems_.corners.insert(hems_.corners.end(), own.corners.begin(), own.corners.end());
  }
}

/// Hems may reach over other parts of the same primitive, as if it had one colour. That is true of a shape, and of
/// parts of a primitive that have the same; so numbers of such groups take the place of the primitive's.
PaintOrder WholeHems::grouped_by_color(std::vector<std::uint8_t>& hiding,
                                       const std::function<bool(PrimitiveId)>& hides) const {
  PaintOrder grouped = wholes_;
  // What has no pieces is not painted: a group of its own, that hides nothing.
  hiding.assign(1, 0);
  for (PaintPolygon& polygon : grouped.polygons) polygon.id = 0;
  const std::size_t count = colored_.colors.size();
  bool was_cut = true;
  for (std::size_t i = 0, end; i < count; i = end) {
    const std::size_t whole = whole_of(i);
    for (end = i + 1; end < count && whole_of(end) == whole;) ++end;
    const bool is_cut = end > i + 1;
    const PrimitiveId id = wholes_.polygons[whole].id;
    const bool goes_on = !is_cut && !was_cut &&
                         (colored_.shapes[i] == colored_.shapes[i - 1] ||
                          (id == wholes_.polygons[whole_of(i - 1)].id && colored_.colors[i] == colored_.colors[i - 1]));
    if (!goes_on) hiding.push_back(1);
    hiding.back() = hiding.back() && colored_.colors[i].a == 255 && (!hides || hides(id));
    grouped.polygons[whole].id = PrimitiveId(hiding.size() - 1);
    was_cut = is_cut;
  }
  return grouped;
}

/// Sets sides_ to those of a whole, parted where a hem begins or ends.
void WholeHems::list_whole(std::size_t whole) {
  const Corners corners = corners_of(wholes_, whole);
  auto [hem, end] = hems_of_[whole];
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 from(corners[i].at), to(corners[i + 1 == corners.size() ? 0 : i + 1].at);
    sides_.push_back({from});
    for (; hem < end && hems_.hems[hem].side == i; ++hem) {
      if (sides_.back().at != hems_.hems[hem].from) sides_.push_back({hems_.hems[hem].from});
      sides_.back().hem = std::uint32_t(hem);
      if (hems_.hems[hem].to != to) sides_.push_back({hems_.hems[hem].to});
    }
  }
}

std::span<const NetCorner> WholeHems::sides(std::size_t polygon) {
  const std::size_t whole = whole_of(polygon);
  sides_.clear();
  const bool is_whole = (polygon == 0 || whole_of(polygon - 1) != whole) &&
                        (polygon + 1 == colored_.colors.size() || whole_of(polygon + 1) != whole);
  if (is_whole) {
    list_whole(whole);
    return sides_;
  }
  const Corners corners = corners_of(colored_.order, polygon);
  for (std::size_t i = 0; i < corners.size(); ++i)
    add_side(hems_of_[whole], glm::dvec2(corners[i].at), glm::dvec2(corners[i + 1 == corners.size() ? 0 : i + 1].at));
  return sides_;
}

/// A side of a piece, with the parts of all hems that lie beside it.
void WholeHems::add_side(const Range& hems, const glm::dvec2& from, const glm::dvec2& to) {
  const double length = glm::length(to - from);
  double done = 0;
  for (std::size_t k = hems.begin; k < hems.end && length > 0; ++k) {
    const painter_detail::SideHem& hem = hems_.hems[k];
    if (distance_from_line(hem.from, hem.to, from) > kOnSide || distance_from_line(hem.from, hem.to, to) > kOnSide)
      continue;
    // How far along the piece's side the hem begins and ends.
    const glm::dvec2 along = (to - from) / length;
    const double begin = std::max(glm::dot(hem.from - from, along), 0.0);
    const double end = std::min(glm::dot(hem.to - from, along), length);
    if (!(end - begin > kOnSide)) continue;
    if (begin > done + kOnSide) sides_.push_back({from + along * done});
    sides_.push_back({from + along * begin, std::uint32_t(k)});
    done = end;
  }
  if (done < length - kOnSide || done == 0)
    sides_.push_back({length > 0 ? from + (to - from) * (done / length) : from});
}

std::span<const glm::dvec2> WholeHems::part(std::uint32_t number, const glm::dvec2& from, const glm::dvec2& to) {
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
