// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/whole_hems.h"

#include <cmath>

#include "base/float_environment.h"

namespace frontmost::shading {
namespace {

/// Pixels that a cut's ends may lie beside the side that was cut.
constexpr double kOnSide = 1e-6;

std::span<const PaintCorner> corners_of(const PaintOrder& order, std::size_t i) {
  return {order.corners.data() + order.polygons[i].first_corner, order.polygons[i].corner_count};
}

/// The hem of the side from one corner to another whose first corner beside it is `beside`.
SideHem hem_between(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& beside) {
  const glm::dvec2 way = (to - from) / glm::length(to - from), out = beside - from;
  return {float(std::abs(way.x * out.y - way.y * out.x)), float(glm::dot(way, out))};
}

}  // namespace

WholeHems::WholeHems(const ColoredOrder& colored, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution)
    : colored_(colored), wholes_(colored.whole_of.empty() ? colored.order : colored.wholes) {
  std::vector<std::uint8_t> hiding;
  const PaintOrder grouped = grouped_by_color(hiding, hides);
  hemmed_ = with_hems(
      grouped, width, [&](PrimitiveId group) { return hiding[group] != 0; }, execution);
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
    hiding.back() = hiding.back() && (!hides || hides(id));
    grouped.polygons[whole].id = PrimitiveId(hiding.size() - 1);
    was_cut = is_cut;
  }
  return grouped;
}

/// Reads hems off: where a polygon has two corners more between two of its own.
void WholeHems::read_whole(std::size_t whole) {
  if (read_ == whole) return;
  read_ = whole;
  whole_sides_.clear();
  const Corners bare = corners_of(wholes_, whole), hemmed = corners_of(hemmed_, whole);
  std::size_t at = 0;
  for (std::size_t i = 0; i < bare.size(); ++i, ++at) {
    const bool is_last = i + 1 == bare.size();
    const glm::dvec2 from(bare[i].at), to(bare[is_last ? 0 : i + 1].at);
    HemmedSide side{from, {}, 0, glm::length(to - from)};
    const bool is_hemmed = at + 2 < hemmed.size() && (is_last || glm::dvec2(hemmed[at + 1].at) != to);
    if (is_hemmed) {
      side.hem = hem_between(from, to, glm::dvec2(hemmed[at + 1].at));
      at += 2;
    }
    whole_sides_.push_back(side);
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
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 from(corners[i].at), to(corners[i + 1 == corners.size() ? 0 : i + 1].at);
    HemmedSide side{from, {}, 0, 0};
    for (std::size_t k = 0; k < whole_sides_.size(); ++k) {
      const HemmedSide& of = whole_sides_[k];
      if (!(of.hem.width > 0)) continue;
      const glm::dvec2 end = whole_sides_[k + 1 == whole_sides_.size() ? 0 : k + 1].from;
      const glm::dvec2 along = (end - of.from) / of.whole_length;
      const auto is_on = [&](const glm::dvec2& p) {
        return std::abs(along.x * (p.y - of.from.y) - along.y * (p.x - of.from.x)) < kOnSide;
      };
      if (!is_on(from) || !is_on(to)) continue;
      side.hem = of.hem;
      side.begin = glm::dot(from - of.from, along);
      side.whole_length = of.whole_length;
    }
    sides_.push_back(side);
  }
  return sides_;
}

}  // namespace frontmost::shading
