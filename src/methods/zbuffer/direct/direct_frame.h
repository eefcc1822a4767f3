// SPDX-License-Identifier: Apache-2.0
// Draws one picture of a scene straight from the scene's own arrays, and declares the kernel that draws a tile from
// batches.
//
//    scene's arrays --survey--> batches, nearest first --place--> on the screen --lists--> tiles --draw_batches-->
//       repeated for every few hundred batches, drawn into the planes and `farthest` of those before
//
// Making clusters pays off from the second picture on. The first picture is drawn without clusters, straight from the
// loaded arrays, and has the same bits.
#pragma once

#include <span>

#include "base/isa.h"
#include "frontmost/view.h"
#include "surfaces/placed_scene.h"
#include "zbuffer/place/triangle_batch.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

/// Returns the picture of ZBuffer::draw(), equal to the bit, without clusters. Time: O(triangles + covered samples).
/// Memory beside the result: some 30 MiB, at most as much again for triangles with holes, and 100 bytes for each large
/// or clipped triangle among the half million that are placed at once.
[[nodiscard]] Visible draw_directly(const PlacedScene& scene, const View& view, const Execution& execution);
/// draw_directly() for a VisiblePixels. Scenes of more than a quarter of a million triangles also need the planes of a
/// Visible for a while.
[[nodiscard]] VisiblePixels draw_pixels_directly(const PlacedScene& scene, const View& view,
                                                 const Execution& execution);

/// The input that all tiles drawn from the same batches share.
struct BatchFrame : Picture {
  std::span<const TriangleBatch* const> batches;
  std::span<const TriangleRecord> records;
};

/// One tile, and the records and batches that may be seen in it.
struct BatchJob : Tile {
  /// Indices of records and of batches, nearest first.
  struct Items {
    std::span<const std::uint32_t> records, batches;

    [[nodiscard]] bool is_empty() const { return records.empty() && batches.empty(); }
  };
  Items solid, cutouts;
  bool is_drawn;    ///< true if earlier batches were drawn to the tile; the planes hold the result
  bool is_last;     ///< true if no batches follow
  float* farthest;  ///< farthest keys of the 64 blocks: read, and updated unless is_last

  [[nodiscard]] bool is_empty() const { return solid.is_empty() && cutouts.is_empty(); }
};

/// Draws a tile and writes it to the planes.
void draw_batches(const BatchFrame& frame, const BatchJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
