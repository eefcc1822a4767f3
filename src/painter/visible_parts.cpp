// SPDX-License-Identifier: Apache-2.0
// Every polygon loses what those after it cover, one after the other, the foremost first.
#include "base/float_environment.h"
#include "painter/map_polygons.h"
#include "painter/seen/alone.h"

namespace frontmost {

using namespace painter_detail;

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

}  // namespace frontmost
