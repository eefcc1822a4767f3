// SPDX-License-Identifier: Apache-2.0
#include "raycast/curved/patch_packet.h"

#include "raycast/curved/ray_frame.h"

namespace frontmost::raycast_detail {

void RayPacket::set(std::size_t lane, const DoubleRay& ray) {
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

void RayPacket::shorten(std::size_t lane, const DoubleRay& ray) {
  to[lane] = ray.to;
  farthest[lane] = ray.to * length_[lane] * kPastTheEnd;
}

}  // namespace frontmost::raycast_detail
