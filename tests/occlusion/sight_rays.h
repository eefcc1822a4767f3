// SPDX-License-Identifier: Apache-2.0
// Checks answers of occlusion culling by rays between the samples: the first hit of a ray is visible.
#pragma once

#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "frontmost/raycast.h"
#include "support/random_scene.h"

namespace frontmost::test {

/// The line of sight through a point of the picture, from the near plane on.
inline Ray sight_line(const View& view, double x, double y) {
  const Projection& p = view.projection;
  const double right = p.left + (p.right - p.left) * x / view.width, up = p.top - (p.top - p.bottom) * y / view.height;
  const glm::dvec3 across = right * view.right() + up * view.up();
  if (p.orthographic) return {glm::vec3(view.eye() + across + p.clip.near * view.forward()), glm::vec3(view.forward())};
  const glm::dvec3 direction = view.forward() + across;
  return {glm::vec3(view.eye() + p.clip.near * direction), glm::vec3(direction)};
}

/// Number and seed of random lines of sight.
struct SightLines {
  int count;
  std::uint64_t seed = 5;
};

/// Number of random lines of sight whose first hit has a false `is_seen(primitive id)`.
template <class IsSeen>
std::size_t wrong_sight_lines(const Surfaces& surfaces, const View& view, const SightLines& lines,
                              const IsSeen& is_seen) {
  const RayIndex index(surfaces);
  Random random(lines.seed);
  std::vector<Ray> rays;
  for (int i = 0; i < lines.count; ++i) {
    const double x = double(random.unit()) * view.width;
    rays.push_back(sight_line(view, x, double(random.unit()) * view.height));
  }
  std::vector<RayHit> hits(rays.size());
  closest_hits(index, rays, hits);
  std::size_t wrong = 0;
  for (const RayHit& hit : hits) wrong += hit && !is_seen(hit.primitive);
  return wrong;
}

/// Number of random lines of sight whose first hit belongs to an instance not marked as visible.
inline std::size_t wrong_sights(const Surfaces& surfaces, const View& view, std::span<const ObjectSight> sights,
                                const SightLines& lines) {
  return wrong_sight_lines(surfaces, view, lines, [&](PrimitiveId id) {
    return sights[surfaces.source(id).instance] == ObjectSight::may_be_seen;
  });
}

}  // namespace frontmost::test
