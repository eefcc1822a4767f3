// SPDX-License-Identifier: Apache-2.0
// Rays from points of surfaces towards a light at infinity, many together.
#pragma once

#include <span>

#include "raycast/index/ray_tree.h"

namespace frontmost::raycast_detail {

/// Rays that walk the tree together: four pixels by four of four samples.
inline constexpr std::size_t kLightRays = 64;

/// are_lit() on this thread.
void find_lit(const RayTree& tree, std::span<const TrianglePoint> points, const glm::vec3& to_light,
              std::span<std::uint8_t> answers, Isa isa);

}  // namespace frontmost::raycast_detail
