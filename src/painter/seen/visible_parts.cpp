// SPDX-License-Identifier: Apache-2.0
// Every polygon loses what those after it cover, one after the other, the foremost first.
#include "base/float_environment.h"
#include "painter/seen/slot_lists.h"
#include "painter/seen/unoverlapped.h"

namespace frontmost {

using namespace painter_detail;

PaintOrder visible_parts(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides,
                         const Execution& execution) {
  const IeeeScope ieee;
  const ScreenPolygons screen(order, hides);
  const Adjacency adjacency(screen);
  const std::vector<std::uint8_t> is_alone = find_unoverlapped(screen, adjacency, {}, execution);
  return map_polygons(order, screen, adjacency, execution,
                      [&](OcclusionClipper& clipper, std::size_t slot, const auto& keep) {
                        if (is_alone[slot]) return keep(screen.outline(slot));
                        const OutlineList& seen = clipper.look(slot);
                        for (std::size_t i = 0; i < seen.count(); ++i) keep(seen[i]);
                      });
}

}  // namespace frontmost
