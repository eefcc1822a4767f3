// SPDX-License-Identifier: Apache-2.0
// Shades a Visible tile by tile.
#pragma once

#include "base/pool.h"
#include "shade/canvas/canvas.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Shades the tiles of a part of the picture. The part begins at the corner of a tile.
void shade_part(const TileRectangle& part, const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                Isa isa);

/// Shades all tiles, one row of tiles per thread at a time.
void shade_tiles(const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works, const Execution& execution);

}  // namespace frontmost::shading
