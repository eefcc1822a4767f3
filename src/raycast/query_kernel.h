// SPDX-License-Identifier: Apache-2.0
// Single rays and segments through the tree.
#pragma once

#include <span>
#include <vector>

#include "raycast/exact_sign.h"
#include "raycast/index/ray_tree.h"

namespace frontmost::raycast_detail {

/// A ray, or a segment whose far end is at t = 1.
struct Query {
  glm::vec3 origin, end;  ///< `end` of segments only
  glm::vec3 direction;    ///< of segments: end - origin, rounded
  bool is_segment;
};

/// What ends a walk.
enum class Want : std::uint8_t {
  closest,  ///< one hit, the nearest
  any,      ///< one hit, whichever comes first
  all,      ///< every hit, in no order
};

/// \returns false where nothing can be met: a coordinate that is not finite, or no direction.
[[nodiscard]] bool is_valid(const Query& query);

/// Appends what is met to `hits`. Precondition: is_valid(query).
void walk(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits, Isa isa);

/// The hit of each query that `want`, closest or any, asks for; none where the query is not valid.
/// Precondition: as many answers as queries.
void walk_batch(const RayTree& tree, std::span<const Query> queries, Want want, std::span<RayHit> answers, Isa isa);

/// A triangle met at its exact place, or not at all: the definition, on plain scalars.
[[nodiscard]] RayHit meet(const Query& query, const std::array<glm::vec3, 3>& corners, PrimitiveId id);

}  // namespace frontmost::raycast_detail
