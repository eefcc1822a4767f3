// SPDX-License-Identifier: Apache-2.0
// One picture of a scene, straight from its own arrays, and the kernel that draws a tile of it from batches.
//
//    scene's arrays --survey--> batches, nearest first --place--> on the screen --lists--> tiles --draw_batches-->
//       again for the next some hundred batches, on what the planes and `farthest` hold by then
//
// Clusters are worth their making from the second picture on. The first one is drawn without them, from the arrays as
// they were loaded, and has the same bits.
#pragma once

#include <span>

#include "base/isa.h"
#include "frontmost/view.h"
#include "surfaces/placed_scene.h"
#include "zbuffer/place/triangle_batch.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

/// What ZBuffer::draw() gives of the clusters, to the bit. O(triangles + covered samples). Memory beside the result:
/// some 30 MiB, at most as much again for triangles with holes, and 100 bytes for each large or clipped triangle of
/// half a million in a row.
[[nodiscard]] Visible draw_directly(const PlacedScene& scene, const View& view, const Execution& execution);
/// The same by pixels. Scenes of more than a quarter of a million triangles take the planes beside it for a while.
[[nodiscard]] VisiblePixels draw_pixels_directly(const PlacedScene& scene, const View& view,
                                                 const Execution& execution);

/// What all tiles have in common that are drawn from the same batches.
struct BatchFrame : Picture {
  std::span<const TriangleBatch* const> batches;
  std::span<const TriangleRecord> records;
};

/// One tile, and what may be seen in it.
struct BatchJob : Tile {
  /// Near things first.
  struct Items {
    std::span<const std::uint32_t> records, batches;

    [[nodiscard]] bool is_empty() const { return records.empty() && batches.empty(); }
  };
  Items solid, cutouts;
  bool is_drawn;    ///< it shows something already, which the planes hold
  bool is_last;     ///< nothing will be drawn to it any more
  float* farthest;  ///< of the 64 blocks: what was found before, and is found now unless this is the last time

  [[nodiscard]] bool is_empty() const { return solid.is_empty() && cutouts.is_empty(); }
};

/// Draws a tile and writes it to the planes.
void draw_batches(const BatchFrame& frame, const BatchJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
