// SPDX-License-Identifier: Apache-2.0
// Orders made of what is kept of every polygon of another.
#pragma once

#include <atomic>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "painter/seen/occlusion_clipper.h"

namespace frontmost::painter_detail {

inline constexpr std::size_t kPolygonsPerPart = 1024;

/// What is kept of consecutive slots.
struct Parts {
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
  std::vector<std::size_t> ends;  ///< by slot: of its polygons
};

/// In the order of their polygons.
inline PaintOrder assemble(const PaintOrder& order, const ScreenPolygons& screen, const std::vector<Parts>& lists) {
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
  for (std::uint32_t place = 0; place < screen.count(); ++place) {
    const std::size_t slot = screen.slot(place), in_part = slot % kPolygonsPerPart;
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

/// Makes an order of what look(clipper, slot, keep) keeps of every polygon.
template <class Look>
PaintOrder map_polygons(const PaintOrder& order, const ScreenPolygons& screen, const Adjacency& adjacency,
                        const Execution& execution, const Look& look) {
  const std::size_t count = screen.count();
  std::vector<Parts> lists((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<OcclusionClipper> clippers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto clipper =
        clippers.borrow([&] { return std::make_unique<OcclusionClipper>(screen, adjacency, execution); });
    Parts& parts = lists[begin / kPolygonsPerPart];
    for (std::size_t slot = begin; slot < end; ++slot) {
      const PrimitiveId id = order.polygons[screen.place(slot)].id;
      look(*clipper, slot, [&](Outline outline) {
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
  return assemble(order, screen, lists);
}

}  // namespace frontmost::painter_detail
