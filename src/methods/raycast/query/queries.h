// SPDX-License-Identifier: Apache-2.0
// The definitions of what single rays and segments meet, and of what stands between a point and a light; and the
// kernels of single rays, and of rays to a light.
//
//    closest_hit, is_clear, all_hits, closest_hits ...   --> queries.cpp --> walk(), walk_batch()   query_kernel.cpp
//    are_lit, and shade's shadows by rays                --> find_lit()                              light_kernel.cpp
//
// The definitions are exact, in plain scalar code. Kernels are faster ways to the same bits, and ask there if rounding
// leaves a doubt. sample_rule.h holds the definition for rays through the samples of a view.
//
//              c
//             / |         The line from o along d passes through the triangle, edges included, if it turns to the same
//    o ------/--|---> d   side about all three edges: the signs of det(d, b - o, c - o), det(d, c - o, a - o) and
//           a---b         det(d, a - o, b - o) agree. The triangle is before o if the sign of det(a - o, b - o, c - o)
//                         agrees with them. Differences of floats are kept as exact sums of two doubles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "frontmost/raycast.h"
#include "raycast/index/ray_tree.h"

namespace frontmost::raycast_detail {

/// A vector whose coordinates are exact sums of two doubles.
struct HighLowVector {
  std::array<double, 3> high{}, low{};
};

/// high_low(v) returns v itself, and high_low_difference(b, a) returns b - a.
[[nodiscard]] HighLowVector high_low(const glm::vec3& v);
[[nodiscard]] HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a);

/// Sign of the determinant: -1, 0 or 1. Takes a few nanoseconds, or microseconds if the determinant is within rounding
/// of zero. Precondition: the vectors come from finite floats, so that no product leaves the range of doubles.
[[nodiscard]] int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c);

/// A ray, or a segment whose far end is at t = 1.
struct Query {
  glm::vec3 origin, end;  ///< `end` is used for segments only
  glm::vec3 direction;    ///< in segments: end - origin, rounded
  bool is_segment;
  bool is_one_way = false;  ///< one-sided triangles are not met from behind, as in views with Culling::material
};

/// \returns false if nothing can be met: a coordinate is not finite, or there is no direction.
[[nodiscard]] bool is_valid(const Query& query);

/// Returns the hit of the query with one triangle, or none. This is the definition of a hit, on plain scalars: whether
/// the query meets the triangle is decided exactly.
[[nodiscard]] RayHit meet(const Query& query, const std::array<glm::vec3, 3>& corners, PrimitiveId id);

/// The same for a triangle that the query certainly meets.
[[nodiscard]] RayHit certain_hit(const Query& query, const std::array<glm::vec3, 3>& corners, PrimitiveId id,
                                 bool is_front);

/// Returns false if the point is undefined: a value is not finite, a weight is negative, or no weight is above zero.
[[nodiscard]] bool is_valid(const TrianglePoint& point);

using CornerPositions = std::array<glm::vec3, 3>;

/// Returns whether the vertices are those of the point's own triangle, in any order.
[[nodiscard]] bool is_own(const CornerPositions& corners, const TrianglePoint& point);

/// True if the ray from the point towards the light passes through the triangle. Passing through an edge or vertex
/// counts; passing along the triangle's plane or starting on it does not. A point's own triangle never counts. Takes
/// tens of nanoseconds, or microseconds if the ray is within 1e-14 of touching. Precondition: is_valid(point), finite
/// values elsewhere, and a direction.
[[nodiscard]] bool stands_before(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light);

/// Returns the rounded point where the ray passes through the triangle's plane. Precondition: stands_before() is true.
[[nodiscard]] glm::dvec3 passed_point(const CornerPositions& corners, const TrianglePoint& point,
                                      const glm::vec3& to_light);

/// Returns the rounded position of the point.
[[nodiscard]] glm::dvec3 position_of(const TrianglePoint& point);

/// Whether the query goes on through the triangle that it meets: by a hole, or from behind.
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
/// are as many answers as queries. \returns the number of nodes and leaves that were visited, the same for every
/// instruction set.
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
