// SPDX-License-Identifier: Apache-2.0
// Eight rays at once against one piece of a patch: the same arithmetic as meet() of a single ray, lane by lane.
//
// All arithmetic of a lane is that of a ray by itself, in the same order, so a picture does not depend on which rays
// went together. Lanes that have nothing to ask are masked and their values are never read.
#pragma once

#include <array>
#include <cstdint>

#include "raycast/curved/placed_curves.h"

namespace frontmost::raycast_detail {

inline constexpr std::size_t kPacketRays = 8;
using PacketLanes = std::array<double, kPacketRays>;

struct PacketVectors {
  alignas(64) PacketLanes x{}, y{}, z{};

  void set(std::size_t lane, const glm::dvec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};

/// Rays side by side.
struct RayPacket {
  PacketVectors origin, inverse;            ///< the inverse of the direction
  PacketVectors across_x, across_y, along;  ///< as RayFrame
  alignas(64) PacketLanes from{}, to{}, nearest{}, farthest{};

  void set(std::size_t lane, const DoubleRay& ray);
  /// To what is left of a ray that was set.
  void shorten(std::size_t lane, const DoubleRay& ray);

 private:
  PacketLanes length_{};
};

/// What rays meet of a piece, without regard to culling.
struct PieceMeetings {
  std::uint32_t met = 0;                   ///< lanes, as bits
  std::uint32_t open = 0;                  ///< lanes for which the piece must be halved: to be asked alone
  alignas(64) PacketLanes distance, u, v;  ///< of the met: along the ray in world units; in the piece
};
using MeetPiece = void (*)(const PatchPiece& piece, const RayPacket& rays, std::uint32_t lanes, PieceMeetings& out);
using EnterBox = BoxEntry (*)(const DoubleBox& box, const RayPacket& rays, std::uint32_t lanes);

[[nodiscard]] MeetPiece piece_kernel(Isa isa);
[[nodiscard]] EnterBox box_kernel(Isa isa);

}  // namespace frontmost::raycast_detail
