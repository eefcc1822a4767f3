// SPDX-License-Identifier: Apache-2.0
// Clips every polygon by itself, by the union of the occluders after it.
//
// Polygons that overlap nothing are found together, across the sides that they share, and need no clipper. In a scan or
// a terrain these are most of the polygons.
#include "base/parallel.h"
#include "painter/seen/adjacency.h"
#include "painter/seen/occlusion_clipper.h"
#include "painter/seen/screen_polygons.h"
#include "painter/seen/slot_lists.h"

namespace frontmost {
namespace {

using namespace painter_detail;

/// The parts of consecutive polygons.
struct PartList {
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
  std::vector<std::size_t> ends;  ///< by polygon: end of its parts

  void add(PrimitiveId id, Outline outline, const View& view) {
    polygons.push_back({id, std::uint32_t(outline.size()), corners.size()});
    for (const PaintCorner& corner : outline)
      corners.push_back({{corner.at.x, corner.at.y, affine_depth(view, corner.at.z)}, corner.is_cut});
  }
  void reserve(const std::vector<PartList>& lists) {
    reserve_sum(polygons, lists, &PartList::polygons);
    reserve_sum(corners, lists, &PartList::corners);
  }
  void add_polygon(const PartList& other, std::size_t number) {
    for (std::size_t i = number == 0 ? 0 : other.ends[number - 1]; i < other.ends[number]; ++i) {
      PaintPolygon part = other.polygons[i];
      const PaintCorner* const from = other.corners.data() + part.first_corner;
      part.first_corner = corners.size();
      polygons.push_back(part);
      corners.insert(corners.end(), from, from + part.corner_count);
    }
  }
};

}  // namespace

VisibleParts visible_parts(const PaintOrder& order, const Occluders& occluders, const Execution& execution) {
  const IeeeScope ieee;
  const ScreenPolygons screen(order, occluders);
  const Adjacency adjacency(screen);
  PaintEffort effort(execution, screen.count());
  const std::vector<std::uint8_t> is_unoverlapped = find_unoverlapped(screen, adjacency, {}, effort);
  PartList parts = list_by_place<PartList>(
      screen, execution, "visible parts", [&] { return std::make_unique<OcclusionClipper>(screen, adjacency, effort); },
      [&](OcclusionClipper& clipper, std::size_t slot, PartList& list) {
        const PrimitiveId id = order.polygons[screen.place(slot)].id;
        if (is_unoverlapped[slot]) {
          list.add(id, screen.outline(slot), order.view);
        } else {
          const OutlineList& seen = clipper.clip(slot);
          for (std::size_t i = 0; i < seen.count(); ++i) list.add(id, seen[i], order.view);
        }
        list.ends.push_back(list.polygons.size());
      });
  return {order.view, std::move(parts.polygons), std::move(parts.corners)};
}

}  // namespace frontmost
