// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "harness/coverage.h"
#include "view/screen_transform.h"

namespace frontmost::bench {
namespace {

// Snapping moves a vertex by up to half of 1/256 pixel each way, and so an edge by up to 0.71 of 1/256 pixel. The rays'
// own arithmetic, in floats about the eye, moves the edge by as much again.
constexpr double kNearEdge = kSubPixels / 128.0;
constexpr double kSameDistance = 1e-5;

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double length_squared = glm::dot(along, along);
  const double t = length_squared > 0 ? std::clamp(glm::dot(p - a, along) / length_squared, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * along));
}

/// Distance from a point to the nearest edge of the triangle, in 1/256 pixel; `point` is relative to the centre of the
/// picture. Negative if the triangle is clipped.
double distance_to_edge(const ScreenTransform& t, const Mesh& mesh, PrimitiveId id, const glm::dvec2& point) {
  glm::dvec2 corners[3];
  for (int k = 0; k < 3; ++k) {
    const HomogeneousVertex v = transform(t, mesh.positions[mesh.triangles[id][k]]);
    if (!is_plain(t, v)) return -1;
    corners[k] = glm::dvec2(v.x, v.y) / double(v.d);
  }
  return std::min({distance_to_segment(point, corners[0], corners[1]),
                   distance_to_segment(point, corners[1], corners[2]),
                   distance_to_segment(point, corners[2], corners[0])});
}

struct Pixel {
  glm::dvec2 centre;  ///< in 1/256 pixel from the centre of the picture
  PrimitiveId ours, rays;
  float our_depth, ray_depth;
};

void judge(const ScreenTransform& t, const Mesh& mesh, const Pixel& pixel, RayReport& report) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const PrimitiveId id : {pixel.ours, pixel.rays})
    if (id != no_primitive) nearest = std::min(nearest, distance_to_edge(t, mesh, id, pixel.centre));
  const bool is_close = std::abs(pixel.our_depth - pixel.ray_depth) <= kSameDistance * double(pixel.our_depth);
  if (nearest < 0)
    ++report.clipped;
  else if (nearest <= kNearEdge)
    ++report.edge;
  else if (is_close)
    ++report.depth;
  else
    ++report.disagreed;
}

}  // namespace

RayReport compare_with_rays(const Scene& scene, const Visible& visible, RayPeer& peer) {
  const ScreenTransform t(visible.view);
  const Mesh& mesh = scene.meshes.at(0);
  peer.draw();
  const PeerImage rays = peer.read();
  const Buffer<float> our_depths = depths_of(visible);
  RayReport report;
  for (int y = 0; y < visible.view.height; ++y)
    for (int x = 0; x < visible.view.width; ++x) {
      const std::size_t i = visible.index(x, y);
      const PrimitiveId a = visible.primitives[i], b = rays.primitives[i];
      report.covered += a != no_primitive && b != no_primitive;
      if (a == b) continue;
      ++(b == no_primitive ? report.only_ours : a == no_primitive ? report.only_rays : report.other_ids);
      const glm::dvec2 centre((x + 0.5) * kSubPixels - t.centre_x, (y + 0.5) * kSubPixels - t.centre_y);
      judge(t, mesh, {centre, a, b, our_depths[i], rays.depths[i]}, report);
    }
  return report;
}

}  // namespace frontmost::bench
