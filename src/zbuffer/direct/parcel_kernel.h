// SPDX-License-Identifier: Apache-2.0
// Putting triangles into parcels, and drawing a tile from them.
#pragma once

#include <span>

#include "zbuffer/direct/parcel.h"
#include "zbuffer/place_kernel.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

/// Set in the key of a vertex that cannot be snapped as it is, a negative float: the planes of the clip volume that it
/// lies outside of for certain. What has one of them at every corner is not seen.
inline constexpr std::int32_t kOutside = 63;

/// Puts the vertices of a piece on the screen.
[[nodiscard]] PieceExtent snap_piece(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& vertices);
/// Appends what of the piece's triangles may cover a sample, in no particular order; vertices and `all_plain` are of
/// snap_piece(). Precondition: there is room in the columns.
void place_in_parcel(const PlaceTarget& target, const WorldTriangles& piece, const PieceVertices& vertices,
                     bool all_plain, Parcel& parcel);

/// What all tiles have in common that are drawn from the same parcels.
struct ParcelFrame : Picture {
  std::span<const Parcel* const> parcels;   ///< nearest first
  std::span<const TriangleRecord> records;  ///< likewise
};

/// One tile, and what may be seen in it.
struct ParcelJob : Tile {
  std::span<const std::uint32_t> records, parcels;
  bool is_drawn;    ///< it shows something already, which the planes hold
  bool is_last;     ///< nothing will be drawn to it any more
  float* farthest;  ///< of the 64 blocks: what was found before, and is found now unless this is the last time

  [[nodiscard]] bool is_empty() const { return records.empty() && parcels.empty(); }
};

/// Draws a tile and writes it to the planes.
void draw_parcels(const ParcelFrame& frame, const ParcelJob& job, TileScratch& scratch, Isa isa);

}  // namespace frontmost::zbuffer_detail
