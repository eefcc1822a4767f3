// SPDX-License-Identifier: Apache-2.0
// The kernels of single rays, and of rays to a light.
//
//    closest_hit, is_clear, all_hits, closest_hits ...   --> queries.cpp --> walk(), walk_batch()   query_kernel.cpp
//    are_lit, and shade's shadows by rays                --> find_lit()                              light_kernel.cpp
#pragma once

#include <span>
#include <vector>

#include "frontmost/raycast.h"
#include "raycast/index/ray_tree.h"
#include "raycast/query/query_rule.h"

namespace frontmost::raycast_detail {

/// Returns whether the ray continues behind a hit, because it meets a hole, or a one-sided triangle from behind.
[[nodiscard]] inline bool passes(const RayTree& tree, const Query& query, const RayHit& hit) {
  if (query.is_one_way && !hit.is_front && !tree.sides->is_double(hit.primitive)) return true;
  const Cutouts* const cutouts = tree.cutouts.get();
  if (!cutouts || !cutouts->has(hit.primitive)) return false;
  const glm::dvec3 from(query.origin),
      along = query.is_segment ? glm::dvec3(query.end) - from : glm::dvec3(query.direction);
  return (*cutouts)[hit.primitive].is_hole_at(from + hit.t * along);
}

/// The hits that a walk looks for.
enum class Want : std::uint8_t {
  closest,  ///< one hit, the nearest
  any,      ///< one hit, whichever comes first
  all,      ///< every hit, in no order
};

/// Walks the tree and appends the hits that `want` names to `hits`. Precondition: is_valid(query).
void walk(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits, Isa isa);

/// Stores the hit of each query: closest or any as `want` says, or none if the query is not valid. Precondition: there
/// are as many answers as queries. \returns the number of nodes and leaves that were visited.
std::uint64_t walk_batch(const RayTree& tree, std::span<const Query> queries, Want want, std::span<RayHit> answers,
                         Isa isa);

/// Rays that walk the tree together: four by four pixels of four samples each.
inline constexpr std::size_t kLightRays = 64;

/// A light at infinity.
struct LightAim {
  glm::vec3 to_light;
  bool is_one_way = false;  ///< light passes one-sided triangles from behind, as with Query::is_one_way
};

/// Does are_lit() on this thread. \returns how often exact arithmetic had to decide, which takes microseconds.
std::uint64_t find_lit(const RayTree& tree, std::span<const TrianglePoint> points, const LightAim& light,
                       std::span<std::uint8_t> answers, Isa isa);

}  // namespace frontmost::raycast_detail
