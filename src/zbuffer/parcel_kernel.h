// SPDX-License-Identifier: Apache-2.0
// Putting triangles into parcels, and drawing a tile from them.
#pragma once

#include <span>

#include "zbuffer/parcel.h"
#include "zbuffer/place_kernel.h"
#include "zbuffer/tile.h"

namespace frontmost::zbuffer_detail {

/// Appends what of the triangles may cover a sample, in no particular order. Precondition: there is room in the
/// columns.
void place_in_parcel(const PlaceTarget& target, const PieceGeometry& piece, PieceVertices& scratch, Parcel& parcel);

/// What all tiles have in common that are drawn from the same parcels.
struct ParcelFrame : Picture {
  std::span<const Parcel* const> parcels;   ///< nearest first
  std::span<const TriangleRecord> records;  ///< likewise
};

/// One tile, and what may be seen in it.
struct ParcelJob : Tile {
  std::span<const std::uint32_t> records, parcels;
  bool is_drawn;  ///< it shows something already, which the planes hold

  [[nodiscard]] bool is_empty() const { return records.empty() && parcels.empty(); }
};

/// Draws a tile and writes it to the planes.
void draw_parcels(const ParcelFrame& frame, const ParcelJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
