// SPDX-License-Identifier: Apache-2.0
// Pictures of what is visible, tile by tile.
#pragma once

#include "base/pool.h"
#include "shade/canvas/canvas.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Shades the tiles of a part of the picture that begins where one of them does.
void shade_part(const TileRectangle& part, const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                Isa isa);

/// Shades all tiles, one row of tiles to a thread at a time.
void shade_tiles(const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works, const Execution& execution);

}  // namespace frontmost::shading
