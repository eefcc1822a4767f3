// SPDX-License-Identifier: Apache-2.0
// Single rays, segments and scans among curved surfaces and triangles: the nearer of what each of the two indexes has.
//
//    ray --closest_hit() of triangles--> ends there --curved primitives before it--> the nearer of the two
//
// Segments are closed at neither end: what is met exactly at its beginning or end does not count, as for triangles. So
// their rays begin at the least number above 0 and end at the greatest below 1.
#include <cmath>

#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/curved/patch_packet.h"
#include "raycast/query/queries.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

constexpr std::size_t kQueriesPerPart = 256;

/// Of what was met on a line of curved surfaces and of triangles, the nearer.
CurvedHit nearer(const CurvedParts& parts, const CurvedHit& curved, const RayHit& flat) {
  if (!flat) return curved;
  const PrimitiveId element = parts.element_of(flat.primitive);
  if (curved && (curved.t < flat.t || (curved.t == flat.t && curved.primitive < element))) return curved;
  return {element, flat.t, flat.is_front, glm::dvec2(0), glm::dvec3(0)};
}

/// `line` ends where the segment does.
CurvedHit nearest_on(const CurvedParts& parts, DoubleRay line, const RayHit& flat) {
  if (flat) line.to = flat.t;
  return nearer(parts, parts.nearest(line), flat);
}

constexpr double kAfterStart = std::numeric_limits<double>::denorm_min(), kBeforeEnd = 1 - 0x1p-53;

bool is_valid(const Ray& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != glm::vec3(0);
}

glm::vec3 plane_normal(const CurvedParts& parts, PrimitiveId element) {
  const std::array<glm::vec3, 3> p = parts.corners_of(element);
  const glm::dvec3 a(p[0]), normal = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
  return glm::vec3(normal / std::max(glm::length(normal), std::numeric_limits<double>::min()));
}

void put(const CurvedParts& parts, const CurvedHit& hit, const Ray& ray, CurvedScan& out, std::size_t at) {
  out.scan.primitives[at] = hit.primitive;
  out.scan.ranges[at] = std::numeric_limits<float>::infinity();
  if (!hit) return;
  out.scan.ranges[at] = float(hit.t * glm::length(glm::dvec3(ray.direction)));
  const bool is_flat = hit.normal == glm::dvec3(0);
  out.normals[at] = is_flat ? plane_normal(parts, hit.primitive) : glm::vec3(hit.normal);
}

/// Up to kPacketRays rays, the first of which has the number `first`.
void cast_packet(const CurvedParts& parts, std::span<const Ray> rays, Isa isa, CurvedScan& out, std::size_t first) {
  std::array<DoubleRay, kPacketRays> lines;
  std::array<RayHit, kPacketRays> flat;
  std::array<CurvedHit, kPacketRays> curved;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_valid(rays[i])) continue;  // the line that is there by itself will do
    flat[i] = closest_hit(parts.triangles, rays[i]);
    lines[i] = {rays[i].origin, rays[i].direction, kAfterStart, flat[i].t};
  }
  parts.nearest({lines.data(), rays.size()}, curved, isa);
  for (std::size_t i = 0; i < rays.size(); ++i)
    put(parts, is_valid(rays[i]) ? nearer(parts, curved[i], flat[i]) : CurvedHit(), rays[i], out, first + i);
}

}  // namespace

CurvedHit closest_hit(const CurvedIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  if (!is_valid(ray)) return {};
  const CurvedParts& parts = index.parts();
  return nearest_on(parts, {ray.origin, ray.direction, kAfterStart}, closest_hit(parts.triangles, ray));
}

CurvedHit closest_hit(const CurvedIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  if (!is_finite(segment.from) || !is_finite(segment.to) || segment.from == segment.to) return {};
  const CurvedParts& parts = index.parts();
  const glm::dvec3 from(segment.from), along = glm::dvec3(segment.to) - from;
  return nearest_on(parts, {from, along, kAfterStart, kBeforeEnd}, closest_hit(parts.triangles, segment));
}

void closest_hits(const CurvedIndex& index, std::span<const Segment> segments, std::span<CurvedHit> answers,
                  const Execution& execution) {
  if (segments.size() != answers.size())
    throw Error(ErrorCode::bad_argument, "answers: there are " + std::to_string(answers.size()) + " places for " +
                                             std::to_string(segments.size()) + " queries");
  parallel_for(execution, segments.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) answers[i] = closest_hit(index, segments[i]);
  });
}

CurvedScan scan(const CurvedIndex& index, const RayCamera& camera, const Execution& execution) {
  CurvedScan result{prepare_scan(camera), {}};
  result.normals = Buffer<glm::vec3>(result.scan.ranges.size());
  const CurvedParts& parts = index.parts();
  cast_parts(result.scan, execution, [&](std::size_t first, std::span<const Ray> rays) {
    const IeeeScope ieee;
    for (std::size_t at = 0; at < rays.size(); at += kPacketRays)
      cast_packet(parts, rays.subspan(at, std::min(kPacketRays, rays.size() - at)), execution.isa, result, first + at);
  });
  keep_in_range(result.scan, execution);
  return result;
}

Buffer<float> incidence_angles(const CurvedScan& scan, const Execution& execution) {
  return incidence_to([&](std::size_t i) { return glm::dvec3(scan.normals[i]); }, scan.scan, execution);
}

}  // namespace frontmost
