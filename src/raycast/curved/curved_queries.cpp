// SPDX-License-Identifier: Apache-2.0
// Single rays, segments and scans among curved surfaces and triangles: the nearer of what each of the two indexes has.
#include <cmath>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/scan_parts.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

constexpr std::size_t kQueriesPerPart = 256;

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Of what lies on the line, whose `to` is the end of a segment, and what `flat` says of its triangles.
CurvedHit nearer(const CurvedParts& parts, DoubleRay line, const RayHit& flat) {
  if (flat) line.to = flat.t;
  const CurvedHit best = parts.nearest(line);
  if (!flat) return best;
  const PrimitiveId element = parts.element_of(flat.primitive);
  if (best && (best.t < flat.t || best.primitive < element)) return best;
  return {element, flat.t, flat.is_front, glm::dvec2(0), glm::dvec3(0)};
}

constexpr double kAfterStart = std::numeric_limits<double>::denorm_min(), kBeforeEnd = 1 - 0x1p-53;

glm::vec3 plane_normal(const CurvedParts& parts, PrimitiveId element) {
  const std::array<glm::vec3, 3> p = parts.corners_of(element);
  const glm::dvec3 a(p[0]), normal = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
  return glm::vec3(normal / std::max(glm::length(normal), std::numeric_limits<double>::min()));
}

}  // namespace

CurvedHit closest_hit(const CurvedIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == glm::vec3(0)) return {};
  const CurvedParts& parts = index.parts();
  return nearer(parts, {ray.origin, ray.direction, kAfterStart}, closest_hit(parts.triangles, ray));
}

CurvedHit closest_hit(const CurvedIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  if (!is_finite(segment.from) || !is_finite(segment.to) || segment.from == segment.to) return {};
  const CurvedParts& parts = index.parts();
  const glm::dvec3 from(segment.from), along = glm::dvec3(segment.to) - from;
  return nearer(parts, {from, along, kAfterStart, kBeforeEnd}, closest_hit(parts.triangles, segment));
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
  RangeScan& all = result.scan;
  result.normals = Buffer<glm::vec3>(all.ranges.size());
  cast_parts(all, execution, [&](std::size_t first, std::span<const Ray> rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const CurvedHit hit = closest_hit(index, rays[i]);
      all.primitives[first + i] = hit.primitive;
      all.ranges[first + i] = std::numeric_limits<float>::infinity();
      if (!hit) continue;
      all.ranges[first + i] = float(hit.t * glm::length(glm::dvec3(rays[i].direction)));
      const bool is_flat = hit.normal == glm::dvec3(0);
      result.normals[first + i] = is_flat ? plane_normal(index.parts(), hit.primitive) : glm::vec3(hit.normal);
    }
  });
  return result;
}

}  // namespace frontmost
