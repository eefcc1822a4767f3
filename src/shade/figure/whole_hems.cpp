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

double distance_from_line(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& at) {
  const glm::dvec2 way = (to - from) / glm::length(to - from), out = at - from;
  return std::abs(way.x * out.y - way.y * out.x);
}

/// The hem of the side from one corner to another, by its own two corners.
SideHem hem_between(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& first, const glm::dvec2& last) {
  const glm::dvec2 way = (to - from) / glm::length(to - from);
  return {float(distance_from_line(from, to, first)), float(glm::dot(way, first - from)),
          float(glm::dot(way, to - last))};
}

}  // namespace

WholeHems::WholeHems(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution)
    : colored_(colored),
      wholes_(colored.whole_of.empty() ? colored.order : colored.wholes),
      most_beside_(std::min(kOnSide, width / 64)) {
  std::vector<std::uint8_t> hiding;
  const PaintOrder grouped = grouped_by_color(hiding, hides);
  hemmed_ = with_hems(
      grouped, width, [&](PrimitiveId group) { return hiding[group] != 0; }, execution);
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
    const PaintOrder hemmed = with_hems(sheet, width, {}, execution);
    for (std::size_t k = 0; k < members.size(); ++k) {
      hemmed_.polygons[members[k]] = hemmed.polygons[k];
      hemmed_.polygons[members[k]].first_corner += hemmed_.corners.size();
    }
    hemmed_.corners.insert(hemmed_.corners.end(), hemmed.corners.begin(), hemmed.corners.end());
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

/// Reads hems off: what a polygon has more between two of its own corners are the ends of hems, on the side, and the
/// two corners of each hem.
void WholeHems::read_whole(std::size_t whole) {
  if (read_ == whole) return;
  read_ = whole;
  whole_sides_.clear();
  const Corners bare = corners_of(wholes_, whole), hemmed = corners_of(hemmed_, whole);
  std::size_t at = 1;
  for (std::size_t i = 0; i < bare.size(); ++i, ++at) {
    const bool is_last = i + 1 == bare.size();
    glm::dvec2 from(bare[i].at);
    const glm::dvec2 first = from, last(bare[is_last ? 0 : i + 1].at);
    const auto is_more = [&] { return at < hemmed.size() && (is_last || glm::dvec2(hemmed[at].at) != last); };
    const auto add_until = [&](const glm::dvec2& to, const SideHem& hem) {
      whole_sides_.push_back({from, hem, 0, glm::length(to - from)});
      from = to;
    };
    while (is_more()) {
      const glm::dvec2 beside(hemmed[at].at);
      if (distance_from_line(first, last, beside) < most_beside_) {
        add_until(beside, {});
        ++at;
        continue;
      }
      const glm::dvec2 beside_end(hemmed[at + 1].at);
      at += 2;
      const glm::dvec2 to = is_more() ? glm::dvec2(hemmed[at++].at) : last;
      add_until(to, hem_between(from, to, beside, beside_end));
    }
    if (from != last || first == last) add_until(last, {});
  }
}

std::span<const HemmedSide> WholeHems::sides(std::size_t polygon) {
  const std::size_t whole = whole_of(polygon);
  read_whole(whole);
  const bool is_whole = (polygon == 0 || whole_of(polygon - 1) != whole) &&
                        (polygon + 1 == colored_.colors.size() || whole_of(polygon + 1) != whole);
  if (is_whole) return whole_sides_;
  sides_.clear();
  const Corners corners = corners_of(colored_.order, polygon);
  for (std::size_t i = 0; i < corners.size(); ++i)
    add_side(glm::dvec2(corners[i].at), glm::dvec2(corners[i + 1 == corners.size() ? 0 : i + 1].at));
  return sides_;
}

/// A side of a piece, with the parts of all hems that lie beside it.
void WholeHems::add_side(const glm::dvec2& from, const glm::dvec2& to) {
  const double length = glm::length(to - from);
  double done = 0;
  for (std::size_t k = 0; k < whole_sides_.size() && length > 0; ++k) {
    const HemmedSide& of = whole_sides_[k];
    if (!(of.hem.width > 0)) continue;
    const glm::dvec2 end = whole_sides_[k + 1 == whole_sides_.size() ? 0 : k + 1].from;
    if (distance_from_line(of.from, end, from) > kOnSide || distance_from_line(of.from, end, to) > kOnSide) continue;
    // How far along the piece's side the hem begins and ends.
    const glm::dvec2 along = (to - from) / length;
    const double first = glm::dot(of.from - from, along), last = glm::dot(end - from, along);
    const double begin = std::max(first, 0.0);
    if (!(std::min(last, length) - begin > kOnSide)) continue;
    if (begin > done + kOnSide) sides_.push_back({from + along * done, {}, 0, 0});
    sides_.push_back({from + along * begin, of.hem, begin - first, of.whole_length});
    done = std::min(last, length);
  }
  if (done < length - kOnSide || done == 0)
    sides_.push_back({length > 0 ? from + (to - from) * (done / length) : from, {}, 0, 0});
}

}  // namespace frontmost::shading
