// SPDX-License-Identifier: Apache-2.0
#include "shade/shade_tiles.h"

#include <algorithm>
#include <memory>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

void shade_tile(const TileRectangle& tile, TileWork& work, const Painting& painting) {
  if (work.shade(tile)) {
    if (painting.opacity != 1.0f) work.fade(painting.opacity);
    painting.canvas.write(tile, work.pixels(), painting.background);
  } else {
    painting.canvas.fill(tile, painting.background);
  }
}

}  // namespace

void shade_part(const TileRectangle& part, const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                Isa isa) {
  const auto work = works.borrow([] { return std::make_unique<TileWork>(); });
  work->begin(layer, painting.colorist, painting.rate, isa);
  for (int y = 0; y < part.height; y += tile_height)
    for (int x = 0; x < part.width; x += tile_width)
      shade_tile({part.x + x, part.y + y, std::min(tile_width, part.width - x), std::min(tile_height, part.height - y)},
                 *work, painting);
}

void shade_tiles(const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                 const Execution& execution) {
  const View& view = layer.view();
  const auto rows = std::size_t((view.height + tile_height - 1) / tile_height);
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    const int y = int(begin) * tile_height, below = std::min(int(end) * tile_height, view.height);
    shade_part({0, y, view.width, below - y}, layer, painting, works, execution.isa);
  });
}

}  // namespace frontmost::shading
