// SPDX-License-Identifier: Apache-2.0
// Eight rays through the boxes together. What each meets is what it would meet alone: the nearest, and of several at
// the same place the lowest, in whatever order they come.
//
// Rays that a piece's kernel leaves open, because the piece has to be halved for them, as at outlines, are asked one by
// one. Each ray is shortened as soon as it has met something, so that the packet ends where its last ray does.
#include <algorithm>

#include "raycast/curved/curved_parts.h"
#include "raycast/curved/patch_packet.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

/// Calls visit(lane) for every bit.
template <class Visit>
void for_each_lane(std::uint32_t lanes, const Visit& visit) {
  for (std::size_t i = 0; lanes >> i != 0; ++i)
    if (lanes >> i & 1) visit(i);
}

class PacketWalk {
 public:
  PacketWalk(const CurvedParts& parts, std::span<DoubleRay> rays, Isa isa)
      : parts_(parts), rays_(rays), meet_piece_(piece_kernel(isa)), enter_box_(box_kernel(isa)) {
    for (std::size_t i = 0; i < rays.size(); ++i) packet_.set(i, rays[i]);
  }

  void run() {
    const auto enter = [&](const DoubleBox& box, std::uint32_t lanes) { return enter_box_(box, packet_, lanes); };
    const auto all = std::uint32_t((1u << rays_.size()) - 1);
    const auto is_past = [&](const BoxEntry& entry) {
      for (std::size_t i = 0; i < rays_.size(); ++i)
        if ((entry.lanes >> i & 1) != 0 && entry.at <= rays_[i].to) return false;
      return true;
    };
    parts_.tree.walk_together(all, enter, is_past,
                              [&](std::uint32_t item, std::uint32_t lanes) { visit(item, lanes); });
  }

  [[nodiscard]] const CurvedHit& hit(std::size_t lane) const { return nearest_[lane].hit; }

 private:
  void visit(std::uint32_t item, std::uint32_t lanes) {
    if (item < parts_.spheres.size()) return for_each_lane(lanes, [&](std::size_t i) { ask_alone(item, i); });
    const PatchPiece& piece = parts_.pieces[item - parts_.spheres.size()];
    PieceMeetings found;
    meet_piece_(piece, packet_, lanes, found);
    for_each_lane(found.open, [&](std::size_t i) { ask_alone(item, i); });
    for_each_lane(found.met, [&](std::size_t i) {
      keep(item, i, meeting_at(piece, rays_[i], {found.u[i], found.v[i]}, found.distance[i]));
    });
  }

  void ask_alone(std::uint32_t item, std::size_t lane) { keep(item, lane, parts_.meet_item(item, rays_[lane])); }

  void keep(std::uint32_t item, std::size_t lane, const std::optional<RayMeeting>& met) {
    if (met && nearest_[lane].keep(*met, parts_.id_of(item), item, rays_[lane])) packet_.shorten(lane, rays_[lane]);
  }

  const CurvedParts& parts_;
  std::span<DoubleRay> rays_;
  MeetPiece meet_piece_;
  EnterBox enter_box_;
  RayPacket packet_;
  std::array<NearestHit, kPacketRays> nearest_;
};

}  // namespace

void raycast_detail::RayPacket::set(std::size_t lane, const DoubleRay& ray) {
  const RayFrame frame(ray);
  origin.set(lane, ray.origin);
  inverse.set(lane, 1.0 / ray.direction);
  across_x.set(lane, frame.across_x);
  across_y.set(lane, frame.across_y);
  along.set(lane, frame.along);
  from[lane] = ray.from;
  to[lane] = ray.to;
  nearest[lane] = frame.nearest;
  farthest[lane] = frame.farthest;
  length_[lane] = frame.length;
}

void raycast_detail::RayPacket::shorten(std::size_t lane, const DoubleRay& ray) {
  to[lane] = ray.to;
  farthest[lane] = ray.to * length_[lane] * kPastTheEnd;
}

void CurvedParts::nearest(std::span<DoubleRay> rays, std::span<CurvedHit> hits, Isa isa) const {
  std::fill(hits.begin(), hits.end(), CurvedHit());
  if (rays.empty() || rays[0].culling == Culling::both) return;
  if (pieces.empty()) {  // spheres are met one by one anyway
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = nearest(rays[i]);
    return;
  }
  PacketWalk walk(*this, rays, isa);
  walk.run();
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk.hit(i);
}

}  // namespace frontmost
