// SPDX-License-Identifier: Apache-2.0
// Every polygon loses what those after it cover, one after the other, the foremost first.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "painter/looker.h"
#include "painter/seen/alone.h"

namespace frontmost {
namespace {

using namespace painter_detail;

constexpr std::size_t kPolygonsPerPart = 1024;

/// What is kept of consecutive slots.
struct Parts {
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
  std::vector<std::size_t> ends;  ///< by slot: of its polygons
};

/// In the order of their polygons.
PaintOrder assemble(const PaintOrder& order, const Scenery& scenery, const std::vector<Parts>& lists) {
  PaintOrder made;
  made.view = order.view;
  made.steps = order.steps;
  std::size_t polygons = 0, corners = 0;
  for (const Parts& parts : lists) {
    polygons += parts.polygons.size();
    corners += parts.corners.size();
  }
  made.polygons.reserve(polygons);
  made.corners.reserve(corners);
  for (std::uint32_t place = 0; place < scenery.count(); ++place) {
    const std::size_t slot = scenery.slot(place), in_part = slot % kPolygonsPerPart;
    const Parts& parts = lists[slot / kPolygonsPerPart];
    for (std::size_t i = in_part == 0 ? 0 : parts.ends[in_part - 1]; i < parts.ends[in_part]; ++i) {
      PaintPolygon polygon = parts.polygons[i];
      const PaintCorner* const from = parts.corners.data() + polygon.first_corner;
      polygon.first_corner = made.corners.size();
      made.polygons.push_back(polygon);
      made.corners.insert(made.corners.end(), from, from + polygon.corner_count);
    }
  }
  return made;
}

/// Makes an order of what look(looker, slot, keep) keeps of every polygon.
template <class Look>
PaintOrder map_polygons(const PaintOrder& order, const Scenery& scenery, const Mosaic& mosaic,
                        const Execution& execution, const Look& look) {
  const std::size_t count = scenery.count();
  std::vector<Parts> lists((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<Looker> lookers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto looker = lookers.borrow([&] { return std::make_unique<Looker>(scenery, mosaic, execution); });
    Parts& parts = lists[begin / kPolygonsPerPart];
    for (std::size_t slot = begin; slot < end; ++slot) {
      const PrimitiveId id = order.polygons[scenery.place(slot)].id;
      look(*looker, slot, [&](Outline outline) {
        parts.polygons.push_back({id, std::uint32_t(outline.size()), parts.corners.size()});
        for (const PaintCorner& corner : outline) {
          const double depth = affine_depth(order.view, corner.at.z);  // its own inverse
          parts.corners.push_back({{corner.at.x, corner.at.y, depth}, corner.is_cut});
        }
      });
      parts.ends.push_back(parts.polygons.size());
    }
    report_progress(execution, "visible parts", double(done += end - begin) / double(count));
  });
  return assemble(order, scenery, lists);
}

/// Hems that are tried, the first that is hidden is taken: part of the width, and how far from the ends they have it,
/// in their width. Neighbours are narrow towards their corners, and may be narrow everywhere.
struct HemShape {
  double part, inset;
};
constexpr std::array<HemShape, 7> kHemShapes{
    {{1, 0.5}, {1, 2}, {1, 6}, {0.25, 0.5}, {0.25, 2}, {0.25, 8}, {0.0625, 1}}};

/// What lies beside a side of an outline.
std::array<PaintCorner, 4> hem(const PaintCorner& from, const PaintCorner& to, double width, double inset) {
  const glm::dvec3 way = to.at - from.at;
  const double length = glm::length(glm::dvec2(way));
  inset = std::min(inset * width, 0.45 * length);
  const glm::dvec3 along = way / length, out(-along.y * width, along.x * width, 0);
  return {from, {from.at + along * inset + out, true}, {to.at - along * inset + out, true}, to};
}

/// Next to the middle of a side: within each of its hems. What lies at the rim of one hides nothing of it.
glm::dvec2 next_to(const PaintCorner& from, const PaintCorner& to, double distance) {
  const glm::dvec2 way(to.at - from.at), out(-way.y, way.x);
  return glm::dvec2(from.at) + 0.5 * way + out * (distance / glm::length(way));
}

}  // namespace

PaintOrder visible_parts(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides,
                         const Execution& execution) {
  const IeeeScope ieee;
  const Scenery scenery(order, hides);
  const Mosaic mosaic(scenery);
  const std::vector<std::uint8_t> is_alone = find_alone(scenery, mosaic, {}, execution);
  return map_polygons(order, scenery, mosaic, execution, [&](Looker& looker, std::size_t slot, const auto& keep) {
    if (is_alone[slot]) return keep(scenery.outline(slot));
    const OutlineList& seen = looker.look(slot);
    for (std::size_t i = 0; i < seen.count(); ++i) keep(seen[i]);
  });
}

PaintOrder with_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution) {
  if (!(width > 0 && width <= 100))
    throw Error(ErrorCode::bad_argument, "hems: must be more than 0, at most 100 pixels");
  const IeeeScope ieee;
  const Scenery scenery(order, hides);
  const Mosaic mosaic(scenery);
  return map_polygons(order, scenery, mosaic, execution, [&](Looker& looker, std::size_t slot, const auto& keep) {
    const std::span<const PaintCorner> outline = scenery.outline(slot);
    std::vector<PaintCorner> hemmed;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const PaintCorner &from = outline[i], &to = outline[i + 1 == outline.size() ? 0 : i + 1];
      hemmed.push_back(from);
      if (!scenery.hides(slot) || glm::length(glm::dvec2(to.at - from.at)) < OutlineCutter::thin) continue;
      const glm::dvec2 at = next_to(from, to, 0.5 * width * kHemShapes.back().part);
      std::array<PaintCorner, 4> beside;
      const std::size_t found = looker.first_hidden(slot, i, kHemShapes.size(), at, [&](std::size_t k) {
        beside = hem(from, to, width * kHemShapes[k].part, kHemShapes[k].inset);
        return Outline(beside);
      });
      if (found < kHemShapes.size()) hemmed.insert(hemmed.end(), {beside[1], beside[2]});
    }
    keep(hemmed);
  });
}

}  // namespace frontmost
